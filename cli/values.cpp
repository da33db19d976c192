#include "cli/values.h"

#include <algorithm>
#include <limits>

namespace sahl::cli {

namespace {

constexpr int most_pixels_a_side = 65536;
constexpr int most_generations = 64;

}  // namespace

std::string either(const std::vector<std::string>& words) {
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i) {
        text += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
    }
    return text;
}

void refuse(std::string_view option, std::string_view text, std::string_view wanted) {
    throw Error(ExitCode::usage, fmt::format("{} '{}': {} is wanted", option, text, wanted));
}

double read_number(std::string_view option, std::string_view text, double least, double most) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !(value >= least && value <= most)) {
        refuse(option, text, fmt::format("a number from {} to {}", least, most));
    }
    return value;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> pieces;
    for (;;) {
        const std::size_t end = text.find(separator);
        pieces.push_back(text.substr(0, end));
        if (end == std::string_view::npos) return pieces;
        text.remove_prefix(end + 1);
    }
}

std::uint64_t read_bytes(std::string_view option, std::string_view text) {
    constexpr std::string_view wanted = "a number of bytes such as 500M or 8G (powers of 1024: K, M, G, T)";
    constexpr std::string_view units = "KMGT";
    if (text.empty()) refuse(option, text, wanted);
    const std::size_t unit = units.find(text.back());
    const std::size_t shift = unit == units.npos ? 0 : 10 * (unit + 1);
    std::uint64_t value = 0;
    const char* end = text.data() + text.size() - (shift > 0 ? 1 : 0);
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stop != end || value > std::numeric_limits<std::uint64_t>::max() >> shift)
        refuse(option, text, wanted);
    return value << shift;
}

Resolution read_size(std::string_view option, std::string_view text) {
    const std::vector<std::string_view> sides = split(text, 'x');
    if (sides.size() != 2) refuse(option, text, "WIDTHxHEIGHT, such as 640x480,");
    return {read_whole<int>(option, sides[0], 1, most_pixels_a_side),
            read_whole<int>(option, sides[1], 1, most_pixels_a_side)};
}

SampleRange read_samples(std::string_view option, std::string_view text) {
    const std::size_t dots = text.find("..");
    if (dots == std::string_view::npos) refuse(option, text, "A..B, such as 0..8,");
    const SampleRange samples{read_whole<int>(option, text.substr(0, dots), 0, most_samples),
                              read_whole<int>(option, text.substr(dots + 2), 0, most_samples)};
    if (samples.begin >= samples.end) refuse(option, text, "a range with A < B (B is just outside)");
    return samples;
}

Crop read_crop(std::string_view option, std::string_view text) {
    const std::vector<std::string_view> edges = split(text, ',');
    if (edges.size() != 4) refuse(option, text, "X0,Y0,X1,Y1 in pixels, such as 0,0,64,64,");
    const auto edge = [&](std::size_t i) { return read_whole<int>(option, edges[i], 0, most_pixels_a_side); };
    const Crop crop{edge(0), edge(1), edge(2), edge(3)};
    if (crop.x0 >= crop.x1 || crop.y0 >= crop.y1) {
        refuse(option, text, "a crop with X0 < X1 and Y0 < Y1 (X1 and Y1 are just outside)");
    }
    return crop;
}

std::vector<int> read_depths(std::string_view option, std::string_view text) {
    std::vector<int> depths;
    for (const std::string_view piece : split(text, ',')) {
        const int depth = read_whole<int>(option, piece, 0, most_generations);
        if (std::find(depths.begin(), depths.end(), depth) != depths.end()) {
            refuse(option, text, "each depth once");
        }
        depths.push_back(depth);
    }
    return depths;
}

}  // namespace sahl::cli
