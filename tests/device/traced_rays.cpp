#include "tests/device/traced_rays.h"

#include <algorithm>
#include <array>
#include <bit>
#include <catch2/catch.hpp>
#include <iomanip>
#include <span>
#include <sstream>

#include "kernels/rays_per_item.h"
#include "tests/device/ray_kernels.h"

namespace sahl::tests {
namespace {

/// The ends of the kernels' names.
constexpr std::array traversals{"scalar", "packet", "stream"};

/// What is behind the rays of a batch: more than a packet.
constexpr std::uint32_t guard_rays = 200;
constexpr std::uint32_t fill_bits = 0xa5a5a5a5;

void fill(Buffer& buffer) {
    const auto bits = buffer.map<std::uint32_t>(MapMode::write, buffer.bytes() / sizeof(std::uint32_t));
    std::fill(bits.begin(), bits.end(), fill_bits);
}

/// Whether each of a buffer's arrays of `capacity` still has what fill() wrote behind the first `count`.
bool is_filled_behind(Buffer& buffer, std::size_t count, std::size_t capacity) {
    const auto bits = buffer.map<std::uint32_t>(MapMode::read, buffer.bytes() / sizeof(std::uint32_t));
    for (std::size_t i = 0; i < bits.size(); ++i) {
        if (i % capacity >= count && bits[i] != fill_bits) return false;
    }
    return true;
}

/// Leaves of primitives with the instances they are in.
struct Leaves {
    std::vector<std::uint32_t> children, instances;
};

/// The leaves of the world's tree, then those of each instance's.
Leaves all_leaves(DeviceScene& scene) {
    const auto nodes =
        scene.nodes.map<device::BvhNode>(MapMode::read, scene.nodes.bytes() / sizeof(device::BvhNode));
    const auto instances = scene.instances.map<device::DeviceInstance>(
        MapMode::read, scene.instances.bytes() / sizeof(device::DeviceInstance));
    Leaves leaves;
    std::vector<std::uint32_t> placed;
    const auto collect = [&](std::uint32_t root, std::uint32_t instance) {
        std::vector<std::uint32_t> waiting{root};
        while (!waiting.empty()) {
            const device::BvhNode& node = nodes[waiting.back()];
            waiting.pop_back();
            for (int slot = 0; slot < 8; ++slot) {
                const std::uint32_t child = node.child[slot];
                if (!(node.lo_x[slot] <= node.hi_x[slot])) continue;
                if (!(child & SAHL_CHILD_LEAF)) {
                    waiting.push_back(child);
                } else if ((child >> SAHL_CHILD_KIND_SHIFT & SAHL_CHILD_KIND_MASK) == SAHL_KIND_INSTANCE) {
                    placed.push_back(child & SAHL_CHILD_OFFSET_MASK);
                } else {
                    leaves.children.push_back(child);
                    leaves.instances.push_back(instance);
                }
            }
        }
    };
    collect(0, SAHL_WORLD);
    for (const std::uint32_t i : std::vector(placed)) collect(instances[i].root, i + 1);
    return leaves;
}

glm::dvec3 sum_of_parts(const float* parts) {
    glm::dvec3 sum;
    for (int k = 0; k < 3; ++k) sum[k] = static_cast<double>(parts[k]) + static_cast<double>(parts[k + 3]);
    return sum;
}

}  // namespace

bool operator==(const TestHit& a, const TestHit& b) {
    const auto same = [](float x, float y) {
        return std::bit_cast<std::uint32_t>(x) == std::bit_cast<std::uint32_t>(y);
    };
    return a.primitive == b.primitive && a.instance == b.instance && same(a.t, b.t) && same(a.u, b.u) &&
           same(a.v, b.v);
}

std::string differences(const std::vector<TestRay>& rays, const std::vector<TestHit>& a,
                        const std::vector<TestHit>& b) {
    constexpr int shown = 4;
    std::ostringstream text;
    text << std::setprecision(9);
    const auto put = [&](const TestHit& hit) {
        text << hit.instance << '/' << hit.primitive << " at " << hit.t << " (" << hit.u << ", " << hit.v
             << ')';
    };
    int count = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (a[i] == b[i] || ++count > shown) continue;
        const TestRay& ray = rays[i];
        text << "; ray " << i << " from " << ray.origin.x << ' ' << ray.origin.y << ' ' << ray.origin.z
             << " along " << ray.direction.x << ' ' << ray.direction.y << ' ' << ray.direction.z
             << " starting on " << ray.exclude_instance << '/' << ray.exclude << ": ";
        put(a[i]);
        text << ", ";
        put(b[i]);
    }
    return count == 0 ? "" : std::to_string(count) + " of " + std::to_string(rays.size()) + text.str();
}

