// Scenes that mean harm, in the real program: each ends soon with exit status 3, its place and a remedy.
#include <catch2/catch.hpp>

#include <fmt/format.h>

#include "tests/cli/sahl_program.h"
#include "tests/host/scene/parse.h"

namespace sahl::tests {
namespace {

namespace fs = std::filesystem;

const std::string head = R"({"sahl": 1, "cameras": {"main": {"eye": [0, 0, 5], "look_at": [0, 0, 0]}}, )";
const std::string huge = "4611686018427387904";  // 2^62

std::string include(const std::string& uri) {
    return fmt::format(R"({{"type": "include", "uri": "{}"}})", uri);
}

std::string repeated(const std::string& text, int count) {
    std::string all;
    for (int i = 0; i < count; ++i) all += text;
    return all;
}

/// `name`, holding `text`, is refused at line:column of the file `at` with these words.
void check_refused(const fs::path& folder, const std::string& name, const std::string& text,
                   const std::string& place, const std::string& says) {
    write_file(folder / name, text);
    ProcessOptions options;
    options.working_directory = folder;
    options.timeout = std::chrono::seconds(60);  // of a busy machine; parts of a second, in fact
    const ProcessResult result = run_sahl({"info", name}, options);
    INFO(name << " ended with status " << result.status << '\n' << result.err.substr(0, 1000));
    CHECK_FALSE(result.timed_out);
    CHECK(result.status == 3);
    CHECK_THAT(result.err, Catch::StartsWith("sahl: error: " + place) && Catch::Contains(says));
}

TEST_CASE("hostile scenes: what nests without end is refused", "[cli]") {
    const TemporaryFolder folder;
    check_refused(folder.path(), "arrays.json", R"({"sahl": 1, "objects": )" + repeated("[", 1'000'000),
                  "arrays.json:1:123", "nested deeper than 100; nest them less");
    check_refused(folder.path(), "objects.json", repeated(R"({"a": )", 1'000'000), "objects.json:1:601",
                  "nested deeper than 100; nest them less");
    std::string groups = R"("groups": {"g0": [{"type": "sphere"}])";
    for (int i = 1; i < 3000; ++i)
        groups += fmt::format(R"(, "g{}": [{{"type": "instance", "group": "g{}"}}])", i, i - 1);
    check_refused(folder.path(), "groups.json",
                  head + groups + "},\n\"objects\": [{\"type\": \"instance\", \"group\": \"g2999\"}]}",
                  "groups.json:1:", "groups nest deeper than 64");
    // No end of pushes is no harm: a matrix each.
    write_file(folder / "push.test", cse167_head + repeated("pushTransform\n", 100'000));
    CHECK(run_sahl_in(folder.path(), {"info", "push.test"}).status == 0);
}

TEST_CASE("hostile scenes: what multiplies is refused", "[cli]") {
    const TemporaryFolder folder;
    // Ten instances of ten instances of …
    std::string groups = R"("groups": {"g0": [{"type": "sphere"}])";
    for (int i = 1; i < 40; ++i) {
        groups += fmt::format(", \"g{}\": [", i);
        for (int k = 0; k < 10; ++k)
            groups += fmt::format(R"({}{{"type": "instance", "group": "g{}"}})", k > 0 ? ", " : "", i - 1);
        groups += "]";
    }
    check_refused(folder.path(), "instances.json",
                  head + groups + R"(}, "objects": [{"type": "instance", "group": "g39"}]})",
                  "instances.json:1:", "more than 134217727 groups are placed");
    for (int i = 0; i < 12; ++i) {
        const std::string next = include(fmt::format("i{}.json", i + 1));
        write_file(folder / fmt::format("i{}.json", i),
                   R"({"sahl": 1, "objects": [)" + next + repeated(", " + next, 9) + "]}");
    }
    write_file(folder / "i12.json", R"({"sahl": 1})");
    check_refused(folder.path(), "includes.json", head + R"("objects": [)" + include("i0.json") + "]}", "i",
                  "more than 10000 files are included; use instances of a group");
}

TEST_CASE("hostile scenes: what contains itself is refused", "[cli]") {
    const TemporaryFolder folder;
    check_refused(folder.path(), "groups.json",
                  head + R"("groups": {"a": [{"type": "instance", "group": "b"}],
                            "b": [{"type": "instance", "group": "a"}]},
                            "objects": [{"type": "instance", "group": "a"}]})",
                  "groups.json:2:35", "the group 'a' contains itself: a -> b -> a; remove this instance");
    write_file(folder / "b.json", R"({"sahl": 1, "objects": [)" + include("a.json") + "]}");
    check_refused(folder.path(), "a.json", head + "\"objects\": [\n" + include("b.json") + "]}",
                  "b.json:1:52",
                  "a.json includes itself: a.json -> b.json -> a.json (included from a.json:2:28)");
}

TEST_CASE("hostile scenes: counts of 2^62 are refused", "[cli]") {
    const TemporaryFolder folder;
    struct Case {
        std::string name, text, place, says;
    };
    const std::string view = nff_view + "f 1 1 1 1 0 0 0 1\n";
    for (const Case& c : std::vector<Case>{
             {"size.test", "size 64 " + huge, "size.test:1:9", "the height in pixels, a whole number from 1"},
             {"vertices.test", cse167_head + "maxverts " + huge, "vertices.test:3:10", "found '" + huge},
             {"normals.test", cse167_head + "maxvertnorms " + huge, "normals.test:3:14", "found '" + huge},
             {"depth.test", cse167_head + "maxdepth " + huge, "depth.test:3:10", "the depth, a whole number"},
             {"index.test", cse167_head + "vertex 0 0 0\ntri 0 " + huge + " 0", "index.test:4:7",
              "the number of a vertex, a whole number from 0 to 0"},
             // What a hint promises is not allocated before it comes.
             {"hint.test", cse167_head + "maxverts 4294967295\nmaxvertnorms 4294967295\nvertex 0 0\n",
              "hint.test:5:11", "found the end of the line"},
             {"size.nff", "v\nresolution 64 " + huge, "size.nff:2:15", "a whole number from 1 to 65536"},
             {"polygon.nff", view + "p " + huge + "\n0 0 0\n", "polygon.nff:9:3", "corners of the polygon"},
             {"corners.nff", view + "p 2147483647\n0 0 0\n", "corners.nff:", "corner"},
             {"patch.nff", view + "pp " + huge + "\n0 0 0\n", "patch.nff:9:4", "corners of the patch"},
             {"size.json", head + "\"film\": {\n\"width\": " + huge + "}}", "size.json:2:10",
              "width: expected an integer"},
             {"depth.json", head + "\n\"depth\": " + huge + "}", "depth.json:2:10", "depth"},
             {"index.json",
              head + R"("objects": [{"type": "mesh", "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]],)" +
                  "\n\"triangles\": [[0, 1, " + huge + "]]}]}",
              "index.json:2:22", "triangles"},
         })
        check_refused(folder.path(), c.name, c.text, c.place, c.says);
}

