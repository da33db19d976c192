#include "engine/batch/expand.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>
#include <glm/ext/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include "engine/batch/output_pattern.h"
#include "engine/core/atomic_file.h"
#include "engine/scene/validate.h"
#include "engine/scene/write_text.h"

namespace sahl {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const BatchEntry& entry, const std::string& message) {
    if (entry.place.file.empty()) throw Error(ExitCode::usage, message);
    throw SceneError(entry.place, message);
}

/// Parameters that change together: several, if they are zipped.
struct Axis {
    std::vector<const BatchParameter*> parameters;
    std::size_t count = 1;
};

const std::vector<std::string>& texts_of(const BatchParameter& parameter) {
    return std::get<std::vector<std::string>>(parameter.values);
}

std::vector<Axis> axes_of(const BatchEntry& entry) {
    std::vector<Axis> axes;
    std::vector<std::string> done;
    for (const BatchParameter& parameter : entry.parameters) {
        if (std::holds_alternative<KeyFrames>(parameter.values)) continue;
        if (std::find(done.begin(), done.end(), parameter.name) != done.end()) continue;
        std::vector<std::string> names{parameter.name};
        for (const std::vector<std::string>& zip : entry.zips)
            if (std::find(zip.begin(), zip.end(), parameter.name) != zip.end()) names = zip;
        Axis axis{{}, texts_of(parameter).size()};
        for (const BatchParameter& other : entry.parameters)
            if (std::find(names.begin(), names.end(), other.name) != names.end())
                axis.parameters.push_back(&other);
        axes.push_back(std::move(axis));
        done.insert(done.end(), names.begin(), names.end());
    }
    return axes;
}

/// The values at position `index` of the axes' product, the last axis fastest, and those of the frame.
std::vector<std::pair<std::string, std::string>> values_at(const BatchEntry& entry,
                                                           const std::vector<Axis>& axes, std::size_t index,
                                                           double frame) {
    std::map<std::string, std::string> values;
    for (std::size_t i = axes.size(); i-- > 0;) {
        for (const BatchParameter* parameter : axes[i].parameters)
            values[parameter->name] = texts_of(*parameter)[index % axes[i].count];
        index /= axes[i].count;
    }
    std::vector<std::pair<std::string, std::string>> ordered;
    for (const BatchParameter& parameter : entry.parameters) {
        if (const auto* keys = std::get_if<KeyFrames>(&parameter.values)) {
            const glm::dvec3 value = keys->at(frame);
            ordered.emplace_back(parameter.name, keys->is_vector ? decimals(value, ",") : decimal(value.x));
        } else {
            ordered.emplace_back(parameter.name, values[parameter.name]);
        }
    }
    return ordered;
}

Camera camera_at(const BatchEntry& entry, const BatchCamera& camera, double frame) {
    const CameraPath& path = *camera.path;
    Camera view;
    view.name = camera.name;
    view.look_at = path.look_at.at(frame);
    view.up = path.up.at(frame);
    view.fov_y = path.fov.at(frame).x;
    view.eye = path.eye.at(frame);
    const double degrees = path.turn.at(frame).x;
    if (degrees != 0 && view.up != glm::dvec3(0)) {
        const glm::dmat4 turn = glm::rotate(glm::dmat4(1), glm::radians(degrees), glm::normalize(view.up));
        view.eye = view.look_at + glm::dvec3(turn * glm::dvec4(view.eye - view.look_at, 0));
    }
    if (!(view.fov_y > 0 && view.fov_y < 180))
        fail(entry,
             fmt::format("the camera '{}' has a fov of {} at frame {}; keep it between 0 and 180 degrees",
                         camera.name, view.fov_y, frame));
    check_camera(view, camera.place, camera.place);
    return view;
}

/// One name for a file, however it is spelt.
class FileIdentity {
public:
    std::string of(const fs::path& path) {
        const fs::path folder = path.parent_path();
        auto [found, is_new] = folders_.try_emplace(folder.string());
        if (is_new) {
            std::error_code failed;
            fs::path real = fs::weakly_canonical(fs::absolute(folder.empty() ? "." : folder), failed);
            if (!real.has_filename()) real = real.parent_path();  // "folder/"
            found->second = failed ? folder.string() : real.string();
        }
        return found->second + "/" + path.filename().string();
    }

private:
    std::map<std::string, std::string> folders_;
};

/// What is different in two jobs and not in their files' names.
std::string missing_placeholder(const BatchJob& a, const BatchJob& b) {
    if (a.scene.stem() != b.scene.stem()) return "{scene}";
    if (a.camera != b.camera) return "{camera}";
    if (a.frame != b.frame) return "{frame:04}";
    for (std::size_t i = 0; i < std::min(a.parameters.size(), b.parameters.size()); ++i)
        if (a.parameters[i] != b.parameters[i]) return "{" + a.parameters[i].first + "}";
    return "";
}

