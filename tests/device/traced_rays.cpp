#include "tests/device/traced_rays.h"

#include <bit>

namespace sahl::tests {
namespace {

constexpr const char* kKernels = R"(
#include "kernels/intersect.cl"
#include "kernels/shade.cl"
#include "kernels/shadow.cl"

kernel void brute_force(const global uchar* leaves, const global float* polygon_vertices,
                        const global DeviceInstance* instances, const global uint* children,
                        const global uint* child_instances, const uint child_count, const float extent,
                        const global float* rays, const global uint* ray_ids,
                        global float* hits, global uint* hit_ids, const uint count) {
    const Bvh bvh = {0, leaves, polygon_vertices, instances, extent};
    TEST_FOR_EACH(i, count) {
        Ray ray = load_ray(rays, ray_ids, count, i);
        HitState state = hit_state(0.0f, INFINITY);
        TracedRay here = traced_ray(ray.origin, ray.direction, &ray, SAHL_WORLD, extent);
        for (uint k = 0; k < child_count; ++k) {
            if (child_instances[k] != state.inside_of) {
                state.inside_of = child_instances[k];
                here = traced_in_instance(&bvh, &ray, state.inside_of - 1u);
            }
            intersect_leaf(&bvh, children[k], &here.ray, &here.shear, &here.boxes, &state, false);
        }
        store_hit(hits, hit_ids, count, i, &state);
    }
}

kernel void occlusion(const global BvhNode* nodes, const global uchar* leaves, const global float* polygon_vertices,
                      const global DeviceInstance* instances, const float extent, const global float* rays, const global uint* ray_ids, const float t_max,
                      global uint* out, const uint count) {
    const Bvh bvh = {nodes, leaves, polygon_vertices, instances, extent};
    TEST_FOR_EACH(i, count) {
        Ray ray = load_ray(rays, ray_ids, count, i);
        out[i] = any_hit(&bvh, &ray, t_max);
    }
}

kernel void walk(const global BvhNode* nodes, const global uchar* leaves, const global float* polygon_vertices,
                 const global DeviceInstance* instances, const float extent, const global float* rays, const global uint* ray_ids, const float t_max,
                 const uint longest, global uint* out, const uint count) {
    const Bvh bvh = {nodes, leaves, polygon_vertices, instances, extent};
    TEST_FOR_EACH(i, count) {
        Ray ray = load_ray(rays, ray_ids, count, i);
        global uint* crossings = out + (size_t)i * (1u + 3u * longest);
        uint met = 0;
        HitState hit = closest_hit(&bvh, &ray, hit_state(0.0f, t_max));
        while (hit.primitive != SAHL_NO_PRIMITIVE && met < longest) {
            crossings[1u + met] = hit.primitive;
            crossings[1u + longest + met] = hit.instance;
            crossings[1u + 2u * longest + met] = as_uint(hit.t);
            ++met;
            hit = closest_hit(&bvh, &ray, hit_state_behind(hit, t_max));
        }
        crossings[0] = met;
    }
}

static inline void store_parts(global float* to, real3 v) {
    float3 rounded = round3(v);
    vstore3(rounded, 0, to);
    vstore3(round3(v - convert_real3(rounded)), 1, to);
}

kernel void surfaces(const global DevicePrimitive* primitives, const global float* shape_data,
                     const global DeviceInstance* instances, const global float* rays, const global float* hits,
                     const global uint* hit_ids, global float* out, const uint count) {
    const Shapes shapes = {primitives, shape_data, instances};
    TEST_FOR_EACH(i, count) {
        if (hit_ids[i] == SAHL_NO_PRIMITIVE) { continue; }
        float3 hit = load_soa3(hits, SAHL_HIT_T, count, i);
        real3 o = convert_real3(load_soa3(rays, SAHL_RAY_ORIGIN, count, i));
        real3 d = convert_real3(load_soa3(rays, SAHL_RAY_DIRECTION, count, i));
        Surface s = surface_at(&shapes, hit_ids[count + i], hit_ids[i], o, d, hit.x, hit.y, hit.z);
        store_parts(out + 19 * i, s.position);
        store_parts(out + 19 * i + 6, s.ng);
        store_parts(out + 19 * i + 12, s.ns);
        out[19 * i + 18] = s.offset;
    }
}
)";

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

RayTracer::RayTracer(const std::string& options) : runner_(kKernels, options) {}

RayTracer::Batch RayTracer::upload(const std::vector<TestRay>& rays) {
    const std::size_t count = rays.size();
    Batch batch{Buffer(device(), SAHL_RAY_FLOATS * count * sizeof(float), "rays"),
                Buffer(device(), SAHL_RAY_UINTS * count * sizeof(std::uint32_t), "ray ids"),
                Buffer(device(), SAHL_HIT_FLOATS * count * sizeof(float), "hits"),
                Buffer(device(), SAHL_HIT_UINTS * count * sizeof(std::uint32_t), "hit ids"),
                static_cast<std::uint32_t>(count)};
    const auto floats = batch.rays.map<float>(MapMode::write, SAHL_RAY_FLOATS * count);
    const auto ids = batch.ids.map<std::uint32_t>(MapMode::write, SAHL_RAY_UINTS * count);
    for (std::size_t i = 0; i < count; ++i) {
        for (int k = 0; k < 3; ++k) {
            floats[(SAHL_RAY_ORIGIN + static_cast<std::size_t>(k)) * count + i] = rays[i].origin[k];
            floats[(SAHL_RAY_DIRECTION + static_cast<std::size_t>(k)) * count + i] = rays[i].direction[k];
        }
        for (std::size_t k = 0; k < 3; ++k) floats[(SAHL_RAY_WEIGHT + k) * count + i] = 1;
        ids[SAHL_RAY_EXCLUDE * count + i] = rays[i].exclude;
        ids[SAHL_RAY_INSTANCE * count + i] = rays[i].exclude_instance;
    }
    return batch;
}

RayTracer::Batch RayTracer::upload(const std::vector<TestRay>& rays, const std::vector<TestHit>& hits) {
    Batch batch = upload(rays);
    const std::size_t count = batch.count;
    const auto floats = batch.hits.map<float>(MapMode::write, SAHL_HIT_FLOATS * count);
    const auto hit_ids = batch.hit_ids.map<std::uint32_t>(MapMode::write, SAHL_HIT_UINTS * count);
    for (std::size_t i = 0; i < count; ++i) {
        floats[i] = hits[i].t;
        floats[count + i] = hits[i].u;
        floats[2 * count + i] = hits[i].v;
        hit_ids[SAHL_HIT_PRIMITIVE * count + i] = hits[i].primitive;
        hit_ids[SAHL_HIT_INSTANCE * count + i] = hits[i].instance;
    }
    return batch;
}

std::vector<TestHit> RayTracer::download(Batch& batch) {
    const std::size_t count = batch.count;
    const auto floats = batch.hits.map<float>(MapMode::read, SAHL_HIT_FLOATS * count);
    const auto hit_ids = batch.hit_ids.map<std::uint32_t>(MapMode::read, SAHL_HIT_UINTS * count);
    std::vector<TestHit> hits;
    hits.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
        hits.push_back({floats[i], floats[count + i], floats[2 * count + i],
                        hit_ids[SAHL_HIT_PRIMITIVE * count + i], hit_ids[SAHL_HIT_INSTANCE * count + i]});
    return hits;
}

std::vector<TestHit> RayTracer::intersect(const DeviceScene& scene, const std::vector<TestRay>& rays) {
    Batch batch = upload(rays);
    runner_.run("intersect_scalar", batch.count, scene.nodes, scene.leaves, scene.polygon_vertices, scene.instances,
                scene.constants, batch.rays, batch.ids, batch.hits, batch.hit_ids, batch.count);
    return download(batch);
}

std::vector<TestHit> RayTracer::brute_force(DeviceScene& scene, const std::vector<TestRay>& rays) {
    Batch batch = upload(rays);
    const Leaves leaves = all_leaves(scene);
    runner_.run("brute_force", batch.count, scene.leaves, scene.polygon_vertices, scene.instances,
                runner_.upload(leaves.children), runner_.upload(leaves.instances),
                static_cast<std::uint32_t>(leaves.children.size()), scene.constants.extent, batch.rays,
                batch.ids, batch.hits, batch.hit_ids);
    return download(batch);
}

std::vector<Occlusion> RayTracer::occlusion(const DeviceScene& scene, const std::vector<TestRay>& rays,
                                            float t_max) {
    Batch batch = upload(rays);
    runner_.run("occlusion", batch.count, scene.nodes, scene.leaves, scene.polygon_vertices, scene.instances,
                scene.constants.extent, batch.rays, batch.ids, t_max, batch.hit_ids);
    return KernelRunner::download<Occlusion>(batch.hit_ids, batch.count);
}

std::vector<TestWalk> RayTracer::walk(const DeviceScene& scene, const std::vector<TestRay>& rays,
                                      float t_max) {
    Batch batch = upload(rays);
    Buffer out(device(), batch.count * sizeof(TestWalk), "crossings");
    runner_.run("walk", batch.count, scene.nodes, scene.leaves, scene.polygon_vertices, scene.instances,
                scene.constants.extent, batch.rays, batch.ids, t_max, TestWalk::longest, out);
    return KernelRunner::download<TestWalk>(out, batch.count);
}

std::vector<TestSurface> RayTracer::surfaces(const DeviceScene& scene, const std::vector<TestRay>& rays,
                                             const std::vector<TestHit>& hits) {
    Batch batch = upload(rays, hits);
    constexpr std::size_t kFloats = 19;
    Buffer out(device(), kFloats * batch.count * sizeof(float), "surfaces");
    runner_.run("surfaces", batch.count, scene.primitives, scene.shape_data, scene.instances, batch.rays,
                batch.hits, batch.hit_ids, out);
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
    const std::size_t count = batch.count;
    const std::size_t lights = scene.constants.light_count;
    const auto buffer = [&](std::size_t arrays) { return Buffer(device(), arrays * count * 4, "shading"); };
    Buffer light = buffer(3), pixels = buffer(1), surfaces = buffer(SAHL_SURFACE_FLOATS),
           brought = buffer(3 * lights);
    Buffer children = buffer(std::size_t{2} * SAHL_RAY_FLOATS),
           child_ids = buffer(std::size_t{2} * SAHL_RAY_UINTS);
    Buffer outcomes = buffer(1);
    // run() adds the count, which as shade's last parameter says: do spawn.
    runner_.run("shade", count, scene.primitives, scene.shape_data, scene.instances, scene.materials,
                scene.textures, scene.lights, scene.constants, batch.rays, batch.ids, batch.hits,
                batch.hit_ids, light, pixels, surfaces, brought, children, child_ids, outcomes, batch.count,
                batch.count);
    runner_.run("shadow_scalar", count, scene.nodes, scene.leaves, scene.polygon_vertices, scene.instances,
                scene.primitives, scene.materials, scene.lights, scene.constants, batch.hit_ids, surfaces,
                brought, outcomes, light, batch.count);

    const auto rays_out = children.map<float>(MapMode::read, std::size_t{2} * SAHL_RAY_FLOATS * count);
    const auto ids = child_ids.map<std::uint32_t>(MapMode::read, std::size_t{2} * SAHL_RAY_UINTS * count);
    const auto outcome = outcomes.map<std::uint32_t>(MapMode::read, count);
    const auto arrived = light.map<float>(MapMode::read, count);
    const auto unshadowed = brought.map<float>(MapMode::read, 3 * lights * count);
    const auto child = [&](std::size_t which, std::size_t i) {
        TestRay ray;
        const float* floats = rays_out.data() + which * SAHL_RAY_FLOATS * count + i;
        for (int k = 0; k < 3; ++k) {
            ray.origin[k] = floats[(SAHL_RAY_ORIGIN + static_cast<std::size_t>(k)) * count];
            ray.direction[k] = floats[(SAHL_RAY_DIRECTION + static_cast<std::size_t>(k)) * count];
        }
        ray.exclude = ids[(which * SAHL_RAY_UINTS + SAHL_RAY_EXCLUDE) * count + i] & SAHL_ID_MASK;
        ray.exclude_instance = ids[(which * SAHL_RAY_UINTS + SAHL_RAY_INSTANCE) * count + i];
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
        for (std::size_t l = 0; l < lights; ++l) result[i].unshadowed += unshadowed[3 * l * count + i];
    }
    return result;
}

}  // namespace sahl::tests
