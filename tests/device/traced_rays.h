// Rays through scenes by the engine's kernels: the intersect kernel, and test kernels that call the
// functions behind it.
#pragma once

#include <cstdint>
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

/// What surface_at() says of a hit.
struct TestSurface {
    glm::dvec3 position, ng, ns;
    float offset;
};

/// What a shadow ray meets: SAHL_HIT_* of kernels/hit.h.
enum class Occlusion : std::uint32_t { nothing = 0, transparent = 1, opaque = 2 };

/// The crossings of a ray in order, by closest_hit() and hit_state_behind().
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
    float arrived = 0;     ///< what kernels/shadow.cl left of it
};

/// Traces batches of rays on the default device.
class RayTracer {
public:
    explicit RayTracer(const std::string& options = "");

    Device& device() { return runner_.device(); }
    DeviceScene upload(const Scene& scene) { return make_device_scene(runner_.device(), scene); }

    /// Nodes to put in the place of a scene's own.
    Buffer upload_nodes(const std::vector<device::BvhNode>& nodes) { return runner_.upload(nodes); }

    /// Closest hits by kernels/intersect.cl.
    std::vector<TestHit> intersect(const DeviceScene& scene, const std::vector<TestRay>& rays);
    /// Closest hits by offering each ray all blocks of all leaves, without the tree.
    std::vector<TestHit> brute_force(DeviceScene& scene, const std::vector<TestRay>& rays);
    /// any_hit() up to `t_max`.
    std::vector<Occlusion> occlusion(const DeviceScene& scene, const std::vector<TestRay>& rays, float t_max);
    std::vector<TestWalk> walk(const DeviceScene& scene, const std::vector<TestRay>& rays, float t_max);
    /// Of hits; the others' surfaces mean nothing.
    std::vector<TestSurface> surfaces(const DeviceScene& scene, const std::vector<TestRay>& rays,
                                      const std::vector<TestHit>& hits);

    /// Children and light of hits by kernels/shade.cl and shadow.cl; nothing for rays that miss. Directions
    /// have to be unit vectors, emission black.
    std::vector<TestSpawn> shade(const DeviceScene& scene, const std::vector<TestRay>& rays,
                                 const std::vector<TestHit>& hits);

private:
    struct Batch {
        Buffer rays, ids, hits, hit_ids;
        std::uint32_t count;
    };
    Batch upload(const std::vector<TestRay>& rays);
    Batch upload(const std::vector<TestRay>& rays, const std::vector<TestHit>& hits);
    std::vector<TestHit> download(Batch& batch);

    KernelRunner runner_;
};

}  // namespace sahl::tests
