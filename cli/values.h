// Values of the command line: each kind is read and checked here, once, with a message that says
// what is allowed.
#pragma once

#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "engine/sahl.h"

namespace CLI {  // NOLINT(readability-identifier-naming): CLI11's
class App;
class Option;
}  // namespace CLI

namespace sahl::cli {

constexpr int most_samples = 16384;  ///< a pixel; more could overflow the film's fixed point

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

/// "a, b or c".
std::string either(const std::vector<std::string>& words);

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

/// The words for the values of a choice.
template <class T>
using Choices = std::vector<std::pair<std::string, T>>;

template <class T>
std::vector<std::string> words_of(const Choices<T>& choices) {
    std::vector<std::string> words;
    for (const auto& choice : choices) words.push_back(choice.first);
    return words;
}

/// One of a few words.
template <class T>
T read_choice(std::string_view option, std::string_view text, const Choices<T>& choices) {
    for (const auto& [word, value] : choices) {
        if (text == word) return value;
    }
    refuse(option, text, fmt::format("one of {}", fmt::join(words_of(choices), ", ")));
}

/// Bytes: "4096", "64K", "64M", "8G", "1T", in powers of 1024.
std::uint64_t read_bytes(std::string_view option, std::string_view text);

/// "640x480".
Resolution read_size(std::string_view option, std::string_view text);

/// "X0,Y0,X1,Y1" with 0 <= X0 < X1 and 0 <= Y0 < Y1.
Crop read_crop(std::string_view option, std::string_view text);

/// "A..B" with 0 <= A < B.
SampleRange read_samples(std::string_view option, std::string_view text);

/// "4" or "0,1,2,3": each depth once.
std::vector<int> read_depths(std::string_view option, std::string_view text);

/// The pieces between `separator`s; one more than there are separators.
std::vector<std::string_view> split(std::string_view text, char separator);

}  // namespace sahl::cli
