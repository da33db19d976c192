// Every rule that a Sahl scene can break, with the place and the words of its message.
#include <catch2/catch.hpp>

#include <string>
#include <utility>
#include <vector>

#include "engine/scene/validate.h"
#include "kernels/device_types.h"
#include "tests/host/scene/parse.h"

namespace sahl::tests {
namespace {

struct BrokenScene {
    std::string text;
    std::string place;
    std::string says;
};

template <typename Parse>
void check_cases(const std::vector<BrokenScene>& cases, Parse parse) {
    for (const BrokenScene& c : cases) {
        INFO(c.text);
        try {
            parse(c.text);
            FAIL_CHECK("was accepted");
        } catch (const SceneError& error) {
            CHECK_THAT(error.what(),
                       Catch::StartsWith("scene.json:" + c.place + ": ") && Catch::Contains(c.says));
            CHECK(error.code() == ExitCode::scene);
        }
    }
}

// The members of the file behind "sahl", from column 14 on.
void check_file(const std::vector<BrokenScene>& cases) {
    check_cases(cases, [](const std::string& text) {
        return read_scene_json("scene.json", R"({"sahl": 1, )" + text + "}");
    });
}

void check_objects(const std::vector<BrokenScene>& cases) {
    check_cases(cases, [](const std::string& text) { return parse_json(text); });
}

// g0 holds what `first` says, each further group `each` instances of the one before; one object places the
// last.
std::string nested_groups(int count, const std::string& first, int each) {
    std::string text = R"("groups": {"g0": [)" + first + "]";
    for (int i = 1; i < count; ++i) {
        text += ", \"g" + std::to_string(i) + "\": [\n";
        for (int k = 0; k < each; ++k) {
            text += (k > 0 ? ",\n" : "") + std::string(R"({"type": "instance", "group": "g)") +
                    std::to_string(i - 1) + "\"}";
        }
        text += "]";
    }
    return text +
           R"(}, "cameras": {"main": {"eye": [0, 0, 5], "look_at": [0, 0, 0]}}, "objects": [)"
           "\n" +
           R"({"type": "instance", "group": "g)" + std::to_string(count - 1) + "\"}]";
}

Scene parse_file(const std::string& members) {
    return read_scene_json("scene.json", R"({"sahl": 1, )" + members + "}");
}

}  // namespace

TEST_CASE("Sahl scenes: as many groups are placed as the renderer can number", "[scene][json]") {
    STATIC_REQUIRE(max_placed == SAHL_CHILD_OFFSET_MASK);
    const std::string sphere = R"({"type": "sphere"})";
    // Groups of two: g26 holds 2^27 - 2, which with itself is the limit of 2^27 - 1.
    CHECK(parse_file(nested_groups(27, sphere, 2)).groups.size() == 27);
    // The second instance in g27 is one too many, whatever comes above it.
    const std::string says = "with this instance of the group 'g26' more than 134217727 groups are placed";
    check_file({{nested_groups(28, sphere, 2), "55:1", says}, {nested_groups(40, sphere, 2), "55:1", says}});
    // In the world: one more beside the full tree.
    std::string beside = nested_groups(27, sphere, 2);
    beside.insert(beside.size() - 1, ",\n{\"type\": \"instance\", \"group\": \"g0\"}");
    check_file({{beside, "55:1", "with this instance of the group 'g0' more than 134217727 groups"}});
}

TEST_CASE("Sahl scenes: groups nest 64 deep", "[scene][json]") {
    CHECK(parse_file(nested_groups(64, "", 1)).groups.size() == 64);
    const std::string says =
        "groups nest deeper than 64 with this instance of the group 'g63'; nest them less";
    check_file({{nested_groups(65, "", 1), "65:1", says}, {nested_groups(3000, "", 1), "65:1", says}});
}

