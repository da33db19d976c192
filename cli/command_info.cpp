// `sahl info`: what is in a scene. Needs no OpenCL device.
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <memory>

#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/memory_report.h"
#include "cli/options.h"
#include "cli/standard_output.h"
#include "engine/render/scene_info.h"

namespace sahl::cli {

namespace {

using Json = nlohmann::ordered_json;

struct Name {
    const char* one;
    const char* many;
    const char* key;  ///< in JSON
};
constexpr std::array<Name, 6> primitive_names{{{"triangle", "triangles", "triangles"},
                                               {"polygon", "polygons", "polygons"},
                                               {"sphere", "spheres", "spheres"},
                                               {"cone or cylinder", "cones and cylinders", "cones"},
                                               {"disc", "discs", "discs"},
                                               {"box", "boxes", "boxes"}}};
constexpr std::array<Name, 3> light_names{
    {{"point", "point", "point"}, {"directional", "directional", "directional"}, {"spot", "spot", "spot"}}};

struct InfoOptions {
    std::string scene;
    LoadOptions loading;
};

const char* format_of(const std::filesystem::path& scene) {
    std::string extension = scene.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension == ".nff" ? "Neutral File Format" : extension == ".test" ? "CSE 167" : "Sahl scene";
}

template <std::size_t N>
std::uint64_t sum(const std::array<std::uint64_t, N>& counts) {
    std::uint64_t all = 0;
    for (const std::uint64_t count : counts) all += count;
    return all;
}

/// "5: 3 spheres, 2 boxes".
template <std::size_t N>
std::string counts_text(const std::array<std::uint64_t, N>& counts, const std::array<Name, N>& names) {
    std::string parts;
    for (std::size_t i = 0; i < N; ++i) {
        if (counts[i] > 0)
            parts += fmt::format("{} {} {}", parts.empty() ? ":" : ",", counts[i],
                                 counts[i] == 1 ? names[i].one : names[i].many);
    }
    return fmt::format("{}{}", sum(counts), parts);
}

std::vector<std::string> camera_names(const Scene& scene) {
    std::vector<std::string> names;
    for (const Camera& camera : scene.cameras) names.push_back(camera.name);
    return names;
}

bool is_empty(const SceneInfo& info) { return info.placed_primitives == 0; }

/// "-1 0 -1 to 1 2 1": to 1/10000 of each axis, which is more than the tree's boxes are wider.
std::string bounds_text(const SceneInfo& info) {
    if (is_empty(info)) return "none";
    std::array<double, 3> lo{};
    std::array<double, 3> hi{};
    for (std::size_t k = 0; k < 3; ++k) {
        lo[k] = static_cast<double>(info.bounds.lo[k]);
        hi[k] = static_cast<double>(info.bounds.hi[k]);
        const double largest = std::max(std::abs(lo[k]), std::abs(hi[k]));
        if (largest == 0) continue;
        const double step = std::pow(10.0, std::floor(std::log10(largest)) - 4);
        lo[k] = std::round(lo[k] / step) * step + 0.0;  // no -0
        hi[k] = std::round(hi[k] / step) * step + 0.0;
    }
    return fmt::format("{:g} {:g} {:g} to {:g} {:g} {:g}", lo[0], lo[1], lo[2], hi[0], hi[1], hi[2]);
}

/// The name of each material, by id.
std::string material_lines(const Scene& scene) {
    std::string text;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        text += fmt::format("  {:<14}{}\n", i, scene.materials[i].name);
    }
    return text;
}

std::string unused_text(const SceneInfo& info) {
    std::vector<std::string> parts;
    for (const std::string& name : info.unused_materials) parts.push_back("material '" + name + "'");
    for (const std::string& name : info.unused_groups) parts.push_back("group '" + name + "'");
    return parts.empty() ? "nothing" : fmt::format("{}", fmt::join(parts, ", "));
}

std::string info_text(const InfoOptions& options, const Scene& scene, const SceneInfo& info, bool verbose) {
    std::string text;
    const auto line = [&text](std::string_view name, const std::string& value) {
        text += fmt::format("{:<16}{}\n", name, value);
    };
    line("scene", fmt::format("{} ({})", options.scene, format_of(options.scene)));
    line("image",
         fmt::format("{}x{}, depth {}", scene.resolution.width, scene.resolution.height, scene.depth));
    line("primitives", counts_text(info.primitives, primitive_names));
    line("instances", fmt::format("{} of {} groups; placed {}, {} primitives in all", info.instances,
                                  scene.groups.size(), info.placed_instances, info.placed_primitives));
    line("lights", fmt::format("{}; ambient {:g} {:g} {:g}", counts_text(info.lights, light_names),
                               scene.ambient.x, scene.ambient.y, scene.ambient.z));
    line("cameras", fmt::format("{}: {}", scene.cameras.size(), fmt::join(camera_names(scene), ", ")));
    line("materials", fmt::format("{}, textures {}", scene.materials.size(), scene.textures.size()));
    if (verbose) text += material_lines(scene);
    line("bounds", bounds_text(info));
    line("BVH", fmt::format("{} nodes, {} leaves; trees: {}", info.nodes, info.leaves, info.trees));
    line("  the world's",
         fmt::format("{} nodes, {} leaves, depth {}, {:.2f} of 4 primitives a leaf, SAH cost "
                     "{:.2f}, built in {:.2f} s",
                     info.bvh.nodes, info.bvh.leaves, info.bvh.depth, info.bvh.leaf_fill, info.bvh.sah_cost,
                     info.bvh.build_seconds));
    line("memory", "a render of the scene's size and depth, without files");
    text += memory_lines(info.memory);
    line("unused", unused_text(info));
    return text;
}

template <std::size_t N>
Json counts_object(const std::array<std::uint64_t, N>& counts, const std::array<Name, N>& names) {
    Json object{{"count", sum(counts)}};
    for (std::size_t i = 0; i < N; ++i) object[names[i].key] = counts[i];
    return object;
}

template <class Vector>
Json vector_array(const Vector& v) {
    return {v[0], v[1], v[2]};
}

Json info_event(const InfoOptions& options, const Scene& scene, const SceneInfo& info) {
    Json cameras = Json::array();
    for (const Camera& camera : scene.cameras) {
        cameras.push_back({{"name", camera.name},
                           {"eye", vector_array(camera.eye)},
                           {"look_at", vector_array(camera.look_at)},
                           {"up", vector_array(camera.up)},
                           {"fov", camera.fov_y}});
    }
    Json memory = Json::object();
    for (const auto& [name, bytes] : memory_parts(info.memory)) memory[name] = bytes;
    Json lights = counts_object(info.lights, light_names);
    lights["ambient"] = vector_array(scene.ambient);
    Json primitives = counts_object(info.primitives, primitive_names);
    primitives["placed"] = info.placed_primitives;
    Json material_names = Json::array();
    for (const Material& material : scene.materials) material_names.push_back(material.name);
    Json bounds;  // null
    if (!is_empty(info)) bounds = {vector_array(info.bounds.lo), vector_array(info.bounds.hi)};
    return {{"event", "scene"},
            {"scene", options.scene},
            {"format", format_of(options.scene)},
            {"width", scene.resolution.width},
            {"height", scene.resolution.height},
            {"depth", scene.depth},
            {"primitives", primitives},
            {"instances", {{"count", info.instances}, {"placed", info.placed_instances}}},
            {"groups", scene.groups.size()},
            {"lights", lights},
            {"cameras", cameras},
            {"materials", scene.materials.size()},
            {"material_names", material_names},
            {"textures", scene.textures.size()},
            {"bounds", bounds},
            {"bvh",
             {{"trees", info.trees},
              {"nodes", info.nodes},
              {"leaves", info.leaves},
              {"world",
               {{"primitives", info.bvh.primitives},
                {"references", info.bvh.references},
                {"nodes", info.bvh.nodes},
                {"leaves", info.bvh.leaves},
                {"depth", info.bvh.depth},
                {"leaf_fill", info.bvh.leaf_fill},
                {"sah_cost", info.bvh.sah_cost},
                {"build_seconds", info.bvh.build_seconds}}}}},
            {"memory", memory},
            {"unused", {{"materials", info.unused_materials}, {"groups", info.unused_groups}}}};
}

ExitCode describe(const InfoOptions& options, const CommonOptions& common) {
    const Scene scene = load_scene(options.scene, options.loading);
    const SceneInfo info = describe_scene(scene);
    if (common.json) {
        print_event(info_event(options, scene, info));
    } else {
        print(info_text(options, scene, info, common.verbose));
    }
    return ExitCode::ok;
}

}  // namespace

Command add_info_command(CLI::App& app, CommonOptions& common) {
    const auto options = std::make_shared<InfoOptions>();
    CLI::App* command = app.add_subcommand("info", "says what is in a scene");
    add_scene_argument(*command, "SCENE", options->scene);
    add_scene_options(*command, options->loading);
    add_common_options(*command, common);
    command->footer(
        "An unused material is one that no primitive has, an unused group one that no instance leads to.\n"
        "Bounds are those of the tree, a little larger than the scene; in text they are rounded.\n"
        "With -v or --json there are the materials' names by id, as the AOV id.material has it.\n"
        "Memory: what is needed at different times, and the most at one time as the total; the OpenCL\n"
        "driver's own comes on top. 'sahl render --dry-run' plans for other sizes, depths and files.\n"
        "Examples:\n"
        "  sahl info scene.json\n"
        "  sahl info scene.json --set count=100 --json");
    return {command, [options, &common] { return describe(*options, common); }};
}

}  // namespace sahl::cli
