#include "tests/support/sound_scene.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace sahl::tests {
namespace {

bool finite(const Scene& scene) {
    const auto all = [](const auto& list) {
        return std::all_of(list.begin(), list.end(),
                           [](const auto& v) { return std::isfinite(v.x + v.y + v.z); });
    };
    bool good = all(scene.vertices) && all(scene.normals) && all(scene.polygon_vertices);
    for (const glm::dmat4& m : scene.transforms) {
        for (int i = 0; i < 4; ++i) good = good && std::isfinite(m[i].x + m[i].y + m[i].z);
    }
    for (const Camera& c : scene.cameras) {
        for (const glm::dvec3& v : {c.eye, c.look_at, c.up}) good = good && std::isfinite(v.x + v.y + v.z);
    }
    for (const Light& light : scene.lights) {
        good = good && std::isfinite(light.position.x + light.position.y + light.position.z);
        good = good && std::isfinite(light.direction.x + light.direction.y + light.direction.z);
    }
    return good;
}

/// Whether every index of the scene names something.
bool consistent(const Scene& scene) {
    bool good = !scene.cameras.empty();
    const auto check = [&](bool holds) { good = good && holds; };
    for (const Primitive& p : scene.primitives) {
        const std::size_t sizes[] = {scene.triangles.size(), scene.polygons.size(), scene.spheres.size(),
                                     scene.cones.size(),     scene.discs.size(),    scene.boxes.size()};
        check(p.index < sizes[static_cast<std::size_t>(p.kind)]);
        check(p.material < scene.materials.size() && p.transform < scene.transforms.size());
    }
    for (const Triangle& t : scene.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            check(t.vertices[i] < scene.vertices.size());
            check(!t.smooth || t.normals[i] < scene.normals.size());
            check(!t.has_uv || t.uvs[i] < scene.uvs.size());
        }
    }
    for (const Polygon& p : scene.polygons) {
        check(p.vertex_count >= 4 && p.first_vertex + p.vertex_count <= scene.polygon_vertices.size());
    }
    for (const Material& m : scene.materials) {
        for (const std::uint32_t t : {m.textures.ambient, m.textures.diffuse, m.textures.specular,
                                      m.textures.emission, m.textures.reflection})
            check(t == no_texture || t < scene.textures.size());
    }
    const auto check_instances = [&](const std::vector<Instance>& instances) {
        for (const Instance& i : instances)
            check(i.group < scene.groups.size() && i.transform < scene.transforms.size());
    };
    check_instances(scene.instances);
    std::size_t next = world_primitive_count(scene);
    for (const Group& g : scene.groups) {
        check(g.first_primitive == next);
        next += g.primitive_count;
        check_instances(g.instances);
    }
    check(next == scene.primitives.size());
    return good;
}

}  // namespace

std::string flaw_of(const Scene& scene) {
    if (!finite(scene)) return "a number that is not finite";
    return consistent(scene) ? "" : "an index that names nothing";
}

}  // namespace sahl::tests