PlaceholderValues placeholders_of(const BatchJob& job) {
    PlaceholderValues values{{"scene", job.scene.stem().string()}};
    if (!job.camera.empty()) values.emplace_back("camera", job.camera);
    if (job.frame) values.emplace_back("frame", std::to_string(*job.frame));
    for (const auto& [name, text] : job.parameters) values.emplace_back(name, text);
    return values;
}

void name_outputs(const BatchEntry& entry, BatchJob& job) {
    const PlaceholderValues values = placeholders_of(job);
    for (const std::string& pattern : entry.outputs) {
        FilledPattern filled = fill_pattern(pattern, values);
        if (!filled.problem.empty()) fail(entry, fmt::format("output '{}': {}", pattern, filled.problem));
        job.outputs.emplace_back(std::move(filled.text));
    }
}

void check_formats(const BatchEntry& entry, const BatchJob& job) {
    for (const fs::path& output : job.outputs)
        if (is_special_file(output))
            fail(entry, fmt::format("'{}' is no regular file; a batch has to find its images again",
                                    output.string()));
    try {
        const std::vector<OutputSettings> encodings = settings_for(job.outputs, encoding_of(job.settings));
        for (std::size_t i = 0; i < job.outputs.size(); ++i)
            check_output_format(job.outputs[i], encodings[i]);
    } catch (const Error& error) {
        if (error.code() == ExitCode::usage) fail(entry, error.what());
        throw;
    }
    const bool has_aovs = job.settings.aovs && !job.settings.aovs->empty();
    if (has_aovs && std::none_of(job.outputs.begin(), job.outputs.end(), can_hold_aovs))
        fail(entry, fmt::format("'{}' has no room for AOVs; add an EXR file to the outputs",
                                job.outputs.front().string()));
}

/// All of one entry, without their outputs' names.
void expand_entry(const BatchEntry& entry, std::vector<BatchJob>& jobs) {
    const std::vector<Axis> axes = axes_of(entry);
    double count = static_cast<double>(entry.scenes.size()) *
                   static_cast<double>(std::max<std::size_t>(1, entry.frames.size())) *
                   static_cast<double>(std::max<std::size_t>(1, entry.cameras.size()));
    std::size_t products = 1;
    for (const Axis& axis : axes) {
        count *= static_cast<double>(axis.count);
        products *= axis.count;
    }
    if (count + static_cast<double>(jobs.size()) > static_cast<double>(most_batch_jobs))
        fail(entry, fmt::format("this makes {} jobs, where a batch has {} at most; divide it", count,
                                most_batch_jobs));
    const std::vector<BatchCamera> no_camera(1);
    const std::vector<int> no_frame(1);
    for (const fs::path& scene : entry.scenes) {
        for (std::size_t i = 0; i < products; ++i) {
            for (const int frame : entry.frames.empty() ? no_frame : entry.frames) {
                for (const BatchCamera& camera : entry.cameras.empty() ? no_camera : entry.cameras) {
                    BatchJob& job = jobs.emplace_back();
                    job.scene = scene;
                    job.asset_root = entry.asset_root;
                    job.parameters = values_at(entry, axes, i, frame);
                    job.camera = camera.name;
                    if (camera.path) job.view = camera_at(entry, camera, frame);
                    if (!entry.frames.empty()) job.frame = frame;
                    job.settings = entry.settings;
                }
            }
        }
    }
}

}  // namespace

std::vector<BatchJob> expand_batch(std::span<const BatchEntry> entries) {
    std::vector<BatchJob> jobs;
    FileIdentity identity;
    std::unordered_map<std::string, std::size_t> writers;
    for (const BatchEntry& entry : entries) {
        const std::size_t first = jobs.size();
        expand_entry(entry, jobs);
        for (std::size_t i = first; i < jobs.size(); ++i) {
            name_outputs(entry, jobs[i]);
            for (const fs::path& output : jobs[i].outputs) {
                const auto [writer, is_new] = writers.emplace(identity.of(output), i);
                if (is_new) continue;
                const std::string missing = missing_placeholder(jobs[writer->second], jobs[i]);
                fail(entry, fmt::format("two images would go into '{}'; give each a name of its own{}",
                                        output.string(),
                                        missing.empty() ? "" : fmt::format(", such as with {}", missing)));
            }
        }
        for (std::size_t i = first; i < jobs.size(); ++i) check_formats(entry, jobs[i]);
    }
    return jobs;
}

}  // namespace sahl
