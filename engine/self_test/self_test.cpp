#include "engine/self_test/self_test.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "engine/core/error.h"
#include "engine/core/host_steps.h"
#include "engine/core/log.h"
#include "engine/device/compile_helper.h"
#include "engine/self_test/every_feature.h"
#include "engine/self_test/first_use.h"
#include "engine/self_test/kernel_tests.h"

namespace sahl {
namespace {

using self_test::Generation;
using self_test::TestWave;

constexpr int depth = 3;

TestWave wave_from(const glm::dvec3& eye, const glm::dvec3& look_at, double fov_y, const Crop& crop,
                   int spp) {
    TestWave wave;
    wave.camera = {eye, look_at, {0, 0, 1}, fov_y};
    wave.settings.resolution = {36, 28};
    wave.settings.spp = spp;
    wave.settings.seed = 0x123456789abcdef;
    wave.crop = crop;
    return wave;
}

/// Into every_feature() from its front, from above with several samples a pixel, from beside it, where
/// rays leave it, and from inside its glass.
std::vector<TestWave> test_waves() {
    constexpr Crop whole{0, 0, 36, 28};
    return {wave_from({0.4, -7, 3.5}, {0, 0, 0.7}, 42, whole, 1),
            wave_from({3, 3, 5}, {0, -0.5, 0.5}, 60, {5, 9, 23, 23}, 4),
            wave_from({11, -3, 3}, {0, 0, 1}, 60, whole, 1),
            wave_from({-1.9, -1.9, 0.5}, {1, -2.1, 0.4}, 100, whole, 1)};
}

/// The scene on the device and what asks the reference about it.
struct Bench {
    explicit Bench(Device& on, WavefrontKernels& with)
        : uncounted(on.memory()),
          device_scene(make_device_scene(on, scene)),
          queues(on, self_test::samples_of_wave, 1, device_scene.constants.light_count),
          wavefront{on, with, device_scene, queues} {}

    UncountedMemory uncounted;
    Scene scene = every_feature();
    oracle::Oracle reference{scene};
    DeviceScene device_scene;
    RayQueues queues;
    Wavefront wavefront;
};

/// Findings by kernel, in the order of a wave.
struct WaveTests {
    KernelTest generate{"generate"}, intersect{"intersect"}, shade{"shade"}, shadow{"shadow"},
        count_children{"count_children"}, sum_children{"sum_children"}, compact{"compact"};

