// The self-test as a user meets it: before the first image of a device, and by `sahl devices --test`.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <random>

#include "tests/cli/sahl_program.h"
#include "tests/device/test_device_support.h"
#include "tests/support/broken_kernels.h"

namespace sahl::tests {
namespace {

namespace fs = std::filesystem;

/// A copy of the kernels, a cache and a folder to work in.
struct Place {
    Place() {
        for (const fs::path& made : {kernels, cache, work}) fs::create_directory(made);
        copy_kernels(kernels);
        options.environment["SAHL_KERNEL_DIR"] = kernels.string();
        options.environment["SAHL_CACHE_DIR"] = cache.string();
        options.working_directory = work;
    }

    ProcessResult run(const std::vector<std::string>& arguments) const {
        return run_sahl(arguments, options);
    }

    /// Renders; whether the self-test ran before.
    bool render_tests(const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{"render", scene_file("cli_mirrors.nff"), "-v"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProcessResult result = run(arguments);
        INFO(result.err);
        REQUIRE(result.status == 0);
        return contains(result.err, "self-test of device");
    }

    TemporaryFolder folder;
    fs::path kernels = folder / "kernels", cache = folder / "cache", work = folder / "work";
    ProcessOptions options;
};

const std::vector<Fault> one_a_kernel{
    {"generate", "camera.h", "(real)camera->half_width", "(real)0.5 - (real)camera->half_width"},
    {"intersect", "shape_group.h", "chords.middle - half_chord, chords",
     "chords.middle + half_chord, chords"},
    {"shade", "material.h", "light = mul(diffuse, SAHL_MAX", "light = mul(diffuse, 1.01f * SAHL_MAX"},
    {"shadow", "light.h", "SAHL_LIGHT_DIRECTIONAL ? INFINITY : 1.0f",
     "SAHL_LIGHT_DIRECTIONAL ? INFINITY : 2.0f"},
    {"count_children", "compact.cl", "block_count + block] = transmitted",
     "block_count + block] = transmitted + 1u"},
    {"sum_children", "compact.cl", "totals[SAHL_TOTAL_CHILDREN] = children",
     "totals[SAHL_TOTAL_CHILDREN] = children - 1u"},
    {"compact", "compact.cl", "next[to + k] = from[place[k]]", "next[to + k] = from[place[0]]"},
    {"describe", "aov.cl", "turned ? facing : surfaces.ns", "surfaces.ns"},
};

TEST_CASE("self-test: a wrong kernel ends a render with 4, named with its answer, and no image is written",
          "[cli][self_test]") {
    for (const Fault& fault : one_a_kernel) {
        const Place place;
        break_kernel(place.kernels, fault);
        const ProcessResult result =
            place.run({"render", scene_file("cli_mirrors.nff"), "-o", "image.exr", "--aov", "all", "--json"});
        INFO(fault.kernel << ": " << result.err);
        CHECK(result.status == 4);
        CHECK(contains(result.err, " driver "));
        CHECK(contains(result.err, "computes wrongly: kernel " + fault.kernel + ", "));
        const bool moves_numbers = contains(fault.file, "compact");
        CHECK(contains(result.err, moves_numbers ? ": expected " : " of generation "));
        CHECK(contains(result.err, ", found "));
        CHECK(contains(result.err, "update its driver"));
        CHECK(contains(result.err, "--device"));
        CHECK(fs::is_empty(place.work));
        const std::vector<nlohmann::json> events = json_lines(result.out);
        REQUIRE(!events.empty());
        CHECK(events.back().at("event") == "error");
        CHECK(events.back().at("code") == 4);
    }
}

TEST_CASE("self-test: what has passed is on record until device code or record change", "[cli][self_test]") {
    const Place place;
    CHECK(place.render_tests());
    CHECK_FALSE(place.render_tests());
    // The AOVs' kernel is a program of its own.
    const std::vector<std::string> aovs{"-o", "image.exr", "--aov", "Z"};
    CHECK(place.render_tests(aovs));
    CHECK_FALSE(place.render_tests(aovs));

    std::vector<fs::path> records;
    for (const auto& entry : fs::directory_iterator(place.cache)) records.push_back(entry.path());
    REQUIRE(records.size() == 2);
    for (const fs::path& record : records) {
        const std::string good = read_file(record);
        write_file(record, good.substr(0, good.size() / 2));
    }
    CHECK(place.render_tests());
    CHECK_FALSE(place.render_tests());
    for (const fs::path& record : records) {
        std::string damaged = read_file(record);
        damaged[48] ^= 1;  // the word that says so
        write_file(record, damaged);
    }
    CHECK(place.render_tests());

    break_kernel(place.kernels, {"", "sphere.h", "float4 half_chord", "/* other */ float4 half_chord"});
    CHECK(place.render_tests());
}

TEST_CASE("self-test: without a cache folder every process tests", "[cli][self_test]") {
    Place place;
    for (const char* name : {"HOME", "XDG_CACHE_HOME", "SAHL_CACHE_DIR"})
        place.options.environment[name] = std::nullopt;
    CHECK(place.render_tests());
    CHECK(place.render_tests());
}

TEST_CASE("self-test: devices --test says of each kernel what was found", "[cli][self_test]") {
    const Place place;
    const ProcessResult text = place.run({"devices", "--test"});
    INFO(text.out << text.err);
    CHECK(text.status == 0);
    CHECK(contains(text.out, "driver "));
    CHECK(contains(text.out, "      passed\n"));
    CHECK(!contains(text.out, "WRONG"));
    for (const Fault& fault : one_a_kernel) CHECK(contains(text.out, "\n      " + fault.kernel + " "));
    CHECK(contains(text.out, " answers, all right, worst difference "));

    const std::vector<nlohmann::json> events = json_lines(place.run({"devices", "--test", "--json"}).out);
    const std::size_t kernels = one_a_kernel.size() + 1;  // and of batches whose rays go any way
    REQUIRE(events.size() >= kernels + 1);
    for (std::size_t i = 0; i < kernels; ++i) {
        CHECK(events[i].at("event") == "kernel_test");
        CHECK(events[i].at("passed") == true);
        CHECK(events[i].at("checked") > 100);
        CHECK(events[i].at("worst_difference") <= events[i].at("allowed_difference"));
    }
    CHECK(events[kernels].at("event") == "device_test");
    CHECK(events[kernels].at("passed") == true);
    // It is the same record that renders look at.
    CHECK_FALSE(place.render_tests());

    const ProcessResult missing = place.run({"devices", "--test", "--device", "9999"});
    CHECK(missing.status == 4);
    CHECK(contains(missing.err, "9999"));
}

TEST_CASE(
    "self-test: the kernel of rays that go any way is tested before its first use, while an image is "
    "rendered",
    "[cli][self_test]") {
    const Place place;
    // A pile of mirroring balls, each a few pixels large.
    std::string scene = "v\nfrom 0 0 6\nat 0 0 0\nup 0 1 0\nangle 50\nhither 1\nresolution 320 320\n";
    scene += "b 0.3 0.5 0.9\nf 1 1 1 0 0.9 30 0 1\n";
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-3, 3);
    for (int i = 0; i < 2000; ++i)
        scene += fmt::format("s {} {} {} 0.12\n", uniform(random), uniform(random), uniform(random) / 3);
    write_file(place.work / "pile.nff", scene);
    const std::vector<std::string> render{"render",  "pile.nff", "-o",    "image.png",
                                          "--depth", "3",        "--spp", "8"};
    CHECK(place.run(render).status == 0);
    fs::remove(place.work / "image.png");

