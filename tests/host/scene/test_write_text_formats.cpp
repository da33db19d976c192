// Scenes written as NFF and as .test: read again they are the same, and what the formats have no
// words for is refused by its name.
#include <catch2/catch.hpp>

#include <filesystem>
#include <functional>
#include <random>
#include <string>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/core/error.h"
#include "engine/scene/load.h"
#include "engine/scene/write_cse167.h"
#include "engine/scene/write_nff.h"
#include "engine/scene/write_scene.h"
#include "engine/scene/write_text.h"
#include "tests/host/scene/parse.h"
#include "tests/host/scene/resolved_scene.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"

namespace sahl::tests {
namespace {

// Compared line by line: a difference of a whole scene would fill screens.
void check_same(const Scene& a, const Scene& b) {
    const std::string text_a = resolved(a);
    const std::string text_b = resolved(b);
    if (text_a == text_b) return;
    std::size_t i = 0;
    while (i < text_a.size() && i < text_b.size() && text_a[i] == text_b[i]) ++i;
    const std::size_t start = text_a.rfind('\n', i == 0 ? 0 : i - 1) + 1;
    FAIL_CHECK("the scenes differ: '" << text_a.substr(start, 200) << "' against '"
                                      << text_b.substr(start, 200) << "'");
}

// A sphere with a material and camera that both text formats can say.
Scene simple_scene(bool nff) {
    return nff ? parse_nff(nff_view + "f 1 .5 .25 .8 .2 30 0 1\ns 0 0 0 1\nl 1 2 3\n")
               : parse_cse167(cse167_head + "point 1 2 3 1 1 1\ndiffuse 1 .5 .25\nsphere 0 0 0 1\n");
}

}  // namespace

TEST_CASE("Decimal text of numbers is short and exact", "[scene][write]") {
    CHECK(decimal(0.1F) == "0.1");
    CHECK(decimal(0.1) == "0.1");
    CHECK(decimal(1e-15) == "1e-15");
    CHECK(decimal(-3.0F) == "-3");
    std::mt19937 random(1);
    for (int i = 0; i < 100000; ++i) {
        const float x =
            std::ldexp(static_cast<float>(random()) / 3e9F, static_cast<int>(random() % 200) - 100);
        if (static_cast<float>(std::stod(decimal(x))) != x) FAIL("float " << x);
        const double y = static_cast<double>(random()) * 1e-3 + static_cast<double>(random()) * 1e-12;
        if (std::stod(decimal(y)) != y) FAIL("double " << y);
    }
}

TEST_CASE("Unit normals survive being normalised again", "[scene][write]") {
    std::mt19937 random(2);
    std::normal_distribution<double> gauss;
    int changed = 0;
    for (int i = 0; i < 100000; ++i) {
        glm::dvec3 direction(gauss(random), gauss(random), gauss(random));
        if (i % 5 == 0) direction.x = 0;
        if (i % 7 == 0) direction.y *= 1e-9;
        const glm::vec3 normal(glm::normalize(direction));
        if (glm::vec3(glm::normalize(before_normalizing(normal, "NFF"))) != normal) FAIL("normal " << i);
        changed += glm::vec3(glm::normalize(glm::dvec3(normal))) != normal ? 1 : 0;
    }
    // The plain way does lose some.
    CHECK(changed > 100);
    CHECK_THROWS_WITH(before_normalizing({0, 0, 2}, "NFF"),
                      Catch::StartsWith("NFF makes normals unit length"));
}

TEST_CASE("NFF and .test scenes are the same after writing and reading", "[scene][write]") {
    check_same(load_scene(own_scene("all_entities.nff")),
               parse_nff(write_nff(load_scene(own_scene("all_entities.nff")))));
    check_same(load_scene(own_scene("cli_mirrors.nff")),
               parse_nff(write_nff(load_scene(own_scene("cli_mirrors.nff")))));
    check_same(load_scene(own_scene("all_commands.test")),
               parse_cse167(write_cse167(load_scene(own_scene("all_commands.test")))));
    // The comparison sees a difference in the last bit.
    Scene scene = simple_scene(true);
    const std::string before = resolved(scene);
    scene.materials[0].diffuse.g = std::nextafter(scene.materials[0].diffuse.g, 1.0F);
    CHECK(resolved(scene) != before);
}

TEST_CASE("The Standard Procedural Databases are the same after writing as NFF", "[scene][write][data]") {
    const auto data = test_data();
    if (!data) {
        WARN("SKIPPED: SAHL_TEST_DATA is not set");
        return;
    }
    for (const auto& entry : std::filesystem::recursive_directory_iterator(*data / "spd" / "nff")) {
        if (entry.path().extension() != ".nff") continue;
        INFO(entry.path().string());
        const Scene scene = load_scene(entry.path());
        check_same(scene, parse_nff(write_nff(scene)));
    }
}

TEST_CASE("The CSE 167 scenes are the same after writing as .test", "[scene][write][data]") {
    const auto data = test_data();
    if (!data) {
        WARN("SKIPPED: SAHL_TEST_DATA is not set");
        return;
    }
    for (const auto& entry : std::filesystem::recursive_directory_iterator(*data / "cse167" / "scenes")) {
        if (entry.path().extension() != ".test") continue;
        INFO(entry.path().string());
        const Scene scene = load_scene(entry.path());
        check_same(scene, parse_cse167(write_cse167(scene)));
    }
}

TEST_CASE("Turns and scales are found again behind a matrix of .test", "[scene][write]") {
    const std::string turns =
        GENERATE(as<std::string>(), "scale 2 -3 .25", "rotate 0 1 0 30\nscale 1 2 3",
                 "scale 1 2 3\nrotate 1 0 0 -15", "rotate 1 1 1 120", "rotate 0 0 1 180\nscale .5 .5 .5",
                 "rotate 1 0 0 90", "translate 1 2 3\nrotate 0 1 0 -60\ntranslate 0 0 -1\nscale 10 10 1");
    INFO(turns);
    const Scene scene = parse_cse167(cse167_head + "pushTransform\n" + turns + "\nsphere 1 2 3 .5\n");
    check_same(scene, parse_cse167(write_cse167(scene)));
}

TEST_CASE("What NFF cannot express is refused by its name", "[scene][write]") {
    struct Case {
        std::string says;
        std::function<void(Scene&)> change;
    };
    const auto item = GENERATE(values<Case>({
        {"has one camera, and the scene has 2", [](Scene& s) { s.cameras.emplace_back(); }},
        {"is always rendered with depth 4, and the scene's depth is 5", [](Scene& s) { s.depth = 5; }},
        {"has no groups and instances",
         [](Scene& s) {
             s.groups.push_back({"g", 1, 0, {}});
         }},
        {"has no directional lights: light 1", [](Scene& s) { s.lights[0].kind = LightKind::directional; }},
        {"has no spot lights: light 1", [](Scene& s) { s.lights[0].kind = LightKind::spot; }},
        {"has no attenuation of light by distance: light 1", [](Scene& s) { s.lights[0].attenuation.z = 1; }},
        {"has no ambient light: material 'fill1'", [](Scene& s) { s.materials[0].ambient.g = 1; }},
        {"has no emission: the material of object 1 (a sphere)",
         [](Scene& s) {
             s.materials[0].emission.g = 1;
             s.materials[0].name.clear();
         }},
        {"has no emission: material 2, which nothing uses",
         [](Scene& s) { s.materials.emplace_back().emission.g = 1; }},
        {"has no capped cones and cylinders: object 2 (a cylinder)",
         [](Scene& s) {
             s.cones.push_back({{0, 0, 0}, {0, 0, 1}, 1, 1, true});
             s.primitives.push_back({PrimitiveKind::cone, 0});
         }},
        {"has no emission", [](Scene& s) { s.materials[0].emission.g = 1; }},
        {"both have to be equal", [](Scene& s) { s.materials[0].specular = glm::vec3(1); }},
        {"has no coloured Ks",
         [](Scene& s) {
             s.materials[0].specular = s.materials[0].reflection = {1, .5, 1};
         }},
        {"has no coloured T",
         [](Scene& s) {
             s.materials[0].transmission = {1, .5, 1};
         }},
        {"has no Blinn highlights", [](Scene& s) { s.materials[0].specular_model = SpecularModel::blinn; }},
        {"has no one-sided materials", [](Scene& s) { s.materials[0].two_sided = false; }},
        {"has no index of refraction outside", [](Scene& s) { s.materials[0].ior_outside = 1.5F; }},
        {"has no attenuation of the reflected light",
         [](Scene& s) { s.materials[0].reflection_attenuation.y = 1; }},
        {"has no textures: material 'fill1'", [](Scene& s) { s.materials[0].textures.diffuse = 0; }},
        {"has no transforms: object 1 (",
         [](Scene& s) { s.transforms[0] = glm::scale(glm::dmat4(1), glm::dvec3(2)); }},
        {"has no one-sided objects but the insides of spheres and cones: object 1 (",
         [](Scene& s) { s.primitives[0].sides = Sides::front; }},
        {"has no discs: object 1 (a disc)", [](Scene& s) { s.primitives[0].kind = PrimitiveKind::disc; }},
        {"has no boxes: object 1 (a box)", [](Scene& s) { s.primitives[0].kind = PrimitiveKind::box; }},
        {"has no capped cones and cylinders: object 1 (a cone)",
         [](Scene& s) {
             s.primitives[0].kind = PrimitiveKind::cone;
             s.cones.push_back({{0, 0, 0}, {0, 0, 1}, 1, 0, true});
         }},
        {"makes a polygon of three corners a triangle: object 1 (a polygon)",
         [](Scene& s) {
             s.primitives[0].kind = PrimitiveKind::polygon;
             s.polygons.push_back({0, 3});
         }},
    }));
    INFO(item.says);
    Scene scene = simple_scene(true);
    CHECK_NOTHROW(write_nff(scene));
    item.change(scene);
    try {
        write_nff(scene);
        FAIL_CHECK("was written");
    } catch (const Error& error) {
        CHECK(error.code() == ExitCode::scene);
        CHECK_THAT(error.what(), Catch::StartsWith("NFF ") && Catch::Contains(item.says) &&
                                     Catch::EndsWith("; write .json, which has everything"));
    }
}

TEST_CASE("What .test cannot express is refused by its name", "[scene][write]") {
    struct Case {
        std::string says;
        std::function<void(Scene&)> change;
    };
    const auto item = GENERATE(values<Case>({
        {"has one camera, and the scene has 2", [](Scene& s) { s.cameras.emplace_back(); }},
        {"has depths up to 1000, and the scene's is 1001", [](Scene& s) { s.depth = 1001; }},
        {"has no background but black", [](Scene& s) { s.background.g = 1; }},
        {"has no groups and instances",
         [](Scene& s) {
             s.groups.push_back({"g", 1, 0, {}});
         }},
        {"has no spot lights: light 1", [](Scene& s) { s.lights[0].kind = LightKind::spot; }},
        {"has one attenuation for all point lights: light 2",
         [](Scene& s) { s.lights.emplace_back().attenuation.z = 1; }},
        {"has no ambient light but 1 1 1: material 'material1'", [](Scene& s) { s.ambient.g = 0; }},
        {"both have to be equal", [](Scene& s) { s.materials[0].specular = glm::vec3(1); }},
        {"has no Phong highlights",
         [](Scene& s) {
             s.materials[0].specular = s.materials[0].reflection = glm::vec3(1);
             s.materials[0].specular_model = SpecularModel::phong;
         }},
        {"has no transmission", [](Scene& s) { s.materials[0].transmission.g = 1; }},
        {"has no two-sided materials", [](Scene& s) { s.materials[0].two_sided = true; }},
        {"has no attenuation of the reflected light",
         [](Scene& s) { s.materials[0].reflection_attenuation.y = 1; }},
        {"has no textures", [](Scene& s) { s.materials[0].textures.emission = 0; }},
        {"has no shapes but triangles and spheres: object 1 (a ",
         [](Scene& s) {
             s.primitives[0].kind = PrimitiveKind::cone;
             s.cones.emplace_back();
         }},
        {"has no one-sided objects: object 1 (", [](Scene& s) { s.primitives[0].sides = Sides::back; }},
        {"no turn and scale were found that make the transform of object 1 (",
         [](Scene& s) {
             s.transforms.emplace_back(1);
             s.transforms[1][1][0] = 0.5;  // a shear
             s.primitives[0].transform = 1;
         }},
    }));
    INFO(item.says);
    Scene scene = simple_scene(false);
    CHECK_NOTHROW(write_cse167(scene));
    item.change(scene);
    try {
        write_cse167(scene);
        FAIL_CHECK("was written");
    } catch (const Error& error) {
        CHECK(error.code() == ExitCode::scene);
        CHECK_THAT(error.what(), Catch::StartsWith(".test ") && Catch::Contains(item.says) &&
                                     Catch::EndsWith("; write .json, which has everything"));
    }
}

TEST_CASE("Scenes are written by their extension", "[scene][write]") {
    const TemporaryFolder folder;
    const Scene scene = simple_scene(true);
    write_scene(folder / "a.NFF", scene);
    check_same(scene, load_scene(folder / "a.NFF"));
    const Scene other = simple_scene(false);
    write_scene(folder / "a.test", other);
    check_same(other, load_scene(folder / "a.test"));
    try {
        write_scene(folder / "a.obj", scene);
        FAIL_CHECK("was written");
    } catch (const Error& error) {
        CHECK(error.code() == ExitCode::usage);
        CHECK_THAT(error.what(), Catch::Contains("'.obj'; formats are .json (Sahl scene), .nff"));
    }
    CHECK_THROWS_AS(check_scene_output("scene"), Error);
    CHECK_THROWS_AS(check_scene_output(folder / "a.NFF/b.nff"), Error);
    CHECK_NOTHROW(check_scene_output("scene.JSON"));
    // A refused scene leaves nothing behind.
    CHECK_THROWS_AS(write_scene(folder / "b.nff", other), Error);
    CHECK(folder.entries() == 2);
}

}  // namespace sahl::tests