TEST_CASE("Sahl scenes: the least lengths are allowed", "[scene][json]") {
    CHECK_NOTHROW(parse_json(R"({"type": "sphere", "radius": 1e-15})"));
    CHECK_NOTHROW(parse_json(R"({"type": "sphere", "radius": 1, "transform": {"scale": 1e-15}})"));
    CHECK_NOTHROW(parse_json(R"({"type": "box", "min": [0, 0, 0], "max": [1, 1, 1e-15]})"));
    // Thin, but not where single precision is coarse.
    CHECK_NOTHROW(parse_json(R"({"type": "box", "min": [1e6, 0, 0], "max": [1000001, 1, 1e-6]})"));
    CHECK_NOTHROW(parse_json(R"({"type": "box", "min": [1e6, 0, 0], "max": [1000000.01, 1, 1],
        "transform": {"translate": [-1e6, 0, 0]}})"));
}

TEST_CASE("Sahl scenes: errors of the file", "[scene][json]") {
    check_cases(
        {{"[]", "1:1", "scene: expected an object, found an array of 0 values"},
         {"{}", "1:1", "this scene has no 'sahl', the version of the format; add \"sahl\": 1"},
         {"{\"sahl\": 2}", "1:10", "this file is of version 2 of the format, this program reads version 1"},
         {"{\"sahl\": \"1\"}", "1:10", "sahl: expected an integer, found the string '1'"},
         {"{\"sahl\": 1}", "1:1", "the scene has no camera; add \"cameras\""},
         {"{\"sahl\": 1, \"cameras\": {}}", "1:1", "the scene has no camera"},
         {"{\"sahl\": 4294967296}", "1:10", "this file is of version 4294967296 of the format"},
         {"{\"sahl\": 1.5}", "1:10", "sahl: expected an integer, found the number 1.5"}},
        [](const std::string& text) { return read_scene_json("scene.json", text); });
    check_file({
        {R"("object": [])", "1:13", "unknown key 'object' of a scene; did you mean 'objects'?"},
        {R"("zzz": [])", "1:13", "unknown key 'zzz' of a scene; its keys are sahl"},
        {R"("description": 5)", "1:28", "description: expected a string, found the number 5"},
        {R"("film": [])", "1:21", "film: expected an object, found an array of 0 values"},
        {R"("film": {"widht": 5})", "1:22", "unknown key 'widht' of a film; did you mean 'width'?"},
        {R"("film": {"width": 0})", "1:31", "'width' must be at least 1 and at most 65536, not 0"},
        {R"("film": {"width": 65537})", "1:31", "'width' must be at least 1 and at most 65536, not 65537"},
        {R"("film": {"height": 1.5})", "1:32", "height: expected an integer, found the number 1.5"},
        {R"("film": {"height": true})", "1:32", "height: expected an integer, found true"},
        {R"("depth": 65)", "1:22", "'depth' must be at least 0 and at most 64, not 65"},
        {R"("depth": -1)", "1:22", "'depth' must be at least 0"},
        {R"("depth": 1e300)", "1:22", "depth: expected an integer, found the number 1"},
        {R"("background": "red")", "1:27",
         "background: expected a colour ([r, g, b] or one number), found the string 'red'"},
        {R"("background": [1, 2])", "1:27", "found an array of 2 values"},
        {R"("background": [1, 2, null])", "1:34", "background: expected a number, found null"},
        {R"("background": [1, -2, 3])", "1:31", "'background' must be at least 0"},
        {R"("background": -1)", "1:27", "'background' must be at least 0"},
        {R"("background": {})", "1:27", "found an object"},
        {R"("cameras": [])", "1:24", "cameras: expected an object"},
        {R"("cameras": {"a": 5})", "1:30", "camera: expected an object, found the number 5"},
        {R"("cameras": {"a": {"eye": [0, 0, 0]}})", "1:30", "this camera has no 'look_at'; add it"},
        {R"("cameras": {"a": {"eye": [0, 0], "look_at": [0, 0, 0]}})", "1:38",
         "eye: expected a vector ([x, y, z]), found an array of 2 values"},
        {R"("cameras": {"a": {"eye": [0, 0, 2e15], "look_at": [0, 0, 0]}})", "1:45",
         "'eye' must lie within ±1e+15, not 2e+15"},
        {R"("cameras": {"a": {"eye": [0, 0, 0], "look_at": [0, 0, 0]}})", "1:60",
         "looks at the point it stands on"},
        {R"("cameras": {"a": {"eye": [0, 0, 1], "look_at": [0, 0, 0], "up": [0, 0, 0]}})", "1:77",
         "the camera's up vector is zero"},
        {R"("cameras": {"a": {"eye": [0, 0, 1], "look_at": [0, 0, 0], "up": [0, 0, 2]}})", "1:77",
         "the camera's up vector is parallel"},
        {R"("cameras": {"a": {"eye": [0, 1, 0], "look_at": [0, 0, 0]}})", "1:30",
         "the camera's up vector is parallel"},
        {R"("cameras": {"a": {"eye": [0, 0, 1], "look_at": [0, 0, 0], "fov": 180}})", "1:78",
         "'fov' must be greater than 0 and less than 180, not 180"},
        {R"("cameras": {"": {}})", "1:25", "this camera's name is empty; give it one"},
        {R"("cameras": {"$a": {}})", "1:25", "the name '$a' of a camera begins with $"},
        {R"("groups": {"": []})", "1:24", "this group's name is empty"},
        {R"("groups": {"$a": []})", "1:24", "the name '$a' of a group begins with $"},
        {R"("groups": [])", "1:23", "groups: expected an object"},
        {R"("groups": {"a": {}})", "1:29", "objects: expected an array of objects, found an object"},
        {R"("groups": {"a": [{"type": "instance", "group": "a"}]})", "1:30",
         "the group 'a' contains itself: a -> a; remove this instance"},
        {R"("groups": {"a": [{"type": "instance", "group": "b"}], "b": [{"type": "instance", "group": "c"}],)"
         "\n"
         R"("c": [{"type": "sphere"}, {"type": "instance", "group": "b"}]})",
         "2:27", "the group 'b' contains itself: b -> c -> b"},
        {R"("groups": {"a": [{"type": "sphere"}], "b": [)"
         "\n"
         R"({"type": "instance", "group": "a", "transform": {"translate": [9e14, 0, 0]}}]},)"
         "\n"
         R"("objects": [{"type": "instance", "group": "b", "transform": {"translate": [9e14, 0, 0]}}])",
         "3:13", "here the group 'b' reaches beyond ±1e+15"},
        {R"("objects": {})", "1:24", "objects: expected an array of objects, found an object"},
    });
}

