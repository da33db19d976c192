// The memory contract of the real program: --max-mem, --dry-run, and allocations that fail.
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include <catch2/catch.hpp>

#include "engine/film/image_io.h"
#include "tests/cli/sahl_program.h"
#include "tests/support/kernel_runner.h"

namespace sahl::tests {
namespace {

nlohmann::json plan_event(const ProcessResult& result) {
    INFO(result.out << result.err);
    REQUIRE(result.status == 0);
    const std::vector<nlohmann::json> events = json_lines(result.out);
    REQUIRE(events.size() == 1);
    REQUIRE(events[0].at("event") == "plan");
    return events[0];
}

std::size_t files_in(const std::filesystem::path& folder) {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

/// The number in "needs at least N bytes".
std::string least_named(const std::string& message) {
    const std::string before = "needs at least ";
    const std::size_t begin = message.find(before);
    REQUIRE(begin != std::string::npos);
    return message.substr(begin + before.size(),
                          message.find(' ', begin + before.size()) - begin - before.size());
}

/// Sanitizers hold memory of their own, several times what the program holds.
constexpr bool sanitized =
#ifdef __SANITIZE_ADDRESS__
    true;
#else
    false;
#endif

}  // namespace

TEST_CASE("memory: --dry-run says what would be done and does nothing", "[cli]") {
    const TemporaryFolder folder;
    const ProcessResult text = run_sahl_in(
        folder.path(), {"render", scene_file("cli_mirrors.nff"), "--dry-run", "--depth", "1,2", "-o",
                        "d{depth}.png", "-o", "d{depth}.exr", "--max-mem", "1G", "--aov", "Z"});
    INFO(text.out << text.err);
    CHECK(text.status == 0);
    CHECK(contains(text.out, "depth 1           d1.png, d1.exr\n"));
    CHECK(contains(text.out, "depth 2           d2.png, d2.exr\n"));
    CHECK(contains(text.out, "limit 1.00 GiB\n"));
    CHECK(contains(text.out, "\n  total "));
    CHECK(contains(text.out, "\n  base "));
    const nlohmann::json plan =
        plan_event(run_sahl_in(folder.path(), {"render", scene_file("cli_mirrors.nff"), "--dry-run", "--json",
                                               "--crop", "0,0,10,20", "--spp", "4", "--max-mem", "64M"}));
    CHECK(plan.at("outputs") == nlohmann::json({{"cli_mirrors.png"}}));
    CHECK(plan.at("crop") == nlohmann::json({0, 0, 10, 20}));
    CHECK(plan.at("memory").at("limit") == 64 << 20);
    CHECK(plan.at("memory").at("image") == 10 * 20 * 12);
    CHECK(plan.at("memory").at("runtime_base").get<std::uint64_t>() > 0);
    CHECK(plan.at("memory").at("total").get<std::uint64_t>() <= 64U << 20U);
    CHECK(files_in(folder.path()) == 0);
}

TEST_CASE("memory: --dry-run finds what would be wrong", "[cli]") {
    const TemporaryFolder folder;
    const auto status = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"render", scene_file("cli_mirrors.nff"), "--dry-run"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_sahl_in(folder.path(), arguments).status;
    };
    CHECK(status({"--max-mem", "10K"}) == 5);
    CHECK(status({"--camera", "none"}) == 2);
    CHECK(status({"-o", "/dev/null/a.png"}) == 6);
    CHECK(status({"--device", "none of these"}) == 4);
    CHECK(run_sahl_in(folder.path(), {"render", "none.nff", "--dry-run"}).status == 3);
    for (const char* size : {"", "M", "-1", "1.5G", "5X", "1e9", "99999999999G", "16777216T"})
        CHECK(status({"--max-mem", size}) == 2);
}

TEST_CASE("memory: below the least --max-mem names it, at the least the image is the same", "[cli]") {
    const TemporaryFolder folder;
    const std::vector<std::string> job{
        "render", scene_file("cli_mirrors.nff"), "--size", "150x100", "-o", "a.exr", "--pixel-type", "float"};
    const auto within = [&](const std::string& limit, const char* output) {
        std::vector<std::string> arguments = job;
        arguments[5] = output;
        arguments.insert(arguments.end(), {"--max-mem", limit});
        return run_sahl_in(folder.path(), arguments);
    };
    REQUIRE(run_sahl_in(folder.path(), job).status == 0);
    const ProcessResult refused = within("20K", "b.exr");
    CHECK(refused.status == 5);
    CHECK_FALSE(std::filesystem::exists(folder / "b.exr"));
    const std::string least = least_named(refused.err);
    CHECK(within(least, "b.exr").status == 0);
    CHECK(read_image(folder / "b.exr").pixels == read_image(folder / "a.exr").pixels);
    const ProcessResult less = within(std::to_string(std::stoull(least) - 1), "c.exr");
    CHECK(less.status == 5);
    CHECK(least_named(less.err) == least);
}

TEST_CASE("memory: what is resident stays within plan, base and a tenth", "[cli]") {
    if (sanitized) {
        WARN("SKIPPED: sanitizers hold memory of their own");
        return;
    }
    const TemporaryFolder folder;
    const std::string scenes = std::string(std::getenv("SAHL_SOURCE_DIR")) + "/scenes/";
    const std::string size = full_tests() ? "3000x3000" : "1200x1200";
    const std::vector<std::vector<std::string>> jobs{
        {scene_file("cli_mirrors.nff"), "--size", size, "-o", "a.png"},
        {scene_file("cli_mirrors.nff"), "--size", size, "-o", "a.exr", "--aov", "all", "--pixel-type",
         "float", "--compression", "none"},
        {scene_file("cli_mirrors.nff"), "--size", size, "-o", "a.jpg", "--depth", "0"},
        {scene_file("cli_mirrors.nff"), "--size", size, "-o", "a.tif", "--depth", "0", "--compression",
         "lzw"},
        {scenes + "field.json", "--size", "100x100", "-o", "a.hdr"}};
    for (const std::vector<std::string>& job : jobs) {
        std::vector<std::string> arguments{"render"};
        arguments.insert(arguments.end(), job.begin(), job.end());
        INFO(job[0] << " " << job[4]);
        arguments.emplace_back("--dry-run");
        arguments.emplace_back("--json");
        const nlohmann::json memory = plan_event(run_sahl_in(folder.path(), arguments)).at("memory");
        arguments.erase(arguments.end() - 2);
        const ProcessResult result = run_sahl_in(folder.path(), arguments);
        CHECK(result.status == 0);
        const auto total = memory.at("total").get<double>();
        const auto base = memory.at("runtime_base").get<double>();
        CHECK(static_cast<double>(result.peak_bytes) <= 1.1 * (total + base));
        CHECK(result.peak_bytes > 50U << 20U);
    }
}

TEST_CASE("memory: an allocation that fails ends with 5, leaves the old file and nothing else", "[cli]") {
    const TemporaryFolder folder;
    const std::vector<std::string> job{
        "render", scene_file("cli_mirrors.nff"), "--size", "20x20", "-o", "a.exr", "--aov", "Z"};
    ProcessOptions options;
    options.working_directory = folder.path();
    REQUIRE(run_sahl(job, options).status == 0);  // the self-test has passed, kernels are compiled
    write_file(folder / "a.exr", "old");
    int failures = 0;
    for (int n = 1;; n += full_tests() ? 1 : 6) {
        options.environment["SAHL_FAIL_ALLOCATION"] = std::to_string(n);
        const ProcessResult result = run_sahl(job, options);
        INFO("allocation " << n << ": " << result.err);
        CHECK(files_in(folder.path()) == 1);
        if (result.status == 0) break;  // there are not so many
        REQUIRE(result.status == 5);
        CHECK(contains(result.err, "cannot allocate"));
        std::ifstream file(folder / "a.exr");
        std::string content;
        std::getline(file, content);
        CHECK(content == "old");
        ++failures;
    }
    CHECK(failures >= (full_tests() ? 40 : 7));
}

TEST_CASE("memory: threads and caches change no bit of the image", "[cli]") {
    const TemporaryFolder folder;
    const std::string scene = std::string(std::getenv("SAHL_SOURCE_DIR")) + "/scenes/transforms.json";
    const auto pixels = [&](const std::vector<std::string>& more, const std::string& cache) {
        std::vector<std::string> arguments{"render", scene, "--size", "60x40",        "--spp",
                                           "32",     "-o",  "a.exr",  "--pixel-type", "float"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        ProcessOptions options;
        options.working_directory = folder.path();
        if (!cache.empty()) options.environment["SAHL_CACHE_DIR"] = cache;
        REQUIRE(run_sahl(arguments, options).status == 0);
        return read_image(folder / "a.exr").pixels;
    };
    const std::vector<float> expected = pixels({}, "");
    CHECK(*std::max_element(expected.begin(), expected.end()) > 0);
    for (const char* threads : {"1", "2", "4"}) CHECK(pixels({"--threads", threads}, "") == expected);
    const TemporaryFolder cache;
    CHECK(pixels({}, cache.path().string()) == expected);  // cold
    CHECK(files_in(cache.path()) > 0);
    CHECK(pixels({}, cache.path().string()) == expected);  // warm
}

}  // namespace sahl::tests
