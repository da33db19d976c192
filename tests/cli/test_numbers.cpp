// Numbers that a film cannot hold: refused where they come in, counted where they come about.
#include <catch2/catch.hpp>

#include <memory>

#include <OpenImageIO/imageio.h>

#include "tests/cli/sahl_program.h"

namespace sahl::tests {
namespace {

/// Inside a ball that reflects `reflection` times the light that meets it, and shines with 1.
std::string bright_ball(const std::string& reflection) {
    return R"({"sahl": 1, "film": {"width": 4, "height": 4}, "depth": 5,
        "cameras": {"main": {"eye": [0, 0, 0], "look_at": [1, 0, 0], "up": [0, 0, 1], "fov": 40}},
        "materials": {"m": {"emission": [1, 0, 0], "reflection": [)" +
           reflection + R"(, 0, 0]}},
        "objects": [{"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "m"}]})";
}

/// Counts of an image's contributions: in the JSON event, in the file, in the log.
struct Counts {
    std::uint64_t non_finite, clamped;
    std::string in_file;
    std::string log;
};

Counts counts_of(const std::string& reflection) {
    const TemporaryFolder folder;
    write_file(folder / "a.json", bright_ball(reflection));
    const ProcessResult result = run_sahl_in(folder.path(), {"render", "a.json", "-o", "a.exr", "--json"});
    INFO(result.err);
    REQUIRE(result.status == 0);
    const nlohmann::json event = json_lines(result.out).back();
    const auto input = OIIO::ImageInput::open((folder / "a.exr").string());
    REQUIRE(input);
    const auto attribute = [&](const char* name) {
        return std::string(input->spec().get_string_attribute(name));
    };
    return {event.at("non_finite"), event.at("clamped"),
            attribute("Sahl:NonFinite") + " " + attribute("Sahl:Clamped"), result.err};
}

}  // namespace

TEST_CASE("numbers: contributions that no film can hold are counted in the log, the file and as JSON",
          "[cli]") {
    // Generation g brings the light r^g. 16 pixels, one ray each, generations 0 to 5.
    const Counts moderate = counts_of("2");
    CHECK(moderate.non_finite == 0);
    CHECK(moderate.clamped == 0);
    CHECK(moderate.in_file == "0 0");
    CHECK(moderate.log.find("warning") == std::string::npos);

    const Counts bright = counts_of("100");  // r^3 is above 131072
    CHECK(bright.non_finite == 0);
    CHECK(bright.clamped == 3 * 16);
    CHECK(bright.in_file == "0 48");
    CHECK(bright.log.find("a.exr: 48 contributions were brighter than 131072") != std::string::npos);

    const Counts infinite = counts_of("1e15");  // r^3 is above the floats
    CHECK(infinite.non_finite >= 3 * 16);
    CHECK(infinite.clamped == 2 * 16);
    CHECK(infinite.in_file == std::to_string(infinite.non_finite) + " 32");
    CHECK(infinite.log.find(std::to_string(infinite.non_finite) + " contributions were") !=
          std::string::npos);
}

TEST_CASE("numbers: what is not finite is refused with its place", "[cli]") {
    const TemporaryFolder folder;
    for (const std::string number : {"1e999", "-1e999", "NaN", "Infinity", "1e39"}) {
        write_file(folder / "a.json", bright_ball(number));
        const ProcessResult json = run_sahl_in(folder.path(), {"render", "a.json"});
        INFO(number << ": " << json.err);
        CHECK(json.status == 3);
        CHECK(json.err.find("a.json:3:") != std::string::npos);
    }
    for (const std::string number : {"1e999", "nan", "inf", "-inf", "1e39"}) {
        write_file(folder / "a.nff",
                   "v\nfrom 0 0 9\nat 0 0 0\nup 0 1 0\nangle 40\nhither 1\nresolution 8 8\n"
                   "f 1 1 1 1 0 0 0 0\ns 0 0 " +
                       number + " 1\n");
        const ProcessResult nff = run_sahl_in(folder.path(), {"render", "a.nff"});
        INFO(number << ": " << nff.err);
        CHECK(nff.status == 3);
        CHECK(nff.err.find("a.nff:9:") != std::string::npos);
        write_file(folder / "a.test", "size 8 8\ncamera 0 0 5 0 0 0 0 1 0 " + number + "\nsphere 0 0 0 1\n");
        const ProcessResult test = run_sahl_in(folder.path(), {"render", "a.test"});
        CHECK(test.status == 3);
        CHECK(test.err.find("a.test:2:") != std::string::npos);
    }
}

}  // namespace sahl::tests
