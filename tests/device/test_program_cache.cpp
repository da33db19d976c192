#include <catch2/catch.hpp>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <map>
#include <random>
#include <vector>

#include "engine/device/pocl_environment.h"
#include "engine/device/program.h"
#include "engine/device/program_cache.h"
#include "kernels/device_types.h"
#include "tests/device/test_device_support.h"
#include "tests/support/run_process.h"

namespace sahl::tests {
namespace {

constexpr const char* source_text = R"(
__kernel void twice(__global float* values) { values[get_global_id(0)] *= 2; }
__kernel void add_three(__global float* values) { values[get_global_id(0)] += 3; }
__kernel void negate(__global float* values) { values[get_global_id(0)] *= -1; }
)";

/// Runs `kernels` of source_text on 1.0 and returns the result; says whether the cache served.
float run(Device& device, const std::vector<std::string>& kernels, bool& from_cache) {
    Program program = Program::from_text(device, source_text);
    from_cache = program.from_cache();
    Buffer values(device, 4 * device.local_size(), "values");
    values.map<float>(MapMode::write, 1)[0] = 1;
    for (const std::string& kernel : kernels) program.kernel(kernel).launch({.work_items = 1}, values);
    return values.map<float>(MapMode::read, 1)[0];
}

std::vector<std::filesystem::path> files_of(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
    return files;
}

std::string damaged(const std::string& good, int variant) {
    std::mt19937 random(static_cast<unsigned>(variant));
    const auto below = [&](std::size_t n) {
        return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
    };
    std::string bytes = good;
    switch (variant % 5) {
        case 0:  // one flipped bit, anywhere
            bytes[below(bytes.size())] ^= static_cast<char>(1 << below(8));
            break;
        case 1:  // one flipped bit in the header
            bytes[below(56)] ^= static_cast<char>(1 << below(8));
            break;
        case 2:  // cut short
            bytes.resize(variant == 2 ? 0 : below(bytes.size()));
            break;
        case 3:  // garbage, of any length
            bytes.resize(1 + below(2 * bytes.size()));
            for (char& byte : bytes) byte = static_cast<char>(below(256));
            break;
        default:  // a damaged sector, or more behind the end
            if (variant % 2 == 0) {
                const std::size_t begin = below(bytes.size() - 512);
                for (std::size_t i = begin; i < begin + 512; ++i) bytes[i] = static_cast<char>(~bytes[i]);
            } else {
                bytes.append(1 + below(1000), 'x');
            }
    }
    return bytes;
}

}  // namespace

TEST_CASE("probe: program cache", "[.probe]") {
    std::vector<std::string> kernels = {"twice", "add_three"};
    if (getenv("SAHL_PROBE_MORE") != nullptr) kernels.push_back("negate");
    Device device;
    std::size_t loaded = 0;
    std::size_t compiled = 0;
    float result = 0;
    bool from_cache = false;
    {
        Program program = Program::from_text(device, source_text);
        from_cache = program.from_cache();
        loaded = count_compiled_kernels();
        Buffer values(device, 4 * device.local_size(), "values");
        values.map<float>(MapMode::write, 1)[0] = 1;
        for (const std::string& kernel : kernels) program.kernel(kernel).launch({.work_items = 1}, values);
        result = values.map<float>(MapMode::read, 1)[0];
        compiled = count_compiled_kernels() - loaded;
    }
    std::cout << "probe: from_cache=" << from_cache << " compiled=" << compiled << " result=" << result
              << " stored=" << count_compiled_kernels() - loaded - compiled << ";" << std::endl;
    CHECK(result == (kernels.size() == 3 ? -5 : 5));
}

