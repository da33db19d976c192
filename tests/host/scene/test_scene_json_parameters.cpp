#include <catch2/catch.hpp>

#include <string>
#include <utility>
#include <vector>

#include "tests/host/scene/parse.h"

namespace sahl::tests {
namespace {

using Values = std::vector<std::pair<std::string, std::string>>;

// One parameter of each type, each used once.
const std::string scene_text = R"({"sahl": 1,
"cameras": {"main": {"eye": "$eye", "look_at": [0, "$height", 0]}},
"parameters": {
  "height": {"type": "number", "default": 0.5, "min": -2, "max": 2},
  "wide": {"type": "integer", "default": 16, "min": 1},
  "eye": {"type": "vector", "default": [0, 0, 5]},
  "tint": {"type": "color", "default": [1, 0.5, 0]},
  "shade": {"type": "color", "default": 0.25},
  "round": {"type": "boolean", "default": true},
  "look": {"type": "text", "default": "red"}
},
"film": {"width": "$wide", "height": "$wide"},
"background": "$tint",
"materials": {"red": {"diffuse": "$shade", "two_sided": "$round"}, "blue": {}},
"objects": [{"type": "sphere", "material": "$look", "transform": {"scale": "$wide"}}]})";

Scene with(const Values& values) {
    LoadOptions options;
    options.parameters = values;
    return read_scene_json("scene.json", scene_text, options);
}

}  // namespace

TEST_CASE("Parameters have their defaults", "[scene][json]") {
    const Scene scene = with({});
    CHECK(scene.cameras[0].look_at == glm::dvec3(0, 0.5, 0));
    CHECK(scene.cameras[0].eye == glm::dvec3(0, 0, 5));
    CHECK(scene.resolution.width == 16);
    CHECK(scene.background == glm::vec3(1, 0.5F, 0));
    CHECK(scene.materials[0].diffuse == glm::vec3(0.25F));
    CHECK(scene.materials[0].two_sided);
    CHECK(scene.primitives[0].material == 0);
    CHECK(scene.transforms[1][0][0] == 16);
}

TEST_CASE("Parameters are set by texts", "[scene][json]") {
    const Scene scene = with({{"height", "-1.5e0"},
                              {"wide", "7"},
                              {"wide", "9"},  // the last one holds
                              {"eye", "1, 2,+3"},
                              {"tint", "0.5"},
                              {"shade", "0,0.25,1"},
                              {"round", "false"},
                              {"look", "blue"}});
    CHECK(scene.cameras[0].look_at == glm::dvec3(0, -1.5, 0));
    CHECK(scene.cameras[0].eye == glm::dvec3(1, 2, 3));
    CHECK(scene.resolution.height == 9);
    CHECK(scene.background == glm::vec3(0.5F));
    CHECK(scene.materials[0].diffuse == glm::vec3(0, 0.25F, 1));
    CHECK_FALSE(scene.materials[0].two_sided);
    CHECK(scene.primitives[0].material == 1);
    CHECK(with({{"height", "2"}}).cameras[0].look_at.y == 2);  // ranges include their ends
}

TEST_CASE("What a parameter does not take is a mistake of usage", "[scene][json]") {
    struct Case {
        std::string name, value, says;
    };
    const std::vector<Case> cases = {
        {"hieght", "1", "scene.json has no parameter 'hieght'; did you mean 'height'?"},
        {"q", "1", "no parameter 'q'; its parameters are height, wide, eye, tint, shade, round, look"},
        {"", "1", "has no parameter ''"},
        {"height", "3", "'height' of scene.json is a number from -2 to 2; found '3'"},
        {"height", "1x", "is a number from -2 to 2; found '1x'"},
        {"height", "", "is a number from -2 to 2; found ''"},
        {"height", "nan", "is a number"},
        {"height", "1e999", "is a number"},
        {"wide", "0", "is an integer of at least 1; found '0'"},
        {"wide", "1.5", "is an integer of at least 1"},
        {"eye", "1,2", "is a vector, such as 1,0,0; found '1,2'"},
        {"eye", "1,2,3,4", "is a vector"},
        {"eye", "1", "is a vector"},
        {"eye", "1,inf,0", "is a vector"},
        {"tint", "-1", "is a colour, such as 1,0.5,0 or 0.5, nowhere negative"},
        {"tint", "1,0", "is a colour"},
        {"tint", "red", "is a colour"},
        {"round", "yes", "is true or false; found 'yes'"},
    };
    for (const Case& c : cases) {
        INFO(c.name << '=' << c.value);
        try {
            with({{c.name, c.value}});
            FAIL_CHECK("was accepted");
        } catch (const Error& error) {
            CHECK(error.code() == ExitCode::usage);
            CHECK_THAT(error.what(), Catch::StartsWith("--set " + c.name + "=" + c.value + ": ") &&
                                         Catch::Contains(c.says));
        }
    }
}

TEST_CASE("A scene without parameters has none to set", "[scene][json]") {
    LoadOptions options;
    options.parameters = {{"x", "1"}};
    try {
        parse_json("", options);
        FAIL_CHECK("was accepted");
    } catch (const Error& error) {
        CHECK(error.code() == ExitCode::usage);
        CHECK(error.what() == std::string("--set x=1: scene.json has no parameters"));
    }
}

TEST_CASE("A set value that its use refuses is refused at the use", "[scene][json]") {
    CHECK_THROWS_WITH(with({{"wide", "70000"}}),
                      Catch::StartsWith("scene.json:12:19: 'width' must be at least 1 and at most 65536"));
    CHECK_THROWS_WITH(with({{"look", "bleu"}}),
                      Catch::StartsWith("scene.json:15:44: there is no material 'bleu'; "
                                        "did you mean 'blue'?"));
}

TEST_CASE("Other formats have no parameters", "[scene][json]") {
    LoadOptions options;
    options.parameters = {{"a", "1"}};
    const std::string name = GENERATE(as<std::string>(), "all_entities.nff", "all_commands.test");
    try {
        load_scene(own_scene(name), options);
        FAIL_CHECK("was accepted");
    } catch (const Error& error) {
        CHECK(error.code() == ExitCode::usage);
        CHECK_THAT(error.what(), Catch::StartsWith("--set a=1: ") && Catch::Contains("has no parameters"));
    }
}

}  // namespace sahl::tests
