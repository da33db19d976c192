#include "cli/batch_options.h"

#include <cmath>
#include <memory>

#include "cli/options.h"
#include "cli/render_options.h"
#include "engine/batch/number_ranges.h"

namespace sahl::cli {

namespace {

constexpr double most_seconds = 1e6;

std::vector<int> read_frames(std::string_view option, std::string_view text) {
    constexpr double largest_frame = 1e9;
    constexpr std::string_view wanted = "a list of frames such as 1-100x2,150";
    const auto numbers = parse_ranges(text);
    if (!numbers) refuse(option, text, wanted);
    std::vector<int> frames;
    for (const double number : *numbers) {
        if (std::floor(number) != number || std::abs(number) > largest_frame) refuse(option, text, wanted);
        frames.push_back(static_cast<int>(number));
    }
    return frames;
}

void add_what_options(CLI::App& command, BatchOptions& options) {
    CLI::Option* files = command.add_option(
        "FILES", options.files, "a manifest (.json with the key 'jobs'), or scenes: .json, .nff, .test");
    files->required()->type_name("FILE");
    set_words(*files, {.extensions = {"json", "nff", "test"}});
    add_values(
        command, "-o,--output", "PATTERN",
        [&options](const std::string& text) { options.outputs.push_back(text); },
        "names of the images, with {scene}, {camera}, {frame:04} and parameters in braces; may be given "
        "several "
        "times (default: the manifest's; {scene}.png)");
    add_value(
        command, "--cameras", "NAME[,NAME...]",
        [&options](const std::string& text) {
            for (const std::string_view name : split(text, ',')) options.cameras.emplace_back(name);
        },
        "of the scenes; an image for each (default: the first)");
    add_value(
        command, "--frames", "RANGES",
        [&options](const std::string& text) { options.frames = read_frames("--frames", text); },
        "such as 1-100x2,150: an image for each");
}

void add_setting_options(CLI::App& command, BatchOptions& options) {
    ImageSettings& settings = options.settings;
    add_value(
        command, "--size", "WxH", [&](const std::string& text) { settings.size = read_size("--size", text); },
        "pixels (default: the manifest's or the scene's)");
    add_value(
        command, "--depth", "N",
        [&](const std::string& text) { settings.depth = read_whole<int>("--depth", text, 0, 64); },
        "generations of rays after the camera's, 0 to 64 (default: the manifest's or the scene's)");
    add_value(
        command, "--spp", "N",
        [&](const std::string& text) { settings.spp = read_whole<int>("--spp", text, 1, most_samples); },
        "samples a pixel, 1 to 16384 (default: the manifest's or 1)");
    add_value(
        command, "--seed", "N",
        [&](const std::string& text) {
            settings.seed =
                read_whole<std::uint64_t>("--seed", text, 0, std::numeric_limits<std::uint64_t>::max());
        },
        "of the random numbers (default: the manifest's or 0)");
}

void add_run_options(CLI::App& command, BatchOptions& options) {
    const char* group = "Run";
    const auto seconds = [&](const std::string& name, double& target, double least, const std::string& help) {
        add_value(
            command, name, "SECONDS",
            [&target, name, least](const std::string& text) {
                target = read_number(name, text, least, most_seconds);
            },
            help)
            ->group(group);
    };
    command
        .add_flag("--dry-run", options.dry_run,
                  "lists the images, the memory and an estimate; renders nothing")
        ->group(group);
    command.add_flag("--check", options.check, "says which images are not finished, and why (exit status 7)")
        ->group(group);
    command.add_flag("--force", options.force, "renders finished images again")->group(group);
    seconds("--timeout", options.hang_seconds, 0.1,
            "a worker that shows no progress for so long is replaced (default: 600)");
    seconds("--checkpoint", options.checkpoint_seconds, 0,
            "an image that takes longer is saved as far as it is, this often; 0: never (default: 60)");
    add_value(
        command, "--max-mem", "SIZE",
        [&options](const std::string& text) { options.max_memory = read_bytes("--max-mem", text); },
        "most memory to use, such as 500M or 8G; the OpenCL driver's own comes on top (default: the "
        "machine's)")
        ->group(group);
    add_value(
        command, "--status", "FILE", [&options](const std::string& text) { options.status_file = text; },
        "how far it is, as JSON, written anew each second")
        ->type_name("FILE")
        ->group(group);
    add_value(
        command, "--export-html", "FILE", [&options](const std::string& text) { options.html_file = text; },
        "a page with all images, their times and failures, written at the end")
        ->type_name("FILE")
        ->group(group);
}

}  // namespace

ImageSettings image_settings(const BatchOptions& options) {
    ImageSettings settings = options.settings;
    const OutputSettings& encoding = options.encoding;
    if (!options.aovs.empty()) settings.aovs = options.aovs;
    if (options.build_quality != BuildQuality::high) settings.build_quality = options.build_quality;
    if (encoding.exposure != 0) settings.exposure = encoding.exposure;
    settings.pixel_type = encoding.pixel_type;
    settings.transfer = encoding.transfer;
    settings.rounding = encoding.rounding;
    settings.compression = encoding.compression;
    return settings;
}

void add_batch_options(CLI::App& command, BatchOptions& options) {
    add_what_options(command, options);
    add_scene_options(command, options.loading);
    add_setting_options(command, options);
    add_aov_option(command, options.aovs);
    add_encoding_options(command, options.encoding);
    add_tree_options(command, options.build_quality, options.traversal);
    add_run_options(command, options);
}

}  // namespace sahl::cli
