// `sahl convert`: a scene from one format into another.
#include <memory>

#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/interruption.h"
#include "cli/options.h"
#include "cli/standard_output.h"

namespace sahl::cli {

namespace {

struct ConvertOptions {
    std::string input;
    std::string output;
    LoadOptions loading;
};

/// Throws as write_scene; what the format cannot hold is an error of the scene, by its name.
void write(const ConvertOptions& options, const Scene& scene) {
    try {
        write_scene(options.output, scene);
    } catch (const Error& error) {
        if (error.code() != ExitCode::scene) throw;
        throw Error(error.code(), fmt::format("{}: {}", options.input, error.what()));
    }
}

ExitCode convert(const ConvertOptions& options, const CommonOptions& common) {
    std::error_code neither_exists;
    if (std::filesystem::equivalent(options.input, options.output, neither_exists)) {
        throw Error(
            ExitCode::usage,
            fmt::format("'{}' is the scene that is read; give the result another name", options.output));
    }
    check_scene_output(options.output);
    const Scene scene = load_scene(options.input, options.loading);
    defer_interruption();  // the file becomes whole
    write(options, scene);
    if (common.json) {
        print_event({{"event", "convert"},
                     {"input", options.input},
                     {"output", options.output},
                     {"primitives", scene.primitives.size()},
                     {"materials", scene.materials.size()},
                     {"lights", scene.lights.size()},
                     {"cameras", scene.cameras.size()},
                     {"groups", scene.groups.size()}});
    }
    if (!common.quiet) print_message(fmt::format("wrote {}\n", options.output));
    return ExitCode::ok;
}

}  // namespace

Command add_convert_command(CLI::App& app, CommonOptions& common) {
    const auto options = std::make_shared<ConvertOptions>();
    CLI::App* command = app.add_subcommand("convert", "writes a scene in another format");
    add_scene_argument(*command, "IN", options->input);
    command->add_option("OUT", options->output, "scene file to write: .json, .nff or .test")
        ->required()
        ->type_name("FILE");
    add_scene_options(*command, options->loading);
    add_common_options(*command, common);
    command->footer(
        "The result renders as the same image, bit for bit. .json can hold every scene; what .nff\n"
        "or .test cannot hold is an error (exit status 3) that names it. Parameters and includes\n"
        "are gone from the result: it has their values.\n"
        "Examples:\n"
        "  sahl convert balls.nff balls.json\n"
        "  sahl convert scene.test scene.json\n"
        "  sahl convert room.json red-room.json --set wall=1,0,0");
    return {command, [options, &common] { return convert(*options, common); }};
}

}  // namespace sahl::cli