TEST_CASE("a second process compiles nothing that the first one did") {
    if (!Device().info().is_pocl) return;
    const TemporaryFolder cache;
    const auto probe = [&](bool more) {
        ProcessOptions options;
        options.environment["SAHL_CACHE_DIR"] = cache.path().string();
        if (more) options.environment["SAHL_PROBE_MORE"] = "1";
        const ProcessResult result = run_process(
            {std::filesystem::read_symlink("/proc/self/exe").string(), "probe: program cache"}, options);
        CHECK(result.status == 0);
        return result.out;
    };
    CHECK(contains(probe(false), "from_cache=0 compiled=2 result=5 stored=0;"));
    CHECK(contains(probe(false), "from_cache=1 compiled=0 result=5 stored=0;"));
    CHECK(contains(probe(true),
                   "from_cache=1 compiled=1 result=-5 stored=0;"));  // a kernel that was not launched yet
    CHECK(contains(probe(true), "from_cache=1 compiled=0 result=-5 stored=0;"));
    CHECK(contains(probe(false), "from_cache=1 compiled=0 result=5 stored=0;"));
    CHECK(files_of(cache.path()).size() == 1);
}

TEST_CASE("quick kernels are those of programs that the cache does not have optimized") {
    if (!Device().info().is_pocl) return;
    const TemporaryFolder cache;
    const ScopedVariable variable("SAHL_CACHE_DIR", cache.path().string());
    Device device;
    const auto run_as = [&](Compilation compilation, bool optimized, bool from_cache) {
        Program program(device, {"compact.cl"}, "", compilation);
        CHECK(program.is_optimized() == optimized);
        CHECK(program.from_cache() == from_cache);
        constexpr std::uint32_t blocks = 2;
        const std::vector<std::uint32_t> reflected_and_transmitted{1, 2, 3, 4}, shadow_rays{5, 6};
        Buffer counts(device, 2 * blocks * sizeof(std::uint32_t), "counts");
        Buffer shadow_counts(device, blocks * sizeof(std::uint32_t), "shadow rays");
        Buffer totals(device, SAHL_TOTALS * sizeof(std::uint32_t), "totals");
        counts.write(std::span(reflected_and_transmitted));
        shadow_counts.write(std::span(shadow_rays));
        program.kernel("sum_children").launch({.work_items = 1}, counts, shadow_counts, totals, blocks);
        CHECK(totals.map<std::uint32_t>(MapMode::read, SAHL_TOTALS)[SAHL_TOTAL_CHILDREN] == 10);
    };
    run_as(Compilation::quick, false, false);
    run_as(Compilation::quick, false, true);
    run_as(Compilation::optimized, true, false);
    run_as(Compilation::quick, true, true);
    run_as(Compilation::optimized, true, true);
}

TEST_CASE("damaged cache files are rebuilt and replaced") {
    const TemporaryFolder cache;
    const ScopedVariable variable("SAHL_CACHE_DIR", cache.path().string());
    Device device;
    bool from_cache = true;
    CHECK(run(device, {"twice", "add_three"}, from_cache) == 5);
    CHECK_FALSE(from_cache);
    REQUIRE(files_of(cache.path()).size() == 1);
    const std::filesystem::path file = files_of(cache.path()).front();
    const std::string good = read_file(file);
    for (int variant = 0; variant < 40; ++variant) {
        CAPTURE(variant);
        const std::string bad = damaged(good, variant);
        REQUIRE((bad != good));  // not printed
        write_file(file, bad);
        REQUIRE(run(device, {"twice", "add_three"}, from_cache) == 5);
        REQUIRE_FALSE(from_cache);
        REQUIRE(run(device, {"twice"}, from_cache) == 2);
        REQUIRE(from_cache);
    }
    CHECK(files_of(cache.path()).size() == 1);
}

