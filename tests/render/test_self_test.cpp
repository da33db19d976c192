// The self-test of a device: right kernels pass it, each kind of mistake is found in the kernel that makes
// it.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <random>

#include <catch2/catch.hpp>

#include "engine/self_test/kernel_tests.h"
#include "engine/self_test/self_test.h"
#include "tests/device/test_device_support.h"
#include "tests/render/rendered.h"
#include "tests/support/broken_kernels.h"
#include "tests/support/kernel_runner.h"

namespace sahl::tests {
namespace {

TEST_CASE("self-test: this device passes, thousands of rays a kernel", "[self_test]") {
    const SelfTestReport report = run_self_test(test_device());
    std::vector<std::string> kernels;
    for (const KernelTest& test : report.kernels) {
        INFO(test.kernel << ": " << test.failure);
        CHECK(test.failure == "");
        // Far from what is allowed: another device may round otherwise.
        CHECK(test.worst <= test.allowed / 4);
        const bool of_rays = test.allowed > 0;
        CHECK(test.checked >= (of_rays ? 3000U : 100U));
        kernels.push_back(test.kernel);
    }
    CHECK(report.failed() == nullptr);
    CHECK(kernels == std::vector<std::string>{"generate", "intersect", "shade", "shadow", "count_children",
                                              "sum_children", "compact", "intersect_stream", "describe"});
}

TEST_CASE("self-test: it holds less than a megabyte, and nothing behind it", "[self_test]") {
    Device device;
    CHECK(run_self_test(device).failed() == nullptr);
    CHECK(device.memory().peak() < 1U << 20U);
    CHECK(device.memory().current() == 0);
}

TEST_CASE("self-test: right kernels are not refused, wherever rays go", "[self_test]") {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<self_test::TestWave> waves(full_tests() ? 600 : 12);
    for (self_test::TestWave& wave : waves) {
        const auto vector = [&](double x, double y, double z) {
            const glm::dvec3 v{x * uniform(random), y * uniform(random), 0};
            return glm::dvec3{v.x, v.y, z * (uniform(random) + 1) + 0.05};
        };
        wave.camera = {vector(6, 5, 2), vector(2, 2, 0.8), {0.1, 0.2, 1}, 70 + 60 * uniform(random)};
        wave.settings.resolution = {36, 28};
        wave.settings.seed = random();
        wave.crop = {0, 0, 36, 28};
    }
    Device& device = test_device();
    Program program = build_wavefront_program(device);
    WavefrontKernels kernels(device.traversal(), program);
    const SelfTestReport report = self_test::run_waves(device, kernels, waves);
    for (const KernelTest& test : report.kernels) {
        INFO(test.kernel << ": " << test.checked << " checked, worst " << test.worst);
        CHECK(test.failure == "");
        CHECK(test.checked > 0);
    }
}

/// Mistakes of every step, in the order of the kernels; one after the other is put into right kernels.
const std::vector<Fault> faults{
    {"generate", "camera.h", "(real)camera->half_width", "(real)0.5 - (real)camera->half_width"},
    {"generate", "sampling.h", "((float)i + jitter)", "((float)i)"},
    {"generate", "rng.h", "round < 10", "round < 9"},
    {"generate", "camera.h", "place.column = rest % place.columns", "place.column = rest / place.columns"},
    {"generate", "camera.h", "= place.left + lane % SAHL_BLOCK_COLUMNS", "= place.left + lane / 2u"},
    {"generate", "generate.cl", "same3((float3)(1.0f)), pixels",
     "same3((float3)(1.0f, 1.0f, 0.999f)), pixels"},
    {"intersect_stream", "sphere.h", "chords.middle - half", "chords.middle + half"},
    {"intersect_stream", "triangle.h", "((float*)&v)[lane] * scale", "((float*)&v)[lane] * 0.999f * scale"},
    {"intersect_stream", "triangle.h", "(vload4(0, block->z) - o.z)) /", "(vload4(0, block->z) - o.x)) /"},
    {"intersect_stream", "stream_ray.h", "words[6] = -(", "words[6] = ("},
    {"intersect_stream", "stream_ray.h", "words[3u + k] = -(", "words[3u + k] = ("},
    {"intersect", "triangle_group.h", "v * scale", "w * scale"},
    {"intersect", "triangle_group.h", "height / *nd", "height / fabs(*nd)"},
    {"intersect", "shape_group.h", "chords.middle - half_chord, chords",
     "chords.middle + half_chord, chords"},
    {"shadow", "shape_group.h", "notg(starting) | enter_is_origin", "notg(starting)"},
    {"intersect", "shape_group.h", "o[0] - block->x[lane]", "o[0]"},
    {"intersect", "shape_group.h", "notg(equalg(inside | on_outline, (intg)(0)))",
     "equalg((intg)(0), (intg)(0))"},
    {"intersect", "ray_group.h", "seen & front", "seen"},
    {"intersect", "crossings_of_width.h", "x * x + y * y <= 1.0f", "x * x + y * y <= 1.02f"},
    {"intersect", "polygon.h", "((edge > 0.0f) == (by > ay))", "(edge > 0.0f)"},
    {"intersect", "crossings_of_width.h", "SAHL_MAX(x - half_x, y - half_y), z - half_z)",
     "x - half_x, y - half_y)"},
    {"intersect", "crossings_of_width.h", "(1.0f - (r->px", "(1.001f - (r->px"},
    {"intersect", "crossings_of_width.h", "(enter_z >= 0.0f) & (enter_z <= 1.0f)", "(enter_z >= 0.0f)"},
    {"intersect", "crossings_of_width.h", "SAHL_MIN(last, SAHL_MAX(bottom, top))", "last"},
    {"intersect_stream", "hit.h", "front ? SAHL_ID_BACK_ONLY : SAHL_ID_FRONT_ONLY",
     "front ? SAHL_ID_BACK_ONLY : 0u"},
    {"intersect", "traverse_packet.h", "groups_that_reach(entries[size]",
     "groups_that_reach(2.0f * entries[size]"},
    {"shadow", "packet.h", "backward ? lo - margin : hi + margin", "backward ? hi + margin : lo - margin"},
    {"intersect", "traverse_packet.h", "(intg)((int)i + 1)", "(intg)((int)i + 2)"},
    {"intersect", "instance.h", "instance_element(instance, 2, 3)", "(real)0"},
    {"shade", "material.h", "light = mul(diffuse, SAHL_MAX(cosine, (floatv)(0.0f)))",
     "light = mul(diffuse, 1.01f * SAHL_MAX(cosine, (floatv)(0.0f)))"},
    {"shade", "material.h", "mul(ns, 2.0f * cosine)", "mul(ns, 1.99f * cosine)"},
    {"shade", "material.h", "dotv(ns, h) / sqrt(length2)", "dotv(ns, h) / length2"},
    {"shade", "material.h", "1.0f / attenuation(a, distance))", "(floatv)(1.0f))"},
    {"shade", "material.h", "(real)2 * dotv(d, n)", "(real)1.999 * dotv(d, n)"},
    {"shade", "material.h", "(real)1 - eta * eta * (", "(real)1 - eta * ("},
    {"shade", "shade.cl", "(realv)(outside / ior), (realv)(ior / outside)",
     "(realv)(ior / outside), (realv)(outside / ior)"},
    {"shade", "shade.cl", "add(s.kr, s.kt)", "s.kr"},
    {"shade", "shade.cl", "SAHL_MATERIAL_TWO_SIDED ? facing : surfaces.ns",
     "SAHL_MATERIAL_TWO_SIDED ? facing : facing"},
    {"shade", "shade.cl", "SAHL_MATERIAL_ATTENUATES ? SAHL_RAY_ATTENUATED : 0u",
     "SAHL_MATERIAL_ATTENUATES ? 0u : 0u"},
    {"shade", "shade.cl", "mul(weight, s.kt), pixel", "s.kt, pixel"},
    {"shade", "shade.cl", "work->scene->background[1]", "work->scene->background[2]"},
    {"shade", "light.h", "mul(color, spot_falloff(light, wi)) : color", "color : color"},
    {"shade", "light.h", "x * x * (3.0f - 2.0f * x)", "x"},
    {"shade", "light.h", "a[2] * distance * distance", "a[2] * distance"},
    {"shade", "texture.h", "mul(a, 1.0f - x), mul(b, x)", "mul(a, x), mul(b, 1.0f - x)"},
    {"shade", "texture.h", "is_odd(cells(q.x, extent.x) +", "is_odd("},
    {"shade", "texture.h", "p.x * uv[2] + p.y * uv[4]", "p.y * uv[2] + p.x * uv[4]"},
    {"shade", "texture.h", "(real)1 - p.z : p.z", "p.z : p.z"},
    {"shade", "texture.h", "(real)2 * turn_of((float)-p.z", "(real)1 * turn_of((float)-p.z"},
    {"shade", "texture.h",
     "colors.reflection = SAHL_TEXTURED(colors.reflection, material->reflection_texture);", ""},
    {"shade", "power.h", "0.0555035711f", "0.0455035711f"},
    {"shade", "surface.h", "mul(vectors_of(at_corners + 6), v)", "mul(vectors_of(at_corners + 6), u)"},
    {"shade", "surface.h", "smooth ? at + 9u : at", "at"},
    {"shade", "surface.h", "where_surfaces(these, of_these, *s)", "of_these"},
    {"shade", "ray_batch.h", "vstorev(lanes.alone ? v : where(lanes.mask, v, vloadv(p)), p)",
     "vstorev(v, p)"},
    {"shade", "shade.cl", "lanes.mask ? outcome : outcomes", "outcome"},
    {"shade", "surface.h", "-slope * ((real)1 + slope * p.z)}", "(realv)(0)}"},
    {"shade", "surface.h", "where_points(within & cap_nearer, cap, side)", "side"},
    {"shade", "surface.h", "sub(position, offset), add(position, offset)",
     "add(position, offset), sub(position, offset)"},
    {"intersect_stream", "hit.h", "enter_is_origin = fabs(enter) < fabs(leave)", "enter_is_origin = false"},
    {"shadow", "light.h", "SAHL_LIGHT_DIRECTIONAL ? INFINITY : 1.0f",
     "SAHL_LIGHT_DIRECTIONAL ? INFINITY : 2.0f"},
    {"shadow", "shadow_work.h", "through *= load3", "through = load3"},
    {"shadow", "shadow_work.h", "capacity, i, sum + light", "capacity, i, light"},
    {"shadow", "shadow_work.h", "load_soa3(work->light, 3u * l, work->capacity, i)",
     "load_soa3(work->light, 0u, work->capacity, i)"},
    {"shadow", "shadow_rays.h", "[lowest_lane(rest)];", "[0];"},
    {"count_children", "compact.cl", "shadow_rays += outcome / SAHL_OUTCOME_SHADOW_RAY",
     "shadow_rays += outcome / SAHL_OUTCOME_SHADOW_RAY != 0u"},
    {"count_children", "compact.cl", "block_counts[block_count + block] = transmitted",
     "block_counts[block_count + block] = reflected"},
    {"sum_children", "compact.cl", "k < 2u * block_count", "k < 2u * block_count - 1u"},
    {"sum_children", "compact.cl", "totals[SAHL_TOTAL_SHADOW_RAYS] = (uint)shadow_rays",
     "totals[SAHL_TOTAL_SHADOW_RAYS] = (uint)(shadow_rays + 1u)"},
    {"compact", "compact.cl", "next[to + k] = from[place[k]]", "next[to + k] = from[place[0]]"},
    {"compact", "compact.cl", "k < SAHL_RAY_UINTS", "k < SAHL_RAY_UINTS - 1u"},
    {"compact", "compact.cl", "waiting[to + k - capacity]", "waiting[to + k - capacity + (k == fitting)]"},
    {"describe", "aov.cl", "turned ? facing : surfaces.ns", "surfaces.ns"},
    {"describe", "aov.cl", "surface_colors(&shapes, material, textures, &surfaces, primitive).diffuse",
     "same3(load3(material->diffuse))"},
    {"describe", "aov.cl", "convert_floatv(surfaces.t * dotv", "convert_floatv(dotv"},
};

TEST_CASE("self-test: each mistake has its place in the kernels", "[self_test]") {
    const TemporaryFolder folder;
    for (const Fault& fault : faults) {
        copy_kernels(folder.path() / "kernels");
        CHECK_NOTHROW(break_kernel(folder.path() / "kernels", fault));
        std::filesystem::remove_all(folder.path() / "kernels");
    }
}

TEST_CASE("self-test: each mistake is found in the kernel that makes it", "[self_test]") {
    const TemporaryFolder cache;
    const ScopedVariable no_cache("SAHL_CACHE_DIR", cache.path().string());
    Device one_by_one({.selector = {}, .traversal = Traversal::scalar});
    // Each takes a second or two: kernels are compiled for it.
    const std::size_t step = full_tests() ? 1 : 20;
    for (std::size_t i = 0; i < faults.size(); i += step) {
        const Fault& fault = faults[i];
        const TemporaryFolder kernels;
        copy_kernels(kernels.path());
        break_kernel(kernels.path(), fault);
        const ScopedVariable from("SAHL_KERNEL_DIR", kernels.path().string());
        INFO(fault.file << ": " << fault.from << " -> " << fault.to);
        SelfTestReport report = run_self_test(test_device());
        // Some of the code is for rays that are traced one by one.
        if (report.failed() == nullptr) report = run_self_test(one_by_one);
        const KernelTest* failed = report.failed();
        CHECK(failed != nullptr);
        if (failed == nullptr) continue;
        INFO(failed->failure);
        CHECK(failed->kernel == fault.kernel);
        CHECK(contains(failed->failure, "expected"));
    }
}

}  // namespace
}  // namespace sahl::tests
