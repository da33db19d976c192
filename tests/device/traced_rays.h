// Rays through scenes by the engine's kernels, every way of traversal at once, and by test kernels that call
// the functions behind them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/render/device_scene.h"
#include "tests/support/kernel_runner.h"

namespace sahl::tests {

struct TestRay {
    glm::vec3 origin{0};
    glm::vec3 direction{0, 0, 1};
    std::uint32_t exclude = SAHL_NO_PRIMITIVE;  ///< the primitive it starts on,
    std::uint32_t exclude_instance = 0;         ///< and its instance
};

struct TestHit {
    float t = 0, u = 0, v = 0;
    std::uint32_t primitive = SAHL_NO_PRIMITIVE;
    std::uint32_t instance = 0;

    bool hit() const { return primitive != SAHL_NO_PRIMITIVE; }
    /// Bit for bit.
    friend bool operator==(const TestHit& a, const TestHit& b);
};

/// Which of the rays have hits in `a` that are not bit for bit those in `b`, for a message: how many there
/// are and the first few in full; empty when there are none.
std::string differences(const std::vector<TestRay>& rays, const std::vector<TestHit>& a,
                        const std::vector<TestHit>& b);

/// What surface_at() says of a hit.
struct TestSurface {
    glm::dvec3 position, ng, ns;
    float offset;
};

/// What a shadow ray meets: SAHL_HIT_* of kernels/hit.h.
enum class Occlusion : std::uint32_t { nothing = 0, transparent = 1, opaque = 2 };

/// The crossings of a ray in order, by collect_crossings().
struct TestWalk {
    static constexpr std::uint32_t longest = 30;
    std::uint32_t count = 0;
    std::uint32_t primitives[longest] = {};
    std::uint32_t instances[longest] = {};
    float t[longest] = {};
};

/// What kernels/shade.cl makes of a hit.
struct TestSpawn {
    bool reflects = false, transmits = false;
    TestRay reflected, transmitted;
    float unshadowed = 0;  ///< light of all lamps as if nothing were in between, first channel
    float arrived = 0;     ///< what kernels/shadow_*.cl left of it
};

/// A point that lamps shine on, as shading leaves it for kernels/shadow_*.cl.
struct TestLitPoint {
    glm::vec3 position{0};
    std::uint32_t exclude = SAHL_NO_PRIMITIVE;  ///< the primitive it lies on,
    std::uint32_t exclude_instance = 0;         ///< and its instance
    bool has_shadow_rays = true;                ///< else nothing is asked about it
};

/// The code paths of kernels/simd.h, by the build options that force them.
inline const std::vector<std::string> simd_versions{"", "-DSAHL_NO_AVX512", "-DSAHL_PLAIN_OPENCL"};

/// Traces batches of rays on the default device, by the kernels of every way of traversal in each of the
/// simd_versions. A test fails where two of them differ in any bit, or where one writes behind its batch.
class RayTracer {
public:
    RayTracer();

    Device& device() { return *device_; }
    DeviceScene upload(const Scene& scene) { return make_device_scene(device(), scene); }

    /// Nodes to put in the place of a scene's own.
    Buffer upload_nodes(const std::vector<device::BvhNode>& nodes) { return scalar().upload(nodes); }
    /// Instances to put in the place of a scene's own.
    Buffer upload_instances(const std::vector<device::DeviceInstance>& instances) {
        return scalar().upload(instances);
    }

    /// Closest hits by kernels/intersect_*.cl.
    std::vector<TestHit> intersect(const DeviceScene& scene, const std::vector<TestRay>& rays);

    /// What kernels/shadow_*.cl lets through of `brought`, which has one colour for each of the scene's
    /// lights and, for each light, each point: index light · points + point.
    std::vector<glm::vec3> arriving(const DeviceScene& scene, const std::vector<TestLitPoint>& points,
                                    const std::vector<glm::vec3>& brought);

    /// What rays meet up to `t_max`, which has one number for each ray, by the any-hit functions behind
    /// kernels/shadow_*.cl.
    std::vector<Occlusion> occlusion(const DeviceScene& scene, const std::vector<TestRay>& rays,
                                     const std::vector<float>& t_max);
    /// The same with one `t_max` for all rays.
    std::vector<Occlusion> occlusion(const DeviceScene& scene, const std::vector<TestRay>& rays, float t_max);

    // The rest is asked of the functions behind intersect_scalar and shadow_scalar, in the first version.

    /// Closest hits by offering each ray all blocks of all leaves, without the tree.
    std::vector<TestHit> brute_force(DeviceScene& scene, const std::vector<TestRay>& rays);
    std::vector<TestWalk> walk(const DeviceScene& scene, const std::vector<TestRay>& rays, float t_max);
    /// Of hits; the others' surfaces mean nothing.
    std::vector<TestSurface> surfaces(const DeviceScene& scene, const std::vector<TestRay>& rays,
                                      const std::vector<TestHit>& hits);

    /// Children and light of hits by kernels/shade.cl and shadow_scalar.cl; nothing for rays that miss.
    /// Directions have to be unit vectors, emission black.
    std::vector<TestSpawn> shade(const DeviceScene& scene, const std::vector<TestRay>& rays,
                                 const std::vector<TestHit>& hits);

private:
    struct Version {
        std::string options;
        KernelRunner runner;
    };
    struct Batch {
        Buffer rays, ids, hits, hit_ids;
        std::uint32_t count, capacity;
    };
    KernelRunner& scalar() { return versions_.front().runner; }
    /// `guard`: how many rays longer the arrays are; rays like the first.
    Batch upload(const std::vector<TestRay>& rays, std::uint32_t guard = 0);
    Batch upload(const std::vector<TestRay>& rays, const std::vector<TestHit>& hits);
    static std::vector<TestHit> download(Batch& batch);
    /// Runs `shadow` of every version and way of traversal on the same `light`, which takes what comes out.
    void shadow(const DeviceScene& scene, Buffer& hit_ids, Buffer& surfaces, Buffer& brought,
                Buffer& outcomes, Buffer& light, std::uint32_t capacity, std::uint32_t count);

    std::shared_ptr<Device> device_;
    std::vector<Version> versions_;
};

}  // namespace sahl::tests