TEST_CASE("Sahl scenes: errors of lights", "[scene][json]") {
    check_cases(
        {
            {R"(5)", "2:1", "light: expected an object"},
            {R"({"color": 1})", "2:1",
             "this light has no 'type'; types are point, directional, spot, ambient"},
            {R"({"type": "pint"})", "2:10", "unknown type 'pint'; did you mean 'point'?"},
            {R"({"type": 5})", "2:10", "type: expected a string, found the number 5"},
            {R"({"type": "point"})", "2:1", "this point light has no 'position'; add it"},
            {R"({"type": "point", "position": [0, 0, 0], "direction": [0, 0, 1]})", "2:42",
             "unknown key 'direction' of a point light"},
            {R"({"type": "point", "position": [0, 0, 0], "attenuation": [0, 0, 0]})", "2:57",
             "the attenuation is zero"},
            {R"({"type": "point", "position": [0, 0, 0], "attenuation": [1, -1, 0]})", "2:61",
             "'attenuation' must be at least 0"},
            {R"({"type": "point", "position": [0, 0, 0], "attenuation": 1})", "2:57",
             "attenuation: expected a vector ([x, y, z])"},
            {R"({"type": "directional"})", "2:1", "this directional light has no 'direction'"},
            {R"({"type": "directional", "direction": [0, 0, 0]})", "2:38",
             "'direction' is zero; give it a direction"},
            {R"({"type": "spot", "position": [0, 0, 0], "direction": [0, 0, 1]})", "2:1",
             "this spot light has no 'outer_angle'"},
            {R"({"type": "spot", "position": [0, 0, 0], "direction": [0, 0, 1], "outer_angle": 0})", "2:80",
             "'outer_angle' must be greater than 0 and at most 180, not 0"},
            {R"({"type": "spot", "position": [0, 0, 0], "direction": [0, 0, 1], "outer_angle": 181})", "2:80",
             "'outer_angle' must be greater than 0 and at most 180, not 181"},
            {R"({"type": "spot", "position": [0, 0, 0], "direction": [0, 0, 1], "outer_angle": 9, "inner_angle": 10})",
             "2:98", "'inner_angle' must be at least 0 and at most 9, not 10"},
            {R"({"type": "spot", "position": [0, 0, 0], "direction": [0, 0, 0], "outer_angle": 9})", "2:54",
             "'direction' is zero"},
            {R"({"type": "ambient"})", "2:1", "this ambient light has no 'color'"},
        },
        [](const std::string& text) {
            return read_scene_json("scene.json", "{\"sahl\": 1, \"lights\": [\n" + text + "]}");
        });
    check_file({{R"("lights": {})", "1:23", "lights: expected an array of lights, found an object"}});
}