RayTracer::RayTracer() : device_(std::make_shared<Device>()) {
    for (const std::string& options : simd_versions)
        versions_.push_back({options, KernelRunner(ray_kernels, options, device_)});
}

RayTracer::Batch RayTracer::upload(const std::vector<TestRay>& rays, std::uint32_t guard) {
    const std::size_t count = rays.size(), capacity = count + guard;
    Batch batch{Buffer(device(), SAHL_RAY_FLOATS * capacity * sizeof(float), "rays"),
                Buffer(device(), SAHL_RAY_UINTS * capacity * sizeof(std::uint32_t), "ray ids"),
                Buffer(device(), SAHL_HIT_FLOATS * capacity * sizeof(float), "hits"),
                Buffer(device(), SAHL_HIT_UINTS * capacity * sizeof(std::uint32_t), "hit ids"),
                static_cast<std::uint32_t>(count),
                static_cast<std::uint32_t>(capacity)};
    const auto floats = batch.rays.map<float>(MapMode::write, SAHL_RAY_FLOATS * capacity);
    const auto ids = batch.ids.map<std::uint32_t>(MapMode::write, SAHL_RAY_UINTS * capacity);
    for (std::size_t i = 0; i < capacity; ++i) {
        const TestRay ray = i < count ? rays[i] : count > 0 ? rays[0] : TestRay{};
        for (int k = 0; k < 3; ++k) {
            floats[(SAHL_RAY_ORIGIN + static_cast<std::size_t>(k)) * capacity + i] = ray.origin[k];
            floats[(SAHL_RAY_DIRECTION + static_cast<std::size_t>(k)) * capacity + i] = ray.direction[k];
        }
        for (std::size_t k = 0; k < 3; ++k) floats[(SAHL_RAY_WEIGHT + k) * capacity + i] = 1;
        ids[SAHL_RAY_EXCLUDE * capacity + i] = ray.exclude;
        ids[SAHL_RAY_INSTANCE * capacity + i] = ray.exclude_instance;
    }
    return batch;
}

RayTracer::Batch RayTracer::upload(const std::vector<TestRay>& rays, const std::vector<TestHit>& hits) {
    // Shading takes whole groups; in what fills the last up are copies of the first hit.
    Batch batch = upload(rays, static_cast<std::uint32_t>((0 - rays.size()) % SAHL_LANES));
    const std::size_t capacity = batch.capacity;
    const auto floats = batch.hits.map<float>(MapMode::write, SAHL_HIT_FLOATS * capacity);
    const auto hit_ids = batch.hit_ids.map<std::uint32_t>(MapMode::write, SAHL_HIT_UINTS * capacity);
    for (std::size_t i = 0; i < capacity; ++i) {
        const TestHit& hit = hits[i < batch.count ? i : 0];
        floats[i] = hit.t;
        floats[capacity + i] = hit.u;
        floats[2 * capacity + i] = hit.v;
        hit_ids[SAHL_HIT_PRIMITIVE * capacity + i] = hit.primitive;
        hit_ids[SAHL_HIT_INSTANCE * capacity + i] = hit.instance;
    }
    return batch;
}

std::vector<TestHit> RayTracer::download(Batch& batch) {
    const std::size_t n = batch.capacity;
    const auto floats = batch.hits.map<float>(MapMode::read, SAHL_HIT_FLOATS * n);
    const auto hit_ids = batch.hit_ids.map<std::uint32_t>(MapMode::read, SAHL_HIT_UINTS * n);
    std::vector<TestHit> hits;
    hits.reserve(batch.count);
    for (std::size_t i = 0; i < batch.count; ++i)
        hits.push_back({floats[i], floats[n + i], floats[2 * n + i], hit_ids[SAHL_HIT_PRIMITIVE * n + i],
                        hit_ids[SAHL_HIT_INSTANCE * n + i]});
    return hits;
}

