// What a child process does to itself does nothing to its parent, which hears of it.
#include <catch2/catch.hpp>

#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <vector>

#include "engine/core/child_process.h"

namespace sahl {
namespace {

void hear_nothing(const PipeEnd&) {}

TEST_CASE("child process: what it writes arrives", "[core]") {
    // More than a pipe holds.
    std::vector<int> sent(1'000'000);
    for (std::size_t i = 0; i < sent.size(); ++i) sent[i] = static_cast<int>(7 * i);
    std::vector<int> received(sent.size());
    bool complete = false;
    bool more = true;
    const std::string misdeed = run_in_child(
        [&](const PipeEnd& pipe) {
            pipe.write(std::as_bytes(std::span(sent)));
            sent[0] = -1;  // in a copy
        },
        [&](const PipeEnd& pipe) {
            complete = pipe.read(std::as_writable_bytes(std::span(received)));
            std::byte byte{};
            more = pipe.read(std::span(&byte, 1));
        });
    CHECK(misdeed == "");
    CHECK(complete);
    CHECK_FALSE(more);
    CHECK(received == sent);
}

TEST_CASE("child process: each way to die is told", "[core]") {
    CHECK(run_in_child([](const PipeEnd&) { raise(SIGSEGV); }, hear_nothing).starts_with("crashes"));
    CHECK(run_in_child([](const PipeEnd&) { std::abort(); }, hear_nothing) == "crashes (Aborted)");
    CHECK(run_in_child([](const PipeEnd&) { _Exit(7); }, hear_nothing) == "crashes");
    CHECK(run_in_child([](const PipeEnd&) { throw std::runtime_error("x"); }, hear_nothing) == "crashes");
    CHECK(run_in_child([](const PipeEnd&) { raise(SIGKILL); }, hear_nothing) ==
          "was killed, perhaps for want of memory");
}

TEST_CASE("child process: work without end is ended", "[core]") {
    const auto misdeed_of = [](void (*work)()) {
        return run_in_child(
            [work](const PipeEnd&) {
                limit_process(std::size_t{1} << 30, 0);
                for (;;) work();
            },
            hear_nothing);
    };
    CHECK(misdeed_of([] { getppid(); }) == "takes more time than it should");
    CHECK(misdeed_of([] { pause(); }) == "takes more time than it should");  // as for a lock
}

TEST_CASE("child process: memory beyond its limit is refused", "[core]") {
    const auto allocates = [](std::size_t limit, std::size_t bytes) {
        bool allocated = false;
        run_in_child(  // which crashes under the address sanitizer: it throws no bad_alloc
            [&](const PipeEnd& pipe) {
                limit_process(limit, 10);
                bool done = true;
                try {
                    std::vector<char>(bytes, 'x');
                } catch (const std::bad_alloc&) {
                    done = false;
                }
                pipe.write(std::as_bytes(std::span(&done, 1)));
            },
            [&](const PipeEnd& pipe) { pipe.read(std::as_writable_bytes(std::span(&allocated, 1))); });
        return allocated;
    };
    constexpr std::size_t mebibyte = std::size_t{1} << 20;
    CHECK(allocates(64 * mebibyte, 32 * mebibyte));
    CHECK_FALSE(allocates(64 * mebibyte, 128 * mebibyte));
}

TEST_CASE("child process: one that nobody listens to any more goes", "[core]") {
    const auto stop_listening = [](const PipeEnd&) { throw std::runtime_error("enough"); };
    const auto write_for_ever = [](const PipeEnd& pipe) {
        const std::vector<std::byte> bytes(1 << 20);
        while (pipe.write(bytes)) {
        }
    };
    CHECK_THROWS_WITH(run_in_child(write_for_ever, stop_listening), "enough");
    // Killed: it would not notice.
    CHECK_THROWS_WITH(run_in_child([](const PipeEnd&) { pause(); }, stop_listening), "enough");
    CHECK(run_in_child(write_for_ever, hear_nothing) == "");
}

}  // namespace
}  // namespace sahl
