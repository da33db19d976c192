// SIGINT and SIGTERM at the real program: what is left, and what it says.
#include <OpenImageIO/imageio.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>

#include <array>
#include <chrono>
#include <csignal>
#include <fstream>
#include <random>
#include <thread>

#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "engine/film/image_io.h"
#include "tests/cli/sahl_program.h"
#include "tests/support/kernel_runner.h"

namespace sahl::tests {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

/// Folders for the images and for temporary files.
struct Workplace {
    TemporaryFolder images;
    TemporaryFolder temporary;

    Process render(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), {"render", scene_file("cli_mirrors.nff")});
        return Process(sahl_command(arguments), options());
    }
    ProcessOptions options() const {
        ProcessOptions options;
        options.working_directory = images.path();
        options.environment["TMPDIR"] = temporary.path().string();
        return options;
    }
};

void wait_for_file(const fs::path& path) {
    for (int i = 0; !fs::exists(path) && i < 60000; ++i) std::this_thread::sleep_for(milliseconds(1));
    REQUIRE(fs::exists(path));
}

/// Waits until the program has taken notice of SIGINT: its thread for signals, which alone lets them through
/// from then on, sleeps.
void wait_for_notice(const Process& process) {
    constexpr std::uint64_t sigint = 1U << (SIGINT - 1);
    REQUIRE(comes_true([&] {
        std::error_code gone;
        for (const auto& task : fs::directory_iterator(fmt::format("/proc/{}/task", process.id()), gone)) {
            const std::string status = content_of(task.path() / "status");
            const std::size_t blocked = status.find("SigBlk:\t");
            if (blocked == std::string::npos || !contains(status, "State:\tS")) continue;
            if ((std::stoull(status.substr(blocked + 8), nullptr, 16) & sigint) == 0) return true;
        }
        return false;
    }));
}

void make_fifo(const fs::path& path) { REQUIRE(::mkfifo(path.c_str(), 0600) == 0); }

/// All that one writer puts in, who may come later.
std::string read_fifo(const fs::path& path) {
    const int fifo = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    REQUIRE(fifo >= 0);
    std::string text;
    for (int i = 0; i < 60000; ++i) {
        std::array<char, 65536> bytes{};
        const ssize_t count = ::read(fifo, bytes.data(), bytes.size());
        if (count > 0) text.append(bytes.data(), static_cast<std::size_t>(count));
        if (count == 0 && !text.empty()) break;
        if (count <= 0) std::this_thread::sleep_for(milliseconds(1));
    }
    ::close(fifo);
    return text;
}

struct PixelCounts {
    std::uint64_t lit = 0;    ///< not black
    std::uint64_t equal = 0;  ///< as in the whole image; some of that are black too
};

/// Pixels of `part`, which have to be `whole`'s or black.
PixelCounts count_pixels(const Image& part, const Image& whole) {
    REQUIRE(part.pixels.size() == whole.pixels.size());
    PixelCounts counts;
    std::uint64_t wrong = 0;
    for (std::size_t i = 0; i < whole.pixels.size(); i += 3) {
        const float* p = &part.pixels[i];
        const bool black = p[0] == 0 && p[1] == 0 && p[2] == 0;
        const bool equal = std::equal(p, p + 3, &whole.pixels[i]);
        counts.lit += black ? 0 : 1;
        counts.equal += equal ? 1 : 0;
        wrong += black || equal ? 0 : 1;
    }
    CHECK(wrong == 0);
    return counts;
}

std::string partial_mark(const fs::path& path) {
    const auto input = OIIO::ImageInput::open(path.string());
    REQUIRE(input);
    return input->spec().get_string_attribute("Sahl:Partial");
}