std::vector<TestHit> RayTracer::intersect(const DeviceScene& scene, const std::vector<TestRay>& rays) {
    Batch batch = upload(rays, guard_rays);
    std::vector<TestHit> wanted;
    for (Version& version : versions_) {
        for (const char* traversal : traversals) {
            fill(batch.hits);
            fill(batch.hit_ids);
            const std::string kernel = std::string("intersect_") + traversal;
            version.runner.run(kernel, batch.count, scene.nodes, scene.leaves, scene.outlines,
                               scene.instances, scene.constants, batch.rays, batch.ids, batch.hits,
                               batch.hit_ids, batch.capacity);
            const std::vector<TestHit> hits = download(batch);
            if (wanted.empty()) wanted = hits;
            const std::string differing = differences(rays, wanted, hits);
            if (!differing.empty()) FAIL_CHECK(kernel << ' ' << version.options << ": " << differing);
            if (!is_filled_behind(batch.hits, batch.count, batch.capacity) ||
                !is_filled_behind(batch.hit_ids, batch.count, batch.capacity))
                FAIL_CHECK(kernel << ' ' << version.options << " writes behind its " << batch.count
                                  << " rays");
        }
    }
    return wanted;
}

void RayTracer::shadow(const DeviceScene& scene, Buffer& hit_ids, Buffer& surfaces, Buffer& brought,
                       Buffer& outcomes, Buffer& light, std::uint32_t capacity, std::uint32_t count) {
    const auto before = KernelRunner::download<float>(light, std::size_t{3} * capacity);
    std::vector<std::uint32_t> wanted;
    for (Version& version : versions_) {
        for (const char* traversal : traversals) {
            light.write(std::span<const float>(before));
            const std::string kernel = std::string("shadow_") + traversal;
            version.runner.run(kernel, count, scene.nodes, scene.leaves, scene.outlines, scene.instances,
                               scene.primitives, scene.materials, scene.lights, scene.constants, hit_ids,
                               surfaces, brought, outcomes, light, capacity);
            const auto bits = KernelRunner::download<std::uint32_t>(light, std::size_t{3} * capacity);
            if (wanted.empty()) wanted = bits;
            std::vector<std::size_t> differing;
            for (std::size_t i = 0; i < bits.size(); ++i) {
                if (bits[i] != wanted[i]) differing.push_back(i);
            }
            if (differing.empty()) continue;
            const std::size_t first = differing.front();
            FAIL_CHECK(kernel << ' ' << version.options << " differs in " << differing.size() << " of "
                              << bits.size() << " numbers, first in number " << first << " of " << count
                              << " rays: " << std::bit_cast<float>(wanted[first]) << ", "
                              << std::bit_cast<float>(bits[first]));
        }
    }
}

