// kernels/stream_ray.h: eight rays that are prepared together are those that are prepared one by one; and
// kernels/hit.h: which rays can be traced.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "kernels/device_types.h"
#include "kernels/rays_per_item.h"
#include "tests/support/kernel_runner.h"

namespace sahl::tests {
namespace {

// wrong[i]: how many numbers of ray i differ.
constexpr const char* kStreamKernels = R"(
#include "kernels/traverse_stream.h"
#define DIFFERS(a, b) (as_uint(a) != as_uint(b))
kernel void prepared(const global float* rays, const global uint* ray_ids, global uint* wrong, const uint count) {
    const float extent = 3.5f;
    TEST_FOR_EACH_GROUP(i, count) {
        const RaySource source = {rays, ray_ids, 0, 0, count, 0};
        StreamRay prepared[SAHL_LANES];
        StreamRay* places[SAHL_LANES];
        for (uint k = 0; k < SAHL_LANES; ++k) { places[k] = prepared + k; }
        prepare_rays(&source, i, extent, places, false);
        for (uint k = 0; k < SAHL_LANES; ++k) {
            const Ray from = load_ray(rays, ray_ids, count, i + k);
            const TracedRay one = traced_ray(from.origin, from.direction, &from, SAHL_WORLD, extent);
            const StreamRay* ray = prepared + k;
            const bool traceable = can_meet_anything(&from);
            uint differ = DIFFERS(ray->cull_t, traceable ? INFINITY : -INFINITY) + (ray->index != i + k) +
                          DIFFERS(ray->state.t, INFINITY) + (ray->state.primitive != SAHL_NO_PRIMITIVE) +
                          (ray->ray.exclude != one.ray.exclude) + (ray->ray.instance != SAHL_WORLD);
            for (uint a = 0; traceable && a < 3u; ++a) {
                differ += DIFFERS(ray->boxes.inverse[a], one.boxes.inverse[a]) +
                          DIFFERS(ray->boxes.near_addend[a], one.boxes.near_addend[a]) +
                          DIFFERS(ray->boxes.far_addend[a], one.boxes.far_addend[a]) +
                          DIFFERS(((const float*)&ray->ray.origin)[a], ((const float*)&from.origin)[a]) +
                          DIFFERS(((const float*)&ray->ray.direction)[a], ((const float*)&from.direction)[a]);
            }
            if (traceable) {
                differ += (ray->boxes.octant != one.boxes.octant) + (ray->boxes.near.x != one.boxes.near.x) +
                          (ray->boxes.near.y != one.boxes.near.y) + (ray->boxes.near.z != one.boxes.near.z) +
                          (ray->boxes.slots[0] != one.boxes.slots[0]) + (ray->boxes.slots[1] != one.boxes.slots[1]) +
                          (ray->shear.kx != one.shear.kx) + (ray->shear.ky != one.shear.ky) +
                          (ray->shear.kz != one.shear.kz) + DIFFERS(ray->shear.ox, one.shear.ox) +
                          DIFFERS(ray->shear.oy, one.shear.oy) + DIFFERS(ray->shear.oz, one.shear.oz) +
                          DIFFERS(ray->shear.sx, one.shear.sx) + DIFFERS(ray->shear.sy, one.shear.sy);
            }
            wrong[i + k] = differ;
        }
    }
}
// Bit 0: by the test of one ray, bit 1: by that of eight.
kernel void traceable(const global float* rays, const global uint* ray_ids, global uint* out, const uint count) {
    TEST_FOR_EACH_GROUP(i, count) {
        float8 o[3], d[3];
        for (uint a = 0; a < 3u; ++a) {
            o[a] = vload8(0, rays + (SAHL_RAY_ORIGIN + a) * count + i);
            d[a] = vload8(0, rays + (SAHL_RAY_DIRECTION + a) * count + i);
        }
        const int8 of_eight = are_traceable(o, d);
        for (uint k = 0; k < 8u; ++k) {
            const Ray ray = load_ray(rays, ray_ids, count, i + k);
            out[i + k] = (uint)can_meet_anything(&ray) | (((const int*)&of_eight)[k] != 0 ? 2u : 0u);
        }
    }
}
)";

using Vector = std::array<float, 3>;

/// Rays as kernels read them, filled up to whole groups.
struct RayArrays {
    std::vector<Vector> origins, directions;

