// `sahl profile --ab` and --export-html on the real program.
#include <catch2/catch.hpp>

#include <cstdlib>
#include <fstream>

#include "tests/cli/sahl_program.h"
#include "tests/support/browser.h"

namespace sahl::tests {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> profile(const std::string& repeat, std::vector<std::string> more) {
    more.insert(more.begin(),
                {"profile", scene_file("cli_mirrors.nff"), "--size", "48x32", "--repeat", repeat});
    return more;
}

/// The kernels of the sources, but intersect traces all rays sixteen times: more than other programs slow it.
void write_slow_kernels(const fs::path& folder) {
    fs::copy(fs::path(std::getenv("SAHL_SOURCE_DIR")) / "kernels", folder);
    const fs::path file = folder / "intersect_packet.cl";
    std::string text = content_of(file);
    const std::string before = "        load_packet(&packet,";
    const std::size_t at = text.find(before);
    REQUIRE(at != text.npos);
    const std::string after = "        store_packet(&packet, hits, hit_ids, capacity, first, count);\n";
    const std::size_t end = text.find(after) + after.size();
    text.insert(end, "        }\n");
    text.insert(at, "        for (int again = 0; again < 16; ++again) {\n");
    write_file(file, text);
}

TEST_CASE("profile --ab: a slower kernel is found, and fails its limit", "[cli][profile]") {
    const TemporaryFolder folder;
    write_slow_kernels(folder / "slow");
    const std::string same = std::string(std::getenv("SAHL_SOURCE_DIR")) + "/kernels";
    const ProcessResult result = run_sahl_in(
        folder.path(), profile("22", {"--json", "--ab", "SAHL_KERNEL_DIR=" + same, "SAHL_KERNEL_DIR=slow",
                                      "--fail-if", "intersect:+30%", "--fail-if", "shade:+300%"}));
    INFO(result.out << result.err);
    REQUIRE(result.status == 9);
    const nlohmann::json event = json_lines(result.out).at(0);
    CHECK(event.at("event") == "profile_diff");
    CHECK(event.at("interleaved") == true);
    CHECK(event.at("base").at("name") == "SAHL_KERNEL_DIR=" + same);
    CHECK(event.at("base").at("kernel_hash") != event.at("other").at("kernel_hash"));
    CHECK(event.at("pairs") == 22);
    CHECK(event.at("base").at("repetitions") == 20);  // blocks
    CHECK(event.at("other").at("repetitions") == 20);
    bool found = false;
    for (const nlohmann::json& row : event.at("rows")) {
        if (row.at("kernel") != "intersect" || !row.at("generation").is_null()) continue;
        found = true;
        CHECK(row.at("verdict") == "slower");
        CHECK(row.at("ratio").get<double>() > 1.5);
    }
    CHECK(found);
    CHECK(event.at("limits")[0].at("exceeded") == true);
    CHECK(event.at("limits")[1].at("exceeded") == false);
}

TEST_CASE("profile --ab: options differ between the sides, without a warning of drift", "[cli][profile]") {
    const ProcessResult result = run_sahl(profile("3", {"--ab", "build-quality=high", "build-quality=fast"}));
    INFO(result.out << result.err);
    REQUIRE(result.status == 0);
    CHECK_THAT(result.out, Catch::Contains("tree high, 3 frames in 3 blocks") &&
                               Catch::Contains("tree fast, 3 frames in 3 blocks"));
    CHECK_THAT(result.err,
               !Catch::Contains("in turn") && Catch::Contains("3 and 3 blocks are too few to tell"));
}

TEST_CASE("profile --ab: what cannot be compared is exit status 2", "[cli][profile]") {
    struct Case {
        std::vector<std::string> arguments;
        std::string message;
    };
    const auto item = GENERATE(values<Case>({
        {{"--ab", "depth=1"}, "--ab"},
        {{"--ab", "deepth=1", "depth=2"}, "did you mean 'depth'"},
        {{"--ab", "repeat=7", "repeat=8"}, "nothing of that name can differ"},
        {{"--ab", "threads=1", "threads=2"}, "nothing of that name can differ"},
        {{"--ab", "depth=1", "depth=x"}, "--depth 'x'"},
        {{"--ab", "depth=1", "depth=2", "--export-json", "x.json"}, "--export-json"},
        {{"--fail-if", "intersect:+3%"}, "nothing to compare with"},
    }));
    const TemporaryFolder folder;
    const ProcessResult result = run_sahl_in(folder.path(), profile("1", item.arguments));
    INFO(result.err);
    CHECK(result.status == 2);
    CHECK_THAT(result.err, Catch::Contains(item.message));
    CHECK(folder.entries() == 0);
}

TEST_CASE("profile --export-html: the page has the measured profile and the image", "[cli][profile]") {
    const TemporaryFolder folder;
    const ProcessResult result = run_sahl_in(
        folder.path(), profile("2", {"--export-html", "page.html", "--export-json", "profile.json"}));
    INFO(result.err);
    REQUIRE(result.status == 0);
    const std::string page = content_of(folder / "page.html");
    const auto measured = nlohmann::ordered_json::parse(content_of(folder / "profile.json"));
    const std::string open = "<script type=\"application/json\" id=\"profile\">";
    const std::size_t begin = page.find(open) + open.size();
    CHECK(nlohmann::ordered_json::parse(page.substr(begin, page.find("</script>", begin) - begin)) ==
          measured);
    if (!has_browser()) {
        WARN("SKIPPED: chromium is not installed");
        return;
    }
    const BrowsedPage shown = browse(page, {.script = R"(
        const root = document.documentElement, image = document.images[0];
        root.dataset.image = image.naturalWidth + "x" + image.naturalHeight;
        root.dataset.wall = document.querySelector("[data-key=wall_ms]").dataset.value;
        root.dataset.rays = document.querySelectorAll(".scale")[0].dataset.sum;
        root.dataset.maps = [...document.querySelectorAll("figcaption b")].map(title => title.textContent).join();
        root.dataset.rows = document.querySelectorAll("#rows tbody tr").length;
    )"});
    CHECK(shown.messages == "");
    CHECK(shown.data("image") == "48x32");
    CHECK(shown.data("maps") == "Image,Rays,Node visits");
    // The pixels' rays are those that were measured.
    std::uint64_t rays = 0;
    for (const auto& row : measured.at("rows")) {
        if (row.at("kernel") == "intersect" || row.at("kernel") == "shadow")
            rays += row.at("rays_in").get<std::uint64_t>();
    }
    CHECK(shown.data("rays") == std::to_string(rays));
    CHECK(std::stod(shown.data("wall")) == measured.at("wall_ms").get<double>());
    CHECK(shown.data("rows") == std::to_string(measured.at("rows").size()));
}

}  // namespace
}  // namespace sahl::tests
