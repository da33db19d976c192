// Every rule that a scene file can break, with the place and the words of its message.
#include <catch2/catch.hpp>

#include <string>
#include <vector>

#include "tests/host/scene/parse.h"

namespace sahl::tests {
namespace {

struct Case {
    std::string text;
    int line, column;
    std::string says;
};

template <typename Parse>
void check_cases(const std::string& file, const std::vector<Case>& cases, Parse parse) {
    for (const Case& c : cases) {
        INFO(c.text);
        try {
            parse(c.text);
            FAIL_CHECK("was accepted");
        } catch (const SceneError& error) {
            const std::string place =
                file + ":" + std::to_string(c.line) + ":" + std::to_string(c.column) + ": ";
            CHECK_THAT(error.what(), Catch::StartsWith(place) && Catch::Contains(c.says));
            CHECK(error.code() == ExitCode::scene);
        }
    }
}

}  // namespace

TEST_CASE("NFF errors", "[scene]") {
    const std::string fill = nff_view + "f 1 1 1 1 0 0 0 1\n";  // 8 lines
    const auto view_with = [](const std::string& line) {
        return "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nhither 1\n" + line;
    };
    const std::vector<Case> cases = {
        {"", 1, 1, "no view"},
        {"b 0 0 0\n", 2, 1, "no view; add v with from"},
        {"b 0 0", 1, 6, "expected the background's blue, a number; found the end of the file"},
        {"b 0 0 x", 1, 7, "found 'x'"},
        {"b 0 -1 0", 1, 5, "the background's green must be at least 0"},
        {"b 0 0 0 0", 1, 9, "expected an entity: b (background)"},
        {"sphere 0 0 0 1", 1, 1, "unknown entity 'sphere'; entities are b (background), v (view)"},
        {"S 0 0 0 1", 1, 1, "unknown entity 'S'"},
        {"b 0 0 0\nb 0 0 0", 2, 1, "a second background (b); the first is on line 1"},
        {nff_view + nff_view, 8, 1, "a second view (v); the first is on line 1"},
        // The view.
        {"v\nform 0 0 5", 2, 1,
         "(from, at, up, angle, hither, resolution); found 'form'; did you mean 'from'?"},
        {"v\nfrom 0 0 5\nfrom 0 0 5", 3, 1, "a second from; the first is on line 2"},
        {view_with("angle 45\ns 0 0 0 1"), 7, 1,
         "expected what the view still needs (resolution); found 's'"},
        {view_with("angle 45"), 6, 9,
         "expected what the view still needs (resolution); found the end of the file"},
        {view_with("angle 0"), 6, 7,
         "the view's angle in degrees must be greater than 0 and less than 180, not 0"},
        {view_with("angle 180"), 6, 7, "less than 180"},
        {view_with("angle nan"), 6, 7, "found 'nan'"},
        {view_with("resolution 0 5"), 6, 12,
         "expected the width in pixels, a whole number from 1 to 65536; found '0'"},
        {view_with("resolution 512 65537"), 6, 16, "the height in pixels"},
        {view_with("resolution 512.5 512"), 6, 12, "a whole number"},
        {view_with("resolution 1e9 512"), 6, 12, "a whole number"},
        {view_with("angle 45 resolution\n4 99999999999999999999"), 7, 3, "a whole number"},
        {"v from 1 2 3\nat 1 2 3 up 0 1 0 angle 45 hither 1 resolution 4 4", 2, 1,
         "looks at the point it stands on"},
        {"v from 1 2 3 at 1 2 5\n up 0 0 0 angle 45 hither 1 resolution 4 4", 2, 2, "up vector is zero"},
        {"v from 1 2 3 at 1 2 5\n up 0 0 -3 angle 45 hither 1 resolution 4 4", 2, 2,
         "parallel to the viewing direction"},
        {"v from 1e16 0 0", 1, 8, "from x must lie within ±1e+15, not 1e+16"},
        {"v from 0 1e999 0", 1, 10, "from y: '1e999' is outside the range of numbers"},
        // Lights and fills.
        {"l 1 2", 1, 6, "expected the light's z, a number; found the end of the file"},
        {"l 1 2 3 4 5\n", 2, 1, "expected the light's blue, a number; found the end of the file"},
        {"l 1 2 3 1 -1 1", 1, 11, "the light's green must be at least 0"},
        {"f 1 1 1 1 0 0 0\ns", 2, 1, "expected the fill's index of refraction, a number; found 's'"},
        {"f 1 1 1 -1 0 0 0 1", 1, 9, "the fill's Kd must be at least 0"},
        {"f 1 1 1 1 -1 0 0 1", 1, 11, "the fill's Ks"},
        {"f 1 1 1 1 0 -1 0 1", 1, 13, "the fill's Shine"},
        {"f 1 1 1 1 0 0 -1 1", 1, 15, "the fill's T"},
        {"f 1 1 1 1 0 0 0 -1", 1, 17, "the fill's index of refraction"},
        {"f 1 1 1 1 0 0 .5 0", 1, 18, "needs an index of refraction above 0, such as 1.5"},
        // Objects.
        {nff_view + "s 0 0 0 1", 8, 1, "'s' comes before any fill; put an f line before it"},
        {nff_view + "c 0 0 0 1 0 0 1 1", 8, 1, "'c' comes before any fill"},
        {nff_view + "p 3", 8, 1, "'p' comes before any fill"},
        {nff_view + " pp 3", 8, 2, "'pp' comes before any fill"},
        {fill + "s 0 0 0 0", 9, 9, "the size of the sphere's radius must be at least 1e-15"},
        {fill + "s 0 0 0\n s 0 0 0 1", 10, 2, "expected the sphere's radius, a number; found 's'"},
        {fill + "s 0 0 0 1 2", 9, 11, "expected an entity"},
        {fill + "s 2e15 0 0 1", 9, 3, "the sphere's centre x must lie within"},
        {fill + "c 0 0 0 1\n0 0 0 1", 10, 1, "the cone's apex is its base"},
        {fill + "c 0 0 0 1\n0 0 2 -1", 10, 7, "one radius of the cone is negative"},
        {fill + "c 0 0 0 0\n0 0 2 0", 10, 7, "both radii of the cone are 0"},
        {fill + "c 0 0 0 1e-20\n0 0 2 1", 9, 9, "the cone's base radius must be at least"},
        {fill + "p 2 0 0 0 1 1 1", 9, 3,
         "expected the number of corners of the polygon, a whole number from 3"},
        {fill + "p 3.0 0 0 0 1 1 1", 9, 3, "a whole number"},
        {fill + "p -3", 9, 3, "a whole number"},
        {fill + "p 999999999999", 9, 3, "a whole number from 3 to 2147483647"},
        {fill + "p 1000000000 0 0 0", 9, 3, "has 1000000000 corners, but the rest of the file has room for"},
        {fill + "pp 4000 0 0 0", 9, 4, "the rest of the file has room for"},
        {fill + "pp 999999 0 0 0", 9, 4, "a whole number from 3 to 4096"},
        {fill + "p 3\n0 0 0\n1.0 0 0\n1 1", 12, 4,
         "expected the polygon's corner z, a number; found the end of the file"},
        {fill + "p 3\n0 0 0\n1 0 0\n1 1 0\n1 1 1", 13, 1, "expected an entity"},
        {fill + "p 4\n0 0 0\n1 0 0\n1 1 1\n0 1 0", 9, 3, "lie in no plane"},
        {fill + "p 4\n0 0 0\n1 1 0\n1 0 0\n0 1 0", 9, 3, "its outline crosses itself"},
        {fill + "pp 3\n0 0 0 0 0 1\n1 0 0 0 0 0\n0 1 0 0 0 1", 11, 7, "this normal is zero"},
        {fill + "pp 4\n0 0 0 0 0 1\n3 3 0 0 0 1\n3 0 0 0 0 1\n0 1 0 0 0 1", 9, 4,
         "outline of this patch crosses itself"},
    };
    check_cases("scene.nff", cases, parse_nff);
}

TEST_CASE("CSE 167 errors", "[scene]") {
    const std::string head = cse167_head;  // 2 lines
    const std::string vertices = head + "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n";
    const std::vector<Case> cases = {
        {"", 1, 1, "no size command"},
        {"# nothing\n", 2, 1, "no size command"},
        {"camera 0 0 5 0 0 0 0 1 0 45", 1, 1,
         "'camera' comes before size; the first command is size WIDTH HEIGHT"},
        {"size 4 4\n", 2, 1, "no camera command"},
        {"size 4", 1, 7,
         "expected the height in pixels, a whole number from 1 to 65536; found the end of the line"},
        {"size 4\n4\n", 1, 7, "found the end of the line"},
        {"size 4 4 4", 1, 10, "expected the end of the line, 'size' has all its values; found '4'"},
        {"size 0 4", 1, 6, "the width in pixels"},
        {"size 4 70000", 1, 8, "the height in pixels"},
        {"size 4 4\nsize 4 4", 2, 1, "a second size; the first is on line 1"},
        {"size 4 4\nintegrator direct", 2, 1,
         "unknown command 'integrator'; commands are size, camera, output"},
        {head + "  Sphere 0 0 0 1", 3, 3, "unknown command 'Sphere'; did you mean 'sphere'? commands are"},
        {head + "quadLight 0 0 0", 3, 1, "unknown command 'quadLight'"},
        {head + "popTransfrom", 3, 1, "did you mean 'popTransform'?"},
        {head + "1 2 3", 3, 1, "unknown command '1'"},
        {head + head, 3, 1, "a second size"},
        {head + "camera 0 0 5 0 0 0 0 1 0 45", 3, 1, "a second camera; the first is on line 2"},
        {"size 4 4\ncamera 0 0 5 0 0 0 0 1 0", 2, 25,
         "the camera's vertical angle in degrees, a number; found the end"},
        {"size 4 4\ncamera 0 0 5 0 0 0 0 1 0 180", 2, 26, "less than 180"},
        {"size 4 4\ncamera 0 0 5 0 0 0 0 1 0 -1", 2, 26, "greater than 0"},
        {"size 4 4\ncamera 0 0 5 0 0 5 0 1 0 45", 2, 14, "looks at the point it stands on"},
        {"size 4 4\ncamera 0 0 5 0 0 0 0 0 1 45", 2, 20, "parallel"},
        {"size 4 4\ncamera 0 0 5 0 0 0 0 0 0 45", 2, 20, "zero"},
        {head + "maxdepth -1", 3, 10, "the depth, a whole number from 0 to 1000; found '-1'"},
        {head + "maxdepth 1.5", 3, 10, "a whole number"},
        {head + "maxverts 99999999999999", 3, 10, "a whole number from 0 to 4294967295"},
        {head + "maxvertnorms", 3, 13, "found the end of the line"},
        {head + "output", 3, 7, "expected a file name; found the end of the line"},
        {head + "vertex 0 0", 3, 11, "expected the vertex z, a number; found the end of the line"},
        {head + "vertex 0 0 0 0", 3, 14, "'vertex' has all its values; found '0'"},
        {head + "vertex 0 0 0\r\nvertex 0 x 0", 4, 10, "found 'x'"},
        {head + "vertexnormal 0 0 0 0 0 0", 3, 20, "this normal is zero"},
        {head + "tri 0 1 2", 3, 1, "'tri' needs three vertex commands before it"},
        {vertices + "tri 0 1 3", 6, 9, "the number of a vertex, a whole number from 0 to 2; found '3'"},
        {vertices + "tri 0 -1 2", 6, 7, "the number of a vertex, a whole number from 0 to 2; found '-1'"},
        {vertices + "tri 0 1", 6, 8, "found the end of the line"},
        {vertices + "tri 0 1 2 3", 6, 11, "'tri' has all its values"},
        {vertices + "trinormal 0 1 2", 6, 1, "'trinormal' needs three vertexnormal commands before it"},
        {vertices + "translate 5e14 0 0\nscale 1 1e6 1\nvertex 0 1e10 0\ntri 0 1 3", 9, 9,
         "the transformed corner must lie within"},
        {head + "sphere 0 0 0", 3, 13, "expected the sphere's radius, a number"},
        {head + "sphere 0 0 0 1 2", 3, 16, "'sphere' has all its values"},
        {head + "sphere 0 0 0 0", 3, 14, "the sphere's radius must be at least 1e-15"},
        {head + "sphere 0 0 0 -1", 3, 14, "the sphere's radius must be at least 1e-15"},
        {head + "scale 1 1 0\n  sphere 0 0 0 1", 4, 3, "flattens this sphere"},
        {head + "scale 1e14 1e14 1e14\nsphere 0 0 0 100", 4, 1, "takes this sphere beyond"},
        {head + "scale 1e-14 1 1\nsphere 0 0 0 .01", 4, 1, "this sphere"},
        {vertices + "vertexnormal 0 0 0 0 0 1\nscale 1 0 1\ntrinormal 0 0 0", 8, 1,
         "flattens this triangle's normals"},
        {head + "scale 1e10 1 1\nscale 1e10 1 1", 4, 1,
         "every element of the transformation must lie within"},
        {head + "translate 1 2", 3, 14, "found the end of the line"},
        {head + "rotate 0 0 0 30", 3, 8, "the axis of this rotation is zero"},
        {head + "rotate 0 0 1", 3, 13, "expected the angle in degrees"},
        {head + "popTransform", 3, 1, "popTransform without a pushTransform before it"},
        {head + "pushTransform\npopTransform\npopTransform", 5, 1, "popTransform without"},
        {head + "pushTransform 1", 3, 15, "'pushTransform' has all its values"},
        {head + "directional 0 0 0 1 1 1", 3, 13, "the direction to this light is zero"},
        {head + "directional 0 0 1 1 1", 3, 22, "the light's blue"},
        {head + "point 0 0 1 1 1 -1", 3, 17, "the light's blue must be at least 0"},
        {head + "attenuation 0 0 0", 3, 13, "the attenuation is zero"},
        {head + "attenuation 1 0 -1", 3, 17, "the quadratic attenuation must be at least 0"},
        {head + "ambient .1 .1", 3, 14, "the ambient blue"},
        {head + "diffuse .1 -.1 0", 3, 12, "the diffuse green must be at least 0"},
        {head + "specular 1e16 0 0", 3, 10, "the specular red must be at least 0 and at most 1e+15"},
        {head + "shininess -1", 3, 11, "the shininess must be at least 0"},
        {head + "emission inf 0 0", 3, 10, "found 'inf'"},
    };
    check_cases("scene.test", cases, parse_cse167);
}

TEST_CASE("Columns do not depend on line ends or a byte order mark", "[scene]") {
    CHECK_THROWS_WITH(parse_nff("\xef\xbb\xbf"
                                "b 0 0 x"),
                      Catch::StartsWith("scene.nff:1:7: "));
    CHECK_THROWS_WITH(parse_nff("#\r\n#\r\nb 0 0 x\r\n"), Catch::StartsWith("scene.nff:3:7: "));
    CHECK_THROWS_WITH(parse_cse167("size 4 4\rcamera\r"), Catch::StartsWith("scene.test:2:7: "));
}

}  // namespace sahl::tests
