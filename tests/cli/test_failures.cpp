// The real program where disks are full, drivers are missing, caches are damaged, and when it is killed.
#include <chrono>
#include <csignal>
#include <fstream>
#include <memory>
#include <random>
#include <thread>

#include <catch2/catch.hpp>

#include "engine/film/image_io.h"
#include "tests/cli/sahl_program.h"
#include "tests/support/kernel_runner.h"
#include "tests/support/small_disk.h"

#define SAHL_REQUIRE_DISK(disk)                                   \
    if (!(disk).mounted()) {                                      \
        WARN("SKIPPED: mounting a small file system takes root"); \
        return;                                                   \
    }

namespace sahl::tests {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// `sahl render` of a small scene into a folder of its own.
struct Render {
    std::vector<std::string> arguments{"render", scene_file("cli_mirrors.nff"), "--pixel-type", "float"};
    ProcessOptions options;

    Render(const fs::path& folder, std::vector<std::string> more) {
        options.working_directory = folder;
        arguments.insert(arguments.end(), more.begin(), more.end());
    }
    Render& with(const std::string& variable, std::optional<std::string> value) {
        options.environment[variable] = std::move(value);
        return *this;
    }
    ProcessResult run() const { return run_sahl(arguments, options); }
};

std::vector<float> pixels(const fs::path& path) { return read_image(path).pixels; }

int repeats(int in_short, int in_full) { return full_tests() ? in_full : in_short; }

/// A moment of something that takes so many seconds.
std::chrono::duration<double> moment(std::mt19937& random, double seconds) {
    return std::chrono::duration<double>(std::uniform_real_distribution<>(0, seconds)(random));
}

bool has_folder_of_pocl(const fs::path& temporary) {
    for (const auto& entry : fs::directory_iterator(temporary))
        if (contains(entry.path().filename().string(), "sahl-pocl-")) return true;
    return false;
}

}  // namespace

TEST_CASE("failures: an image on a full disk is exit status 6 and the old file stays", "[cli]") {
    const SmallDisk disk(512 * 1024);
    SAHL_REQUIRE_DISK(disk);
    const Render render(disk.path(),
                        {"-o", "a.exr", "-o", "b.exr", "--size", "96x64", "--compression", "none"});
    REQUIRE(render.run().status == 0);
    const std::string whole = content_of(disk / "a.exr");  // 74 KB
    int failed = 0;
    const int steps = repeats(6, 40);
    for (int i = 0; i < steps; ++i) {
        const auto left = static_cast<std::size_t>(i * 256 * 1024 / steps);
        INFO(left << " bytes are free");
        fs::remove(disk / "filler");
        write_file(disk / "a.exr", "old");
        write_file(disk / "b.exr", "old");
        disk.fill(left);
        const ProcessResult result = render.run();
        INFO(result.err);
        CHECK((result.status == 0 || result.status == 6));
        for (const char* name : {"a.exr", "b.exr"}) {
            const std::string content = content_of(disk / name);
            CHECK((content == "old" || content.size() == whole.size()));
            if (result.status == 0) CHECK(pixels(disk / name).size() == 96 * 64 * 3);
        }
        if (result.status != 0) {
            ++failed;
            CHECK(contains(result.err, "No space left on device; free some space or write to another disk"));
            CHECK(content_of(disk / "b.exr") == "old");
        }
        CHECK(disk.entries() == 3);
    }
    CHECK(failed > 0);
    CHECK(failed < steps);
}

TEST_CASE("failures: a full disk under PoCL is exit status 4 or none, whenever it fills up", "[cli]") {
    const TemporaryFolder folder;
    const fs::path cold = folder / "cold";
    std::mt19937 random(5);
    for (int i = 0; i < repeats(3, 20); ++i) {
        const SmallDisk disk(40 << 20);
        SAHL_REQUIRE_DISK(disk);
        fs::remove_all(cold);
        const auto when = moment(random, 4);
        INFO("after " << when.count() << " s");
        std::jthread filler([&disk, when] {
            std::this_thread::sleep_for(when);
            disk.fill();
        });
        const ProcessResult result = Render(folder.path(), {"-o", "a.exr"})
                                         .with("TMPDIR", disk.path().string())
                                         .with("SAHL_CACHE_DIR", cold.string())
                                         .with("POCL_SIGFPE_HANDLER", std::nullopt)  // as users have it
                                         .run();
        filler.join();
        INFO(result.err);
        CHECK((result.status == 0 || result.status == 4));
        if (result.status != 0) CHECK(contains(result.err, "TMPDIR"));
        CHECK(fs::exists(folder / "a.exr") == (result.status == 0));
        CHECK_FALSE(has_folder_of_pocl(disk.path()));
        fs::remove(folder / "a.exr");
    }
}