TEST_CASE("Sahl scenes: errors of materials", "[scene][json]") {
    check_cases(
        {
            {R"(5)", "2:1", "material: expected an object, found the number 5"},
            {R"({"difuse": 1})", "2:2", "unknown key 'difuse' of a material; did you mean 'diffuse'?"},
            {R"({"model": "phon"})", "2:11", "unknown model 'phon'; did you mean 'phong'?"},
            {R"({"model": "cook"})", "2:11", "unknown model 'cook'; models are phong, blinn"},
            {R"({"transmission": {"checker": "uv", "colors": [0, 1]}})", "2:18",
             "transmission: expected a colour ([r, g, b] or one number), found an object"},
            {R"({"shininess": -1})", "2:15", "'shininess' must be at least 0"},
            {R"({"ior": 0})", "2:9", "'ior' must be at least 1e-15"},
            {R"({"ior_outside": 0})", "2:17", "'ior_outside' must be at least 1e-15"},
            {R"({"attenuation": [0, 0, 0]})", "2:17", "the attenuation is zero"},
            {R"({"two_sided": 1})", "2:15", "two_sided: expected true or false, found the number 1"},
            {R"({"diffuse": {"colors": [0, 1]}})", "2:13", "this texture has no 'checker' and no 'gradient'"},
            {R"({"diffuse": {"checker": "uv"}})", "2:13", "this checker has no 'colors'; add it"},
            {R"({"diffuse": {"checker": "vu", "colors": [0, 1]}})", "2:25",
             "unknown checker 'vu'; choices are position, uv"},
            {R"({"diffuse": {"checker": "uv", "colors": [0, 1, 2]}})", "2:41",
             "colors: expected an array of 2 colours, found an array of 3 values"},
            {R"({"diffuse": {"checker": "uv", "colors": 1}})", "2:41", "expected an array of 2 colours"},
            {R"({"diffuse": {"checker": "uv", "colors": [0, -1]}})", "2:45", "'colors' must be at least 0"},
            {R"({"diffuse": {"checker": "uv", "colors": [0, 1], "size": 0}})", "2:57",
             "'size' must be at least 1e-15"},
            {R"({"diffuse": {"checker": "uv", "colors": [0, 1], "size": [0, 0, 1]}})", "2:57",
             "the checker's 'size' is zero on all axes"},
            {R"({"diffuse": {"checker": "position", "colors": [0, 1], "size": [0, 0, -1]}})", "2:70",
             "'size' must be at least 0"},
            {R"({"diffuse": {"checker": "uv", "colors": [0, 1], "to": [0, 0, 1]}})", "2:49",
             "unknown key 'to' of a checker"},
            {R"({"diffuse": {"gradient": "uv", "colors": [0, 1]}})", "2:13", "this gradient has no 'to'"},
            {R"({"diffuse": {"gradient": "uv", "colors": [0, 1], "to": [0, 0, 1]}})", "2:56",
             "the gradient's 'to' is where 'from' is"},
            {R"({"diffuse": {"gradient": "position", "colors": [0, 1], "from": [1, 0, 0], "to": [1, 0, 0]}})",
             "2:81", "the gradient's 'to' is where 'from' is"},
        },
        [](const std::string& text) {
            return read_scene_json("scene.json", "{\"sahl\": 1, \"materials\": {\"a\":\n" + text + "}}");
        });
    check_objects({
        {R"({"type": "sphere", "material": "gren"})", "2:32",
         "there is no material 'gren'; there are no materials"},
        {R"({"type": "sphere", "material": 5})", "2:32",
         "material: expected a material's name or a material (an object), found the number 5"},
        {R"({"type": "sphere", "material": {"diffus": 5}})", "2:33", "unknown key 'diffus' of a material"},
    });
    check_file({{R"("materials": {"": {}})", "1:27", "this material's name is empty"},
                {R"("materials": {"$a": {}})", "1:27", "the name '$a' of a material begins with $"}});
    check_file({{R"("materials": {"green": {}}, "objects": [{"type": "sphere", "material": "gren"}])", "1:84",
                 "there is no material 'gren'; did you mean 'green'?"}});
}

