#include <catch2/catch.hpp>
#include <cstdint>
#include <vector>

#include "engine/device/pocl_environment.h"
#include "engine/device/program.h"
#include "kernels/device_types.h"
#include "tests/device/test_device_support.h"

namespace sahl::tests {
namespace {

constexpr const char* arithmetic = R"(
#include "kernels/device_types.h"

__kernel void add(__global const float* a, __global const float* b, uint count, __global float* sum) {
    uint first = (uint)get_global_id(0) * SAHL_RAYS_PER_ITEM;
    for (uint i = first; i < min(first + SAHL_RAYS_PER_ITEM, count); ++i) sum[i] = a[i] + b[i];
}

__kernel void unpack(CameraConstants camera, WaveConstants wave, __global float* out) {
    out[0] = camera.eye[2];
    out[1] = camera.half_height;
    out[2] = camera.step_y[1];
    out[3] = (float)wave.first_high;
    out[4] = (float)wave.seed_low;
}
)";

}  // namespace

TEST_CASE("a program from text computes") {
    Device device;
    Program program = Program::from_text(device, arithmetic);
    constexpr std::uint32_t element_count = 1000;
    Buffer a(device, element_count * 4, "a");
    Buffer b(device, element_count * 4, "b");
    Buffer sum(device, (element_count + 1) * 4, "sum");
    {
        const auto values_a = a.map<float>(MapMode::write, element_count);
        const auto values_b = b.map<float>(MapMode::write, element_count);
        for (std::uint32_t i = 0; i < element_count; ++i) {
            values_a[i] = static_cast<float>(i);
            values_b[i] = 0.25f;
        }
        sum.map<float>(MapMode::write, element_count + 1)[element_count] = -7;
    }
    const std::size_t items = (element_count + device.rays_per_item() - 1) / device.rays_per_item();
    program.kernel("add").launch({.work_items = items}, a, b, element_count, sum);
    const auto result = sum.map<float>(MapMode::read, element_count + 1);
    for (std::uint32_t i = 0; i < element_count; ++i) REQUIRE(result[i] == static_cast<float>(i) + 0.25f);
    CHECK(result[element_count] == -7);
}

TEST_CASE("structs arrive by value") {
    Device device;
    Program program = Program::from_text(device, arithmetic);
    device::CameraConstants camera{};
    camera.eye[2] = 3;
    camera.half_height = 384.5f;
    camera.step_y[1] = -1;
    device::WaveConstants wave{};
    wave.first_high = 77;
    wave.seed_low = 4711;
    Buffer out(device, 5 * sizeof(float), "out");
    program.kernel("unpack").launch({.work_items = 1}, camera, wave, out);
    const auto values = out.map<float>(MapMode::read, 5);
    const std::vector<float> expected = {3, 384.5f, -1, 77, 4711};
    CHECK(std::vector<float>(values.begin(), values.end()) == expected);
}

TEST_CASE("options reach the compiler") {
    Device device;
    Program program = Program::from_text(
        device, "__kernel void get(__global int* out) { out[0] = VALUE; out[1] = __OPENCL_C_VERSION__; }",
        "-DVALUE=42");
    Buffer out(device, 8, "out");
    program.kernel("get").launch({.work_items = 1}, out);
    const auto values = out.map<int>(MapMode::read, 2);
    CHECK(values[0] == 42);
    CHECK(values[1] == 120);
}

TEST_CASE("launches are recorded while that is enabled") {
    Device device;
    Program program = Program::from_text(device, arithmetic);
    Kernel add = program.kernel("add");
    Buffer values(device, 6400, "values");
    add.launch({.work_items = 1, .generation = 9, .items = 9}, values, values, 1u, values);
    CHECK(device.launches().take().empty());

    device.launches().enable(true);
    for (std::uint32_t generation = 0; generation < 3; ++generation) {
        add.launch({.work_items = 2, .generation = generation, .items = 100 + generation}, values, values, 1u,
                   values);
    }
    add.launch({.work_items = 0, .generation = 3}, values, values, 1u, values);  // no launch
    const std::vector<LaunchRecord> records = device.launches().take();
    REQUIRE(records.size() == 3);
    for (std::uint32_t i = 0; i < 3; ++i) {
        CHECK(records[i].kernel == "add");
        CHECK(records[i].generation == i);
        CHECK(records[i].items == 100 + i);
        CHECK(records[i].queued_ns > 0);
        CHECK(records[i].queued_ns <= records[i].submitted_ns);
        CHECK(records[i].submitted_ns <= records[i].started_ns);
        CHECK(records[i].started_ns < records[i].ended_ns);
        if (i > 0) CHECK(records[i - 1].ended_ns <= records[i].started_ns);  // in order
    }
    CHECK(device.launches().take().empty());

    device.launches().enable(false);
    add.launch({.work_items = 1}, values, values, 1u, values);
    CHECK(device.launches().take().empty());
}

