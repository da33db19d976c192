// kernels/bvh.h: the order in which the children that a ray meets go onto its stack.
#include <catch2/catch.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/kernel_runner.h"

namespace sahl::tests {
namespace {

// Child s is called 100 + s and entered at s + 0.5, or missed by that much.
constexpr const char* kOrderKernel = R"(
#include "kernels/bvh.h"
kernel void order(const global BvhNode* nodes, global uint* counts, global uint* children,
                  global float* entries, const uint count) {
    TEST_FOR_EACH(i, count) {
        const uint octant = i >> 8;
        const float3 direction = {octant & 1u ? -1.0f : 1.0f, octant & 2u ? -1.0f : 1.0f, octant & 4u ? -1.0f : 1.0f};
        const RayBoxTest test = ray_box_test((float3)(0.0f), direction, 1.0f);
        float enter[8], leave[8];
        for (uint s = 0; s < 8u; ++s) {
            enter[s] = s + 0.5f;
            leave[s] = i >> s & 1u ? enter[s] : 0.0f;
        }
        WaitingChild stack[9];
        counts[i] = (uint)(push_children(nodes + i, vload8(0, enter), vload8(0, leave), &test, stack + 1) - (stack + 1));
        for (uint k = 0; k < counts[i]; ++k) {
            children[8u * i + k] = stack[1u + k].child;
            entries[8u * i + k] = stack[1u + k].entry;
        }
    }
}
)";

}  // namespace

TEST_CASE("children that are met go onto the stack, the last to visit first, on every code path") {
    constexpr std::size_t octants = 8, masks = 256, count = octants * masks;
    device::BvhNode node{};
    for (std::uint32_t s = 0; s < 8; ++s) node.child[s] = 100 + s;
    const std::vector<device::BvhNode> nodes(count, node);
    for (const std::string option : {"", "-DSAHL_PLAIN_OPENCL", "-DSAHL_NO_AVX512"}) {
        CAPTURE(option);
        KernelRunner runner(kOrderKernel, option);
        Buffer counts(runner.device(), count * sizeof(std::uint32_t), "counts");
        Buffer children(runner.device(), 8 * count * sizeof(std::uint32_t), "children");
        Buffer entries(runner.device(), 8 * count * sizeof(float), "entries");
        runner.run("order", count, runner.upload(nodes), counts, children, entries);
        const auto met = KernelRunner::download<std::uint32_t>(counts, count);
        const auto child = KernelRunner::download<std::uint32_t>(children, 8 * count);
        const auto entry = KernelRunner::download<float>(entries, 8 * count);
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::uint32_t octant = i / masks;
            CAPTURE(octant, i % masks);
            std::size_t k = 0;
            for (std::uint32_t visit = 8; visit-- > 0;) {
                const std::uint32_t slot = visit ^ octant;
                if ((i >> slot & 1U) == 0) continue;
                REQUIRE(k < met[i]);
                REQUIRE(child[8 * i + k] == 100 + slot);
                REQUIRE(entry[8 * i + k] == static_cast<float>(slot) + 0.5F);
                ++k;
            }
            REQUIRE(met[i] == k);
        }
    }
}

}  // namespace sahl::tests
