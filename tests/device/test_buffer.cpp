#include <catch2/catch.hpp>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <numeric>
#include <random>
#include <string_view>
#include <vector>

#include "engine/device/buffer.h"
#include "engine/device/program.h"
#include "tests/device/test_device_support.h"
#include "tests/support/run_process.h"

namespace sahl::tests {
namespace {

constexpr std::size_t mebibyte = std::size_t{1} << 20;

/// Whether memory ends at a page that traps, and is aligned to its end (SAHL_GUARD=1).
bool guarded() {
    const char* guard = std::getenv("SAHL_GUARD");
    return guard != nullptr && std::string_view(guard) == "1";
}

}  // namespace

TEST_CASE("host memory is zeroed, aligned, and accounted for as it is mapped") {
    MemoryAccountant accountant;
    const auto [bytes, alignment, mapped] = GENERATE(table<std::size_t, std::size_t, std::size_t>({
        {1, 4096, 4096},
        {4096, 4096, 4096},
        {4097, 4096, 8192},
        {mebibyte - 1, 4096, mebibyte},
        {mebibyte, 2 * mebibyte, 2 * mebibyte},
        {2 * mebibyte, 2 * mebibyte, 2 * mebibyte},
        {5 * mebibyte + 3, 2 * mebibyte, 6 * mebibyte},
    }));
    {
        const HostMemory memory(accountant, bytes, "test");
        CHECK(memory.size() == bytes);
        CHECK(reinterpret_cast<std::uintptr_t>(memory.data()) % (guarded() ? 128 : alignment) == 0);
        CHECK(HostMemory::mapped_bytes(bytes) == mapped);
        CHECK(accountant.current() == mapped);
        auto* first = static_cast<unsigned char*>(memory.data());
        CHECK(std::accumulate(first, first + bytes, 0u) == 0);
        first[bytes - 1] = 1;
    }
    CHECK(accountant.current() == 0);
    CHECK(accountant.peak() == mapped);
}

TEST_CASE("host memory moves, and is counted once") {
    MemoryAccountant accountant;
    HostMemory a(accountant, 5000, "a");
    void* data = a.data();
    HostMemory b(std::move(a));
    CHECK(b.data() == data);
    CHECK(accountant.current() == 8192);
    b = HostMemory(accountant, 100, "b");
    CHECK(b.size() == 100);
    CHECK(accountant.current() == 4096);
    CHECK(accountant.peak() == 12288);
    CHECK(HostMemory(accountant, 0, "nothing").data() == nullptr);
}

TEST_CASE("host memory that the system refuses is an error with name and size") {
    MemoryAccountant accountant;
    const std::size_t bytes = GENERATE(SIZE_MAX, SIZE_MAX / 5, std::size_t{1} << 60);
    const std::string message =
        error_of(ExitCode::memory, [&] { HostMemory(accountant, bytes, "the film"); });
    CHECK(contains(message, "the film"));
    CHECK(contains(message, std::to_string(bytes)));
    CHECK(accountant.current() == 0);
}

TEST_CASE("an accountant's limit is refused by name, and what is given back may be used again") {
    MemoryAccountant accountant;
    accountant.set_limit(10000);
    HostMemory first(accountant, 8000, "first");
    MemoryReservation vectors(accountant, 1808, "vectors");
    CHECK(accountant.current() == 10000);
    const std::string message = error_of(ExitCode::memory, [&] { MemoryReservation(accountant, 1, "more"); });
    CHECK(contains(message, "more: cannot allocate 1 bytes"));
    CHECK(contains(message, "10000 of the 10000"));
    vectors.give_back(1000);
    CHECK(accountant.current() == 9000);
    const MemoryReservation moved = std::move(vectors);
    CHECK(accountant.current() == 9000);
    first = HostMemory();
    CHECK(accountant.current() == 808);
    accountant.set_limit(100);
    CHECK(error_of(ExitCode::memory, [&] { MemoryReservation(accountant, 1, "less"); }) != "");
    CHECK(accountant.current() == 808);
    CHECK(accountant.peak() == 10000);
}

TEST_CASE("probe: beyond a buffer's end", "[.probe]") {
    Device device;
    const std::string text = "__kernel void set(__global int* out, uint at) { out[at] = 1; }";  // no bounds
    Program program = Program::from_text(device, text);
    Buffer out(device, 4096, "out");
    program.kernel("set").launch({.work_items = 1}, out, std::uint32_t{1023});
    device.finish();
    std::cout << "the last element is written" << std::endl;
    program.kernel("set").launch({.work_items = 1}, out, std::uint32_t{1024});
    device.finish();
}

TEST_CASE("with SAHL_GUARD a kernel that writes beyond a buffer's end is stopped there") {
    ProcessOptions options;
    options.environment = {{"SAHL_GUARD", "1"}};
    const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
    const ProcessResult result = run_process({program, "probe: beyond a buffer's end"}, options);
    CHECK(contains(result.out, "the last element is written"));
    CHECK(result.status != 0);
    CHECK(!contains(result.out, "All tests passed"));
}

TEST_CASE("buffers keep what is written to them") {
    Device device;
    const std::size_t count = GENERATE(0u, 1u, 15u, 1024u, 300001u, 1u << 20);
    std::mt19937 random(7);
    std::vector<std::uint32_t> values(count);
    for (std::uint32_t& value : values) value = static_cast<std::uint32_t>(random());
    {
        Buffer buffer(device, count * 4, "values");
        CHECK(buffer.bytes() == (count == 0 ? 64 : count * 4));
        if (device.zero_copy()) CHECK(device.memory().current() == HostMemory::mapped_bytes(buffer.bytes()));
        buffer.write(std::span<const std::uint32_t>(values));
        {
            const auto mapping = buffer.map<std::uint32_t>(MapMode::read, count);
            CHECK(mapping.size() == count);
            CHECK(std::equal(mapping.begin(), mapping.end(), values.begin(), values.end()));
        }
        {
            const auto mapping = buffer.map<std::uint32_t>(MapMode::read_write, count);
            for (std::uint32_t& value : mapping) value = ~value;
        }
        Buffer moved = std::move(buffer);
        const auto mapping = moved.map<std::uint32_t>(MapMode::read, count);
        CHECK(std::equal(mapping.begin(), mapping.end(), values.begin(), values.end(),
                         [](std::uint32_t a, std::uint32_t b) { return a == ~b; }));
    }
    CHECK(device.memory().current() == 0);
    CHECK(device.memory().peak() > 0);
}

TEST_CASE("the accountant's peak is the most at one time") {
    Device device;
    if (!device.zero_copy()) return;
    {
        Buffer a(device, 4096, "a");
        { Buffer b(device, 3u << 20, "b"); }
        Buffer c(device, 10000, "c");
        c = Buffer(device, 100, "d");
        CHECK(device.memory().current() == 2 * 4096);
    }
    CHECK(device.memory().current() == 0);
    CHECK(device.memory().peak() == 4096 + (4u << 20));
}

TEST_CASE("filled host memory becomes a buffer, in place on CPU devices") {
    Device device;
    HostMemory memory(device.memory(), 3 * sizeof(float), "filled");
    auto* values = static_cast<float*>(memory.data());
    for (int i = 0; i < 3; ++i) values[i] = static_cast<float>(i) + 0.5f;
    Buffer buffer(device, std::move(memory), "filled");
    const auto mapping = buffer.map<float>(MapMode::read, 3);
    CHECK(mapping[2] == 2.5f);
    CHECK((mapping.data() == values) == device.zero_copy());
    Buffer empty(device, HostMemory(), "empty");
    CHECK(empty.bytes() == 64);
}

TEST_CASE("a buffer over the device's limit is an error with name and size") {
    Device device;
    const std::size_t bytes = device.info().max_allocation + 1;
    const std::string message = error_of(ExitCode::memory, [&] { Buffer(device, bytes, "leaf blocks"); });
    CHECK(contains(message, "leaf blocks"));
    CHECK(contains(message, std::to_string(bytes)));
    CHECK(contains(message, std::to_string(device.info().max_allocation)));
    CHECK(device.memory().current() == 0);
}

TEST_CASE("access beyond a buffer's end is an internal error") {
    Device device;
    Buffer buffer(device, 8, "small");
    const std::vector<float> three(3);
    CHECK(contains(error_of(ExitCode::internal, [&] { buffer.write(std::span<const float>(three)); }),
                   "small"));
    CHECK(contains(error_of(ExitCode::internal, [&] { buffer.map<float>(MapMode::read, 3); }), "small"));
}

TEST_CASE("the host works on a mapping while a later kernel runs") {
    Device device;
    if (!device.zero_copy()) return;
    // The second kernel runs until the host, which works on the first one's results, tells it to
    // stop. Had the mapping to wait for the second kernel, that would give up and say so.
    Program program = Program::from_text(device, R"(
        __kernel void fill(__global uint* out) { out[get_global_id(0)] = 3 * get_global_id(0); }
        __kernel void wait_for_host(__global volatile uint* flag, __global uint* seen) {
            ulong left = 3000000000ul;
            while (*flag == 0 && left > 0) --left;
            *seen = *flag;
        })");
    Kernel fill = program.kernel("fill");
    Kernel wait_for_host = program.kernel("wait_for_host");
    Buffer results(device, 4000, "results");
    HostMemory flag_memory(device.memory(), 4, "flag");
    auto* flag = static_cast<volatile std::uint32_t*>(flag_memory.data());
    Buffer flag_buffer(device, std::move(flag_memory), "flag");
    Buffer seen(device, 4, "seen");

    fill.launch({.work_items = 1000}, results);
    {
        auto mapping = results.enqueue_map<std::uint32_t>(MapMode::read, 1000);
        wait_for_host.launch({.work_items = 1}, flag_buffer, seen);
        device.flush();
        mapping.wait();
        for (std::uint32_t i = 0; i < 1000; ++i) REQUIRE(mapping[i] == 3 * i);
        *flag = 1;
    }
    CHECK(seen.map<std::uint32_t>(MapMode::read, 1)[0] == 1);
}

TEST_CASE("mappings that nobody waits for, and buffers that end with work queued, do no harm") {
    Device device;
    Program program = Program::from_text(device, R"(
        __kernel void fill(__global uint* out, uint n) {
            for (uint i = 0; i < n; ++i) out[i] = i;
        })");
    Kernel fill = program.kernel("fill");
    constexpr std::uint32_t element_count = 1u << 20;
    for (int round = 0; round < 20; ++round) {
        Buffer buffer(device, element_count * 4, "short-lived");
        fill.launch({.work_items = 1}, buffer, element_count);
        auto unused = buffer.enqueue_map<std::uint32_t>(MapMode::read, element_count);
    }
    CHECK(device.memory().current() == 0);
}

}  // namespace sahl::tests
