// kernels/material.h, light.h and surface.h's offset: closed forms.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "kernels/device_types.h"
#include "tests/device/random_shapes.h"
#include "tests/support/kernel_runner.h"

namespace sahl::tests {
namespace {

using glm::dvec3;

constexpr const char* kMaterialKernels = R"(
#include "kernels/light.h"
#include "kernels/material.h"
#include "kernels/surface.h"
// v's lanes into place `place` of the `width` vectors that each index has in `out`.
static inline void store_lanes3(floatv3 v, global float* out, uint i, uint width, uint place, uint count) {
    for (uint k = 0; k < SAHL_LANES && i + k < count; ++k) {
        vstore3((float3)(((const float*)&v.x)[k], ((const float*)&v.y)[k], ((const float*)&v.z)[k]),
                width * (i + k) + place, out);
    }
}
kernel void reflect_light(const global DeviceMaterial* material, const global float4* ns, const global float4* wi,
                          const global float4* wo, global float* out, const uint count) {
    TEST_FOR_EACH_GROUP(i, count) {
        store_lanes3(phong_light(material, same3(load3(material->diffuse)), same3(load3(material->specular)),
                                 TEST_LANES3(ns, i), TEST_LANES3(wi, i), TEST_LANES3(wo, i)),
                     out, i, 1, 0, count);
    }
}
kernel void bend(const global float4* d, const global float4* n, global float* out, const uint count) {
    TEST_FOR_EACH_GROUP(i, count) {
        const realv3 direction = normalizev(widen(TEST_LANES3(d, i))), normal = normalizev(widen(TEST_LANES3(n, i)));
        realv3 refracted = same3_real((real3)(0));
        const intv passes = convert_intv(
            refracted_directions(direction, normal, convert_realv(TEST_LANES_OF(floatv, d, i, w)), &refracted));
        store_lanes3(roundv(reflected_directions(direction, normal)), out, i, 3, 0, count);
        store_lanes3(roundv(refracted), out, i, 3, 1, count);
        store_lanes3(where(passes, same3((float3)(1.0f, 0.0f, 0.0f)), same3((float3)(0.0f))), out, i, 3, 2, count);
    }
}
kernel void arrive(const global DeviceLight* lights, const uint light, const global float4* position,
                   global float* out, const uint count) {
    TEST_FOR_EACH_GROUP(i, count) {
        const floatv3 to_light = vectors_to_light(lights + light, TEST_LANES3(position, i));
        store_lanes3(to_light, out, i, 3, 0, count);
        store_lanes3(arriving_light(lights + light, normalizev(to_light), sqrt(dotv(to_light, to_light))), out, i, 3, 1, count);
        store_lanes3(same3((float3)(shadow_t_max(lights + light))), out, i, 3, 2, count);
    }
}
kernel void offset(const global float4* position, const global float4* off, const global float4* direction,
                   global float* out, const uint count) {
    TEST_FOR_EACH_GROUP(i, count) {
        store_lanes3(offset_origins(TEST_LANES3(position, i), TEST_LANES3(off, i), TEST_LANES3(direction, i)), out, i, 1, 0, count);
    }
}
)";

struct Float4 {
    float x, y, z, w;
};

Float4 pack(const dvec3& v, double w = 0) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), static_cast<float>(w)};
}

dvec3 unpack(const Float4& v) { return {v.x, v.y, v.z}; }

dvec3 at(const std::vector<float>& out, std::size_t i) {
    return {out[3 * i], out[3 * i + 1], out[3 * i + 2]};
}

dvec3 reflect(const dvec3& d, const dvec3& n) { return d - 2 * glm::dot(d, n) * n; }

}  // namespace

