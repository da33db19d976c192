#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>
#include <string>

#include <glm/geometric.hpp>

#include "engine/scene/load.h"
#include "tests/host/scene/parse.h"
#include "tests/support/temporary_folder.h"

namespace sahl::tests {
namespace {

namespace fs = std::filesystem;

const std::string nff_scene =
    nff_view +
    "l 1 2 3\nf 1 0 0 1 0 1 0 1\ns 1 0 0 2\nf 0 1 0 1 0 1 0 1\n"
    "p 4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\np 3\n0 0 0\n1 0 0\n1 1 0\nf 0 0 1 1 0 1 0 1\n";

const std::string json_scene = R"({"sahl": 1,
"parameters": {"size": {"type": "number", "default": 1, "max": 9}, "tint": {"type": "color", "default": 1}},
"cameras": {"inner": {"eye": [0, 0, 5], "look_at": [0, 0, 0]}},
"lights": [{"type": "point", "position": [1, 0, 0]}, {"type": "ambient", "color": 0.5},
  {"type": "directional", "direction": [0, 0, -1]},
  {"type": "spot", "position": [0, 0, 1], "direction": [1, 0, 0], "outer_angle": 20}],
"materials": {"a": {"diffuse": "$tint"},
  "b": {"diffuse": {"checker": "uv", "colors": [0, 1]}}, "c": {"ambient": {"checker": "uv", "colors": [1, 0]}}},
"groups": {"g": [{"type": "sphere", "material": "a", "transform": {"translate": [0, 0, 1]}}],
  "h": [{"type": "instance", "group": "g", "transform": {"translate": [0, 1, 0]}}]},
"objects": [{"type": "box", "min": [0, 0, 0], "max": ["$size", 1, 1], "material": "b"},
  {"type": "disc", "material": "c", "sides": "back", "transform": {"translate": [1, 0, 0]}},
  {"type": "cone", "base": [0, 0, 0], "top": [0, 0, 1], "material": "a"},
  {"type": "mesh", "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]], "material": "a",
   "normals": [[0, 0, 1], [0, 0, 1], [0, 0, 1]], "uv": [[0, 0], [1, 0], [0, 1]]},
  {"type": "instance", "group": "h", "transform": {"translate": [5, 0, 0]}}]})";

// A folder of scenes; the top one is top.json.
class Scenes {
public:
    Scenes() {
        write("a.nff", nff_scene);
        write("a.json", json_scene);
        write("a.test", cse167_head + "diffuse 1 0 0\nsphere 0 0 0 1\n");
    }

    void write(const std::string& name, const std::string& text) const {
        fs::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name, std::ios::binary) << text;
    }

    // The objects begin on line 2.
    Scene load(const std::string& objects, const LoadOptions& options = {}) const {
        write("top.json", json_head + objects + "]}");
        return load_scene(folder_ / "top.json", options);
    }

    void check_error(const std::string& objects, const std::string& file_and_place, const std::string& says,
                     const LoadOptions& options = {}) const {
        INFO(objects);
        try {
            load(objects, options);
            FAIL_CHECK("was accepted");
        } catch (const Error& error) {
            CHECK(error.code() == ExitCode::scene);
            CHECK_THAT(error.what(), Catch::StartsWith((folder_ / file_and_place).string() + ": ") &&
                                         Catch::Contains(says));
        }
    }

    const TemporaryFolder& folder() const { return folder_; }

private:
    TemporaryFolder folder_;
};

glm::dvec3 origin_of(const Scene& scene, std::uint32_t transform) {
    return glm::dvec3(scene.transforms[transform][3]);
}

std::string include(const std::string& uri, const std::string& more = "") {
    return R"({"type": "include", "uri": ")" + uri + "\"" + (more.empty() ? "" : ", " + more) + "}";
}

}  // namespace

