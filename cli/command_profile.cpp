// `sahl profile`: where the time of a frame goes.
#include <memory>

#include "cli/commands.h"
#include "cli/interruption.h"
#include "cli/options.h"
#include "cli/profile_ab.h"
#include "cli/profile_options.h"
#include "cli/profile_setup.h"
#include "cli/profile_table.h"
#include "cli/render_settings.h"
#include "cli/standard_output.h"
#include "engine/core/atomic_file.h"
#include "engine/profile/chrome_trace.h"
#include "engine/profile/measure.h"
#include "engine/profile/profile_csv.h"
#include "engine/profile/profile_json.h"
#include "engine/profile/profile_page.h"

#include <nlohmann/json.hpp>

namespace sahl::cli {

namespace {

/// What is found wrong before a long measurement.
void check_files(const ProfileOptions& options) {
    for (const auto& file : {options.json, options.csv, options.trace, options.html}) {
        if (file) check_output_file(*file);
    }
}

/// What is said of a scene.
struct Measured {
    Measurement measurement;
    PagePictures pictures;  ///< for the page, if there is to be one
};

Image rendered_image(Prepared& prepared) {
    const RenderSettings& settings = prepared.job.settings;
    const Resolution size = image_size(settings);
    Film film(prepared.device->memory(), size.width, size.height);
    prepared.renderer->render(settings, film, {}, interruption());
    check_interruption();
    return film.resolve(settings.samples ? settings.samples->count() : settings.spp);
}

PagePictures pictures_of(Prepared& prepared) {
    PagePictures pictures{rendered_image(prepared)};
    std::vector<AovImage> costs =
        prepared.renderer->render_aovs(prepared.job.settings, costs_of_page, interruption());
    check_interruption();
    pictures.counts.push_back({"Rays", std::move(costs[0].uints)});
    pictures.counts.push_back({"Node visits", std::move(costs[1].uints)});
    return pictures;
}

Measured take_measurement(const ProfileOptions& options, const CommonOptions& common) {
    Prepared prepared = prepare(options, common);
    MeasureOptions how{options.warm_up, options.repeat};
    Measurement measured =
        measure(*prepared.device, *prepared.renderer, prepared.job, how, check_interruption);
    ProfileEnvironment environment = std::move(prepared.measurement.environment);
    environment.clock_uncertainty_ns = measured.environment.clock_uncertainty_ns;
    environment.overhead_percent = measured.environment.overhead_percent;
    environment.overhead_low_percent = measured.environment.overhead_low_percent;
    environment.overhead_high_percent = measured.environment.overhead_high_percent;
    environment.warm_up = measured.environment.warm_up;
    measured.environment = std::move(environment);
    measured.setup = std::move(prepared.measurement.setup);
    measured.compiles_in_setup = prepared.measurement.compiles_in_setup;
    measured.lights = prepared.measurement.lights;
    PagePictures pictures;
    if (options.html) pictures = pictures_of(prepared);
    return {std::move(measured), std::move(pictures)};
}

void write_text(const std::optional<std::string>& file, const std::string& text,
                const CommonOptions& common) {
    write_file(*file, std::as_bytes(std::span(text)));
    if (!common.quiet) print_message(fmt::format("wrote {}\n", *file));
}

void write_reports(const ProfileOptions& options, const Profile& profile, const Measured& measured,
                   const CommonOptions& common) {
    if (options.json) write_text(options.json, profile_json(profile), common);
    if (options.csv) write_text(options.csv, profile_csv(profile), common);
    if (options.trace) write_text(options.trace, chrome_trace(measured.measurement), common);
    if (options.html)
        write_text(options.html, profile_page(profile_json(profile), measured.pictures), common);
}

ExitCode run_profile(const ProfileOptions& options, const CommonOptions& common) {
    if (options.render.scene.empty()) {
        throw Error(ExitCode::usage, "SCENE is required\n'sahl profile --help' shows what there is");
    }
    check_files(options);
    if (!options.ab.settings.empty()) return run_ab(options, common);
    if (!options.ab.limits.empty()) {
        throw Error(
            ExitCode::usage,
            "--fail-if: there is nothing to compare with; give --ab, or two files to 'sahl profile diff'");
    }
    const Measured measured = take_measurement(options, common);
    const Profile profile = summarize(measured.measurement);
    defer_interruption();  // reports become whole
    write_reports(options, profile, measured, common);
    if (common.json) {
        nlohmann::ordered_json event{{"event", "profile"}};
        event.update(nlohmann::ordered_json::parse(profile_json(profile)));
        print_event(event);
    } else if (!common.quiet) {
        print(profile_text(profile));
    }
    const std::uint64_t compiled = profile.compiles_in_setup + profile.compiles_during_render;
    if (options.assert_no_jit && compiled > 0) {
        throw Error(
            ExitCode::performance,
            fmt::format("--assert-no-jit: {} kernels were compiled, {} of them while frames were rendered; "
                        "'sahl warm' compiles them beforehand",
                        compiled, profile.compiles_during_render));
    }
    return ExitCode::ok;
}

}  // namespace

Command add_profile_command(CLI::App& app, CommonOptions& common) {
    const auto options = std::make_shared<ProfileOptions>();
    CLI::App* command = app.add_subcommand("profile", "measures where the time of a frame goes, or compares");
    add_profile_options(*command, *options);
    add_ab_options(*command, options->ab);
    add_device_options(*command, common);
    add_common_options(*command, common);
    command->footer(
        "Frames are rendered, encoded and written again and again. The table has a row for each kernel and\n"
        "generation of rays: rays in and out, time, speed, bytes and operations beside what the device can "
        "do\n"
        "at most; nodes and leaves that rays visit are counted in a frame of its own. A frame's wall clock "
        "is\n"
        "the time that the device was busy and that it was idle, this by the step that the host was at.\n"
        "docs/profile.md says what each figure means.\n"
        "Examples:\n"
        "  sahl profile balls.nff\n"
        "  sahl profile scene.json --size 1920x1080 --depth 7 --repeat 20\n"
        "  sahl profile balls.nff --export-json balls.json --export-trace trace.json\n"
        "  sahl profile balls.nff --assert-no-jit -q --export-csv rows.csv\n"
        "  sahl profile balls.nff --export-html balls.html\n"
        "  sahl profile balls.nff --ab traversal=packet traversal=stream\n"
        "  sahl profile balls.nff --ab SAHL_KERNEL_DIR=kernels SAHL_KERNEL_DIR=new --fail-if intersect:+0%\n"
        "  sahl profile diff before.json after.json");
    return {command, [options, &common] { return run_profile(*options, common); }};
}

}  // namespace sahl::cli
