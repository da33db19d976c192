// `sahl batch`: many scenes, cameras and frames, in a process that outlives whatever goes wrong.
#include <algorithm>
#include <map>
#include <memory>
#include <set>

#include <fmt/format.h>

#include "cli/batch_html.h"
#include "cli/batch_listing.h"
#include "cli/batch_options.h"
#include "cli/batch_supervisor.h"
#include "cli/commands.h"
#include "cli/interruption.h"
#include "cli/options.h"
#include "engine/batch/expand.h"
#include "engine/core/atomic_file.h"

namespace sahl::cli {

namespace {

namespace fs = std::filesystem;

/// A scene that is no JSON is found among others when its turn comes, and they are rendered.
bool is_manifest_among(const std::vector<std::string>& files, const std::string& file) {
    try {
        return is_manifest(file);
    } catch (const Error&) {
        if (files.size() == 1) throw;
        return false;
    }
}

/// The scenes that the command line names.
BatchEntry entry_of(const BatchOptions& options, std::vector<fs::path> scenes) {
    BatchEntry entry{.scenes = std::move(scenes)};
    for (const std::string& name : options.cameras) entry.cameras.push_back({name});
    entry.frames = options.frames;
    for (const auto& [name, value] : options.loading.parameters)
        entry.parameters.push_back({name, std::vector{value}});
    entry.outputs = {"{scene}.png"};
    return entry;
}

void refuse_with_manifest(const BatchOptions& options, const std::string& manifest) {
    const auto refuse_option = [&](bool given, const char* option, const char* key) {
        if (!given) return;
        throw Error(ExitCode::usage,
                    fmt::format("{} is for scenes; the manifest {} has '{}'", option, manifest, key));
    };
    refuse_option(!options.cameras.empty(), "--cameras", "cameras");
    refuse_option(!options.frames.empty(), "--frames", "frames");
    refuse_option(!options.loading.parameters.empty(), "--set", "parameters");
}

std::vector<BatchEntry> read_entries(const BatchOptions& options) {
    std::vector<BatchEntry> entries;
    std::vector<fs::path> scenes;
    for (const std::string& file : options.files) {
        if (is_manifest_among(options.files, file)) {
            refuse_with_manifest(options, file);
            for (BatchEntry& entry : read_manifest(file)) entries.push_back(std::move(entry));
        } else {
            scenes.emplace_back(file);
        }
    }
    if (!scenes.empty()) entries.push_back(entry_of(options, std::move(scenes)));
    const ImageSettings settings = image_settings(options);
    for (BatchEntry& entry : entries) {
        entry.settings = overlay(entry.settings, settings);
        if (!options.outputs.empty()) entry.outputs = options.outputs;
        if (options.loading.asset_root) entry.asset_root = options.loading.asset_root;
    }
    return entries;
}

/// What is finished already.
std::vector<JobOutcome> find_finished(BatchSetup& setup) {
    std::vector<JobOutcome> outcomes(setup.jobs.size());
    std::map<fs::path, FolderRecords> folders;
    for (std::size_t i = 0; i < setup.jobs.size(); ++i) {
        JobOutcome& outcome = outcomes[i];
        if (setup.worker.force) {
            outcome.reason = "forced";
            continue;
        }
        const BatchJob& job = setup.jobs[i];
        for (const BatchOutput& output : outputs_of(job, setup.content_of(job), setup.worker.engine)) {
            const std::string reason = reason_to_render(output, folders);
            if (reason.empty()) continue;
            outcome.reason = job.outputs.size() == 1 ? reason : output.path.string() + ": " + reason;
            break;
        }
        if (outcome.reason.empty()) outcome.state = JobState::finished;
    }
    return outcomes;
}

/// Where nothing is to be done nothing needs to be written.
void check_writable(const BatchSetup& setup, const std::vector<JobOutcome>& outcomes) {
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        if (outcomes[i].state == JobState::finished) continue;
        for (const fs::path& output : setup.jobs[i].outputs) check_output_file(output);
    }
}

/// Of images that were finished just before somebody was killed.
void remove_useless_checkpoints(const BatchSetup& setup, const std::vector<JobOutcome>& outcomes) {
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        std::error_code ignored;
        if (outcomes[i].state == JobState::finished) fs::remove(checkpoint_of(setup.jobs[i]), ignored);
    }
}

/// Of this batch's workers, and of others' that were killed.
void tidy_folders(const BatchSetup& setup) {
    std::set<fs::path> folders;
    for (const BatchJob& job : setup.jobs)
        for (const fs::path& output : job.outputs)
            folders.insert(output.has_parent_path() ? output.parent_path() : ".");
    for (const fs::path& folder : folders) {
        remove_stale_files(folder);
        tidy_folder(folder);
    }
}

ExitCode batch(const BatchOptions& options, const CommonOptions& common) {
    BatchSetup setup;
    setup.jobs = expand_batch(read_entries(options));
    setup.worker = {common.device, options.max_memory, options.checkpoint_seconds, options.force,
                    engine_identity()};
    setup.worker.device.traversal = options.traversal;
    if (common.quiet) setup.worker.log_level = LogLevel::quiet;
    if (common.verbose) setup.worker.log_level = LogLevel::verbose;
    if (options.status_file) check_output_file(*options.status_file);
    if (options.html_file) check_output_file(*options.html_file);
    std::vector<JobOutcome> outcomes = find_finished(setup);
    if (options.check) return print_batch_check(setup, outcomes, common.json);
    check_writable(setup, outcomes);
    if (options.dry_run) return print_batch_plan(setup, outcomes, common.json);

    defer_interruption();  // what is finished of an image is kept
    remove_useless_checkpoints(setup, outcomes);
    BatchReport report(setup, common, options.status_file);
    report.begin(outcomes);
    const BatchEnd end = run_batch(setup, outcomes, options.hang_seconds, report);
    report.end(outcomes, end);
    tidy_folders(setup);
    if (options.html_file) write_batch_page(*options.html_file, setup, outcomes);
    if (end.interrupted) throw Interrupted("what is finished stays; the same command goes on");
    if (!end.message.empty()) log_error(end.message);
    if (end.code == ExitCode::ok && report.lost_events()) throw Error(*report.lost_events());
    return end.code;
}

}  // namespace

Command add_batch_command(CLI::App& app, CommonOptions& common) {
    const auto options = std::make_shared<BatchOptions>();
    CLI::App* command =
        app.add_subcommand("batch", "renders many scenes, cameras and frames; goes on where it ended");
    add_batch_options(*command, *options);
    add_device_options(*command, common);
    add_common_options(*command, common);
    command->footer(
        "An image is finished when its file is whole and records what is asked for: scene with all that it\n"
        "includes, parameters, settings, engine and kernels. What is finished is not rendered again; of the\n"
        "rest the reason is said. Several calls with the same images share the work.\n"
        "A job whose worker crashes, hangs or runs out of memory is tried once more; then it has failed, "
        "its\n"
        "log is NAME.log, and the others go on: exit status 8. SIGINT (Ctrl-C) and SIGTERM end it with 130\n"
        "and 143 after a checkpoint of the image in work.\n"
        "Options for images count more than the manifest's settings.\n"
        "Examples:\n"
        "  sahl batch night.json\n"
        "  sahl batch night.json --dry-run\n"
        "  sahl batch night.json --check\n"
        "  sahl batch scenes/*.nff -o 'out/{scene}.png' --size 640x480\n"
        "  sahl batch room.json --cameras front,top -o '{camera}.exr' --spp 16 --export-html sheet.html");
    return {command, [options, &common] { return batch(*options, common); }};
}

}  // namespace sahl::cli