TEST_CASE("Phong and Blinn are their formulas") {
    KernelRunner runner(kMaterialKernels);
    Random random(31);
    std::vector<Float4> ns, wi, wo;
    for (int i = 0; i < 20000; ++i) {
        const dvec3 n = unit_vector(random), l = unit_vector(random);
        ns.push_back(pack(n));
        wi.push_back(pack(l));
        // Every other time near the highlight, and now and then exactly opposite to the light.
        const dvec3 mirrored = -reflect(l, n);
        wo.push_back(pack(i % 2 ? unit_vector(random) : glm::normalize(mirrored + 0.05 * in_ball(random))));
        if (i % 100 == 1) wo.back() = pack(-l);
    }
    for (const float shininess : {0.0F, 1.0F, 7.5F, 100.0F, 5000.0F}) {
        for (const bool blinn : {false, true}) {
            CAPTURE(shininess, blinn);
            device::DeviceMaterial material{};
            material.shininess = shininess;
            material.flags = blinn ? SAHL_MATERIAL_BLINN : 0U;
            const dvec3 diffuse(0.25, 0.5, 0.125), specular(0.5, 0.25, 1);
            for (int k = 0; k < 3; ++k) {
                material.diffuse[k] = static_cast<float>(diffuse[k]);
                material.specular[k] = static_cast<float>(specular[k]);
            }
            Buffer out(runner.device(), 3 * ns.size() * 4, "light");
            runner.run("reflect_light", ns.size(), runner.upload(std::vector{material}), runner.upload(ns),
                       runner.upload(wi), runner.upload(wo), out);
            const auto got = KernelRunner::download<float>(out, 3 * ns.size());
            for (std::size_t i = 0; i < ns.size(); ++i) {
                const dvec3 n = unpack(ns[i]), l = unpack(wi[i]), v = unpack(wo[i]);
                const double cosine = glm::dot(n, l);
                double lobe = 0, base = 0;
                if (blinn) {
                    const dvec3 h = l + v;
                    base = glm::dot(h, h) > 0 ? glm::dot(n, h) / glm::length(h) : -1;
                    lobe = base >= 0 ? std::pow(base, static_cast<double>(shininess)) : 0;
                    // A base below 0 is clamped to 0, and 0^0 = 1.
                    if (base < 0 && shininess == 0 && glm::dot(h, h) > 0) lobe = 1;
                } else if (cosine > 0) {
                    base = glm::dot(2 * cosine * n - l, v);
                    lobe = std::pow(std::max(base, 0.0), static_cast<double>(shininess));
                }
                // n roundings of the base are one of its power.
                const double tolerance = 1e-6 * (1 + static_cast<double>(shininess));
                const dvec3 wanted = diffuse * std::max(cosine, 0.0) + specular * lobe;
                REQUIRE(glm::distance(at(got, i), wanted) < tolerance);
            }
        }
    }
}

TEST_CASE("mirrored and refracted directions obey their laws") {
    KernelRunner runner(kMaterialKernels);
    Random random(32);
    std::vector<Float4> d, n;
    for (int i = 0; i < 20000; ++i) {
        const dvec3 normal = unit_vector(random);
        dvec3 direction = unit_vector(random);
        if (glm::dot(direction, normal) > 0) direction = -direction;
        if (i % 10 == 0) direction = -normal;
        d.push_back(pack(direction, i % 5 == 0 ? 1 : std::exp2(uniform(random, -1.5, 1.5))));
        n.push_back(pack(normal));
    }
    const auto got = runner.map<float>("bend", 9, d, n);
    int total = 0;
    for (std::size_t i = 0; i < d.size(); ++i) {
        const dvec3 direction = glm::normalize(unpack(d[i])), normal = glm::normalize(unpack(n[i]));
        const dvec3 mirrored = at(got, 3 * i), refracted = at(got, 3 * i + 1);
        REQUIRE(glm::distance(mirrored, reflect(direction, normal)) < 2e-7);
        // sin of the angle behind the surface.
        const double eta = d[i].w, sine = eta * glm::length(glm::cross(direction, normal));
        if (std::abs(sine - 1) < 1e-12) continue;
        REQUIRE((at(got, 3 * i + 2).x == 1) == (sine < 1));
        if (sine > 1) {
            ++total;
            continue;
        }
        const double angle = std::asin(sine);
        const dvec3 along = direction - glm::dot(direction, normal) * normal;
        const dvec3 sideways = glm::length(along) > 1e-9 ? glm::normalize(along) : dvec3(0);
        REQUIRE(glm::distance(refracted, std::sin(angle) * sideways - std::cos(angle) * normal) < 2e-7);
        if (d[i].w == 1) REQUIRE(glm::distance(refracted, direction) < 2e-7);
    }
    CHECK(total > 1000);
}