TEST_CASE("Several includes share no index by mistake", "[scene][json]") {
    const Scenes scenes;
    const Scene scene = scenes.load(R"({"type": "sphere", "radius": 9}, )" + include("a.nff") + ", " +
                                    include("a.json", R"("transform": {"translate": [0, 0, 100]})") + ", " +
                                    include("a.test") + ", " + include("a.json"));
    // Nothing but the objects is taken over.
    CHECK(scene.lights.empty());
    CHECK(scene.ambient == glm::vec3(1));
    REQUIRE(scene.cameras.size() == 1);
    CHECK(scene.cameras[0].name == "main");

    REQUIRE(scene.materials.size() == 1 + 3 + 3 + 1 + 3);
    CHECK(scene.materials[0].name == "default");
    CHECK(scene.materials[3].name == "fill3");  // kept though nothing uses it
    CHECK(scene.materials[5].name == "b");
    CHECK(scene.materials[7].name == "material1");
    CHECK(scene.materials[5].textures.diffuse == 0);
    CHECK(scene.materials[6].textures.ambient == 1);
    CHECK(scene.materials[9].textures.diffuse == 2);
    CHECK(scene.materials[10].textures.ambient == 3);
    REQUIRE(scene.textures.size() == 4);
    CHECK(scene.textures[2].colors[1] == glm::vec3(1));
    CHECK(scene.textures[3].colors[1] == glm::vec3(0));

    REQUIRE(world_primitive_count(scene) == 1 + 3 + 4 + 1 + 4);
    const auto& p = scene.primitives;
    CHECK(scene.spheres[p[0].index].radius == 9);
    CHECK(scene.spheres[p[1].index].radius == 2);
    CHECK(p[1].material == 1);
    CHECK(p[2].kind == PrimitiveKind::polygon);
    CHECK(p[2].material == 2);
    CHECK(p[3].kind == PrimitiveKind::triangle);
    const auto check_json = [&](std::size_t first, std::uint32_t materials, double z) {
        CHECK(p[first].kind == PrimitiveKind::box);
        CHECK(p[first].material == materials + 1);
        CHECK(scene.boxes[p[first].index].hi == glm::dvec3(1));
        CHECK(origin_of(scene, p[first].transform) == glm::dvec3(0, 0, z));
        CHECK(p[first + 1].kind == PrimitiveKind::disc);
        CHECK(p[first + 1].material == materials + 2);
        CHECK(p[first + 1].sides == Sides::back);
        CHECK(origin_of(scene, p[first + 1].transform) == glm::dvec3(1, 0, z));
        CHECK(p[first + 2].kind == PrimitiveKind::cone);
        CHECK(scene.cones[p[first + 2].index].apex == glm::dvec3(0, 0, 1));
        const Triangle& triangle = scene.triangles[p[first + 3].index];
        CHECK(scene.vertices[triangle.vertices[1]] == glm::vec3(1, 0, 0));
        CHECK(scene.vertices[triangle.vertices[2]] == glm::vec3(0, 1, 0));
        CHECK(scene.normals[triangle.normals[2]] == glm::vec3(0, 0, 1));
        CHECK(scene.uvs[triangle.uvs[2]] == glm::vec2(0, 1));
    };
    check_json(4, 4, 100);
    CHECK(scene.spheres[p[8].index].radius == 1);
    CHECK(p[8].material == 7);
    check_json(9, 8, 0);

    REQUIRE(scene.groups.size() == 4);
    REQUIRE(scene.instances.size() == 2);
    for (std::uint32_t i = 0; i < 2; ++i) {
        const Group& g = scene.groups[2 * i];
        const Group& h = scene.groups[2 * i + 1];
        CHECK(g.name == "g");
        CHECK(g.first_primitive == 13 + i);
        REQUIRE(g.primitive_count == 1);
        CHECK(p[g.first_primitive].kind == PrimitiveKind::sphere);
        CHECK(p[g.first_primitive].material == (i == 0 ? 4 : 8));
        // What is inside a group stays where it is.
        CHECK(origin_of(scene, p[g.first_primitive].transform) == glm::dvec3(0, 0, 1));
        CHECK(h.name == "h");
        CHECK(h.primitive_count == 0);
        REQUIRE(h.instances.size() == 1);
        CHECK(h.instances[0].group == 2 * i);
        CHECK(origin_of(scene, h.instances[0].transform) == glm::dvec3(0, 1, 0));
        CHECK(scene.instances[i].group == 2 * i + 1);
        CHECK(origin_of(scene, scene.instances[i].transform) == glm::dvec3(5, 0, i == 0 ? 100 : 0));
    }
}

