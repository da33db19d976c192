// `sahl info`: figures that can be counted by hand, without an OpenCL device.
#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/cli/sahl_program.h"

namespace sahl::tests {
namespace {

/// No OpenCL driver is there.
ProcessResult info(const TemporaryFolder& folder, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "info");
    ProcessOptions options;
    options.working_directory = folder.path();
    options.environment["OCL_ICD_VENDORS"] = folder.path().string();
    options.environment["OCL_ICD_FILENAMES"] = std::nullopt;
    return run_sahl(arguments, options);
}

nlohmann::json info_event(const std::vector<std::string>& arguments) {
    const TemporaryFolder folder;
    std::vector<std::string> all = arguments;
    all.push_back("--json");
    const ProcessResult result = info(folder, all);
    INFO(result.err);
    REQUIRE(result.status == 0);
    const std::vector<nlohmann::json> events = json_lines(result.out);
    REQUIRE(events.size() == 1);
    return events[0];
}

}  // namespace

TEST_CASE("info: counts, sizes and bounds of an NFF scene", "[cli]") {
    const nlohmann::json event = info_event({scene_file("all_entities.nff")});
    CHECK(event.at("event") == "scene");
    CHECK(event.at("format") == "Neutral File Format");
    CHECK(event.at("width") == 64);
    CHECK(event.at("height") == 48);
    const nlohmann::json& primitives = event.at("primitives");
    CHECK(primitives.at("spheres") == 2);
    CHECK(primitives.at("cones") == 1);
    CHECK(primitives.at("polygons") == 1);
    CHECK(primitives.at("triangles") == 4);  // p of three corners, pp of three and of four
    CHECK(primitives.at("count") == 8);
    CHECK(primitives.at("placed") == 8);
    CHECK(event.at("lights").at("point") == 2);
    CHECK(event.at("lights").at("count") == 2);
    CHECK(event.at("cameras").size() == 1);
    CHECK(event.at("cameras")[0].at("eye") == nlohmann::json({0, -5, 2}));
    const nlohmann::json& bounds = event.at("bounds");  // the sphere of radius 20 around (0, 0, 0.5)
    for (int k = 0; k < 3; ++k) {
        const double center = k == 2 ? 0.5 : 0;
        CHECK(bounds[0][static_cast<std::size_t>(k)].get<double>() == Approx(center - 20).epsilon(1e-5));
        CHECK(bounds[1][static_cast<std::size_t>(k)].get<double>() == Approx(center + 20).epsilon(1e-5));
    }
    CHECK(event.at("bvh").at("world").at("primitives") == 8);
    CHECK(event.at("bvh").at("trees") == 1);
    CHECK(event.at("unused").at("materials").empty());
}

TEST_CASE("info: the memory plan adds up and grows with what it is for", "[cli]") {
    const TemporaryFolder folder;
    const auto memory = [&](const std::string& resolution, int spheres) {
        std::string text = "v\nfrom 0 0 9\nat 0 0 0\nup 0 1 0\nangle 40\nhither 1\nresolution " + resolution +
                           "\nl 1 1 9\nf 1 1 1 1 0 0 0 0\n";
        for (int i = 0; i < spheres; ++i) text += "s " + std::to_string(i) + " 0 0 1\n";
        write_file(folder / "a.nff", text);
        return info_event({(folder / "a.nff").string()}).at("memory");
    };
    const nlohmann::json small = memory("10 20", 1);
    const nlohmann::json wide = memory("1000 2000", 1);
    const nlohmann::json many = memory("10 20", 64);
    CHECK(small.at("film") == 8192);  // 24 bytes a pixel in whole pages
    CHECK(wide.at("film") == 48234496);
    CHECK(small.at("image") == 10 * 20 * 12);
    CHECK(small.at("bvh_nodes") == 4096);
    CHECK(small.at("leaf_blocks") == 4096);
    CHECK(many.at("scene_loaded") > small.at("scene_loaded"));
    CHECK(many.at("scene_building") > small.at("scene_building"));
    CHECK(wide.at("ray_queues").get<int>() > 50 * small.at("ray_queues").get<int>());
    for (const nlohmann::json& plan : {small, wide, many}) {
        const auto bytes = [&plan](const char* name) { return plan.at(name).get<std::uint64_t>(); };
        const std::uint64_t scene = bytes("bvh_nodes") + bytes("leaf_blocks") + bytes("shapes") +
                                    bytes("instances") + bytes("materials");
        CHECK(bytes("total") ==
              std::max(bytes("scene_loaded") + bytes("scene_building"),
                       scene + bytes("film") + std::max(bytes("ray_queues"), bytes("image"))));
    }
}

