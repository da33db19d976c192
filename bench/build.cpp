// Trees over the same triangles by Sahl and by Embree: `bench/run build`.
//
// Sahl's time is from the triangles' boxes to nodes and leaf blocks as the device takes them; Embree's is
// rtcCommitScene, from committed vertex and index buffers. All builders take turns; medians are reported.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "bench/embree_scene.h"
#include "bench/embree_tree.h"
#include "bench/machine.h"
#include "bench/peak_memory.h"
#include "bench/scenes.h"
#include "bench/statistics.h"
#include "engine/core/error.h"
#include "engine/render/host_scene.h"
#include "engine/render/leaf_blocks.h"

namespace sahl::bench {
namespace {

struct Options {
    std::vector<std::string> scenes;
    int repetitions = 5;
    Clock clock = Clock::wall;
    std::string json;
};

/// One builder of the comparison.
struct Builder {
    std::string name;
    std::vector<double> seconds{};
    BvhStatistics statistics{};    ///< of Sahl's
    std::uint64_t peak_bytes = 0;  ///< of Sahl's
};

struct Cell {
    std::string mesh;
    std::size_t triangles = 0;
    std::vector<Builder> builders;
    EmbreeTree embree_tree;
};

constexpr struct {
    const char* name;
    BuildQuality quality;
} sahl_qualities[] = {{"Sahl high", BuildQuality::high}, {"Sahl fast", BuildQuality::fast}};

constexpr struct {
    const char* name;
    RTCBuildQuality quality;
} embree_qualities[] = {{"Embree HIGH", RTC_BUILD_QUALITY_HIGH},
                        {"Embree MEDIUM", RTC_BUILD_QUALITY_MEDIUM},
                        {"Embree LOW", RTC_BUILD_QUALITY_LOW}};

/// `host` gets the tree; its lowered scene is what it is built of.
void build_sahl(const Scene& scene, HostScene& host, BuildQuality quality, Clock clock, Builder& out) {
    std::vector<BuildPrimitive> primitives;
    primitives.reserve(most_references(host.lowered.build_primitives.size()));
    primitives.assign(host.lowered.build_primitives.begin(), host.lowered.build_primitives.end());
    const TriangleCorners corners{host.lowered.shape_data.data(), host.lowered.primitives.data()};
    MemoryAccountant accountant;
    host.bvh = {};
    const double start = seconds_now(clock);
    host.bvh = build_bvh(std::move(primitives), corners, quality);
    const HostMemory blocks = pack_leaf_blocks(accountant, scene, host);
    out.seconds.push_back(seconds_now(clock) - start);
    out.statistics = host.bvh.statistics;
}

Cell measure(const BenchScene& mesh, RTCDevice device, const Options& options) {
    HostScene host;
    host.lowered = lower_scene(mesh.scene);
    const EmbreeGeometry geometry = embree_triangles(device, mesh.scene);
    Cell cell{mesh.name, mesh.scene.triangles.size(), {}, build_embree_tree(device, host.lowered)};
    for (const auto& entry : sahl_qualities) {
        Builder& builder = cell.builders.emplace_back(Builder{entry.name});
        builder.peak_bytes =
            peak_growth([&] { build_sahl(mesh.scene, host, entry.quality, options.clock, builder); });
        builder.seconds.clear();
    }
    for (const auto& entry : embree_qualities) cell.builders.push_back({entry.name});
    for (int i = 0; i < options.repetitions; ++i) {
        auto builder = cell.builders.begin();
        for (const auto& entry : sahl_qualities) {
            build_sahl(mesh.scene, host, entry.quality, options.clock, *builder++);
        }
        for (const auto& entry : embree_qualities) {
            const double start = seconds_now(options.clock);
            const EmbreeScene scene =
                embree_scene(device, geometry.get(), entry.quality, RTC_SCENE_FLAG_NONE);
            (builder++)->seconds.push_back(seconds_now(options.clock) - start);
        }
    }
    return cell;
}

void print(const Cell& cell) {
    const auto triangles = static_cast<double>(cell.triangles);
    fmt::print("{}, {} triangles; SAH cost of Embree's tree {:.2f}, {:.3f} references a triangle\n",
               cell.mesh, cell.triangles, cell.embree_tree.sah_cost,
               static_cast<double>(cell.embree_tree.references) / triangles);
    for (const Builder& builder : cell.builders) {
        const Spread seconds = spread_of(builder.seconds);
        fmt::print("  {:14} {:7.3f} s ({:.3f} to {:.3f}), {:6.2f} Mtris/s", builder.name, seconds.median,
                   seconds.min, seconds.max, 1e-6 * triangles / seconds.median);
        if (const BvhStatistics& bvh = builder.statistics; bvh.nodes > 0) {
            fmt::print(
                "; SAH cost {:.2f}, {} nodes, {} leaves, {:.3f} references and {:.0f} bytes a triangle",
                bvh.sah_cost, bvh.nodes, bvh.leaves, static_cast<double>(bvh.references) / triangles,
                static_cast<double>(builder.peak_bytes) / triangles);
        }
        fmt::print("\n");
    }
    std::fflush(stdout);
}

nlohmann::ordered_json to_json(const Cell& cell) {
    nlohmann::ordered_json json{{"mesh", cell.mesh},
                                {"triangles", cell.triangles},
                                {"embree_tree",
                                 {{"sah_cost", cell.embree_tree.sah_cost},
                                  {"references", cell.embree_tree.references},
                                  {"seconds", cell.embree_tree.seconds}}}};
    for (const Builder& builder : cell.builders) {
        const Spread seconds = spread_of(builder.seconds);
        nlohmann::ordered_json out{{"builder", builder.name},
                                   {"seconds", {seconds.min, seconds.median, seconds.max}},
                                   {"mtris", 1e-6 * static_cast<double>(cell.triangles) / seconds.median}};
        if (const BvhStatistics& bvh = builder.statistics; bvh.nodes > 0) {
            out.update({{"sah_cost", bvh.sah_cost},
                        {"nodes", bvh.nodes},
                        {"leaves", bvh.leaves},
                        {"references", bvh.references},
                        {"peak_bytes", builder.peak_bytes}});
        }
        json["builders"].push_back(out);
    }
    return json;
}

void run(const Options& options) {
    std::vector<SceneMaker> makers(mesh_makers().begin(), mesh_makers().end());
    makers.push_back({"large terrain", large_terrain_mesh});
    const EmbreeDevice device = open_embree();
    nlohmann::ordered_json cells = nlohmann::ordered_json::array();
    for (const SceneMaker& maker : makers) {
        const auto& wanted = options.scenes;
        if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), maker.name) == wanted.end()) continue;
        const Cell cell = measure(maker.make(), device.get(), options);
        print(cell);
        cells.push_back(to_json(cell));
    }
    if (options.json.empty()) return;
    write_report({{"machine", machine_facts()},
                  {"repetitions", options.repetitions},
                  {"clock", options.clock == Clock::wall ? "wall" : "processor"},
                  {"cells", cells}},
                 options.json);
}

void add_options(CLI::App& app, Options& options) {
    app.add_option("--json", options.json, "Write all figures to this file");
    app.add_option("--scene", options.scenes, "These meshes alone")
        ->delimiter(',')
        ->check(CLI::IsMember({"organic", "terrain", "architecture", "large terrain"}));
    app.add_option("--repetitions", options.repetitions, "Measurements that medians are of")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    app.add_flag_callback(
        "--processor-time", [&] { options.clock = Clock::processor; },
        "Measure processor time over cores instead of time, where the machine has other work");
}

}  // namespace
}  // namespace sahl::bench

int main(int argc, char** argv) {
    try {
        CLI::App app("Trees over the same triangles by Sahl and by Embree");
        sahl::bench::Options options;
        sahl::bench::add_options(app, options);
        CLI11_PARSE(app, argc, argv);
        sahl::bench::run(options);
    } catch (const sahl::Error& error) {
        fmt::print(stderr, "sahl_bench_build: {}\n", error.what());
        return static_cast<int>(error.code());
    } catch (const std::exception& error) {
        fmt::print(stderr, "sahl_bench_build: {}\n", error.what());
        return static_cast<int>(sahl::ExitCode::internal);
    }
}
