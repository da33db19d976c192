#include "tests/support/oracle/build_scene.h"

namespace sahl::oracle {
namespace {

std::uint32_t add_primitive(Scene& scene, PrimitiveKind kind, std::size_t index, const Material& material,
                            const glm::dmat4& world_from_object) {
    Primitive primitive;
    primitive.kind = kind;
    primitive.index = static_cast<std::uint32_t>(index);
    primitive.material = static_cast<std::uint32_t>(scene.materials.size());
    scene.materials.push_back(material);
    if (world_from_object != glm::dmat4(1)) {
        primitive.transform = static_cast<std::uint32_t>(scene.transforms.size());
        scene.transforms.push_back(world_from_object);
    }
    scene.primitives.push_back(primitive);
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

std::uint32_t add_square(Scene& scene, float height, float half, const Material& material,
                         const glm::dmat4& world_from_object) {
    return add_polygon(
        scene, {{-half, -half, height}, {half, -half, height}, {half, half, height}, {-half, half, height}},
        material, world_from_object);
}

Light point_light(const glm::dvec3& position, const glm::vec3& color, const glm::vec3& attenuation) {
    return {LightKind::point, position, color, attenuation};
}

Light directional_light(const glm::dvec3& towards, const glm::vec3& color) {
    return {LightKind::directional, towards, color, {1, 0, 0}};
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
