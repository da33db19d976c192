#include "cli/profile_options.h"

#include "cli/options.h"

namespace sahl::cli {

namespace {

constexpr int most_frames = 10000;

void add_export(CLI::App& command, const std::string& name, std::optional<std::string>& target,
                const std::string& extension, const std::string& help) {
    CLI::Option* option = add_value(
        command, name, "FILE", [&target](const std::string& text) { target = text; }, help);
    option->group("Reports");
    set_words(*option, {.extensions = {extension}});
}

}  // namespace

void add_profile_options(CLI::App& command, ProfileOptions& options) {
    add_scene_argument(command, "SCENE", options.render.scene);
    command.get_option("SCENE")->required(false);  // a command below this one needs none
    add_value(
        command, "-o,--output", "FILE",
        [&options](const std::string& text) { options.render.outputs = {text}; },
        "image to write in each frame (default: encoded as PNG and thrown away)");
    add_scene_options(command, options.render.loading);
    add_image_options(command, options.render);
    add_tree_options(command, options.render.build_quality, options.render.traversal);
    add_memory_limit(command, options.render.max_memory);
    add_value(
        command, "--repeat", "N",
        [&options](const std::string& text) {
            options.repeat = read_whole<int>("--repeat", text, 1, most_frames);
        },
        "frames to measure (default: until their median is sure to 1 %, 7 to 100 frames or 10 s), or pairs "
        "of "
        "them with --ab (default: 300, fewer of frames that take long)")
        ->group("Measuring");
    add_value(
        command, "--warm-up", "N",
        [&options](const std::string& text) {
            options.warm_up = read_whole<int>("--warm-up", text, 0, most_frames);
        },
        "frames before these (default: 1)")
        ->group("Measuring");
    command
        .add_flag("--assert-no-jit", options.assert_no_jit,
                  "exit status 9 if a kernel had to be compiled; 'sahl warm' compiles them all")
        ->group("Measuring");
    add_export(command, "--export-json", options.json, "json", "the profile, see docs/profile.md");
    add_export(command, "--export-csv", options.csv, "csv", "its rows as a table");
    add_export(command, "--export-trace", options.trace, "json",
               "all launches and host steps in time, for ui.perfetto.dev or chrome://tracing");
    add_export(command, "--export-html", options.html, "html",
               "charts and tables as a page for browsers, which needs no network");
}

}  // namespace sahl::cli