TEST_CASE("Each include brings vertices of its own", "[scene][json]") {
    const Scenes scenes;
    const std::string both = include("a.nff") + ", " + include("a.json");
    const Scene scene = scenes.load(both + ", " + both);
    REQUIRE(scene.polygons.size() == 2);
    CHECK(scene.polygons[0].first_vertex == 0);
    CHECK(scene.polygons[1].first_vertex == 4);
    REQUIRE(scene.triangles.size() == 4);
    for (std::uint32_t i = 0; i < 4; ++i) {
        CHECK(scene.triangles[i].vertices[2] == 3 * i + 2);
        if (i % 2 == 0) continue;
        CHECK(scene.triangles[i].normals[2] == 3 * (i / 2) + 2);
        CHECK(scene.triangles[i].uvs[2] == 3 * (i / 2) + 2);
    }
}

TEST_CASE("An include inside a group belongs to it", "[scene][json]") {
    const Scenes scenes;
    scenes.write("top.json", R"({"sahl": 1, "cameras": {"c": {"eye": [0, 0, 5], "look_at": [0, 0, 0]}},
        "groups": {"own": [)" + include("a.json") +
                                 R"(, {"type": "sphere", "radius": 3}], "other": []},
        "objects": [{"type": "instance", "group": "own"}, {"type": "instance", "group": "other"}]})");
    const Scene scene = load_scene(scenes.folder() / "top.json");
    CHECK(world_primitive_count(scene) == 0);
    REQUIRE(scene.groups.size() == 4);
    CHECK(scene.groups[0].name == "own");
    CHECK(scene.groups[0].primitive_count == 5);
    REQUIRE(scene.groups[0].instances.size() == 1);
    CHECK(scene.groups[0].instances[0].group == 3);
    CHECK(scene.groups[1].name == "other");
    CHECK(scene.groups[2].name == "g");
    CHECK(scene.groups[3].instances[0].group == 2);
    REQUIRE(scene.instances.size() == 2);
    CHECK(scene.instances[1].group == 1);
}

TEST_CASE("An include takes materials, sides and parameters from outside", "[scene][json]") {
    const Scenes scenes;
    SECTION("one material for all") {
        const Scene scene =
            scenes.load(include("a.json", R"("material": {"diffuse": [0, 0, 1]}, "sides": "front")"));
        REQUIRE(scene.materials.size() == 1);
        CHECK(scene.materials[0].diffuse == glm::vec3(0, 0, 1));
        CHECK(scene.textures.empty());
        for (const Primitive& p : scene.primitives) {
            CHECK(p.material == 0);
            CHECK(p.sides == Sides::front);
        }
    }
    SECTION("materials by name") {
        const Scene scene = scenes.load(include("a.json", R"("materials": {"b": {"diffuse": [0, 0, 1]}})"));
        REQUIRE(scene.materials.size() == 3);
        CHECK(scene.materials[0].diffuse == glm::vec3(0, 0, 1));
        CHECK(scene.materials[1].name == "a");
        CHECK(scene.materials[2].name == "c");
        CHECK(scene.materials[2].textures.ambient == 0);
        CHECK(scene.textures.size() == 1);
        CHECK(scene.primitives[0].material == 0);
        CHECK(scene.primitives[1].material == 2);
        CHECK(scene.primitives[2].material == 1);
    }
    SECTION("names of other formats") {
        const Scene scene =
            scenes.load(include("a.nff", R"("materials": {"fill2": {"diffuse": [0, 0, 1]}})") + ", " +
                        include("a.test", R"("materials": {"material1": {"diffuse": [0, 1, 1]}})"));
        CHECK(scene.materials[scene.primitives[0].material].name == "fill1");
        CHECK(scene.materials[scene.primitives[1].material].diffuse == glm::vec3(0, 0, 1));
        CHECK(scene.materials[scene.primitives[3].material].diffuse == glm::vec3(0, 1, 1));
    }
    SECTION("parameters") {
        const Scene scene = scenes.load(include("a.json", R"("set": {"size": 4, "tint": [1, 0.5, 0]})"));
        CHECK(scene.boxes[0].hi.x == 4);
        CHECK(scene.materials[0].diffuse == glm::vec3(1, 0.5F, 0));
    }
    SECTION("nothing from the group around but the transform") {
        const Scene scene = scenes.load(
            R"({"type": "group", "material": {}, "sides": "front", "transform": {"translate": [0, 7, 0]}, "objects": [)" +
            include("a.test") + "]}");
        CHECK(scene.materials[scene.primitives[0].material].name == "material1");
        CHECK(scene.primitives[0].sides == Sides::both);
        CHECK(origin_of(scene, scene.primitives[0].transform) == glm::dvec3(0, 7, 0));
    }
}

