// `sahl batch` where something goes wrong: workers and supervisors that die, full disks, broken scenes,
// several batches at once.
#include <csignal>
#include <ctime>
#include <fstream>
#include <functional>
#include <memory>
#include <random>
#include <set>
#include <thread>

#include <catch2/catch.hpp>

#include "engine/film/image_io.h"
#include "tests/cli/batch_night.h"
#include "tests/support/kernel_runner.h"
#include "tests/support/small_disk.h"

namespace sahl::tests {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

int count(int in_short, int in_full) { return full_tests() ? in_full : in_short; }

void wait_until_dead(pid_t process) {
    // It is the child of nobody here: /proc is what there is to ask.
    while (fs::exists("/proc/" + std::to_string(process)))
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

using Pixels = std::map<std::string, std::vector<float>>;

Pixels pixels_of(const Night& night) {
    Pixels pixels;
    for (const auto& [name, identity] : night.files())
        if (name.ends_with(".exr") && !name.starts_with('.'))
            pixels[name] = read_image(night.folder / "out" / name).pixels;
    return pixels;
}

/// Kills what `victim` chooses at a random moment of a batch, again and again until it is done; each file
/// that is there after a kill has to be whole and to stay as it is.
void kill_until_done(const Night& night, const Pixels& wanted, double seconds, std::mt19937& random,
                     int& kills, const std::function<pid_t(const Process&)>& victim) {
    std::map<std::string, FileIdentity> finished;
    for (int i = 0;; ++i) {
        REQUIRE(i < 200);
        // Later and later, as the machine may have become slower.
        const double latest = seconds * (1 + i / 8.0);
        const std::chrono::duration<double> when(std::uniform_real_distribution<>(0, latest)(random));
        INFO("kill " << kills << " after " << when.count() << " s");
        Process process(night.command(), night.options);
        std::this_thread::sleep_for(when);
        const pid_t killed = victim(process);
        const std::vector<pid_t> workers = children_of(process.id());
        if (killed > 0 && ::kill(killed, SIGKILL) == 0) ++kills;
        const ProcessResult result = process.finish();
        INFO(result.err);
        for (const pid_t worker : workers) wait_until_dead(worker);
        for (const auto& [name, identity] : finished)
            CHECK(identity_of(night.folder / "out" / name) == identity);
        for (const auto& [name, pixels] : pixels_of(night)) {
            CHECK(pixels == wanted.at(name));
            finished[name] = identity_of(night.folder / "out" / name);
        }
        if (result.status == 0) break;
        CHECK(result.status == 128 + SIGKILL);
    }
    CHECK(finished.size() == wanted.size());
    CHECK(pixels_of(night) == wanted);
    CHECK(night.files().size() == wanted.size());  // nothing is left beside them
}

double seconds_of(const Night& night) {
    const Clock::time_point start = Clock::now();
    REQUIRE(night.run().status == 0);
    return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

TEST_CASE("batch failures: the supervisor killed at any moment loses no finished image and breaks none",
          "[cli][batch]") {
    const std::string frames = full_tests() ? "1-60" : "1-12";
    const Night whole(frames);
    whole.run();
    fs::remove_all(whole.folder / "out");
    const double seconds = seconds_of(whole);
    const Pixels wanted = pixels_of(whole);
    std::mt19937 random(11);
    int kills = 0;
    for (int round = 0; kills < count(4, 100) && round < 100; ++round) {
        const Night night(frames);
        kill_until_done(night, wanted, seconds, random, kills,
                        [](const Process& process) { return process.id(); });
    }
    CHECK(kills >= count(4, 100));
}

TEST_CASE("batch failures: a worker killed at any moment is replaced, and the batch is finished",
          "[cli][batch]") {
    const std::string frames = full_tests() ? "1-60" : "1-12";
    const Night whole(frames);
    whole.run();
    fs::remove_all(whole.folder / "out");
    double seconds = seconds_of(whole);
    const Pixels wanted = pixels_of(whole);
    std::mt19937 random(12);
    int kills = 0;
    for (int round = 0; kills < count(4, 100) && round < 400; ++round) {
        const Night night(frames);
        const int kills_before = kills;
        const Clock::time_point start = Clock::now();
        kill_until_done(night, wanted, seconds, random, kills, [](const Process& process) {
            const std::vector<pid_t> workers = children_of(process.id());
            return workers.empty() ? 0 : workers.front();
        });
        // Too late, or too early: the machine is faster now, or slower.
        if (kills == kills_before) seconds = std::chrono::duration<double>(Clock::now() - start).count();
    }
    CHECK(kills >= count(4, 100));
}

TEST_CASE("batch failures: a job whose worker crashes, hangs or runs out of memory fails alone, with a log",
          "[cli][batch]") {
    for (const std::string misdeed : {"crash", "hang", "memory"}) {
        Night night("1-4");
        night.options.environment["SAHL_FAIL_JOB"] = misdeed + ":0002";
        const ProcessResult result =
            night.run({"--timeout", misdeed == "hang" ? "2" : "60", "--export-html", "s.html"});
        INFO(misdeed << ": " << result.err);
        CHECK(result.status == 8);
        CHECK(events(result, "image").size() == 3);
        // The image before it may have been on its way to the disk; then it is made again.
        CHECK(events(result, "retry").size() <= 2);
        CHECK(events(result, "retry").back().at("paths") == nlohmann::json({"out/0002.exr"}));
        const std::vector<nlohmann::json> failed = events(result, "failed");
        REQUIRE(failed.size() == 1);
        CHECK(failed[0].at("paths") == nlohmann::json({"out/0002.exr"}));
        const std::string message = failed[0].at("message");
        if (misdeed == "crash") CHECK(contains(message, "Segmentation fault"));
        if (misdeed == "hang") CHECK(contains(message, "no progress for 2 s"));
        if (misdeed == "memory") CHECK(failed[0].at("code") == 5);
        CHECK(contains(content_of(night.folder / "s.html"), "class=\"failed\""));
        if (misdeed == "memory") continue;
        CHECK(contains(content_of(night.folder / "out/0002.exr.log"), message));
        // Once it works, nothing tells of it.
        night.options.environment["SAHL_FAIL_JOB"] = std::nullopt;
        const ProcessResult again = night.run();
        CHECK(again.status == 0);
        CHECK(events(again, "image").size() == 1);
        CHECK(night.files().size() == 4);
    }
}

TEST_CASE("batch failures: a broken scene among others fails alone", "[cli][batch]") {
    const Night night("1");
    write_file(night.folder / "broken.json", "{\"sahl\": 1,");
    write_file(night.folder / "wrong.json", R"({"sahl": 1, "objcts": []})");
    const ProcessResult result = run_sahl_in(
        night.folder.path(), {"batch", "broken.json", "wrong.json", "gone.nff", "balls.json", "--json"});
    INFO(result.err);
    CHECK(result.status == 8);
    CHECK(events(result, "image").size() == 1);
    CHECK(events(result, "failed").size() == 3);
    CHECK(events(result, "retry").empty());
    CHECK(contains(result.err, "wrong.json:1:13: unknown key 'objcts'"));
    CHECK(fs::exists(night.folder / "balls.png"));
}

TEST_CASE("batch failures: on a full disk it ends with 6 or 8, and what was written stays", "[cli][batch]") {
    int failed = 0;
    const int steps = count(3, 40);
    for (int i = 0; i < steps; ++i) {
        const SmallDisk disk(1 << 20);
        if (!disk.mounted()) {
            WARN("SKIPPED: mounting a small file system takes root");
            return;
        }
        const Night night("1-8", "\"" + (disk / "{frame}.exr").string() + "\"",
                          R"({"size": [96, 64], "compression": "none"})");
        const auto left = static_cast<std::size_t>(i * 448 * 1024 / steps);
        INFO(left << " bytes are free");
        disk.fill(left);
        const ProcessResult result = night.run();
        INFO(result.err);
        CHECK((result.status == 0 || result.status == 6 || result.status == 8));
        if (result.status != 0) ++failed;
        std::map<std::string, FileIdentity> whole;
        for (const auto& entry : fs::directory_iterator(disk.path())) {
            if (entry.path().extension() != ".exr") continue;
            CHECK(read_image(entry.path()).width == 96);
            whole[entry.path().string()] = identity_of(entry.path());
        }
        CHECK(whole.size() == events(result, "image").size());
        fs::remove(disk / "filler");
        CHECK(night.run().status == 0);
        for (const auto& [path, identity] : whole) CHECK(identity_of(path) == identity);
    }
    CHECK(failed > 0);
}

TEST_CASE("batch failures: a read-only folder ends it before any work, and can be checked", "[cli][batch]") {
    const SmallDisk disk(1 << 20);
    if (!disk.mounted()) {
        WARN("SKIPPED: mounting a small file system takes root");
        return;
    }
    const std::string on_disk = "\"" + (disk / "{frame}.png").string() + "\"";
    const Night night("1-3", "[\"out/{frame}.png\", " + on_disk + "]");
    REQUIRE(night.run().status == 0);
    disk.make_read_only();
    const auto files = night.files();
    CHECK(night.run({"--check"}).status == 0);
    CHECK(night.run().status == 0);  // nothing is to be done
    fs::remove(night.folder / "out/2.png");
    const ProcessResult result = night.run();
    INFO(result.err);
    CHECK(result.status == 6);
    CHECK(events(result, "render").empty());
    CHECK(contains(result.err, "choose a folder that you may write to"));
    CHECK_FALSE(fs::exists(night.folder / "out/2.png"));
    CHECK(night.files().at("1.png") == files.at("1.png"));
    CHECK(night.run({"--check"}).status == 7);
}

TEST_CASE("batch failures: a clock that is set back changes nothing", "[cli][batch]") {
    fs::path library;
    for (const auto& folder : fs::directory_iterator("/usr/lib"))
        if (fs::exists(folder.path() / "faketime/libfaketime.so.1"))
            library = folder.path() / "faketime/libfaketime.so.1";
    if (library.empty()) {
        WARN("SKIPPED: libfaketime is not installed");
        return;
    }
    Night night("1-6");
    night.write_manifest("1-3", "\"out/{frame:04}.exr\"", "{}");
    REQUIRE(night.run().status == 0);
    const auto before = night.files();
    // First a day back, then, while it runs, more than a year.
    write_file(night.folder / "clock", "-1d");
    night.options.environment = {{"LD_PRELOAD", library.string()},
                                 {"FAKETIME_TIMESTAMP_FILE", (night.folder / "clock").string()},
                                 {"FAKETIME_NO_CACHE", "1"},
                                 {"FAKETIME_DONT_FAKE_MONOTONIC", "1"}};
    night.write_manifest("1-6", "\"out/{frame:04}.exr\"", "{}");
    Process process(night.command({"--status", "status.json"}), night.options);
    process.wait_for_output();
    write_file(night.folder / "clock", "-400d");
    const ProcessResult result = process.finish();
    INFO(result.err);
    CHECK(result.status == 0);
    CHECK(events(result, "image").size() == 3);
    const nlohmann::json status = nlohmann::json::parse(content_of(night.folder / "status.json"));
    CHECK(status.at("updated").get<std::int64_t>() < std::time(nullptr) - 300 * 86400);  // it was set back
    CHECK(status.at("elapsed_seconds") >= 0);
    const auto after = night.files();
    CHECK(after.size() == 6);
    for (const auto& [name, identity] : before) CHECK(after.at(name) == identity);
    night.options.environment = {};
    REQUIRE(night.run().status == 0);
    CHECK(night.files() == after);
}

TEST_CASE("batch failures: it goes on when nobody reads what it says", "[cli][batch]") {
    const auto run = [](const Night& night, const std::string& script) {
        std::vector<std::string> command{"/bin/sh", "-c", script};
        const std::vector<std::string> batch = night.command();
        command.insert(command.end(), batch.begin(), batch.end());
        return run_process(command, night.options).status;
    };
    for (const char* redirected : {"\"$0\" \"$@\" 2>/dev/full", "\"$0\" \"$@\" <&- 2>&-"}) {
        const Night night("1-3");
        INFO(redirected);
        CHECK(run(night, redirected) == 0);
        CHECK(night.run({"--check"}).status == 0);
    }
    // Whoever wants events hears that some were lost: at once, or at the end.
    const Night none("1-3");
    CHECK(run(none, "\"$0\" \"$@\" >/dev/full") == 6);
    CHECK(none.files().empty());
    const Night some("1-20");
    CHECK(run(some, "{ \"$0\" \"$@\"; echo $? >status; } | head -n 1 >first") == 0);
    CHECK(content_of(some.folder / "status") == "6\n");
    CHECK(some.run({"--check"}).status == 0);
}

TEST_CASE("batch failures: SIGTERM to all its processes is SIGTERM to one", "[cli][batch]") {
    const std::string settings = R"({"size": [320, 200], "spp": 200, "pixel_type": "float"})";
    const Night night("1", "\"out/{frame:04}.exr\"", settings);
    std::vector<std::string> command = night.command({"--checkpoint", "0.05"});
    command.insert(command.begin(), "/usr/bin/setsid");  // a group of its own
    Process process(command, night.options);
    REQUIRE(comes_true([&] { return fs::exists(night.folder / "out/.0001.exr.checkpoint"); }));
    const std::vector<pid_t> workers = children_of(process.id());
    REQUIRE(workers.size() == 1);
    CHECK(content_of("/proc/" + std::to_string(workers[0]) + "/cmdline").starts_with("sahl-worker"));
    CHECK(::kill(-process.id(), SIGTERM) == 0);
    const ProcessResult result = process.finish();
    INFO(result.err);
    CHECK(result.status == 128 + SIGTERM);
    CHECK(contains(result.err, "the same command goes on"));
    CHECK(events(result, "stopped").size() == 1);  // by a worker that the signal did not end
}

TEST_CASE("batch failures: several at once on one folder share the work", "[cli][batch]") {
    for (const int processes : {2, 4}) {
        const Night night("1-40");
        std::vector<std::unique_ptr<Process>> batches;
        for (int i = 0; i < processes; ++i)
            batches.push_back(std::make_unique<Process>(night.command(), night.options));
        std::multiset<std::string> rendered;
        for (const auto& batch : batches) {
            const ProcessResult result = batch->finish();
            INFO(result.err);
            CHECK(result.status == 0);
            for (const nlohmann::json& event : events(result, "image"))
                rendered.insert(event.at("paths").at(0));
        }
        CHECK(rendered.size() == 40);
        CHECK(std::set<std::string>(rendered.begin(), rendered.end()).size() == 40);
        CHECK(night.files().size() == 40);
    }
}

TEST_CASE("batch failures: the images of a batch that was killed are finished by another that runs beside it",
          "[cli][batch]") {
    const Night night("1-12");
    Process first(night.command(), night.options);
    first.wait_for_output();
    Process second(night.command(), night.options);
    second.wait_for_output();
    first.send_signal(SIGKILL);
    first.finish();
    const ProcessResult result = second.finish();
    INFO(result.err);
    CHECK(result.status == 0);
    CHECK(night.files().size() == 12);
    CHECK(night.run({"--check"}).status == 0);
}

TEST_CASE("batch failures: a long image goes on from its checkpoint to the same pixels", "[cli][batch]") {
    const std::string settings = R"({"size": [320, 200], "spp": 60, "pixel_type": "float"})";
    const Night whole("1", "\"out/{frame:04}.exr\"", settings);
    REQUIRE(whole.run().status == 0);
    const Pixels wanted = pixels_of(whole);
    std::mt19937 random(13);
    for (const int signal : {SIGKILL, SIGTERM}) {
        const Night night("1", "\"out/{frame:04}.exr\"", settings);
        const fs::path checkpoint = night.folder / "out/.0001.exr.checkpoint";
        std::size_t resumed = 0;
        for (int i = 0; i < count(1, 3); ++i) {
            Process process(night.command({"--checkpoint", "0.05"}), night.options);
            for (int saved = std::uniform_int_distribution(1, count(2, 4))(random); saved > 0; --saved) {
                const FileIdentity before = identity_of(checkpoint);
                const bool saved_again = comes_true([&] {
                    return identity_of(checkpoint) != before || fs::exists(night.folder / "out/0001.exr");
                });
                REQUIRE(saved_again);
            }
            process.send_signal(signal);
            const ProcessResult result = process.finish();
            INFO(result.err);
            resumed += events(result, "resume").size();
            if (result.status == 0) break;
            CHECK(result.status == 128 + signal);
            if (signal != SIGKILL) CHECK(contains(result.err, "the same command goes on"));
        }
        const ProcessResult last = night.run();
        INFO(last.err);
        CHECK(last.status == 0);
        resumed += events(last, "resume").size();
        CHECK(resumed > 0);
        CHECK(pixels_of(night) == wanted);
        CHECK(night.files().size() == 1);
    }
}

TEST_CASE("batch failures: a checkpoint that is damaged or of something else is begun again",
          "[cli][batch]") {
    const Night night("1");
    REQUIRE(night.run().status == 0);
    const Pixels wanted = pixels_of(night);
    fs::remove(night.folder / "out/0001.exr");
    write_file(night.folder / "out/.0001.exr.checkpoint", "SAHLFLM1 and no film");
    const ProcessResult result = night.run();
    CHECK(result.status == 0);
    CHECK(events(result, "resume").empty());
    CHECK(pixels_of(night) == wanted);
    CHECK(night.files().size() == 1);
}

TEST_CASE("batch failures: a scene that is edited while the batch runs makes no image of both",
          "[cli][batch]") {
    const Night night("1-30");
    Process process(night.command(), night.options);
    process.wait_for_output();
    night.write_scene("[0.1, 0.9, 0.1]");
    const ProcessResult result = process.finish();
    INFO(result.err);
    CHECK((result.status == 8 || result.status == 0));
    if (result.status == 8) CHECK(contains(result.err, "was changed after the batch began"));
    const ProcessResult again = night.run();
    CHECK(again.status == 0);
    for (const nlohmann::json& event : events(again, "render")) {
        const std::string reason = event.at("reason");
        CHECK((contains(reason, "materials.red.diffuse changed") || contains(reason, "it is not there")));
    }
    const Pixels edited = pixels_of(night);
    REQUIRE(night.run({"--force"}).status == 0);
    CHECK(pixels_of(night) == edited);
}

}  // namespace sahl::tests