std::vector<glm::vec3> RayTracer::arriving(const DeviceScene& scene, const std::vector<TestLitPoint>& points,
                                           const std::vector<glm::vec3>& brought) {
    const std::size_t count = points.size(), capacity = count + guard_rays;
    const std::size_t lights = scene.constants.light_count;
    std::vector<float> surfaces(SAHL_SURFACE_FLOATS * capacity), colors(3 * lights * capacity);
    std::vector<float> light(3 * capacity);
    std::vector<std::uint32_t> ids(SAHL_HIT_UINTS * capacity, 0), outcomes(capacity, 0);
    for (std::size_t i = 0; i < capacity; ++i) {
        // Behind the end are points like the first that bring light to be added wrongly.
        const TestLitPoint point = i < count ? points[i] : count > 0 ? points[0] : TestLitPoint{};
        for (std::size_t k = 0; k < 3; ++k) {
            surfaces[(SAHL_SURFACE_POSITION + k) * capacity + i] = point.position[static_cast<int>(k)];
            for (std::size_t l = 0; l < lights; ++l)
                colors[(3 * l + k) * capacity + i] =
                    i < count ? brought[l * count + i][static_cast<int>(k)] : 1;
        }
        ids[SAHL_HIT_PRIMITIVE * capacity + i] = point.exclude;
        ids[SAHL_HIT_INSTANCE * capacity + i] = point.exclude_instance;
        outcomes[i] = point.has_shadow_rays ? SAHL_OUTCOME_SHADOW_RAY : 0;
    }
    Buffer hit_ids = scalar().upload(ids), surface_floats = scalar().upload(surfaces);
    Buffer brought_floats = scalar().upload(colors), outcome_bits = scalar().upload(outcomes);
    Buffer light_floats = scalar().upload(light);
    shadow(scene, hit_ids, surface_floats, brought_floats, outcome_bits, light_floats,
           static_cast<std::uint32_t>(capacity), static_cast<std::uint32_t>(count));
    const auto sums = KernelRunner::download<float>(light_floats, 3 * capacity);
    std::vector<glm::vec3> result;
    for (std::size_t i = 0; i < capacity; ++i) {
        const glm::vec3 sum(sums[i], sums[capacity + i], sums[2 * capacity + i]);
        if (i < count) {
            result.push_back(sum);
        } else if (sum != glm::vec3(0)) {
            FAIL_CHECK("a shadow kernel writes behind its " << count << " points");
            break;
        }
    }
    return result;
}

std::vector<Occlusion> RayTracer::occlusion(const DeviceScene& scene, const std::vector<TestRay>& rays,
                                            const std::vector<float>& t_max) {
    Batch batch = upload(rays, guard_rays);
    const Buffer ends = scalar().upload(t_max);
    Buffer out(device(), batch.capacity * sizeof(Occlusion), "occlusion");
    std::vector<Occlusion> wanted;
    for (Version& version : versions_) {
        for (const char* traversal : traversals) {
            fill(out);
            const std::string kernel = std::string("occlusion_") + traversal;
            version.runner.run(kernel, batch.count, scene.nodes, scene.leaves, scene.outlines,
                               scene.instances, scene.constants.extent, batch.rays, batch.ids, ends, out,
                               batch.capacity);
            const auto met = KernelRunner::download<Occlusion>(out, batch.count);
            if (wanted.empty()) wanted = met;
            const auto first = std::mismatch(met.begin(), met.end(), wanted.begin()).first - met.begin();
            if (first < batch.count)
                FAIL_CHECK(kernel << ' ' << version.options << " differs, first in ray " << first << " of "
                                  << batch.count);
            if (!is_filled_behind(out, batch.count, batch.capacity))
                FAIL_CHECK(kernel << ' ' << version.options << " writes behind its " << batch.count
                                  << " rays");
        }
    }
    return wanted;
}

std::vector<Occlusion> RayTracer::occlusion(const DeviceScene& scene, const std::vector<TestRay>& rays,
                                            float t_max) {
    return occlusion(scene, rays, std::vector(rays.size(), t_max));
}

std::vector<TestHit> RayTracer::brute_force(DeviceScene& scene, const std::vector<TestRay>& rays) {
    Batch batch = upload(rays);
    const Leaves leaves = all_leaves(scene);
    scalar().run("brute_force", batch.count, scene.leaves, scene.outlines, scene.instances,
                 scalar().upload(leaves.children), scalar().upload(leaves.instances),
                 static_cast<std::uint32_t>(leaves.children.size()), scene.constants.extent, batch.rays,
                 batch.ids, batch.hits, batch.hit_ids);
    return download(batch);
}

std::vector<TestWalk> RayTracer::walk(const DeviceScene& scene, const std::vector<TestRay>& rays,
                                      float t_max) {
    Batch batch = upload(rays);
    Buffer out(device(), batch.count * sizeof(TestWalk), "crossings");
    scalar().run("walk", batch.count, scene.nodes, scene.leaves, scene.outlines, scene.instances,
                 scene.constants.extent, batch.rays, batch.ids, t_max, TestWalk::longest, out);
    return KernelRunner::download<TestWalk>(out, batch.count);
}