TEST_CASE("Sahl scenes: errors of objects", "[scene][json]") {
    check_objects({
        {R"(5)", "2:1", "object: expected an object, found the number 5"},
        {R"({})", "2:1", "this object has no 'type'; types are sphere, box, disc"},
        {R"({"type": "spere"})", "2:10", "unknown type 'spere'; did you mean 'sphere'?"},
        {R"({"type": "sphere", "raduis": 2})", "2:20",
         "unknown key 'raduis' of a sphere; did you mean 'radius'?"},
        {R"({"type": "sphere", "radius": 0})", "2:30", "'radius' must be at least 1e-15"},
        {R"({"type": "sphere", "radius": "2"})", "2:30", "radius: expected a number, found the string '2'"},
        {R"({"type": "sphere", "center": 2})", "2:30",
         "center: expected a vector ([x, y, z]), found the number 2"},
        {R"({"type": "sphere", "center": [9e14, 0, 0], "radius": 9e14})", "2:1",
         "this sphere reaches beyond ±1e+15"},
        {R"({"type": "sphere", "sides": "top"})", "2:29", "unknown sides 'top'; sides are both, front, back"},
        {R"({"type": "sphere", "radius": 1e-10, "transform": {"scale": 1e-10}})", "2:1",
         "the transformation shrinks this sphere below 1e-15"},
        {R"({"type": "box", "min": [0, 0, 0]})", "2:1", "this box has no 'max'; add it"},
        {R"({"type": "box", "min": [0, 0, 0], "max": [1, 0, 1]})", "2:42",
         "the box's max y must be greater than its min y by at least 1e-15"},
        {R"({"type": "box", "min": [0, 0, 0], "max": [1, 1e-20, 1]})", "2:42",
         "the box's max y must be greater than its min y by at least 1e-15"},
        {R"({"type": "box", "min": [1e6, 0, 0], "max": [1000000.0000000001, 1, 1]})", "2:1",
         "this box is too thin for its place: along x it begins and ends at the same number of single "
         "precision, "
         "1e+06"},
        {R"({"type": "sphere", "center": [0, 0, 1e9]})", "2:1",
         "this sphere is too thin for its place: along z"},
        {R"({"type": "disc", "transform": {"translate": [0, -1e9, 0]}})", "2:1",
         "this disc is too thin for its place: along y"},
        {R"({"type": "box", "min": [0, 0, 2], "max": [1, 1, 1]})", "2:42", "the box's max z must be greater"},
        {R"({"type": "disc", "normal": [0, 0, 0]})", "2:28", "'normal' is zero; give it a direction"},
        {R"({"type": "disc", "radius": -1})", "2:28", "'radius' must be at least"},
        {R"({"type": "cylinder", "base": [0, 0, 0]})", "2:1", "this cylinder has no 'top'"},
        {R"({"type": "cylinder", "base": [1, 0, 0], "top": [1, 0, 0]})", "2:48",
         "'top' is where 'base' is; give it a height"},
        {R"({"type": "cylinder", "base": [0, 0, 0], "top": [1, 0, 0], "radius": 0})", "2:69",
         "'radius' must be at least"},
        {R"({"type": "cylinder", "base": [0, 0, 0], "top": [1, 0, 0], "capped": "no"})", "2:69",
         "capped: expected true or false, found the string 'no'"},
        {R"({"type": "cone", "base": [1, 0, 0], "top": [1, 0, 0]})", "2:44", "'top' is where 'base' is"},
        {R"({"type": "cone", "base": [0, 0, 0], "top": [1, 0, 0], "base_radius": 0})", "2:70",
         "both radii of the cone are 0"},
        {R"({"type": "cone", "base": [0, 0, 0], "top": [1, 0, 0], "top_radius": 1e-20})", "2:69",
         "'top_radius' must be at least 1e-15"},
        {R"({"type": "cone", "base": [0, 0, 0], "top": [1, 0, 0], "base_radius": -1})", "2:70",
         "'base_radius' must be at least 0"},
        {R"({"type": "cone", "base": [0, 0, 0], "top": [1, 0, 0], "radius": 1})", "2:55",
         "unknown key 'radius' of a cone; did you mean 'base_radius' or 'top_radius'?"},
        {R"({"type": "group"})", "2:1", "this group has no 'objects'"},
        {R"({"type": "group", "objects": [{"type": "sphere", "radius": 0}]})", "2:60",
         "'radius' must be at least"},
        {R"({"type": "instance"})", "2:1", "this instance has no 'group'"},
        {R"({"type": "instance", "group": "a"})", "2:31", "there is no group 'a'; there are no groups"},
        {R"({"type": "instance", "group": "a", "material": {}})", "2:36",
         "unknown key 'material' of an instance"},
    });
    // Every solid is checked where its transform takes it.
    const std::string far = R"(, "transform": {"translate": [1e15, 0, 0]}})";
    const std::string tiny = R"(, "transform": {"scale": 1e-15}})";
    const std::vector<std::pair<std::string, std::string>> solids = {
        {"sphere", R"({"type": "sphere", "radius": 0.5)"},
        {"box", R"({"type": "box", "min": [0, 0, 0], "max": [1, 0.5, 1])"},
        {"disc", R"({"type": "disc", "radius": 0.5)"},
        {"cone", R"({"type": "cone", "base": [0, 0, 0], "top": [0, 0, 0.5])"},
        {"cone", R"({"type": "cylinder", "base": [0, 0, 0], "top": [0, 0, 1], "radius": 0.5)"},
    };
    for (const auto& [name, text] : solids) {
        check_objects({{text + far, "2:1", "this " + name + " reaches beyond ±1e+15"},
                       {text + tiny, "2:1", "the transformation shrinks this " + name + " below 1e-15"}});
    }
    check_file({{R"("groups": {"tree": []}, "objects": [{"type": "instance", "group": "tre"}])", "1:79",
                 "there is no group 'tre'; did you mean 'tree'?"}});
}

