// Values of the command line: each kind is read and checked here, once, with a message that says
// what is allowed.
#pragma once

#include <charconv>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "engine/sahl.h"

namespace sahl::cli {

enum class ColorMode { automatic, always, never };

/// Options of all commands (those of the device: of the commands that use one). They may stand
/// before the command too.
struct CommonOptions {
    DeviceOptions device;
    bool quiet = false;
    bool verbose = false;
    bool json = false;
    ColorMode color = ColorMode::automatic;
};

void add_device_options(CLI::App& app, CommonOptions& options);
void add_common_options(CLI::App& app, CommonOptions& options);

/// Adds an option whose text `read` turns into its value; `read` throws Error(usage).
template <class Read>
CLI::Option* add_value(CLI::App& app, const std::string& names, const std::string& value_name, Read read,
                       const std::string& help) {
    return app.add_option_function<std::string>(names, read, help)->type_name(value_name);
}

/// Error(usage): "OPTION 'TEXT': WANTED is wanted".
[[noreturn]] void refuse(std::string_view option, std::string_view text, std::string_view wanted);

/// A decimal whole number from `least` to `most`, and nothing else.
template <class T>
T read_whole(std::string_view option, std::string_view text, T least, T most) {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < least || value > most) {
        refuse(option, text, fmt::format("a whole number from {} to {}", least, most));
    }
    return value;
}

/// A finite decimal number from `least` to `most`.
double read_number(std::string_view option, std::string_view text, double least, double most);

/// One of a few words.
template <class T>
T read_choice(std::string_view option, std::string_view text,
              std::initializer_list<std::pair<const char*, T>> choices) {
    std::string names;
    for (const auto& [name, value] : choices) {
        if (text == name) return value;
        names += (names.empty() ? "" : ", ") + std::string(name);
    }
    refuse(option, text, "one of " + names);
}

/// "640x480".
Resolution read_size(std::string_view option, std::string_view text);

/// "X0,Y0,X1,Y1" with 0 <= X0 < X1 and 0 <= Y0 < Y1.
Crop read_crop(std::string_view option, std::string_view text);

/// "4" or "0,1,2,3": each depth once.
std::vector<int> read_depths(std::string_view option, std::string_view text);

/// The pieces between `separator`s; one more than there are separators.
std::vector<std::string_view> split(std::string_view text, char separator);

}  // namespace sahl::cli
