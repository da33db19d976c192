#include "engine/oracle/build_scene.h"

#include <string>

namespace sahl::oracle {
namespace {

std::uint32_t add_transform(Scene& scene, const glm::dmat4& transform) {
    if (transform == glm::dmat4(1)) return 0;
    scene.transforms.push_back(transform);
    return static_cast<std::uint32_t>(scene.transforms.size() - 1);
}

std::uint32_t add_primitive(Scene& scene, PrimitiveKind kind, std::size_t index, const Material& material,
                            const glm::dmat4& world_from_object) {
    Primitive primitive;
    primitive.kind = kind;
    primitive.index = static_cast<std::uint32_t>(index);
    primitive.material = static_cast<std::uint32_t>(scene.materials.size());
    scene.materials.push_back(material);
    primitive.transform = add_transform(scene, world_from_object);
    scene.primitives.push_back(primitive);
    if (!scene.groups.empty()) ++scene.groups.back().primitive_count;
    return static_cast<std::uint32_t>(scene.primitives.size() - 1);
}

}  // namespace

std::uint32_t add_sphere(Scene& scene, const Sphere& sphere, const Material& material,
                         const glm::dmat4& world_from_object) {
    scene.spheres.push_back(sphere);
    return add_primitive(scene, PrimitiveKind::sphere, scene.spheres.size() - 1, material, world_from_object);
}

std::uint32_t add_cone(Scene& scene, const Cone& cone, const Material& material,
                       const glm::dmat4& world_from_object) {
    scene.cones.push_back(cone);
    return add_primitive(scene, PrimitiveKind::cone, scene.cones.size() - 1, material, world_from_object);
}

std::uint32_t add_triangle(Scene& scene, const std::vector<glm::vec3>& corners, const Material& material,
                           const glm::dmat4& world_from_object, const std::vector<glm::vec3>& normals) {
    Triangle triangle;
    triangle.smooth = !normals.empty();
    for (std::size_t i = 0; i < 3; ++i) {
        triangle.vertices[i] = static_cast<std::uint32_t>(scene.vertices.size());
        scene.vertices.push_back(corners[i]);
        if (!triangle.smooth) continue;
        triangle.normals[i] = static_cast<std::uint32_t>(scene.normals.size());
        scene.normals.push_back(normals[i]);
    }
    scene.triangles.push_back(triangle);
    return add_primitive(scene, PrimitiveKind::triangle, scene.triangles.size() - 1, material,
                         world_from_object);
}

std::uint32_t add_polygon(Scene& scene, const std::vector<glm::vec3>& corners, const Material& material,
                          const glm::dmat4& world_from_object) {
    Polygon polygon;
    polygon.first_vertex = static_cast<std::uint32_t>(scene.polygon_vertices.size());
    polygon.vertex_count = static_cast<std::uint32_t>(corners.size());
    scene.polygon_vertices.insert(scene.polygon_vertices.end(), corners.begin(), corners.end());
    scene.polygons.push_back(polygon);
    return add_primitive(scene, PrimitiveKind::polygon, scene.polygons.size() - 1, material,
                         world_from_object);
}

std::uint32_t add_disc(Scene& scene, const Disc& disc, const Material& material,
                       const glm::dmat4& world_from_object) {
    scene.discs.push_back(disc);
    return add_primitive(scene, PrimitiveKind::disc, scene.discs.size() - 1, material, world_from_object);
}

std::uint32_t add_box(Scene& scene, const Box& box, const Material& material,
                      const glm::dmat4& world_from_object) {
    scene.boxes.push_back(box);
    return add_primitive(scene, PrimitiveKind::box, scene.boxes.size() - 1, material, world_from_object);
}

std::uint32_t add_group(Scene& scene) {
    Group group;
    group.name = "group " + std::to_string(scene.groups.size());
    group.first_primitive = static_cast<std::uint32_t>(scene.primitives.size());
    scene.groups.push_back(group);
    return static_cast<std::uint32_t>(scene.groups.size() - 1);
}

void add_instance(Scene& scene, std::uint32_t group, const glm::dmat4& transform) {
    scene.instances.push_back({group, add_transform(scene, transform)});
}

void add_instance(Scene& scene, std::uint32_t parent, std::uint32_t group, const glm::dmat4& transform) {
    const std::uint32_t index = add_transform(scene, transform);
    scene.groups[parent].instances.push_back({group, index});
}

std::uint32_t add_square(Scene& scene, float height, float half, const Material& material,
                         const glm::dmat4& world_from_object) {
    return add_polygon(
        scene, {{-half, -half, height}, {half, -half, height}, {half, half, height}, {-half, half, height}},
        material, world_from_object);
}

Light point_light(const glm::dvec3& position, const glm::vec3& color, const glm::vec3& attenuation) {
    Light light;
    light.position = position;
    light.color = color;
    light.attenuation = attenuation;
    return light;
}

Light directional_light(const glm::dvec3& towards, const glm::vec3& color) {
    Light light = point_light(towards, color);
    light.kind = LightKind::directional;
    return light;
}

Light spot_light(const glm::dvec3& position, const glm::dvec3& direction, double inner_angle,
                 double outer_angle, const glm::vec3& color) {
    Light light = point_light(position, color);
    light.kind = LightKind::spot;
    light.direction = direction;
    light.inner_angle = inner_angle;
    light.outer_angle = outer_angle;
    return light;
}

std::uint32_t add_texture(Scene& scene, const Texture& texture) {
    scene.textures.push_back(texture);
    return static_cast<std::uint32_t>(scene.textures.size() - 1);
}

Material emitting(const glm::vec3& emission) {
    Material material;
    material.emission = emission;
    return material;
}

Material matte(const glm::vec3& diffuse) {
    Material material;
    material.diffuse = diffuse;
    return material;
}

Material mirror(const glm::vec3& reflection) {
    Material material;
    material.reflection = reflection;
    return material;
}

Material glass(const glm::vec3& transmission, float ior) {
    Material material;
    material.transmission = transmission;
    material.ior = ior;
    return material;
}

}  // namespace sahl::oracle