TEST_CASE("a whole cache file whose binary the driver refuses is rebuilt") {
    const TemporaryFolder cache;
    const ScopedVariable variable("SAHL_CACHE_DIR", cache.path().string());
    Device device;
    bool from_cache = true;
    CHECK(run(device, {"twice"}, from_cache) == 2);
    const std::filesystem::path file = files_of(cache.path()).front();
    const std::string good = read_file(file);
    // The key is what lies between the 56 bytes of header and the kernel names.
    std::uint64_t key_bytes = 0;
    std::memcpy(&key_bytes, good.data() + 24, 8);
    const std::string key = good.substr(56, key_bytes);
    REQUIRE(load_program(key).has_value());
    store_program(key, {std::string(5000, 'g'), {"twice"}});
    REQUIRE(load_program(key)->binary == std::string(5000, 'g'));
    CHECK(run(device, {"twice"}, from_cache) == 2);
    CHECK_FALSE(from_cache);
    CHECK(run(device, {"twice"}, from_cache) == 2);
    CHECK(from_cache);
}

TEST_CASE("the cache tells keys apart and gives back what was stored") {
    const TemporaryFolder cache;
    const ScopedVariable variable("SAHL_CACHE_DIR", (cache.path() / "made" / "on demand").string());
    CHECK_FALSE(load_program("a").has_value());
    store_program("a", {"binary of a", {"k0", "k1"}});
    store_program("b", {std::string("b\0b\n", 4), {}});
    REQUIRE(load_program("a").has_value());
    CHECK(load_program("a")->binary == "binary of a");
    CHECK(load_program("a")->kernels == std::vector<std::string>{"k0", "k1"});
    CHECK(load_program("b")->binary == std::string("b\0b\n", 4));
    CHECK(load_program("b")->kernels.empty());
    CHECK_FALSE(load_program("c").has_value());

    // b's file under a's name: whole, but not a's.
    const auto files = files_of(cache.path() / "made" / "on demand");
    REQUIRE(files.size() == 2);
    const std::string first = read_file(files[0]);
    write_file(files[0], read_file(files[1]));
    write_file(files[1], first);
    CHECK_FALSE(load_program("a").has_value());
    CHECK_FALSE(load_program("b").has_value());
}

TEST_CASE("old cache files make room") {
    const TemporaryFolder cache;
    const ScopedVariable variable("SAHL_CACHE_DIR", cache.path().string());
    for (int i = 0; i < 70; ++i) store_program("key " + std::to_string(i), {"binary", {}});
    CHECK(files_of(cache.path()).size() == 64);
    CHECK(load_program("key 69").has_value());
}

TEST_CASE("what killed writers left in the cache goes, its files are their owner's alone") {
    const TemporaryFolder cache;
    const ScopedVariable variable("SAHL_CACHE_DIR", cache.path().string());
    write_file(cache.path() / ".0123456789abcdef.sahl-program.part-4321", "half");
    store_program("key", {"binary", {}});
    REQUIRE(files_of(cache.path()).size() == 1);
    const auto writers = std::filesystem::perms::group_write | std::filesystem::perms::others_write;
    const auto permissions = std::filesystem::status(files_of(cache.path()).front()).permissions();
    CHECK((permissions & writers) == std::filesystem::perms::none);
}

TEST_CASE("no cache folder, or one that cannot be written, is no error") {
    Device device;
    bool from_cache = true;
    const std::string folder = GENERATE("/dev/null/cache", "/proc/cache");
    const ScopedVariable variable("SAHL_CACHE_DIR", folder);
    CHECK(run(device, {"twice"}, from_cache) == 2);
    CHECK_FALSE(from_cache);
}

TEST_CASE("where the cache is") {
    const TemporaryFolder home;
    const ScopedVariable none("SAHL_CACHE_DIR", "");
    const ScopedVariable home_variable("HOME", home.path().string());
    {
        const ScopedVariable xdg("XDG_CACHE_HOME", (home.path() / "xdg").string());
        store_program("x", {"x", {}});
        CHECK(files_of(home.path() / "xdg" / "sahl").size() == 1);
    }
    const ScopedVariable xdg("XDG_CACHE_HOME", "");
    store_program("x", {"x", {}});
    CHECK(files_of(home.path() / ".cache" / "sahl").size() == 1);
}

}  // namespace sahl::tests
