// Every OpenCL object is given back: a context is kept by all that was made in it.
#include <chrono>
#include <thread>
#include <vector>

#include <catch2/catch.hpp>

#include "engine/device/device_impl.h"
#include "engine/self_test/every_feature.h"
#include "engine/self_test/self_test.h"
#include "tests/render/rendered.h"

namespace sahl::tests {
namespace {

cl_uint references(Device& device) {
    device.finish();
    return device.impl().context.getInfo<CL_CONTEXT_REFERENCE_COUNT>();
}

cl_uint queue_references(Device& device) { return device.impl().queue.getInfo<CL_QUEUE_REFERENCE_COUNT>(); }

/// Whether the device's context and queue get back to these counts. A thread of PoCL lets go of a command,
/// and with it of queue and context, a moment after clFinish has returned: what is merely late gets 10 s, a
/// leak never does.
bool all_given_back(Device& device, cl_uint context_count, cl_uint queue_count) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (references(device) != context_count || queue_references(device) != queue_count) {
        if (std::chrono::steady_clock::now() > deadline) {
            return false;
        }
        std::this_thread::yield();
    }
    return true;
}

}  // namespace

TEST_CASE("release: a renderer's OpenCL objects go with it, whatever it did", "[release]") {
    Device device;
    const cl_uint before = references(device);
    const cl_uint queue_before = queue_references(device);
    {
        device.launches().enable(true);
        Renderer renderer(device, every_feature());
        CHECK(references(device) > before + 9);  // buffers, a program, kernels
        RenderSettings settings = square_settings(20, 3);
        settings.ray_budget = 128;
        Film film(device.memory(), 20, 20);
        renderer.render(settings, film);
        const std::vector<Aov> aovs{Aov::depth, Aov::normal};
        renderer.render_aovs(settings, aovs);
        CHECK(device.launches().take().size() > 30);
        device.launches().enable(false);
    }
    CHECK(all_given_back(device, before, queue_before));
    CHECK(device.memory().current() == 0);

    // Errors on the way leave nothing behind either.
    device.memory().set_limit(60000);
    CHECK_THROWS_AS(Renderer(device, every_feature()), Error);
    CHECK(all_given_back(device, before, queue_before));
    CHECK(device.memory().current() == 0);
    device.memory().set_limit(SIZE_MAX);
    CHECK(run_self_test(device).failed() == nullptr);
    CHECK(all_given_back(device, before, queue_before));
    CHECK(device.memory().current() == 0);
}

}  // namespace sahl::tests