TEST_CASE("failures: a TMPDIR that is full, noexec, read-only or not there is exit status 4", "[cli]") {
    const TemporaryFolder folder;
    const SmallDisk full(1 << 20);
    const SmallDisk noexec(64 << 20, MS_NOEXEC);
    const SmallDisk read_only(64 << 20);
    SAHL_REQUIRE_DISK(full);
    full.fill();
    read_only.make_read_only();
    for (const fs::path& temporary : {full.path(), noexec.path(), read_only.path(), folder / "none"}) {
        const ProcessResult result =
            Render(folder.path(), {"-o", "a.exr"}).with("TMPDIR", temporary.string()).run();
        INFO(result.err);
        CHECK(result.status == 4);
        CHECK(contains(result.err, temporary.string()));
        CHECK(contains(result.err, "set TMPDIR to"));
        CHECK(folder.entries() == 0);
    }
}

TEST_CASE("failures: a low file size limit is exit status 4 and says how to raise it", "[cli]") {
    const TemporaryFolder folder;
    std::vector<std::string> command =
        sahl_command({"render", scene_file("cli_mirrors.nff"), "-o", (folder / "a.exr").string()});
    command.insert(command.begin(), {"/bin/sh", "-c", "ulimit -f 1000; exec \"$0\" \"$@\""});
    const ProcessResult result = run_process(command);
    INFO(result.err);
    CHECK(result.status == 4);
    CHECK(contains(result.err, "ulimit -f"));
    CHECK(folder.entries() == 0);
}

TEST_CASE("failures: a cache that is full, noexec or read-only costs time alone", "[cli]") {
    const TemporaryFolder folder;
    REQUIRE(Render(folder.path(), {"-o", "good.exr"}).run().status == 0);
    const SmallDisk full(64 * 1024);
    const SmallDisk noexec(4 << 20, MS_NOEXEC);
    const SmallDisk read_only(4 << 20);
    SAHL_REQUIRE_DISK(full);
    read_only.make_read_only();
    for (const SmallDisk* cache : {&full, &noexec, &read_only}) {
        const ProcessResult result =
            Render(folder.path(), {"-o", "a.exr"}).with("SAHL_CACHE_DIR", cache->path().string()).run();
        INFO(result.err);
        CHECK(result.status == 0);
        CHECK(pixels(folder / "a.exr") == pixels(folder / "good.exr"));
    }
    CHECK(full.entries() == 0);  // no half file
    CHECK(noexec.entries() > 0);
}

TEST_CASE("failures: damaged cache files are rebuilt, the pixels stay the same", "[cli]") {
    const TemporaryFolder folder;
    const TemporaryFolder cache;
    Render render(folder.path(), {"-o", "a.exr"});
    render.with("SAHL_CACHE_DIR", cache.path().string());
    REQUIRE(render.run().status == 0);
    const std::vector<float> good_pixels = pixels(folder / "a.exr");
    REQUIRE(cache.entries() > 0);
    const fs::path file = fs::directory_iterator(cache.path())->path();
    const std::string good = content_of(file);
    std::mt19937 random(6);
    for (int i = 0; i < repeats(2, 40); ++i) {
        std::string bad = good;
        const std::size_t place = std::uniform_int_distribution<std::size_t>(0, good.size() - 1)(random);
        if (i % 2 == 0) {
            bad[place] = static_cast<char>(bad[place] ^ (1 << i % 8));
        } else {
            bad.resize(place);
        }
        INFO((i % 2 == 0 ? "flipped at " : "cut at ") << place);
        write_file(file, bad);
        const ProcessResult result = render.run();
        INFO(result.err);
        CHECK(result.status == 0);
        CHECK(pixels(folder / "a.exr") == good_pixels);
        CHECK((content_of(file) != bad));  // stored anew
    }
}

TEST_CASE("failures: read-only folders, /dev/full, /dev/null and links as images", "[cli]") {
    const TemporaryFolder folder;
    const auto render = [&](const std::string& output) {
        return Render(folder.path(), {"-o", output}).run();
    };
    const SmallDisk disk(1 << 20);
    SAHL_REQUIRE_DISK(disk);
    write_file(disk / "a.exr", "old");
    disk.make_read_only();
    const ProcessResult read_only = render((disk / "a.exr").string());
    INFO(read_only.err);
    CHECK(read_only.status == 6);
    CHECK(contains(read_only.err, "choose a folder that you may write to"));
    CHECK(content_of(disk / "a.exr") == "old");

    fs::create_symlink("/dev/full", folder / "full.exr");
    fs::create_symlink("/dev/null", folder / "null.exr");
    CHECK(render("full.exr").status == 6);
    CHECK(render("null.exr").status == 0);
    CHECK(fs::is_character_file("/dev/null"));
    CHECK(fs::is_character_file("/dev/full"));
    CHECK(folder.entries() == 2);

    write_file(folder / "target.exr", "old");
    fs::create_symlink("target.exr", folder / "link.exr");
    CHECK(render("link.exr").status == 0);
    CHECK(fs::is_symlink(folder / "link.exr"));
    CHECK(pixels(folder / "target.exr").size() == 48 * 32 * 3);
}