std::vector<TestSurface> RayTracer::surfaces(const DeviceScene& scene, const std::vector<TestRay>& rays,
                                             const std::vector<TestHit>& hits) {
    Batch batch = upload(rays, hits);
    constexpr std::size_t kFloats = 19;
    Buffer out(device(), kFloats * batch.count * sizeof(float), "surfaces");
    scalar().run("surfaces", batch.count, scene.primitives, scene.shape_data, scene.instances, batch.rays,
                 batch.hits, batch.hit_ids, out, batch.capacity);
    const std::vector<float> parts = KernelRunner::download<float>(out, kFloats * batch.count);
    std::vector<TestSurface> result;
    for (std::size_t i = 0; i < batch.count; ++i) {
        const float* p = &parts[kFloats * i];
        result.push_back({sum_of_parts(p), sum_of_parts(p + 6), sum_of_parts(p + 12), p[18]});
    }
    return result;
}

std::vector<TestSpawn> RayTracer::shade(const DeviceScene& scene, const std::vector<TestRay>& rays,
                                        const std::vector<TestHit>& hits) {
    Batch batch = upload(rays, hits);
    const std::size_t count = batch.count, capacity = batch.capacity;
    const std::size_t lights = scene.constants.light_count;
    const auto buffer = [&](std::size_t arrays) {
        return Buffer(device(), arrays * capacity * 4, "shading");
    };
    Buffer light = buffer(3), pixels = buffer(1), surfaces = buffer(SAHL_SURFACE_FLOATS),
           brought = buffer(3 * lights);
    Buffer children = buffer(std::size_t{2} * SAHL_RAY_FLOATS),
           child_ids = buffer(std::size_t{2} * SAHL_RAY_UINTS);
    Buffer outcomes = buffer(1);
    // run() adds the count, which as shade's last parameter says: do spawn.
    scalar().run("shade", count, scene.primitives, scene.shape_data, scene.instances, scene.materials,
                 scene.textures, scene.lights, scene.constants, batch.rays, batch.ids, batch.hits,
                 batch.hit_ids, light, pixels, surfaces, brought, children, child_ids, outcomes,
                 batch.capacity, batch.count);
    shadow(scene, batch.hit_ids, surfaces, brought, outcomes, light, batch.capacity, batch.count);

    const auto rays_out = children.map<float>(MapMode::read, std::size_t{2} * SAHL_RAY_FLOATS * capacity);
    const auto ids = child_ids.map<std::uint32_t>(MapMode::read, std::size_t{2} * SAHL_RAY_UINTS * capacity);
    const auto outcome = outcomes.map<std::uint32_t>(MapMode::read, count);
    const auto arrived = light.map<float>(MapMode::read, count);
    const auto unshadowed = brought.map<float>(MapMode::read, 3 * lights * capacity);
    const auto child = [&](std::size_t which, std::size_t i) {
        TestRay ray;
        const float* floats = rays_out.data() + which * SAHL_RAY_FLOATS * capacity + i;
        for (int k = 0; k < 3; ++k) {
            ray.origin[k] = floats[(SAHL_RAY_ORIGIN + static_cast<std::size_t>(k)) * capacity];
            ray.direction[k] = floats[(SAHL_RAY_DIRECTION + static_cast<std::size_t>(k)) * capacity];
        }
        ray.exclude = ids[(which * SAHL_RAY_UINTS + SAHL_RAY_EXCLUDE) * capacity + i] & SAHL_ID_MASK;
        ray.exclude_instance = ids[(which * SAHL_RAY_UINTS + SAHL_RAY_INSTANCE) * capacity + i];
        return ray;
    };
    std::vector<TestSpawn> result(count);
    for (std::size_t i = 0; i < count; ++i) {
        if (!hits[i].hit()) continue;
        result[i] = {(outcome[i] & SAHL_OUTCOME_REFLECTED) != 0,
                     (outcome[i] & SAHL_OUTCOME_TRANSMITTED) != 0,
                     child(0, i),
                     child(1, i),
                     0,
                     arrived[i]};
        for (std::size_t l = 0; l < lights; ++l) result[i].unshadowed += unshadowed[3 * l * capacity + i];
    }
    return result;
}

}  // namespace sahl::tests
