// The real program's first start, without a program cache: kernels are compiled by two processes.
#include <OpenImageIO/imageio.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "engine/film/image_io.h"
#include "engine/render/renderer.h"
#include "tests/cli/sahl_program.h"
#include "tests/support/kernel_runner.h"

#define SAHL_REQUIRE_PROCESSORS                                           \
    if (std::thread::hardware_concurrency() < 2) {                        \
        WARN("SKIPPED: compiling in two processes takes two processors"); \
        return;                                                           \
    }

namespace sahl::tests {
namespace {

namespace fs = std::filesystem;

/// `sahl` without a program cache, and with temporary files of its own.
struct FirstStart {
    TemporaryFolder folder, temporary, cache;
    ProcessOptions options;

    FirstStart() {
        options.working_directory = folder.path();
        options.environment["TMPDIR"] = temporary.path().string();
        options.environment["SAHL_CACHE_DIR"] = cache.path().string();
    }
    ProcessResult run(const std::vector<std::string>& arguments) const {
        return run_sahl(arguments, options);
    }
};

std::vector<std::string> render_arguments() {
    return {"render", scene_file("cli_mirrors.nff"), "-v", "-o", "a.exr"};
}

/// All channels of the image, AOVs too.
std::vector<float> all_channels(const fs::path& path) {
    const auto input = OIIO::ImageInput::open(path.string());
    REQUIRE(input);
    const OIIO::ImageSpec& spec = input->spec();
    std::vector<float> values(spec.image_pixels() * static_cast<std::size_t>(spec.nchannels));
    REQUIRE(input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, values.data()));
    return values;
}

/// The helper of `process`, as soon as it works for it.
pid_t helper_of(const Process& process) {
    pid_t helper = -1;
    REQUIRE(comes_true([&] {
        for (const pid_t child : children_of(process.id()))
            if (content_of("/proc/" + std::to_string(child) + "/cmdline").starts_with("sahl-compiler"))
                helper = child;
        return helper >= 0;
    }));
    return helper;
}

}  // namespace

TEST_CASE("first start: kernels that another process compiles are tested, counted and stored", "[cli]") {
    SAHL_REQUIRE_PROCESSORS
    std::vector<int> compiled;
    std::vector<std::vector<float>> images;
    for (const std::vector<std::string>& threads : {std::vector<std::string>{}, {"--threads", "1"}}) {
        const FirstStart start;
        std::vector<std::string> warm{"warm", "-v", "--json", "--traversal", "packet"};
        warm.insert(warm.end(), threads.begin(), threads.end());
        const ProcessResult first = start.run(warm);
        INFO(first.err);
        REQUIRE(first.status == 0);
        CHECK(contains(first.err, "4 kernels were compiled by another process") == threads.empty());
        compiled.push_back(json_lines(first.out).back().at("compiled"));
        CHECK(json_lines(start.run(warm).out).back().at("compiled") == 0);
        CHECK(start.run(render_arguments()).status == 0);
        images.push_back(read_image(start.folder / "a.exr").pixels);
        CHECK(start.temporary.entries() == 0);
    }
    CHECK(compiled[0] == compiled[1]);
    CHECK(images[0] == images[1]);
}

TEST_CASE(
    "first start: small images have kernels that are not optimized, unless others are cached: the same bits",
    "[cli]") {
    constexpr const char* says_so = "kernels that are not optimized";
    const FirstStart start;
    const auto render = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments = render_arguments();
        arguments.insert(arguments.end(), {"--aov", "all"});
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProcessResult result = start.run(arguments);
        INFO(result.err);
        CHECK(result.status == 0);
        return result.err;
    };
    const std::string first = render({});
    CHECK(contains(first, says_so));
    CHECK(contains(first, "of 7 kernels are right"));
    const bool has_helper = std::thread::hardware_concurrency() > 1;
    CHECK(contains(first, "4 kernels were compiled by another process") == has_helper);
    const std::vector<float> values = all_channels(start.folder / "a.exr");
    const std::string second = render({});
    CHECK(contains(second, says_so));
    CHECK_FALSE(contains(second, "are right"));  // it is known
    CHECK(
        contains(start.run({"explain", scene_file("cli_mirrors.nff"), "--pixel", "1,2", "-v"}).err, says_so));

    CHECK_FALSE(contains(render({"--size", "400x300", "-o", "large.exr"}), says_so));
    CHECK_FALSE(contains(render({}), says_so));
    CHECK(all_channels(start.folder / "a.exr") == values);
}

TEST_CASE(
    "first start: a job's samples, generations, lights and images decide whether it is worth optimizing") {
    MemoryRequest job;
    job.samples = 1U << 15U;
    job.depth = 3;
    job.light_count = 1;
    CHECK(compilation_for(job) == Compilation::quick);
    CHECK(compilation_for(job, 2) == Compilation::optimized);
    ++job.samples;
    CHECK(compilation_for(job) == Compilation::optimized);
    job.depth = 2;
    CHECK(compilation_for(job) == Compilation::quick);
    job.light_count = 2;
    CHECK(compilation_for(job) == Compilation::optimized);
}

TEST_CASE("first start: if the other process ends early, this one compiles all", "[cli]") {
    SAHL_REQUIRE_PROCESSORS
    for (const int signal :
         full_tests() ? std::vector<int>{SIGKILL, SIGTERM, SIGABRT} : std::vector<int>{SIGKILL}) {
        const FirstStart start;
        Process process(sahl_command(render_arguments()), start.options);
        CHECK(::kill(helper_of(process), signal) == 0);
        const ProcessResult result = process.finish();
        INFO(result.err);
        CHECK(result.status == 0);
        CHECK(contains(result.err, "0 kernels were compiled by another process"));
        CHECK(contains(result.err, "of 7 kernels are right"));
    }
}

TEST_CASE("first start: whatever ends this process ends the other, which leaves nothing", "[cli]") {
    SAHL_REQUIRE_PROCESSORS
    const int signal = GENERATE(SIGKILL, SIGTERM);
    const FirstStart start;
    Process process(sahl_command(render_arguments()), start.options);
    const pid_t helper = helper_of(process);
    process.send_signal(signal);
    CHECK(process.finish().status == 128 + signal);
    CHECK(comes_true([&] { return !fs::exists("/proc/" + std::to_string(helper)); }));
    // Of the one that was killed, its folder: the next one removes it.
    CHECK(start.temporary.entries() == (signal == SIGKILL ? 1 : 0));
}

}  // namespace sahl::tests