TEST_CASE("failures: OpenCL drivers that are missing, empty or none are exit status 4 with a remedy",
          "[cli]") {
    for (const char* content : {"", "\n", "/nonexistent/libOpenCL-driver.so\n", "libm.so.6\n"}) {
        const TemporaryFolder folder;
        write_file(folder / "wrong.icd", content);
        const ProcessResult result = Render(folder.path(), {"-o", "a.exr"})
                                         .with("OCL_ICD_VENDORS", folder.path().string())
                                         .with("OCL_ICD_FILENAMES", std::nullopt)
                                         .run();
        INFO("driver '" << content << "': " << result.err);
        CHECK(result.status == 4);
        CHECK(contains(result.err, "apt-get install pocl-opencl-icd"));
        CHECK(folder.entries() == 1);
    }
}

TEST_CASE("failures: without HOME and a cache folder the image is the same, and nothing is left", "[cli]") {
    const TemporaryFolder folder;
    const TemporaryFolder temporary;
    REQUIRE(Render(folder.path(), {"-o", "good.exr"}).run().status == 0);
    const ProcessResult result = Render(folder.path(), {"-o", "a.exr"})
                                     .with("HOME", std::nullopt)
                                     .with("XDG_CACHE_HOME", std::nullopt)
                                     .with("SAHL_CACHE_DIR", std::nullopt)
                                     .with("TMPDIR", temporary.path().string())
                                     .run();
    INFO(result.err);
    CHECK(result.status == 0);
    CHECK(pixels(folder / "a.exr") == pixels(folder / "good.exr"));
    CHECK(folder.entries() == 2);
    CHECK(temporary.entries() == 0);
}

TEST_CASE("failures: programs that start cold at once make the same image and one cache", "[cli]") {
    for (const int programs : full_tests() ? std::vector<int>{2, 6} : std::vector<int>{2}) {
        const TemporaryFolder folder;
        const TemporaryFolder cache;
        std::vector<std::unique_ptr<Process>> running;
        for (int i = 0; i < programs; ++i) {
            Render render(folder.path(), {"-o", std::to_string(i) + ".exr"});
            render.with("SAHL_CACHE_DIR", cache.path().string());
            running.push_back(std::make_unique<Process>(sahl_command(render.arguments), render.options));
        }
        for (int i = 0; i < programs; ++i) {
            const ProcessResult result = running[static_cast<std::size_t>(i)]->finish();
            INFO(result.err);
            CHECK(result.status == 0);
            CHECK(pixels(folder / (std::to_string(i) + ".exr")) == pixels(folder / "0.exr"));
        }
        CHECK(cache.entries() == 1);
    }
}

TEST_CASE("failures: killed at any moment, no file is broken, and the next run tidies up", "[cli]") {
    const TemporaryFolder folder;
    const TemporaryFolder temporary;
    const TemporaryFolder cache;
    Render render(folder.path(), {"-o", "a.exr", "--size", "640x400", "--compression", "none"});
    render.with("TMPDIR", temporary.path().string()).with("SAHL_CACHE_DIR", cache.path().string());
    REQUIRE(render.run().status == 0);
    const Clock::time_point start = Clock::now();
    REQUIRE(render.run().status == 0);
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    const std::vector<float> whole = pixels(folder / "a.exr");
    std::mt19937 random(7);
    for (int i = 0; i < repeats(10, 100); ++i) {
        if (i % 5 == 0)  // a cold one
            for (const auto& entry : fs::directory_iterator(cache.path())) fs::remove(entry.path());
        write_file(folder / "a.exr", "old");
        const auto when = moment(random, seconds);
        INFO("after " << when.count() << " s");
        Process process(sahl_command(render.arguments), render.options);
        std::this_thread::sleep_for(when);
        process.send_signal(SIGKILL);
        const int status = process.finish().status;
        CHECK((status == 128 + SIGKILL || status == 0));
        if (content_of(folder / "a.exr") != "old") CHECK(pixels(folder / "a.exr") == whole);
        if (fs::is_empty(cache.path())) REQUIRE(render.run().status == 0);
    }
    // What is likely to be left, for certain: by killed writers of the image and of the cache.
    write_file(folder / ".a.exr.part-12345", "half");
    write_file(cache / ".0123456789abcdef.sahl-program.part-12345", "half");
    fs::create_directory(temporary / "sahl-pocl-12345-abcdef");
    for (const auto& entry : fs::directory_iterator(cache.path()))
        if (entry.path().extension() == ".sahl-program") fs::remove(entry.path());
    REQUIRE(render.run().status == 0);
    CHECK(pixels(folder / "a.exr") == whole);
    CHECK(folder.entries() == 1);
    CHECK(temporary.entries() == 0);
    CHECK(cache.entries() <= 2);
    CHECK_FALSE(fs::exists(cache / ".0123456789abcdef.sahl-program.part-12345"));
}

}  // namespace sahl::tests