TEST_CASE("Sahl scenes: errors of polygons and meshes", "[scene][json]") {
    const std::string mesh =
        R"({"type": "mesh", "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": )";  // 78
    check_objects({
        {R"({"type": "polygon", "vertices": [[0, 0, 0], [1, 0, 0]]})", "2:33",
         "vertices: expected at least 3 vertices, found an array of 2 values"},
        {R"({"type": "polygon", "vertices": 5})", "2:33",
         "vertices: expected an array of vertices ([x, y, z])"},
        {R"({"type": "polygon", "vertices": [[0, 0, 0], [1, 0, 0], [2, 0, 0]]})", "2:33",
         "the vertices of this polygon lie on one line"},
        {R"({"type": "polygon", "vertices": [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]]})", "2:33",
         "the vertices of this polygon lie on one line"},
        {R"({"type": "polygon", "vertices": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 1]]})", "2:33",
         "the vertices of this polygon lie in no plane"},
        {R"({"type": "polygon", "vertices": [[0, 0, 0], [1, 1, 0], [1, 0, 0], [0, 1, 0]]})", "2:33",
         "or its outline crosses itself"},
        {R"({"type": "polygon", "vertices": [[0, 0, 0], [1, 0, 0], [0, 1e14, 0]], "transform": {"scale": 100}})",
         "2:56", "the transformed vertex must lie within ±1e+15"},
        {mesh + "[[0, 1, 3]]}", "2:86", "there is no vertex 3; they are 0 to 2"},
        {mesh + "[[0, 1, 4294967296]]}", "2:86", "there is no vertex 4294967296; they are 0 to 2"},
        {mesh + "[[0, -1, 2]]}", "2:83", "there is no vertex -1; they are 0 to 2"},
        {mesh + "[[0, 1.5, 2]]}", "2:83", "triangles: expected an integer, found the number 1.5"},
        {mesh + "[[0, 1]]}", "2:79",
         "triangles: expected 3 indices of vertices ([i, j, k]), found an array of 2 values"},
        {mesh + "5}", "2:78", "triangles: expected an array of triangles ([i, j, k]), found the number 5"},
        {R"({"type": "mesh", "vertices": [], "triangles": [[0, 0, 0]]})", "2:49",
         "there is no vertex to refer to"},
        {mesh + "[], \"normals\": [[0, 0, 1]]}", "2:93",
         "'normals' has 1 elements, and there are 3 vertices"},
        {mesh + "[], \"normals\": [[0, 0, 1], [0, 0, 0], [0, 0, 1]]}", "2:105", "this normal is zero"},
        {mesh + "[], \"uv\": [[0, 0], [0, 0], [1]]}", "2:105",
         "uv: expected texture coordinates ([u, v]), found an array of 1 value"},
        {mesh + "[], \"uv\": []}", "2:88", "'uv' has 0 elements, and there are 3 vertices"},
    });
}