    std::vector<KernelTest> in_order() const {
        return {generate, intersect, shade, shadow, count_children, sum_children, compact};
    }
};

/// All generations of a wave; what the batch cannot hold is left out. False at the first wrong answer.
bool test_wave(Bench& bench, const TestWave& wave, WaveTests& tests) {
    Wavefront& wavefront = bench.wavefront;
    if (!test_generate(tests.generate, wavefront, wave)) return false;
    std::uint32_t count = self_test::samples_of_wave;
    for (std::uint32_t generation = 0; generation <= depth && count > 0; ++generation) {
        const Generation here{{0, count, generation}, generation < depth};
        const bool right = test_intersect(tests.intersect, wavefront, bench.reference, here) &&
                           test_shade(tests.shade, wavefront, bench.reference, here) &&
                           test_shadow(tests.shadow, wavefront, bench.reference, here) &&
                           test_count_children(tests.count_children, wavefront, here) &&
                           test_sum_children(tests.sum_children, wavefront, here) &&
                           (!here.spawn || test_compact(tests.compact, wavefront, here, count));
        if (!right) return false;
        count = std::min(count, bench.queues.capacity);
    }
    return true;
}

SelfTestReport test_wavefront(Bench& bench, std::span<const TestWave> waves) {
    WaveTests tests;
    const WavefrontKernels& kernels = bench.wavefront.kernels;
    if (const Traversal way = kernels.intersect.way; way != kernels.shadow.way)
        tests.intersect.kernel = fmt::format("intersect_{}", name_of(way));
    for (const TestWave& wave : waves) {
        if (!test_wave(bench, wave, tests)) break;
    }
    return {tests.in_order()};
}

/// The kernel of batches whose rays go that way, among the others of `program`, which have passed.
KernelTest test_incoherent(Device& device, Program& program, Traversal way) {
    Program incoherent = build_incoherent_program(device, false);
    WavefrontKernels kernels(device.traversal(), program, tracing_kernel("intersect", way, incoherent));
    Bench bench(device, kernels);
    const SelfTestReport report = test_wavefront(bench, test_waves());
    if (const KernelTest* failed = report.failed()) return *failed;
    incoherent.record_self_test();
    return report.kernels[1];  // behind generate
}

KernelTest test_aovs(Bench& bench, Kernel& describe) {
    KernelTest test{"describe"};
    for (const TestWave& wave : test_waves()) {
        if (!test_describe(test, bench.wavefront, describe, bench.reference, wave)) break;
    }
    return test;
}

/// Remembers what has passed, or says what has not.
void conclude(Device& device, Program& program, const SelfTestReport& report,
              std::chrono::steady_clock::time_point start) {
    const DeviceInfo& info = device.info();
    if (const KernelTest* failed = report.failed()) {
        throw Error(
            ExitCode::device,
            fmt::format("device {} ({}, driver {}) computes wrongly: kernel {}{}, {}; update its driver "
                        "or choose another device with --device ('sahl devices --test' tests it again)",
                        info.name, info.platform, info.driver, failed->kernel,
                        program.is_optimized() ? "" : ", not optimized", failed->failure));
    }
    program.record_self_test();
    std::uint64_t checked = 0;
    for (const KernelTest& test : report.kernels) checked += test.checked;
    const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
    log_debug(fmt::format("self-test of device {}: {} answers of {} kernels are right ({:.0f} ms)", info.name,
                          checked, report.kernels.size(), taken.count()));
}

}  // namespace

const KernelTest* SelfTestReport::failed() const {
    const auto found = std::find_if(kernels.begin(), kernels.end(),
                                    [](const KernelTest& test) { return !test.failure.empty(); });
    return found == kernels.end() ? nullptr : &*found;
}

SelfTestReport self_test::run_waves(Device& device, WavefrontKernels& kernels,
                                    std::span<const TestWave> waves) {
    Bench bench(device, kernels);
    return test_wavefront(bench, waves);
}

SelfTestReport run_self_test(Device& device) {
    Program program = build_wavefront_program(device);
    WavefrontKernels kernels(device.traversal(), program);
    Bench bench(device, kernels);
    SelfTestReport report = test_wavefront(bench, test_waves());
    if (report.failed() != nullptr) return report;
    program.record_self_test();
    if (const Traversal way = device.incoherent_traversal(); way != device.traversal()) {
        report.kernels.push_back(test_incoherent(device, program, way));
        if (report.failed() != nullptr) return report;
    }
    Program aov_program = build_aov_program(device);
    Kernel describe = aov_program.kernel("describe");
    report.kernels.push_back(test_aovs(bench, describe));
    if (report.failed() == nullptr) aov_program.record_self_test();
    return report;
}

void test_before_first_use(Device& device, Program& program, WavefrontKernels& kernels) {
    if (program.passed_self_test()) return;
    const HostStep step("self-test");
    const auto start = std::chrono::steady_clock::now();
    Bench bench(device, kernels);
    conclude(device, program, test_wavefront(bench, test_waves()), start);
}

void compile_for_another_process(const DeviceOptions& options) {
    std::optional<std::string> compiled;
    try {
        Device device(options);
        Program program = build_wavefront_program(device);
        WavefrontKernels kernels(device.traversal(), program);
        Bench bench(device, kernels);
        // A hit of which nothing becomes: PoCL compiles what is launched, in this order.
        const WaitingBatch batch{0, 1, 0};
        RayQueues& queues = bench.queues;
        launch_shadow(bench.wavefront, batch, queues.contributions[0]);
        launch_compact(bench.wavefront, batch, queues.batches[0], queues.batches[1], queues.contributions[0]);
        launch_count_children(bench.wavefront, batch);
        launch_sum_children(bench.wavefront, batch, queues.contributions[0]);
        compiled = program.compiled_files();
    } catch (const std::exception&) {
        // Who has asked finds out by itself, and can say it.
    }
    deliver_compiled(compiled);
}

void test_before_first_use(Device& device, Program& program, Kernel& describe, WavefrontKernels& kernels) {
    if (program.passed_self_test()) return;
    const auto start = std::chrono::steady_clock::now();
    Bench bench(device, kernels);
    conclude(device, program, {{test_aovs(bench, describe)}}, start);
}

}  // namespace sahl