TEST_CASE("Lights and cameras of an include come if they are asked for", "[scene][json]") {
    const Scenes scenes;
    const Scene scene = scenes.load(include("a.json",
                                            R"("lights": true, "cameras": true,
           "transform": [{"rotate": 90, "axis": [0, 1, 0]}, {"scale": 2}, {"translate": [0, 10, 0]}])"));
    const auto near = [](glm::dvec3 a, glm::dvec3 b) { return glm::length(a - b) < 1e-12; };
    REQUIRE(scene.lights.size() == 3);
    CHECK(near(scene.lights[0].position, {0, 10, -2}));
    CHECK(near(scene.lights[1].position, {1, 0, 0}));  // towards the light
    CHECK(near(scene.lights[2].position, {2, 10, 0}));
    CHECK(near(scene.lights[2].direction, {0, 0, -1}));
    CHECK(scene.ambient == glm::vec3(0.5F));
    REQUIRE(scene.cameras.size() == 2);
    CHECK(scene.cameras[1].name == "inner");
    CHECK(near(scene.cameras[1].eye, {10, 10, 0}));
    CHECK(near(scene.cameras[1].look_at, {0, 10, 0}));
    CHECK(near(scene.cameras[1].up, {0, 2, 0}));

    // Formats without ambient lights add none; a scene may live on the cameras of others.
    scenes.write("top.json", R"({"sahl": 1, "objects": [)" +
                                 include("a.nff", R"("lights": true, "cameras": true)") + "]}");
    const Scene second = load_scene(scenes.folder() / "top.json");
    CHECK(second.lights.size() == 1);
    CHECK(second.ambient == glm::vec3(1));
    CHECK(second.cameras[0].name == "camera");
}

TEST_CASE("Includes nest, each file from its own folder", "[scene][json]") {
    const Scenes scenes;
    scenes.write("deep/one.json", R"({"sahl": 1, "objects": [)" + include("two/two.json") + "]}");
    scenes.write("deep/two/two.json", R"({"sahl": 1, "objects": [)" + include("../../a.test") + "]}");
    CHECK(scenes.load(include("deep/one.json")).primitives.size() == 1);
    // Sixteen files below the top are allowed.
    for (int i = 1; i <= 17; ++i) {
        scenes.write("n" + std::to_string(i) + ".json",
                     R"({"sahl": 1, "objects": [)" + include("n" + std::to_string(i + 1) + ".json") + "]}");
    }
    scenes.write("n16.json", R"({"sahl": 1, "objects": [{"type": "sphere"}]})");
    CHECK(scenes.load(include("n1.json")).primitives.size() == 1);
    scenes.write("n16.json", R"({"sahl": 1, "objects": [)" + include("n17.json") + "]}");
    scenes.check_error(include("n1.json"), "n16.json:1:52", "includes nest deeper than 16");
}

TEST_CASE("Errors of includes", "[scene][json]") {
    const Scenes scenes;
    scenes.check_error(include("b.nff"), "top.json:2:28", "there is no file ");
    scenes.check_error(
        include("a.nff", R"("materials": {"x": {}})") + "," + include("a.test", R"("materials": {"x": {}})"),
        "top.json:2:51", "the included scene has no material 'x'; its materials are fill1");
    scenes.write("plain.json", R"({"sahl": 1})");
    scenes.check_error(include("plain.json", R"("materials": {"x": {}})"), "top.json:2:56",
                       "the included scene has no material 'x'; there are none");
    scenes.check_error(include("plain.json", R"("set": {"x": 1})"), "top.json:2:50",
                       "plain.json has no parameters");
    scenes.check_error(include(""), "top.json:2:28", "the uri is empty");
    scenes.check_error(include("/etc/a.nff"), "top.json:2:28", "'/etc/a.nff' is no relative path");
    scenes.check_error(include("http://a/b.nff"), "top.json:2:28", "without a scheme such as http:");
    scenes.check_error(include("file:a.nff"), "top.json:2:28", "is no relative path");
    scenes.check_error(include("a.nff\\u0000.json"), "top.json:2:28", "holds a control character");
    scenes.check_error(include(std::string(300, 'x') + ".nff"), "top.json:2:28", "cannot read");
    scenes.write("a.obj", "");
    scenes.check_error(include("a.obj"), "top.json:2:28", "no scene format has the extension '.obj'");
    fs::create_directories(scenes.folder() / "folder.nff");
    scenes.check_error(include("folder.nff"), "top.json:2:28", "is no regular file");
    scenes.check_error(R"({"type": "include"})", "top.json:2:1", "this include has no 'uri'; add it");
    scenes.check_error(include("a.nff", R"("set": {"size": 1})"), "top.json:2:44",
                       "has no parameters; remove 'set'");
    scenes.check_error(include("a.json", R"("set": {"sise": 1})"), "top.json:2:46",
                       "has no parameter 'sise'; did you mean 'size'?");
    scenes.check_error(include("a.json", R"("set": {"size": "x"})"), "top.json:2:54",
                       "size: expected a number, found the string 'x'");
    scenes.check_error(include("a.json", R"("set": {"size": 10})"), "top.json:2:54",
                       "'size' must be at least -1e+15 and at most 9, not 10");
    scenes.check_error(include("a.nff", R"("materials": {"fill4": {}})"), "top.json:2:51",
                       "the included scene has no material 'fill4'; did you mean 'fill1'?");
    scenes.check_error(include("a.nff", R"("materials": {"fill1": "red"})"), "top.json:2:60",
                       "there is no material 'red'; there are no materials");
    scenes.check_error(include("a.nff", R"("material": {}, "materials": {})"), "top.json:2:66",
                       "'material' already replaces all materials");
    scenes.check_error(include("a.nff", R"("lights": 1)"), "top.json:2:47",
                       "lights: expected true or false, found the number 1");
    scenes.check_error(include("a.nff", R"("transform": {"scale": 1e15})"), "top.json:2:1",
                       "this sphere reaches beyond ±1e+15");
    scenes.check_error(
        include("a.nff", R"("cameras": true)") + ",\n" + include("a.nff", R"("cameras": true)"),
        "top.json:3:48", "there is a camera 'camera' already");
    scenes.check_error(include("top.json"), "top.json:2:28",
                       "top.json includes itself: top.json -> top.json");
    scenes.write("b.json", R"({"sahl": 1, "objects": [)" + include("c.json") + "]}");
    scenes.write("c.json", R"({"sahl": 1, "objects": [)" + include("b.json") + "]}");
    scenes.check_error(include("b.json"), "c.json:1:52",
                       "b.json includes itself: b.json -> c.json -> b.json");
}

TEST_CASE("An error in an included file has its place there, and that of the include", "[scene][json]") {
    const Scenes scenes;
    const auto from = [&](const std::string& place) {
        return "(included from " + (scenes.folder() / place).string() + ")";
    };
    scenes.write("bad.nff", "b 0 0 x\n");
    scenes.check_error(include("bad.nff"), "bad.nff:1:7", from("top.json:2:28"));
    scenes.write("bad.json", "{\"sahl\": 1,\n \"film\": 3}");
    scenes.check_error(include("bad.json"), "bad.json:2:10", from("top.json:2:28"));
    scenes.write("bad.json", "{\"sahl\": 1,\n \"film\": 3,}");
    scenes.check_error(include("bad.json"), "bad.json:2:11", from("top.json:2:28"));
    scenes.write("middle.json", "{\"sahl\": 1,\n \"objects\": [" + include("bad.json") + "]}");
    scenes.check_error(include("middle.json"), "bad.json:2:11",
                       from("middle.json:2:41") + " " + from("top.json:2:28"));
    scenes.write("bad.json", R"({"sahl": 1, "parameters": {"p": {"type": "number", "default": 1}}})");
    scenes.check_error(include("bad.json"), "bad.json:1:28", "the parameter 'p' is never used");
}

TEST_CASE("Included files lie in the asset root", "[scene][json]") {
    const Scenes scenes;
    const fs::path root = scenes.folder().path();
    scenes.write("inner/top2.json", json_head + include("../a.nff") + "]}");
    const std::string place = (root / "inner/top2.json").string() + ":2:28: ";
    CHECK_THROWS_WITH(load_scene(root / "inner/top2.json"),
                      Catch::StartsWith(place) && Catch::Contains("lies outside the asset root"));
    LoadOptions wide;
    wide.asset_root = root;
    CHECK(load_scene(root / "inner/top2.json", wide).primitives.size() == 3);
    wide.asset_root = root / "";
    CHECK(load_scene(root / "inner/top2.json", wide).primitives.size() == 3);
    LoadOptions sibling;  // its name begins like the folder's, but it is another
    fs::create_directories(root / "inn");
    sibling.asset_root = root / "inn";
    scenes.write("inner/a.nff", nff_scene);
    scenes.write("inner/top2.json", json_head + include("a.nff") + "]}");
    CHECK_THROWS_WITH(load_scene(root / "inner/top2.json", sibling), Catch::StartsWith(place));
    CHECK(load_scene(root / "inner/top2.json").primitives.size() == 3);
    LoadOptions missing;
    missing.asset_root = root / "nowhere";
    CHECK_THROWS_WITH(load_scene(root / "inner/top2.json", missing), Catch::StartsWith("--asset-root "));

    // Links count as where they lead to.
    fs::create_symlink(root / "a.nff", root / "inner/link.nff");
    scenes.write("inner/top2.json", json_head + include("link.nff") + "]}");
    CHECK_THROWS_WITH(load_scene(root / "inner/top2.json"),
                      Catch::StartsWith(place) && Catch::Contains("lies outside the asset root"));
    CHECK(load_scene(root / "inner/top2.json", wide).primitives.size() == 3);
    fs::create_directory_symlink(root, root / "inner/up");
    scenes.write("inner/top2.json", json_head + include("up/a.nff") + "]}");
    CHECK_THROWS_WITH(load_scene(root / "inner/top2.json"), Catch::StartsWith(place));
    fs::create_symlink(root / "inner/loop.nff", root / "inner/loop.nff");
    scenes.write("inner/top2.json", json_head + include("loop.nff") + "]}");
    CHECK_THROWS_WITH(load_scene(root / "inner/top2.json"), Catch::StartsWith(place));
    // Behind a link, .. is the folder above the link's target, for what is included there too.
    fs::create_directories(root / "far/below");
    fs::create_directory_symlink(root / "far/below", root / "inner/away");
    scenes.write("far/b.json", R"({"sahl": 1, "objects": [)" + include("c.json") + "]}");
    scenes.write("far/c.json", R"({"sahl": 1, "objects": [{"type": "sphere"}]})");
    scenes.write("inner/top2.json", json_head + include("away/../b.json") + "]}");
    CHECK(load_scene(root / "inner/top2.json", wide).primitives.size() == 1);
    // .. inside the root is fine.
    fs::create_directories(root / "inner/down");
    scenes.write("inner/top2.json", json_head + include("down/../a.nff") + "]}");
    CHECK(load_scene(root / "inner/top2.json").primitives.size() == 3);
}

TEST_CASE("A scene is found from any working directory", "[scene][json]") {
    const Scenes scenes;
    scenes.write("top.json", json_head + include("a.nff") + "]}");
    const fs::path before = fs::current_path();
    fs::current_path(scenes.folder().path());
    const std::size_t count = load_scene("top.json").primitives.size();
    const auto refusal = [&](const std::string& scene, const std::string& uri) -> std::string {
        scenes.write("top.json", json_head + include(uri) + "]}");
        try {
            load_scene(scene);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    std::vector<std::pair<std::string, std::string>> seen;  // what was said, what should be
    for (const std::string scene : {"top.json", "./top.json"}) {
        const std::string place = scene + ":2:28: ";
        for (const std::string uri : {"nope.nff", "./nope.nff", "inner/../nope.nff", "no/where.nff"})
            seen.emplace_back(refusal(scene, uri), place + "there is no file ");
        for (const std::string uri : {"../nope.nff", "inner/../../nope.nff", "no/../../nope.nff"})
            seen.emplace_back(refusal(scene, uri), place + "../nope.nff lies outside the asset root ");
    }
    // A link to nothing is no file; behind a link, `..` is the folder above the link's target.
    fs::create_symlink("nothing.nff", scenes.folder() / "dangling.nff");
    fs::create_directories(scenes.folder() / "far/below");
    fs::create_directory_symlink("far/below", scenes.folder() / "away");
    seen.emplace_back(refusal("top.json", "dangling.nff"), "top.json:2:28: there is no file dangling.nff");
    seen.emplace_back(refusal("top.json", "away/../nope.nff"),
                      "top.json:2:28: there is no file away/../nope.nff");
    fs::current_path(before);
    CHECK(count == 3);
    for (const auto& [said, expected] : seen) CHECK_THAT(said, Catch::StartsWith(expected));
}

}  // namespace sahl::tests