TEST_CASE("Sahl scenes: errors of transforms", "[scene][json]") {
    check_cases(
        {
            {R"(5)", "2:1",
             "transform: expected a step, such as {\"translate\": [1, 0, 0]}, or an array of steps"},
            {R"([5])", "2:2", "step of a transform: expected an object"},
            {R"({})", "2:1", "this step is empty; steps are translate, scale, rotate, look_at, matrix"},
            {R"({"tanslate": [1, 0, 0]})", "2:2", "unknown step 'tanslate'; did you mean 'translate'?"},
            {R"({"translate": [1, 0, 0], "scale": 2})", "2:26",
             "one operation a step: write [{\"translate\": …}, {\"scale\": …}]"},
            {R"({"scale": 2, "axis": [1, 0, 0]})", "2:14", "unknown key 'axis' of a scale step"},
            {R"({"scale": 2, "rotate": 5, "axis": [1, 0, 0]})", "2:14",
             "one operation a step: write [{\"scale\": …}, {\"rotate\": …}]"},
            {R"({"translate": 1})", "2:15", "translate: expected a vector"},
            {R"({"scale": 0})", "2:1",
             "this transformation flattens what it is applied to (it has no inverse); use no scale factor of "
             "0"},
            {R"([{"scale": 2}, {"scale": [1, 0, 1]}])", "2:16", "this transformation flattens"},
            {R"([{"scale": 1e10}, {"scale": 1e10}])", "2:1",
             "every element of the transformation must lie within"},
            {R"([{"scale": [1e7, 1, 1]}, {"scale": [1e7, 1, 1]}])", "2:1", "this transformation flattens"},
            {R"({"scale": "2"})", "2:11", "scale: expected a vector ([x, y, z]), found the string '2'"},
            {R"({"rotate": 90})", "2:1", "this rotate step has no 'axis'"},
            {R"({"rotate": 90, "axis": [0, 0, 0]})", "2:24", "'axis' is zero; give it a direction"},
            {R"({"look_at": [0, 0, 0]})", "2:1", "this look_at step has no 'from'"},
            {R"({"look_at": [1, 0, 0], "from": [1, 0, 0]})", "2:13",
             "'look_at' and 'from' are the same point"},
            {R"({"look_at": [1, 0, 0], "from": [0, 0, 0], "up": [0, 0, 0]})", "2:49", "'up' is zero"},
            {R"({"look_at": [1, 0, 0], "from": [0, 0, 0], "up": [2, 0, 0]})", "2:49", "'up' is parallel"},
            {R"({"look_at": [0, 1, 0], "from": [0, 0, 0]})", "2:1", "'up' is parallel"},
            {R"({"matrix": 5})", "2:12", "matrix: expected 4 rows of 4 numbers, found the number 5"},
            {R"({"matrix": [[1, 0, 0, 0]]})", "2:12",
             "matrix: expected 4 rows of 4 numbers, found an array of 1 value"},
            {R"({"matrix": [[1, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]})", "2:13",
             "matrix: expected a row of 4 numbers, found an array of 3 values"},
            {R"({"matrix": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 2]]})", "2:55",
             "the last row of the matrix must be 0 0 0 1"},
            {R"({"matrix": [[1, 0, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]})", "2:1",
             "(it has no inverse); the first three columns of its matrix must not lie in one plane"},
        },
        [](const std::string& text) {
            return read_scene_json(
                "scene.json",
                "{\"sahl\": 1, \"objects\": [{\"type\": \"sphere\", \"transform\":\n" + text + "}]}");
        });
    // A group's transform and its objects' count together.
    check_objects({{R"({"type": "group", "transform": {"scale": 1e8}, "objects": [)"
                    "\n"
                    R"({"type": "sphere", "transform": {"scale": 1e8}}]})",
                    "3:33", "every element of the transformation must lie within"}});
}

