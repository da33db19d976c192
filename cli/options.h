// Options of several commands, and the ways of adding one. Files that add none include values.h alone: CLI11
// is most of what they would compile.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/values.h"

namespace sahl::cli {

void add_device_options(CLI::App& app, CommonOptions& options);
void add_common_options(CLI::App& app, CommonOptions& options);

/// The argument `name`, the scene to load.
void add_scene_argument(CLI::App& app, const std::string& name, std::string& target);

/// `--set` and `--asset-root`, of all commands that load a scene.
void add_scene_options(CLI::App& app, LoadOptions& options);

/// Adds an option whose text `read` turns into its value; `read` throws Error(usage).
template <class Read>
CLI::Option* add_value(CLI::App& app, const std::string& names, const std::string& value_name, Read read,
                       const std::string& help) {
    return app.add_option_function<std::string>(names, read, help)->type_name(value_name);
}

/// The same for an option that may be given several times; `read` gets one text at a time.
template <class Read>
CLI::Option* add_values(CLI::App& app, const std::string& names, const std::string& value_name, Read read,
                        const std::string& help) {
    const auto read_all = [read](const std::vector<std::string>& texts) {
        for (const std::string& text : texts) read(text);
    };
    return app.add_option_function<std::vector<std::string>>(names, read_all, help)
        ->type_name(value_name)
        ->allow_extra_args(false);
}

/// What an option's value may be, for completion; nothing where it may be any text.
struct OptionWords {
    std::vector<std::string> words{};
    bool list = false;                      ///< several, separated by commas
    std::string alone{};                    ///< of a list: one more word, which no other goes with
    std::vector<std::string> extensions{};  ///< of files
};
const OptionWords& words_of(const CLI::Option& option);
void set_words(const CLI::Option& option, OptionWords words);

/// Adds an option whose value is one of a few words; `help` goes on after "a, b or c ".
template <class T, class Target>
CLI::Option* add_choice(CLI::App& app, const std::string& name, const std::string& value_name, Target& target,
                        const Choices<T>& choices, const std::string& help) {
    CLI::Option* option = add_value(
        app, name, value_name,
        [name, choices, &target](const std::string& text) { target = read_choice(name, text, choices); },
        either(words_of(choices)) + " " + help);
    set_words(*option, {words_of(choices)});
    return option;
}

}  // namespace sahl::cli
