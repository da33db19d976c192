#include "cli/options.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace sahl::cli {

namespace {

constexpr int most_threads = 1024;
constexpr int most_pixels_a_side = 65536;
constexpr int most_generations = 64;

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