TEST_CASE("a kernel called wrongly is an internal error that names it") {
    Device device;
    Program program = Program::from_text(device, arithmetic);
    Buffer buffer(device, 64, "buffer");
    CHECK(contains(error_of(ExitCode::internal, [&] { program.kernel("subtract"); }), "subtract"));
    Kernel add = program.kernel("add");
    const Launch one{.work_items = 1};
    CHECK(contains(error_of(ExitCode::internal, [&] { add.launch(one, buffer); }), "add"));
    CHECK(
        contains(error_of(ExitCode::internal, [&] { add.launch(one, buffer, buffer, 1.0, buffer); }), "add"));
    CHECK(contains(error_of(ExitCode::internal, [&] { add.launch(one, buffer, buffer, 1u, buffer, 1u); }),
                   "add"));
    if (device.info().is_pocl) {
        const Launch many{.work_items = device.max_work_items() + 1};
        CHECK(contains(error_of(ExitCode::internal, [&] { add.launch(many, buffer, buffer, 1u, buffer); }),
                       "add"));
    }
}

TEST_CASE("a kernel is compiled once for all sizes of launches") {
    Device device;
    if (!device.info().is_pocl) return;
    const TemporaryFolder cache;
    const ScopedVariable variable("SAHL_CACHE_DIR", cache.path().string());
    Program program = Program::from_text(
        device, "__kernel void count_items(__global int* out) { out[get_global_id(0)] = -1; }");
    Kernel kernel = program.kernel("count_items");
    Buffer out(device, 4 * device.max_work_items(), "out");
    const std::size_t before = count_compiled_kernels();
    for (const std::size_t items : {std::size_t{1}, std::size_t{1000}, device.max_work_items()}) {
        kernel.launch({.work_items = items}, out);
    }
    device.finish();
    CHECK(count_compiled_kernels() == before + 1);
    CHECK(out.map<int>(MapMode::read, device.max_work_items())[device.max_work_items() - 1] == -1);
}

TEST_CASE("a kernel keeps its program") {
    Device device;
    Kernel add = [&] { return Program::from_text(device, arithmetic).kernel("add"); }();
    Buffer values(device, 4, "values");
    values.map<float>(MapMode::write, 1)[0] = 2;
    add.launch({.work_items = 1}, values, values, 1u, values);
    CHECK(values.map<float>(MapMode::read, 1)[0] == 4);
}

TEST_CASE("a build error shows device, options, log and the source") {
    Device device;
    const std::string message = error_of(ExitCode::device, [&] {
        Program::from_text(device, "int f(int x) {\n\treturn x + missing;\n}\n", "-DSOME_OPTION=1");
    });
    CHECK(contains(message, "CL_BUILD_PROGRAM_FAILURE"));
    CHECK(contains(message, device.info().name));
    CHECK(contains(message, "-cl-std=CL1.2"));
    CHECK(contains(message, "-DSOME_OPTION=1"));
    CHECK(contains(message, "text.cl:2:13"));
    CHECK(contains(message, "     2 | \treturn x + missing;\n       | \t           ^"));
}

TEST_CASE("a build error in an included file names that file and its line") {
    const TemporaryFolder folder;
    write_file(folder.path() / "outer.h",
               "#ifndef OUTER_H\n#define OUTER_H\n#include \"kernels/inner.h\"\n#endif\n");
    write_file(folder.path() / "inner.h",
               "#ifndef INNER_H\n#define INNER_H\nint g(int x) { return x; }\n"
               "int f(int x) { return oops; }\n#endif\n");
    write_file(folder.path() / "main.cl",
               "#include \"kernels/outer.h\"\n__kernel void k(__global int* o) {\n"
               "    o[0] = f(wrong);\n}\n");
    const ScopedVariable variable("SAHL_KERNEL_DIR", folder.path().string());
    Device device;
    const std::string message = error_of(ExitCode::device, [&] { Program(device, {"main.cl"}); });
    CHECK(contains(message, "kernels/inner.h:4:23"));
    CHECK(contains(message, "     4 | int f(int x) { return oops; }\n"));
    CHECK(contains(message, "kernels/main.cl:3:14"));
    CHECK(contains(message, "     3 |     o[0] = f(wrong);\n       |              ^"));
}

}  // namespace sahl::tests