TEST_CASE("Sahl scenes: errors of parameters", "[scene][json]") {
    check_file({
        {R"("parameters": [])", "1:27", "parameters: expected an object"},
        {R"("parameters": {"": {}})", "1:28", "'' cannot name a parameter; use letters, digits and _"},
        {R"("parameters": {"1a": {}})", "1:28", "'1a' cannot name a parameter"},
        {R"("parameters": {"a-b": {}})", "1:28", "'a-b' cannot name a parameter"},
        {R"("parameters": {"$a": {}})", "1:28", "'$a' cannot name a parameter"},
        {R"("parameters": {"ä": {}})", "1:28", "cannot name a parameter"},
        {R"("parameters": {"a": {"type": "number"}})", "1:33", "this parameter has no 'default'; add it"},
        {R"("parameters": {"a": {"default": 1}})", "1:33", "this parameter has no 'type'"},
        {R"("parameters": {"a": {"type": "nubmer", "default": 1}})", "1:42",
         "unknown type 'nubmer'; did you mean 'number'?"},
        {R"("parameters": {"a": {"type": "number", "default": "1"}})", "1:63",
         "default: expected a number, found the string '1'"},
        {R"("parameters": {"a": {"type": "integer", "default": 1.5}})", "1:64",
         "default: expected an integer"},
        {R"("parameters": {"a": {"type": "number", "default": 3, "min": 1, "max": 2}})", "1:63",
         "'default' must be at least 1 and at most 2, not 3"},
        {R"("parameters": {"a": {"type": "number", "default": 3, "min": 4, "max": 2}})", "1:83",
         "'max' is less than 'min'"},
        {R"("parameters": {"a": {"type": "vector", "default": [1, 0, 0], "min": 4}})", "1:81",
         "'min' is for numbers and integers; remove it"},
        {R"("parameters": {"a": {"type": "color", "default": [1, 0]}})", "1:62",
         "default: expected a colour"},
        {R"("parameters": {"a": {"type": "text", "default": "x", "description": 5}})", "1:81",
         "description: expected a string"},
        {R"("parameters": {"a": {"type": "number", "defualt": 3}})", "1:52",
         "unknown key 'defualt' of a parameter; did you mean 'default'?"},
        {R"("parameters": {"a": {"type": "number", "default": 1}, "b": {"type": "number", "default": "$a"}})",
         "1:102", "'$a' refers to a parameter; here only plain values are allowed"},
        {R"("parameters": {"a": {"type": "number", "default": 1}})", "1:28",
         "the parameter 'a' is never used; write \"$a\" where its value belongs, or remove it"},
        {R"("depth": "$depht", "parameters": {"depth": {"type": "integer", "default": 1}})", "1:22",
         "there is no parameter 'depht'; did you mean 'depth'?"},
        {R"("depth": "$d")", "1:22", "there is no parameter 'd'; this file declares none"},
        {R"("depth": "$d", "parameters": {"d": {"type": "number", "default": 1}})", "1:22",
         "depth: expected an integer, found the parameter 'd', which is a number"},
        {R"("background": "$d", "parameters": {"d": {"type": "vector", "default": [1, 1, 1]}})", "1:27",
         "background: expected a colour ([r, g, b] or one number), found the parameter 'd', which is a "
         "vector"},
        {R"("background": "$d", "parameters": {"d": {"type": "number", "default": -1}})", "1:27",
         "'background' must be at least 0"},
        {R"("background": [0, "$d", 0], "parameters": {"d": {"type": "boolean", "default": true}})", "1:31",
         "background: expected a number, found the parameter 'd', which is true or false"},
        {R"("sahl": 1)", "1:13", "the key 'sahl' is there a second time"},
    });
}

}  // namespace sahl::tests