    break_kernel(place.kernels, {"intersect_stream", "traverse_stream.h", "ray->state.inside_of = i + 1u",
                                 "ray->state.inside_of = i"});
    const ProcessResult broken = place.run(render);
    INFO(broken.err);
    CHECK(broken.status == 4);
    CHECK(contains(broken.err, "computes wrongly: kernel intersect_stream, "));
    CHECK_FALSE(fs::exists(place.work / "image.png"));
    const ProcessResult tested = place.run({"devices", "--test", "--device", "0"});
    CHECK(tested.status == 4);
    CHECK(contains(tested.out, "FAILED: kernel intersect_stream is wrong"));
}

TEST_CASE("self-test: devices --test ends with 4 at a wrong kernel and tests it each time",
          "[cli][self_test]") {
    const Place place;
    break_kernel(place.kernels, one_a_kernel[2]);
    for (int run = 0; run < 2; ++run) {
        const ProcessResult result = place.run({"devices", "--test", "--device", "0"});
        INFO(result.out << result.err);
        CHECK(result.status == 4);
        CHECK(contains(result.out, "intersect"));
        CHECK(contains(result.out, "WRONG: ray "));
        CHECK(contains(result.out, "not reached"));
        CHECK(contains(result.out, "FAILED: kernel shade is wrong"));
        CHECK(contains(result.err, "failed the self-test: "));
    }
    const ProcessResult json = place.run({"devices", "--test", "--json"});
    CHECK(json.status == 4);
    int failed = 0;
    for (const nlohmann::json& event : json_lines(json.out)) {
        if (event.at("event") != "kernel_test" || event.at("failure") == "") continue;
        ++failed;
        CHECK(event.at("kernel") == "shade");
        CHECK(event.at("passed") == false);
    }
    CHECK(failed >= 1);
}

}  // namespace
}  // namespace sahl::tests