/// Interrupts an endless render later and later until something of it is saved. The old files are in place.
ProcessResult interrupt_endless(const Workplace& workplace, std::vector<std::string> arguments, int signal) {
    arguments.insert(arguments.end(), {"--size", "300x200", "--spp", "16384", "--json"});
    for (milliseconds wait(200); wait < std::chrono::minutes(1); wait *= 2) {
        Process process = workplace.render(arguments);
        REQUIRE(process.wait_for_output());  // the start event
        std::this_thread::sleep_for(wait);
        process.send_signal(signal);
        ProcessResult result = process.finish();
        INFO(result.err);
        REQUIRE(result.status == 128 + signal);
        REQUIRE(workplace.temporary.entries() == 0);
        if (contains(result.err, "saved as ")) return result;
    }
    FAIL("no pixel was finished");
    return {};
}

}  // namespace

TEST_CASE("interruption: what is finished is saved beside each file, marked", "[cli]") {
    const int signal = GENERATE(SIGINT, SIGTERM);
    const Workplace workplace;
    for (const char* name : {"a.png", "a.exr", "b.tif"}) write_file(workplace.images / name, "old");
    const ProcessResult result = interrupt_endless(
        workplace, {"-o", "a.png", "-o", "a.exr", "-o", "b.tif", "-o", "/dev/null"}, signal);
    INFO(result.err);
    for (const char* name : {"a.png", "a.exr", "b.tif"}) CHECK(content_of(workplace.images / name) == "old");
    CHECK(workplace.images.entries() == 6);
    CHECK(!fs::exists("/dev/null.partial"));

    const std::string name = signal == SIGINT ? "SIGINT" : "SIGTERM";
    CHECK(contains(result.err, "interrupted by " + name + ": "));
    CHECK(contains(result.err,
                   " of 60000 pixels are finished, saved as a.partial.png, a.partial.exr, "
                   "b.partial.tif\n"));
    const nlohmann::json event = json_lines(result.out).back();
    CHECK(event.at("event") == "interrupted");
    CHECK(event.at("code") == 128 + signal);
    CHECK(event.at("signal") == name);
    CHECK(event.at("partial") == nlohmann::json({"a.partial.png", "a.partial.exr", "b.partial.tif"}));
    const std::string mark = partial_mark(workplace.images / "a.partial.exr");
    CHECK(contains(event.at("message"), mark + " are finished"));
    CHECK(contains(mark, " of 60000 pixels"));
    CHECK(partial_mark(workplace.images / "a.partial.png") == mark);
    CHECK(read_image(workplace.images / "b.partial.tif").width == 300);
}

TEST_CASE("interruption: at any moment the old file stays or the new one is whole", "[cli]") {
    const Workplace workplace;
    const std::vector<std::string> arguments{"-o", "a.exr", "--size", "640x400", "--spp", "4"};
    REQUIRE(workplace.render(arguments).finish().status == 0);  // and now kernels are in the cache
    const Clock::time_point start = Clock::now();
    REQUIRE(workplace.render(arguments).finish().status == 0);
    const std::chrono::duration<double> whole_run = Clock::now() - start;
    const Image whole = read_image(workplace.images / "a.exr");
    const std::string whole_file = content_of(workplace.images / "a.exr");

    std::mt19937 random(4);
    const int moments = full_tests() ? 50 : 10;
    for (int i = 0; i < moments; ++i) {
        const int signal = i % 2 == 0 ? SIGINT : SIGTERM;
        const auto moment = whole_run * std::uniform_real_distribution<>(0, 1.1)(random);
        INFO("signal " << signal << " after " << moment.count() << " s");
        write_file(workplace.images / "a.exr", "old");
        fs::remove(workplace.images / "a.partial.exr");
        Process process = workplace.render(arguments);
        std::this_thread::sleep_for(moment);
        process.send_signal(signal);
        const ProcessResult result = process.finish();
        INFO(result.err);
        CHECK(workplace.temporary.entries() == 0);
        const bool partial = fs::exists(workplace.images / "a.partial.exr");
        CHECK(workplace.images.entries() == (partial ? 2 : 1));
        if (result.status == 0) {
            CHECK(read_image(workplace.images / "a.exr").pixels == whole.pixels);
            CHECK_FALSE(partial);
            continue;
        }
        CHECK(result.status == 128 + signal);
        CHECK(content_of(workplace.images / "a.exr") == "old");
        if (!partial) continue;
        const std::string mark = partial_mark(workplace.images / "a.partial.exr");
        CHECK(contains(mark, " of 256000 pixels"));
        const std::uint64_t finished = std::stoull(mark);
        const PixelCounts counts = count_pixels(read_image(workplace.images / "a.partial.exr"), whole);
        CHECK(counts.lit <= finished);
        CHECK(finished <= counts.equal);
        CHECK(counts.lit > 0);
    }
}

