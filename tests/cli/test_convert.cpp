// `sahl convert`: scenes from format to format, with the exit statuses and messages of the program.
#include <catch2/catch.hpp>

#include <fstream>
#include <iterator>

#include "tests/cli/sahl_program.h"

namespace sahl::tests {
namespace {

std::string read_file(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

TEST_CASE("convert: to JSON and back is the same file", "[cli][convert]") {
    const auto [scene, extension] = GENERATE(table<std::string, std::string>(
        {{"all_entities.nff", ".nff"}, {"cli_mirrors.nff", ".nff"}, {"all_commands.test", ".test"}}));
    const TemporaryFolder folder;
    const std::string same = "same" + extension;
    const std::string back = "back" + extension;
    for (const auto& [in, out] : {std::pair{scene_file(scene), std::string("a.json")},
                                  {"a.json", back},
                                  {scene_file(scene), same},
                                  {back, "b.json"}}) {
        const ProcessResult result = run_sahl_in(folder.path(), {"convert", in, out});
        INFO(in << " " << out << " " << result.err);
        REQUIRE(result.status == 0);
        CHECK(result.out == "");
        CHECK(result.err == "wrote " + out + "\n");
    }
    CHECK(read_file(folder / back) == read_file(folder / same));
    CHECK(read_file(folder / "a.json") == read_file(folder / "b.json"));
    CHECK(folder.entries() == 4);
}

TEST_CASE("convert: the scene in another format renders as the same image", "[cli][convert]") {
    const std::string scene =
        GENERATE(as<std::string>(), "all_entities.nff", "cli_mirrors.nff", "all_commands.test");
    const TemporaryFolder folder;
    REQUIRE(run_sahl_in(folder.path(), {"convert", scene_file(scene), "a.json", "-q"}).status == 0);
    REQUIRE(run_sahl_in(folder.path(), {"render", scene_file(scene), "-o", "a.exr", "--pixel-type", "float"})
                .status == 0);
    REQUIRE(run_sahl_in(folder.path(), {"render", "a.json", "-o", "b.exr", "--pixel-type", "float"}).status ==
            0);
    const ProcessResult result = run_sahl_in(folder.path(), {"compare", "a.exr", "b.exr"});
    INFO(result.out << result.err);
    CHECK(result.status == 0);
}

TEST_CASE("convert: -q says nothing, --json says it as an event", "[cli][convert]") {
    const TemporaryFolder folder;
    const ProcessResult quiet =
        run_sahl_in(folder.path(), {"convert", "-q", scene_file("all_entities.nff"), "a.json"});
    CHECK(quiet.status == 0);
    CHECK(quiet.out + quiet.err == "");
    const ProcessResult result =
        run_sahl_in(folder.path(), {"convert", "--json", scene_file("all_entities.nff"), "a.json"});
    CHECK(result.status == 0);
    const std::vector<nlohmann::json> events = json_lines(result.out);
    REQUIRE(events.size() == 1);
    CHECK(events[0].at("event") == "convert");
    CHECK(events[0].at("output") == "a.json");
    CHECK(events[0].at("primitives") == 8);
    CHECK(events[0].at("materials") == 2);
    CHECK(events[0].at("lights") == 2);
}

TEST_CASE("convert: parameters are set before the scene is written", "[cli][convert]") {
    const TemporaryFolder folder;
    write_file(folder / "in.json",
               R"({"sahl": 1, "parameters": {"size": {"type": "number", "default": 1, "max": 5}},
                   "cameras": {"main": {"eye": [0, 0, 9], "look_at": [0, 0, 0]}},
                   "objects": [{"type": "sphere", "radius": "$size"}]})");
    CHECK(run_sahl_in(folder.path(), {"convert", "in.json", "out.json", "--set", "size=2.5"}).status == 0);
    const nlohmann::json written = nlohmann::json::parse(read_file(folder / "out.json"));
    CHECK(written.at("objects")[0].at("radius") == 2.5);
    CHECK(!written.contains("parameters"));
    const ProcessResult refused =
        run_sahl_in(folder.path(), {"convert", "in.json", "b.json", "--set", "size=6"});
    CHECK(refused.status == 2);
    CHECK(!std::filesystem::exists(folder / "b.json"));
}

TEST_CASE("convert: refused with the status and the reason", "[cli][convert]") {
    struct Case {
        std::vector<std::string> arguments;
        int status;
        std::string says;
    };
    const auto item = GENERATE(values<Case>({
        {{"in.nff"}, 2, "OUT is required"},
        {{"in.nff", "in.nff"}, 2, "'in.nff' is the scene that is read; give the result another name"},
        {{"in.nff", "./in.nff"}, 2, "'./in.nff' is the scene that is read"},
        {{"in.nff", "link.nff"}, 2, "'link.nff' is the scene that is read"},
        {{"in.nff", "out.obj"}, 2, "formats are .json (Sahl scene), .nff (Neutral File Format) and .test"},
        {{"in.png", "out.json"}, 2, "extension '.png'"},
        {{"in.nff", "out.json", "third"}, 2, "nothing takes the argument 'third'"},
        {{"missing.nff", "out.json"}, 3, "there is no such file"},
        {{"bad.nff", "out.json"}, 3, "bad.nff:1:1: unknown entity"},
        {{"in.nff", "out.test"},
         3,
         "error: in.nff: .test has no background but black; write .json, which has everything"},
        {{"in.nff", "in.nff/out.json"}, 6, "cannot write 'in.nff/out.json'"},
    }));
    const TemporaryFolder folder;
    write_file(folder / "in.nff",
               "b 1 1 1\nv from 0 0 5 at 0 0 0 up 0 1 0 angle 45 hither 0 resolution 4 4\n");
    write_file(folder / "bad.nff", "q");
    std::filesystem::create_symlink("in.nff", folder / "link.nff");
    const std::string before = read_file(folder / "in.nff");
    std::vector<std::string> arguments{"convert"};
    arguments.insert(arguments.end(), item.arguments.begin(), item.arguments.end());
    const ProcessResult result = run_sahl_in(folder.path(), arguments);
    INFO(result.err);
    CHECK(result.status == item.status);
    CHECK(result.err.find(item.says) != std::string::npos);
    CHECK(folder.entries() == 3);
    CHECK(read_file(folder / "in.nff") == before);
}

}  // namespace
}  // namespace sahl::tests