TEST_CASE("hostile scenes: no file outside the asset root is read", "[cli]") {
    const TemporaryFolder folder;
    const fs::path root = folder / "root";
    fs::create_directories(root / "inner");
    write_file(folder / "secret.nff", nff_view);
    fs::create_symlink("../secret.nff", root / "link.nff");
    fs::create_directory_symlink(folder.path(), root / "up");
    struct Case {
        std::string uri, says;
    };
    const std::string outside = "lies outside the asset root";
    const std::string no_path = "is no relative path; name a file by its path from this file's folder";
    const std::string no_file = "there is no file";
    for (const Case& c : std::vector<Case>{
             {"../secret.nff", outside},
             {"inner/../../secret.nff", outside},
             {"nowhere/../../secret.nff", outside},
             {"link.nff", outside},
             {"up/secret.nff", outside},
             {(folder / "secret.nff").string(), no_path},
             {"//host/secret.nff", no_path},
             {"file:" + (folder / "secret.nff").string(), no_path},
             {"file://" + (folder / "secret.nff").string(), no_path},
             {"FILE:secret.nff", no_path},
             {"http://localhost/secret.nff", no_path},
             {"data:,s", no_path},
             // Names are names: nothing in them is decoded or expanded.
             {"..%2fsecret.nff", no_file},
             {"%2e%2e/secret.nff", no_file},
             {R"(..\\secret.nff)", no_file},
             {"~/secret.nff", no_file},
         }) {
        INFO(c.uri);
        check_refused(root, "scene.json", head + "\"objects\": [\n" + include(c.uri) + "]}",
                      "scene.json:2:28", c.says);
    }
    // The same file, allowed.
    write_file(root / "scene.json", head + "\"objects\": [" + include("../secret.nff") + "]}");
    CHECK(run_sahl_in(root, {"info", "scene.json", "--asset-root", ".."}).status == 0);
}

}  // namespace
}  // namespace sahl::tests