TEST_CASE("interruption: a file that is being written becomes whole", "[cli]") {
    const Workplace workplace;
    // Nobody reads the FIFO: the program waits there, with its first image written.
    make_fifo(workplace.images / "fifo");
    Process process = workplace.render({"-o", "first.png", "-o", "fifo"});
    wait_for_file(workplace.images / "first.png");
    process.send_signal(SIGTERM);
    const std::string received = read_fifo(workplace.images / "fifo");
    CHECK(process.finish().status == 0);
    CHECK(received == content_of(workplace.images / "first.png"));
}

TEST_CASE("interruption: the images of a series that are written stay, no other begins", "[cli]") {
    const Workplace workplace;
    make_fifo(workplace.images / "f0.png");
    Process process =
        workplace.render({"--depth", "0,1,2", "-o", "d{depth}.png", "-o", "f{depth}.png", "--json"});
    wait_for_file(workplace.images / "d0.png");
    process.send_signal(SIGINT);
    wait_for_notice(process);
    CHECK(read_fifo(workplace.images / "f0.png") == content_of(workplace.images / "d0.png"));
    const ProcessResult result = process.finish();
    CHECK(result.status == 128 + SIGINT);
    INFO(result.err);
    CHECK(contains(result.err, "1 of 3 images are written"));
    CHECK(workplace.images.entries() == 2);
    const std::vector<nlohmann::json> events = json_lines(result.out);
    REQUIRE(events.size() == 3);
    CHECK(events[1].at("path") == "d0.png");
    CHECK(events[2].at("event") == "interrupted");
    CHECK(events[2].at("partial").empty());
}

TEST_CASE("interruption: a second signal ends the program at once", "[cli]") {
    const Workplace workplace;
    make_fifo(workplace.images / "fifo");
    Process process = workplace.render({"-o", "first.png", "-o", "fifo"});
    wait_for_file(workplace.images / "first.png");
    process.send_signal(SIGINT);
    // Two signals that are pending at one time would be one.
    for (int i = 0; i < 20; ++i) {
        std::this_thread::sleep_for(milliseconds(5));
        process.send_signal(SIGTERM);
    }
    CHECK(process.finish().status == 128 + SIGTERM);
    // What it left goes with the next run.
    REQUIRE(workplace.render({"-o", "first.png"}).finish().status == 0);
    CHECK(workplace.temporary.entries() == 0);
}

TEST_CASE("interruption: a signal that is ignored at the start stays so", "[cli]") {
    const Workplace workplace;
    make_fifo(workplace.images / "fifo");
    std::vector<std::string> command =
        sahl_command({"render", scene_file("cli_mirrors.nff"), "-o", "first.png", "-o", "fifo"});
    command.insert(command.begin(), {"/bin/sh", "-c", "trap '' INT; exec \"$0\" \"$@\""});
    Process process(command, workplace.options());
    wait_for_file(workplace.images / "first.png");
    for (int i = 0; i < 3; ++i) {
        process.send_signal(SIGINT);
        std::this_thread::sleep_for(milliseconds(5));
    }
    CHECK(read_fifo(workplace.images / "fifo") == content_of(workplace.images / "first.png"));
    CHECK(process.finish().status == 0);
}

}  // namespace sahl::tests