    void add(const Vector& origin, const Vector& direction) {
        origins.push_back(origin);
        directions.push_back(direction);
    }
    std::size_t size() const { return (origins.size() + SAHL_LANES - 1) / SAHL_LANES * SAHL_LANES; }

    std::vector<float> floats() const {
        std::vector<float> arrays(SAHL_RAY_FLOATS * size(), 1.0F);
        for (std::size_t i = 0; i < origins.size(); ++i) {
            for (std::size_t a = 0; a < 3; ++a) {
                arrays[(SAHL_RAY_ORIGIN + a) * size() + i] = origins[i][a];
                arrays[(SAHL_RAY_DIRECTION + a) * size() + i] = directions[i][a];
            }
        }
        return arrays;
    }
    /// Some start on primitives of the world, some on those of an instance.
    std::vector<std::uint32_t> ids() const {
        std::vector<std::uint32_t> arrays(SAHL_RAY_UINTS * size());
        for (std::uint32_t i = 0; i < size(); ++i) {
            arrays[SAHL_RAY_EXCLUDE * size() + i] = i % 3 == 0 ? SAHL_NO_PRIMITIVE : i | SAHL_RAY_ATTENUATED;
            arrays[SAHL_RAY_INSTANCE * size() + i] = i % 4 == 1 ? i : SAHL_WORLD;
        }
        return arrays;
    }
};

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

/// All vectors of some awkward numbers.
std::vector<Vector> awkward_vectors() {
    const std::vector<float> numbers{0, -0.0F, 1, -1, 0.5F, 1e-18F, -1e-19F, 1e-40F, not_a_number, -infinity};
    std::vector<Vector> vectors;
    for (const float x : numbers)
        for (const float y : numbers)
            for (const float z : numbers) vectors.push_back({x, y, z});
    return vectors;
}

}  // namespace

TEST_CASE("rays that are prepared together are those that are prepared one by one, on every code path") {
    RayArrays batch;
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    const auto any = [&] { return Vector{normal(random), normal(random), normal(random)}; };
    for (int i = 0; i < 1000; ++i) batch.add(any(), any());
    for (const Vector& direction : awkward_vectors()) batch.add(any(), direction);
    for (const Vector& origin : awkward_vectors()) batch.add(origin, any());
    for (const std::string option : {"", "-DSAHL_PLAIN_OPENCL", "-DSAHL_NO_AVX512"}) {
        CAPTURE(option);
        KernelRunner runner(kStreamKernels, option);
        Buffer wrong(runner.device(), batch.size() * sizeof(std::uint32_t), "differences");
        runner.run("prepared", batch.size(), runner.upload(batch.floats()), runner.upload(batch.ids()),
                   wrong);
        CHECK(KernelRunner::download<std::uint32_t>(wrong, batch.size()) ==
              std::vector<std::uint32_t>(batch.size()));
    }
}

TEST_CASE("rays can be traced up to the same limits one by one and together") {
    RayArrays batch;
    std::vector<std::uint32_t> wanted;
    const auto add = [&](const Vector& origin, const Vector& direction, bool traceable) {
        batch.add(origin, direction);
        wanted.push_back(traceable ? 3 : 0);
    };
    const float largest = 0x1p60F, shortest = 0x1p-40F;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const float sign : {1.0F, -1.0F}) {
            const auto along = [&](float x) {
                Vector vector{0, -0.0F, 0};
                vector[axis] = sign * x;
                return vector;
            };
            for (const float x : {largest, std::nextafter(largest, infinity), infinity, not_a_number}) {
                add(along(x), {0, 1, 0}, x == largest);
                add({0, 0, 0}, along(x), x == largest);
            }
            for (const float x : {shortest, std::nextafter(shortest, 0.0F), 0.0F})
                add({0, 0, 0}, along(x), x == shortest);
        }
    }
    for (const std::string option : {"", "-DSAHL_PLAIN_OPENCL", "-DSAHL_NO_AVX512"}) {
        CAPTURE(option);
        KernelRunner runner(kStreamKernels, option);
        Buffer out(runner.device(), batch.size() * sizeof(std::uint32_t), "verdicts");
        runner.run("traceable", batch.size(), runner.upload(batch.floats()), runner.upload(batch.ids()), out);
        CHECK(KernelRunner::download<std::uint32_t>(out, wanted.size()) == wanted);
    }
}

}  // namespace sahl::tests
