// Rays through the same scenes by Sahl and by Embree: `bench/run traversal`.
#include <algorithm>
#include <exception>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "bench/embree_scene.h"
#include "bench/embree_shapes.h"
#include "bench/machine.h"
#include "bench/traversal_report.h"
#include "engine/core/error.h"

namespace sahl::bench {
namespace {

struct Options {
    std::vector<std::string> scenes, rays, kernels;
    int size = 1024;
    Measurement measurement;
    DeviceOptions device;
    std::string embree_config;
    std::string json;
};

/// Whether an option that narrows the benchmark lets `name` through.
bool is_wanted(const std::vector<std::string>& wanted, const std::string& name) {
    return wanted.empty() || std::find(wanted.begin(), wanted.end(), name) != wanted.end();
}

/// All sets of rays that start with the camera's, made of what `embree` hits.
std::vector<RaySet> make_ray_sets(const BenchScene& scene, RTCScene embree, MemoryAccountant& accountant,
                                  const Options& options) {
    const RaySet primary = primary_rays(scene.scene.cameras[0], options.size);
    EmbreeRays layout(accountant, primary, 1);
    layout.trace(embree, embree_apis().front());
    const std::vector<SurfacePoint> points = surface_points(scene.scene, primary, layout.hits());
    std::vector<RaySet> sets{primary, shadow_rays(points, scene.scene.lights[0]), diffuse_rays(points),
                             mirror_rays(points), refracted_rays(points)};
    std::erase_if(sets, [&](const RaySet& set) { return !is_wanted(options.rays, set.kind); });
    return sets;
}

void measure_mesh(const SceneMaker& maker, SahlTracer& sahl, RTCDevice embree, const Options& options,
                  std::vector<TraversalCell>& cells) {
    const BenchScene scene = maker.make();
    sahl.set_scene(scene.scene);
    const EmbreeGeometry triangles = embree_triangles(embree, scene.scene);
    const EmbreeScene fast =
        embree_scene(embree, triangles.get(), RTC_BUILD_QUALITY_HIGH, RTC_SCENE_FLAG_NONE);
    const EmbreeScene robust =
        embree_scene(embree, triangles.get(), RTC_BUILD_QUALITY_HIGH, RTC_SCENE_FLAG_ROBUST);
    for (const RaySet& rays : make_ray_sets(scene, robust.get(), sahl.device().memory(), options)) {
        cells.push_back(
            measure_cell(scene, rays, sahl, {"triangles", fast.get(), robust.get()}, options.measurement));
        print_cell(cells.back());
    }
}

/// Spheres, cones or polygons: camera and diffuse rays alone.
void measure_field(const SceneMaker& maker, SahlTracer& sahl, RTCDevice embree, const Options& options,
                   std::vector<TraversalCell>& cells) {
    const BenchScene field = maker.make();
    sahl.set_scene(field.scene);
    const OwnedUserShapes shapes = user_shapes(field.scene);
    const EmbreeGeometry user = embree_user_geometry(embree, *shapes);
    const EmbreeScene user_scene =
        embree_scene(embree, user.get(), RTC_BUILD_QUALITY_HIGH, RTC_SCENE_FLAG_NONE);
    EmbreeScene sphere_scene;
    if (!field.scene.spheres.empty()) {
        const EmbreeGeometry spheres = embree_spheres(embree, field.scene);
        sphere_scene = embree_scene(embree, spheres.get(), RTC_BUILD_QUALITY_HIGH, RTC_SCENE_FLAG_NONE);
    }
    for (const RaySet& rays : make_ray_sets(field, user_scene.get(), sahl.device().memory(), options)) {
        if (rays.kind != "primary" && rays.kind != "diffuse") continue;
        const auto measure = [&](const EmbreeSide& side) {
            cells.push_back(measure_cell(field, rays, sahl, side, options.measurement));
            print_cell(cells.back());
        };
        if (sphere_scene) measure({"spheres", sphere_scene.get(), nullptr});
        measure({"user geometry", user_scene.get(), nullptr});
    }
}

void run(const Options& options) {
    if (options.size % 8 != 0) throw Error(ExitCode::usage, "--size must be a multiple of 8");
    SahlTracer sahl(options.device);
    const EmbreeDevice embree = open_embree(options.embree_config);

    std::vector<TraversalCell> cells;
    print_head();
    for (const SceneMaker& maker : mesh_makers()) {
        if (is_wanted(options.scenes, maker.name)) measure_mesh(maker, sahl, embree.get(), options, cells);
    }
    for (const SceneMaker& maker : field_makers()) {
        if (is_wanted(options.scenes, maker.name)) measure_field(maker, sahl, embree.get(), options, cells);
    }
    print_means(cells);
    print_differences(cells);

    if (options.json.empty()) return;
    nlohmann::ordered_json report{{"machine", machine_facts()},
                                  {"size", options.size},
                                  {"repetitions", options.measurement.repetitions},
                                  {"clock", options.measurement.clock == Clock::wall ? "wall" : "processor"},
                                  {"build_options", options.device.build_options},
                                  {"embree_config", options.embree_config},
                                  {"means", means_json(cells)},
                                  {"cells", nlohmann::ordered_json::array()}};
    for (const TraversalCell& cell : cells) report["cells"].push_back(cell_json(cell));
    write_report(report, options.json);
}

void choose_kernels(Options& options) {
    for (const char* kernel : sahl_kernels) {
        if (is_wanted(options.kernels, kernel)) options.measurement.kernels.emplace_back(kernel);
    }
}

/// Of everything in a table with names.
template <class Table>
std::vector<std::string> names_of(const Table& table) {
    std::vector<std::string> names;
    for (const auto& entry : table) names.emplace_back(entry.name);
    return names;
}

/// An option that names some of `all`.
void add_selection(CLI::App& app, const char* option, std::vector<std::string>& selected, const char* what,
                   const std::vector<std::string>& all) {
    app.add_option(option, selected, what)
        ->delimiter(',')
        ->check(CLI::IsMember(all))
        ->type_name("NAME,NAME...");
}

void add_options(CLI::App& app, Options& options) {
    std::vector<std::string> scenes = names_of(mesh_makers()), fields = names_of(field_makers());
    scenes.insert(scenes.end(), fields.begin(), fields.end());
    app.add_option("--json", options.json, "Write all figures to this file");
    add_selection(app, "--scene", options.scenes, "These scenes alone", scenes);
    add_selection(app, "--rays", options.rays, "These rays alone", {ray_kinds.begin(), ray_kinds.end()});
    add_selection(app, "--kernel", options.kernels, "These of Sahl's kernels alone",
                  {sahl_kernels.begin(), sahl_kernels.end()});
    app.add_option("--size", options.size, "Camera rays are size x size")
        ->check(CLI::Range(8, 8192))
        ->capture_default_str();
    app.add_option("--repetitions", options.measurement.repetitions, "Measurements that medians are of")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    app.add_flag_callback(
        "--processor-time", [&] { options.measurement.clock = Clock::processor; },
        "Measure processor time over cores instead of time, where the machine has other work");
    app.add_option("--device", options.device.selector, "OpenCL device, as for sahl");
    app.add_option("--build-options", options.device.build_options,
                   "More options for the OpenCL compiler, as -DSAHL_NO_AVX512 or -DSAHL_PLAIN_OPENCL");
    app.add_option("--embree", options.embree_config, "Configuration of Embree, as isa=avx2");
}

}  // namespace
}  // namespace sahl::bench

int main(int argc, char** argv) {
    try {
        CLI::App app("Rays through the same scenes by Sahl and by Embree");
        sahl::bench::Options options;
        sahl::bench::add_options(app, options);
        CLI11_PARSE(app, argc, argv);
        sahl::bench::choose_kernels(options);
        sahl::bench::run(options);
    } catch (const sahl::Error& error) {
        fmt::print(stderr, "sahl_bench_traversal: {}\n", error.what());
        return static_cast<int>(error.code());
    } catch (const std::exception& error) {
        fmt::print(stderr, "sahl_bench_traversal: {}\n", error.what());
        return static_cast<int>(sahl::ExitCode::internal);
    }
}
