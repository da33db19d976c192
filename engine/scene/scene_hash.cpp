#include "engine/scene/scene_hash.h"

#include <cstring>
#include <type_traits>
#include <vector>

#include <glm/mat4x4.hpp>

namespace sahl {
namespace {

/// By 32-bit words, each step a bijection of the state (a multiplication by an odd number and a shifted xor).
class SceneHasher {
public:
    /// Of numbers and vectors, which have no padding.
    template <class T>
    void add(const T& value) {
        static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % 4 == 0);
        for (std::size_t i = 0; i < sizeof(T); i += 4) {
            std::uint32_t word = 0;
            std::memcpy(&word, reinterpret_cast<const char*>(&value) + i, 4);
            hash_ = (hash_ ^ word) * 0x9e3779b97f4a7c15U;
            hash_ ^= hash_ >> 32U;
        }
    }
    void add(bool value) { add(value ? 1 : 0); }

    template <class T, class AddOne>
    void add_all(const std::vector<T>& values, AddOne add_one) {
        add(values.size());
        for (const T& value : values) add_one(value);
    }
    template <class T>
    void add_all(const std::vector<T>& values) {
        add_all(values, [this](const T& value) { add(value); });
    }
    template <class... Values>
    void add_each(const Values&... values) {
        (add(values), ...);
    }
    std::uint64_t hash() const { return hash_; }

private:
    std::uint64_t hash_ = 0xcbf29ce484222325U;
};

void add_materials(SceneHasher& h, const Scene& scene) {
    h.add_all(scene.materials, [&](const Material& m) {
        h.add_each(m.ambient, m.diffuse, m.specular, m.emission, m.reflection, m.transmission, m.shininess,
                   m.ior, m.specular_model, m.two_sided, m.ior_outside, m.reflection_attenuation);
        const MaterialTextures& t = m.textures;
        h.add_each(t.ambient, t.diffuse, t.specular, t.emission, t.reflection);
    });
    h.add_all(scene.textures, [&](const Texture& t) {
        h.add_each(t.pattern, t.space, t.colors[0], t.colors[1], t.origin, t.extent);
    });
    h.add_all(scene.lights, [&](const Light& l) {
        h.add_each(l.kind, l.position, l.color, l.attenuation, l.direction, l.inner_angle, l.outer_angle);
    });
}

void add_structure(SceneHasher& h, const Scene& scene) {
    const auto add_instance = [&](const Instance& i) { h.add_each(i.group, i.transform); };
    h.add_all(scene.transforms);
    h.add_all(scene.primitives,
              [&](const Primitive& p) { h.add_each(p.kind, p.index, p.material, p.transform, p.sides); });
    h.add_all(scene.instances, add_instance);
    h.add_all(scene.groups, [&](const Group& g) {
        h.add_each(g.first_primitive, g.primitive_count);
        h.add_all(g.instances, add_instance);
    });
}

void add_shapes(SceneHasher& h, const Scene& scene) {
    h.add_all(scene.triangles, [&](const Triangle& t) {
        for (int i = 0; i < 3; ++i) h.add_each(t.vertices[i], t.normals[i], t.uvs[i]);
        h.add_each(t.smooth, t.has_uv);
    });
    h.add_all(scene.polygons, [&](const Polygon& p) { h.add_each(p.first_vertex, p.vertex_count); });
    h.add_all(scene.spheres, [&](const Sphere& s) { h.add_each(s.center, s.radius); });
    h.add_all(scene.cones,
              [&](const Cone& c) { h.add_each(c.base, c.apex, c.base_radius, c.apex_radius, c.capped); });
    h.add_all(scene.discs, [&](const Disc& d) { h.add_each(d.center, d.normal, d.radius); });
    h.add_all(scene.boxes, [&](const Box& b) { h.add_each(b.lo, b.hi); });
    h.add_all(scene.vertices);
    h.add_all(scene.normals);
    h.add_all(scene.uvs);
    h.add_all(scene.polygon_vertices);
}

void add_scene(SceneHasher& h, const Scene& scene) {
    h.add_each(scene.background, scene.ambient);
    add_materials(h, scene);
    add_structure(h, scene);
    add_shapes(h, scene);
}

}  // namespace

std::uint64_t hash_without_cameras(const Scene& scene) {
    SceneHasher hasher;
    add_scene(hasher, scene);
    return hasher.hash();
}

std::uint64_t hash_with_camera(const Scene& scene, const Camera& camera) {
    SceneHasher hasher;
    add_scene(hasher, scene);
    hasher.add_each(camera.eye, camera.look_at, camera.up, camera.fov_y);
    return hasher.hash();
}

}  // namespace sahl
