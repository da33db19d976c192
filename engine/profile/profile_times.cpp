#include "engine/profile/profile_times.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/core/error.h"
#include "engine/profile/measures.h"
#include "engine/profile/timeline.h"

namespace sahl {
namespace {

constexpr int times_version = 1;

/// Adds row by row; what belongs together adds up repetition by repetition.
class RowTable {
public:
    explicit RowTable(std::vector<double> wall) : wall_(std::move(wall)) {}

    void add(const std::string& kernel, std::uint32_t generation, const std::vector<double>& samples) {
        if (std::find(order_.begin(), order_.end(), kernel) == order_.end()) order_.push_back(kernel);
        add_to(kernels_[kernel].total, samples);
        add_to(kernels_[kernel].generations[generation], samples);
    }

    std::vector<TimedRow> rows() const {
        std::vector<TimedRow> rows{{"wall", std::nullopt, wall_}};
        for (const std::string& kernel : order_) {
            const KernelTimes& times = kernels_.at(kernel);
            rows.push_back({kernel, std::nullopt, times.total});
            for (const auto& [generation, samples] : times.generations) {
                rows.push_back({kernel, generation, samples});
            }
        }
        return rows;
    }

private:
    struct KernelTimes {
        std::vector<double> total;
        std::map<std::uint32_t, std::vector<double>> generations;
    };

    void add_to(std::vector<double>& sums, const std::vector<double>& samples) const {
        sums.resize(wall_.size());
        std::transform(sums.begin(), sums.end(), samples.begin(), sums.begin(), std::plus<>());
    }

    std::vector<double> wall_;
    std::map<std::string, KernelTimes> kernels_;
    std::vector<std::string> order_;
};

/// A value in a profile's file, which knows where it stands.
class Value {
public:
    Value(const nlohmann::json& json, const std::string& file, std::string path)
        : json_(json), file_(file), path_(std::move(path)) {}

    Value at(const char* key) const {
        if (!json_.is_object() || !json_.contains(key)) fail(fmt::format("has no \"{}\"", key));
        return {json_.at(key), file_, path_ + "/" + key};
    }
    std::vector<Value> elements() const {
        if (!json_.is_array()) fail("is no array");
        std::vector<Value> values;
        for (std::size_t i = 0; i < json_.size(); ++i) {
            values.push_back({json_[i], file_, fmt::format("{}/{}", path_, i)});
        }
        return values;
    }
    std::string text() const {
        if (!json_.is_string()) fail("is no string");
        return json_.get<std::string>();
    }
    std::uint64_t whole() const {
        if (!json_.is_number_unsigned()) fail("is no whole number");
        return json_.get<std::uint64_t>();
    }
    int small() const { return static_cast<int>(std::min<std::uint64_t>(whole(), 1U << 30U)); }
    double milliseconds() const {
        if (!json_.is_number() || json_.get<double>() < 0) fail("is no number from 0 on");
        return json_.get<double>();
    }
    bool is_null() const { return json_.is_null(); }
    [[noreturn]] void fail(const std::string& what) const {
        throw Error(ExitCode::scene,
                    fmt::format("{}: not a profile that 'sahl profile --export-json' wrote: {} {}", file_,
                                path_.empty() ? "it" : path_, what));
    }

private:
    const nlohmann::json& json_;
    const std::string& file_;
    std::string path_;
};

ProfileEnvironment environment_of(const Value& json) {
    ProfileEnvironment environment;
    environment.sahl = json.at("sahl").text();
    environment.scene = json.at("scene").text();
    environment.scene_hash = json.at("scene_hash").text();
    environment.kernel_hash = json.at("kernel_hash").text();
    environment.camera = json.at("camera").text();
    environment.width = json.at("width").small();
    environment.height = json.at("height").small();
    if (const Value crop = json.at("crop"); !crop.is_null()) {
        environment.crop.emplace();
        for (const Value& edge : crop.elements()) environment.crop->push_back(edge.small());
    }
    environment.depth = json.at("depth").small();
    environment.spp = json.at("spp").small();
    environment.seed = json.at("seed").whole();
    environment.ray_budget = static_cast<std::uint32_t>(json.at("ray_budget").small());
    environment.build_quality = json.at("build_quality").text();
    environment.device = json.at("device").text();
    environment.platform = json.at("platform").text();
    environment.driver = json.at("driver").text();
    environment.cpu = json.at("cpu").text();
    environment.threads = json.at("threads").small();
    return environment;
}

std::vector<double> samples_of(const Value& row, std::size_t repetitions) {
    const Value list = row.at("samples_ms");
    std::vector<double> samples;
    for (const Value& sample : list.elements()) samples.push_back(sample.milliseconds());
    if (samples.size() != repetitions)
        list.fail(fmt::format("has not one time for each of {} repetitions", repetitions));
    return samples;
}

nlohmann::json parse_file(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        throw Error(ExitCode::scene,
                    fmt::format("{}: cannot be read; 'sahl profile SCENE --export-json FILE' writes profiles",
                                path.string()));
    }
    try {
        return nlohmann::json::parse(file);
    } catch (const nlohmann::json::exception& error) {
        throw Error(ExitCode::scene, fmt::format("{}: no JSON: {}", path.string(), error.what()));
    }
}

}  // namespace

std::string name_of(const TimedRow& row) {
    return row.generation ? fmt::format("{}/{}", row.kernel, *row.generation) : row.kernel;
}

const TimedRow* find_row(const ProfileTimes& times, const std::string& name) {
    for (const TimedRow& row : times.rows) {
        if (name_of(row) == name) return &row;
    }
    return nullptr;
}

ProfileTimes times_of(const ProfileEnvironment& environment, const std::vector<TimelineRecord>& frames) {
    std::vector<double> wall;
    for (const TimelineRecord& frame : frames) wall.push_back(in_ms(frame.end_ns - frame.begin_ns));
    RowTable table(std::move(wall));
    for (std::size_t i = 0; i < frames.size(); ++i) {
        for (const LaunchRecord& launch : frames[i].launches) {
            std::vector<double> samples(frames.size());
            samples[i] = in_ms(launch.ended_ns - launch.started_ns);
            table.add(split_name(launch.kernel).first, launch.generation, samples);
        }
    }
    return {environment, table.rows()};
}

ProfileTimes read_profile_times(const std::filesystem::path& path) {
    const nlohmann::json json = parse_file(path);
    const std::string file = path.string();
    const Value document(json, file, "");
    if (const std::uint64_t version = document.at("version").whole(); version != times_version) {
        throw Error(ExitCode::scene,
                    fmt::format("{}: a profile in version {} of the format; this program reads "
                                "version {}: profile again with it",
                                file, version, times_version));
    }
    ProfileTimes times{environment_of(document.at("environment")), {}};
    std::vector<double> wall;
    for (const Value& repetition : document.at("repetitions").elements()) {
        wall.push_back(repetition.at("wall_ms").milliseconds());
    }
    if (wall.empty()) document.at("repetitions").fail("is empty");
    const std::size_t repetitions = wall.size();
    RowTable table(std::move(wall));
    for (const Value& row : document.at("rows").elements()) {
        table.add(row.at("kernel").text(), static_cast<std::uint32_t>(row.at("generation").small()),
                  samples_of(row, repetitions));
    }
    times.rows = table.rows();
    return times;
}

}  // namespace sahl
