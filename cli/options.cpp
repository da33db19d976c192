#include "cli/options.h"

#include <map>

namespace sahl::cli {

namespace {

constexpr int most_threads = 1024;

/// CLI11's options have no room for them.
std::map<const CLI::Option*, OptionWords>& all_words() {
    static std::map<const CLI::Option*, OptionWords> words;
    return words;
}

std::pair<std::string, std::string> read_assignment(std::string_view option, const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == 0 || equals == std::string::npos) {
        refuse(option, text, "NAME=VALUE, such as radius=1.5 or color=1,0,0,");
    }
    return {text.substr(0, equals), text.substr(equals + 1)};
}

}  // namespace

const OptionWords& words_of(const CLI::Option& option) {
    static const OptionWords none;
    const auto found = all_words().find(&option);
    return found == all_words().end() ? none : found->second;
}

void set_words(const CLI::Option& option, OptionWords words) { all_words()[&option] = std::move(words); }

void add_device_options(CLI::App& app, CommonOptions& options) {
    add_value(
        app, "--device", "ID", [&options](const std::string& text) { options.device.selector = text; },
        "OpenCL device: index or part of a name, see 'sahl devices' (default: PoCL's CPU)")
        ->group("Device");
    add_value(
        app, "--threads", "N",
        [&options](const std::string& text) {
            options.device.threads = read_whole<int>("--threads", text, 1, most_threads);
        },
        "CPU threads of a PoCL device (default: all)")
        ->group("Device");
}

void add_common_options(CLI::App& app, CommonOptions& options) {
    app.add_flag("--json", options.json, "results as JSON on standard output, one object a line")
        ->group("Messages");
    app.add_flag("-q,--quiet", options.quiet, "errors only")->group("Messages");
    app.add_flag("-v,--verbose", options.verbose, "more about what happens")->group("Messages");
    add_choice<ColorMode>(
        app, "--color", "WHEN", options.color,
        {{"auto", ColorMode::automatic}, {"always", ColorMode::always}, {"never", ColorMode::never}},
        "(default: auto, on a terminal without NO_COLOR)")
        ->group("Messages");
}

void add_scene_argument(CLI::App& app, const std::string& name, std::string& target) {
    CLI::Option* option =
        app.add_option(name, target, "scene file: .json, .nff or .test")->required()->type_name("FILE");
    set_words(*option, {.extensions = {"json", "nff", "test"}});
}

void add_scene_options(CLI::App& app, LoadOptions& options) {
    const auto set = [&options](const std::string& text) {
        auto assignment = read_assignment("--set", text);
        for (const auto& [name, value] : options.parameters) {
            if (name == assignment.first) refuse("--set", text, "each name once");
        }
        options.parameters.push_back(std::move(assignment));
    };
    add_values(app, "--set", "NAME=VALUE", set, "a parameter of a Sahl scene; may be given several times")
        ->group("Scene");
    add_value(
        app, "--asset-root", "DIR", [&options](const std::string& text) { options.asset_root = text; },
        "all files that the scene names lie in here (default: the scene's folder)")
        ->group("Scene");
}

}  // namespace sahl::cli