TEST_CASE("total reflection begins at the critical angle") {
    KernelRunner runner(kMaterialKernels);
    std::vector<Float4> d, n;
    for (int i = 0; i < 2000; ++i) {
        // From glass, sin = 2/3 is critical; steps of 1e-6 around it.
        const double sine = 2.0 / 3 + (i - 1000) * 1e-6;
        d.push_back(pack({sine, 0, -std::sqrt(1 - sine * sine)}, 1.5));
        n.push_back({0, 0, 1, 0});
    }
    const auto got = runner.map<float>("bend", 9, d, n);
    for (std::size_t i = 0; i < d.size(); ++i) {
        const double x = d[i].x, z = d[i].z, sine = 1.5 * x / std::sqrt(x * x + z * z);
        REQUIRE((at(got, 3 * i + 2).x == 1) == (sine <= 1));
    }
}

TEST_CASE("light arrives with its distance's attenuation") {
    KernelRunner runner(kMaterialKernels);
    device::DeviceLight point{{1, 2, 3}, SAHL_LIGHT_POINT, {4, 5, 6}, 0, {0.5F, 0.25F, 0.125F}, 0, {}, 0};
    device::DeviceLight sun{
        {0, 0.6F, 0.8F}, SAHL_LIGHT_DIRECTIONAL, {4, 5, 6}, 0, {0.5F, 0.25F, 0.125F}, 0, {}, 0};
    Buffer lights = runner.upload(std::vector{point, sun});
    Random random(33);
    std::vector<Float4> positions{{1, 2, 2, 0}};
    for (int i = 0; i < 1000; ++i) positions.push_back(pack(100.0 * in_ball(random)));
    for (const std::uint32_t light : {0U, 1U}) {
        Buffer out(runner.device(), 9 * positions.size() * 4, "light");
        runner.run("arrive", positions.size(), lights, light, runner.upload(positions), out);
        const auto got = KernelRunner::download<float>(out, 9 * positions.size());
        for (std::size_t i = 0; i < positions.size(); ++i) {
            const dvec3 towards = light == 0 ? dvec3(1, 2, 3) - unpack(positions[i]) : dvec3(0, 0.6F, 0.8F);
            const double r = glm::length(towards);
            const dvec3 color = dvec3(4, 5, 6) / (light == 0 ? 0.5 + 0.25 * r + 0.125 * r * r : 1.0);
            REQUIRE(glm::distance(at(got, 3 * i), towards) < 1e-5);
            REQUIRE(glm::distance(at(got, 3 * i + 1), color) < 1e-6 * glm::length(color));
            REQUIRE(got[9 * i + 6] == (light == 0 ? 1.0F : std::numeric_limits<float>::infinity()));
        }
    }
}

TEST_CASE("rays start on the side of the surface that they leave to") {
    KernelRunner runner(kMaterialKernels);
    const std::vector<Float4> position(4, {1, 2, 3, 0}), off(4, {0, 0.25F, 0, 0});
    const std::vector<Float4> direction{{1, 1, 0, 0}, {1, -1, 0, 0}, {1, 1e-20F, 0, 0}, {1, -1e-20F, 0, 0}};
    const auto got = runner.map<float>("offset", 3, position, off, direction);
    for (std::size_t i = 0; i < 4; ++i) CHECK(at(got, i) == dvec3(1, i % 2 ? 1.75 : 2.25, 3));
}

}  // namespace sahl::tests
