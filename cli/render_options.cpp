#include "cli/render_options.h"

#include <algorithm>

#include "cli/options.h"

namespace sahl::cli {

namespace {

constexpr double most_stops = 100;
constexpr std::string_view all_aovs = "all";

std::vector<Aov> read_aovs(std::string_view option, std::string_view text) {
    if (text == all_aovs) return aovs_of_first_hits();
    Choices<Aov> choices;
    for (const AovName& name : aov_names) choices.emplace_back(name.name, name.aov);
    std::vector<Aov> aovs;
    for (const std::string_view piece : split(text, ',')) {
        if (piece == all_aovs) {
            throw Error(ExitCode::usage, fmt::format("{} '{}': '{}' stands alone", option, text, all_aovs));
        }
        const Aov aov = read_choice<Aov>(option, piece, choices);
        if (std::find(aovs.begin(), aovs.end(), aov) != aovs.end()) refuse(option, text, "each AOV once");
        aovs.push_back(aov);
    }
    return aovs;
}

void check_compression_name(const std::string& text) {
    const std::vector<std::string> names = compression_names();
    if (std::find(names.begin(), names.end(), text.substr(0, text.find(':'))) == names.end()) {
        refuse("--compression", text, fmt::format("one of {}", fmt::join(names, ", ")));
    }
}

}  // namespace

void add_aov_option(CLI::App& command, std::vector<Aov>& aovs) {
    OptionWords words{.list = true, .alone = std::string(all_aovs)};
    for (const AovName& name : aov_names) words.words.emplace_back(name.name);
    CLI::Option* option = add_value(
        command, "--aov", "LIST", [&aovs](const std::string& text) { aovs = read_aovs("--aov", text); },
        fmt::format("channels beside the image in EXR files: {} (without costs), or several of {}",
                    words.alone, fmt::join(words.words, ", ")));
    set_words(*option, std::move(words));
}

void add_encoding_options(CLI::App& command, OutputSettings& encoding) {
    add_choice<Transfer>(command, "--transfer", "CURVE", encoding.transfer,
                         {{"srgb", Transfer::srgb}, {"linear", Transfer::linear}},
                         "(default: srgb for 8 and 16 bits, linear for floats)");
    add_choice<Rounding>(command, "--rounding", "RULE", encoding.rounding,
                         {{"round", Rounding::round}, {"floor", Rounding::floor}},
                         "for 8 and 16 bits (default: round)");
    add_value(
        command, "--exposure", "STOPS",
        [&encoding](const std::string& text) {
            encoding.exposure = static_cast<float>(read_number("--exposure", text, -most_stops, most_stops));
        },
        "makes the image 2^STOPS as bright (default: 0)");
    add_choice<PixelType>(command, "--pixel-type", "TYPE", encoding.pixel_type,
                          {{"half", PixelType::half},
                           {"float", PixelType::float32},
                           {"uint8", PixelType::uint8},
                           {"uint16", PixelType::uint16}},
                          "(default: the format's)");
    CLI::Option* compression = add_value(
        command, "--compression", "NAME[:LEVEL]",
        [&encoding](const std::string& text) {
            check_compression_name(text);
            encoding.compression = text;
        },
        fmt::format("{}; levels: jpeg:1..100, zip:0..9 in PNG, dwaa:1..500 (default: the format's)",
                    either(compression_names())));
    set_words(*compression, {compression_names()});
}

void add_view_options(CLI::App& command, RenderOptions& options) {
    add_value(
        command, "--camera", "NAME", [&options](const std::string& text) { options.camera = text; },
        "one of the scene's cameras (default: its first)");
    add_value(
        command, "--size", "WxH",
        [&options](const std::string& text) { options.size = read_size("--size", text); },
        "pixels (default: the scene's)");
    add_value(
        command, "--depth", "N[,N...]",
        [&options](const std::string& text) { options.depths = read_depths("--depth", text); },
        "generations of rays after the camera's, 0 to 64 (default: the scene's)");
    add_value(
        command, "--spp", "N",
        [&options](const std::string& text) {
            options.spp = read_whole<int>("--spp", text, 1, most_samples);
        },
        "samples a pixel, 1 to 16384 (default: 1, the pixel's centre)");
    add_value(
        command, "--samples", "A..B",
        [&options](const std::string& text) { options.samples = read_samples("--samples", text); },
        "only samples A to B - 1 of the --spp of each pixel");
    add_value(
        command, "--seed", "N",
        [&options](const std::string& text) {
            options.seed =
                read_whole<std::uint64_t>("--seed", text, 0, std::numeric_limits<std::uint64_t>::max());
        },
        "of the random numbers (default: 0)");
}

void add_image_options(CLI::App& command, RenderOptions& options) {
    add_view_options(command, options);
    add_value(
        command, "--crop", "X0,Y0,X1,Y1",
        [&options](const std::string& text) { options.crop = read_crop("--crop", text); },
        "only these pixels; X1 and Y1 are just outside");
}

void add_traversal_option(CLI::App& command, std::optional<Traversal>& traversal) {
    add_choice<Traversal>(
        command, "--traversal", "WAY", traversal,
        {{"packet", Traversal::packet}, {"stream", Traversal::stream}, {"scalar", Traversal::scalar}},
        "of rays through the tree, which changes no image: neighbours together, single rays "
        "in turn, or ray by ray (default: on CPUs packet for batches of rays that keep together and stream "
        "for others, elsewhere scalar)");
}

void add_tree_options(CLI::App& command, BuildQuality& quality, std::optional<Traversal>& traversal) {
    add_choice<BuildQuality>(
        command, "--build-quality", "QUALITY", quality,
        {{"high", BuildQuality::high}, {"fast", BuildQuality::fast}},
        "of the tree over the primitives: fast builds it in less time, and rays take longer "
        "(default: high)");
    add_traversal_option(command, traversal);
}

void add_memory_limit(CLI::App& command, std::optional<std::uint64_t>& limit) {
    add_value(
        command, "--max-mem", "SIZE",
        [&limit](const std::string& text) { limit = read_bytes("--max-mem", text); },
        "most memory to use, such as 500M or 8G; the OpenCL driver's own comes on top (default: the "
        "machine's)")
        ->group("Memory");
}

void add_render_options(CLI::App& command, RenderOptions& options) {
    add_scene_argument(command, "SCENE", options.scene);
    add_values(
        command, "-o,--output", "FILE",
        [&options](const std::string& text) { options.outputs.push_back(text); },
        "image, may be given several times; {depth} stands for the depth, missing folders are made "
        "(default: the scene's name, .png, here)");
    add_scene_options(command, options.loading);
    add_image_options(command, options);
    add_aov_option(command, options.aovs);
    add_encoding_options(command, options.encoding);
    add_tree_options(command, options.build_quality, options.traversal);
    add_memory_limit(command, options.max_memory);
    command
        .add_flag("--dry-run", options.dry_run,
                  "checks everything and says what would be done; renders nothing")
        ->group("Memory");
}

}  // namespace sahl::cli