TEST_CASE("info: the text says the same", "[cli]") {
    const TemporaryFolder folder;
    const ProcessResult result = info(folder, {scene_file("all_entities.nff")});
    INFO(result.out << result.err);
    CHECK(result.status == 0);
    CHECK(result.err == "");
    CHECK(contains(result.out, "(Neutral File Format)\n"));
    CHECK(contains(result.out, "\nimage           64x48, depth 4\n"));
    CHECK(
        contains(result.out, "\nprimitives      8: 4 triangles, 1 polygon, 2 spheres, 1 cone or cylinder\n"));
    CHECK(contains(result.out, "\nlights          2: 2 point; "));
    CHECK(contains(result.out, "\ncameras         1: camera\n"));
    CHECK(contains(result.out, "\n  film               72.00 KiB\n"));
    CHECK(contains(result.out, "\nunused          nothing\n"));
}

TEST_CASE("info: groups, instances, parameters and what is unused in a Sahl scene", "[cli]") {
    const TemporaryFolder folder;
    write_file(folder / "a.json", R"({
  "sahl": 1,
  "parameters": {"size": {"type": "number", "default": 1}},
  "film": {"width": 8, "height": 4},
  "cameras": {"front": {"eye": [0, 0, 9], "look_at": [0, 0, 0]},
              "top": {"eye": [0, 9, 0], "look_at": [0, 0, 0], "up": [0, 0, 1]}},
  "lights": [{"type": "spot", "position": [0, 5, 0], "direction": [0, -1, 0], "outer_angle": 30}],
  "materials": {"red": {"diffuse": [1, 0, 0]}, "spare": {}},
  "groups": {
    "pair": [{"type": "sphere", "radius": "$size", "material": "red"},
             {"type": "box", "min": [2, 2, 2], "max": [3, 3, 3], "material": "red"}],
    "pairs": [{"type": "instance", "group": "pair"},
              {"type": "instance", "group": "pair", "transform": {"translate": [0, 0, 5]}}],
    "lonely": [{"type": "disc", "material": "red"}]
  },
  "objects": [{"type": "instance", "group": "pairs"},
              {"type": "instance", "group": "pairs", "transform": {"translate": [10, 0, 0]}},
              {"type": "sphere", "material": "red"}]
})");
    const std::string scene = (folder / "a.json").string();
    const nlohmann::json event = info_event({scene});
    CHECK(event.at("format") == "Sahl scene");
    CHECK(event.at("primitives").at("count") == 4);
    CHECK(event.at("primitives").at("placed") == 1 + 2 * 2 * 2);
    CHECK(event.at("instances").at("count") == 4);
    CHECK(event.at("instances").at("placed") == 2 + 2 * 2);
    CHECK(event.at("groups") == 3);
    CHECK(event.at("lights").at("spot") == 1);
    CHECK(event.at("cameras")[1].at("name") == "top");
    CHECK(event.at("unused").at("groups") == nlohmann::json({"lonely"}));
    CHECK(event.at("unused").at("materials") == nlohmann::json({"spare"}));
    CHECK(event.at("memory").at("instances") == 4096);  // a page for 6 of 128 bytes
    CHECK(event.at("bounds")[0][0].get<double>() == Approx(-1).margin(1e-3));
    CHECK(event.at("bounds")[1][0].get<double>() == Approx(13).margin(1e-3));
    const nlohmann::json larger = info_event({scene, "--set", "size=4"});
    CHECK(larger.at("bounds")[0][0].get<double>() == Approx(-4).margin(1e-3));
    CHECK(event.at("material_names") == nlohmann::json({"red", "spare"}));
    const ProcessResult text = info(folder, {scene});
    CHECK(contains(text.out, "\nmaterials       2, textures 0\nbounds          -1 -1 -1 to 13 3 8\n"));
    const ProcessResult verbose = info(folder, {scene, "-v"});
    CHECK(contains(verbose.out,
                   "\nmaterials       2, textures 0\n  0             red\n  1             spare\nbounds"));
    CHECK(contains(text.out, "unused          material 'spare', group 'lonely'\n"));
}

TEST_CASE("info: a scene of nothing has no bounds", "[cli]") {
    const TemporaryFolder folder;
    write_file(folder / "a.json",
               R"({"sahl": 1, "cameras": {"main": {"eye": [0, 0, 9], "look_at": [0, 0, 0]}}})");
    const std::string scene = (folder / "a.json").string();
    CHECK(info_event({scene}).at("bounds").is_null());
    CHECK(contains(info(folder, {scene}).out, "\nbounds          none\n"));
}

TEST_CASE("info: a scene that is wrong or not there is exit status 3", "[cli]") {
    const TemporaryFolder folder;
    write_file(folder / "bad.nff", "s 1 2\n");
    CHECK(info(folder, {"bad.nff"}).status == 3);
    CHECK(info(folder, {"missing.nff"}).status == 3);
    CHECK(info(folder, {}).status == 2);
    CHECK(info(folder, {"a.png"}).status == 2);
    CHECK(info(folder, {"bad.nff", "--device", "0"}).status == 2);
}

}  // namespace sahl::tests
