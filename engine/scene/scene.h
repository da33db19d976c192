// The scene as every loader leaves it and the renderer takes it: plain structs, world units,
// linear colour. Nothing here knows about files or devices.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace sahl {

/// Pinhole camera. `fov_y` is the full vertical angle in degrees between the image's edges.
struct Camera {
    glm::dvec3 eye{0, 0, 0};
    glm::dvec3 look_at{0, 0, -1};
    glm::dvec3 up{0, 1, 0};
    double fov_y = 45;
};

/// Image size in pixels.
struct Resolution {
    int width = 512;
    int height = 512;
};

/// `phong`: (R·V)^n, only where N·L > 0. `blinn`: (N·H)^n, wherever it is positive.
enum class SpecularModel { phong, blinn };

/// Whitted surface: I = ambient + emission + Σ lights [diffuse N·L + specular highlight]
/// + reflection · I(reflected) + transmission · I(transmitted). All colours linear RGB.
struct Material {
    glm::vec3 ambient{0};
    glm::vec3 diffuse{0};
    glm::vec3 specular{0};
    glm::vec3 emission{0};
    glm::vec3 reflection{0};    ///< kr; zero: no reflected ray
    glm::vec3 transmission{0};  ///< kt; zero: opaque
    float shininess = 1;        ///< the highlight's exponent n
    float ior = 1;              ///< index of refraction inside; 1 outside
    SpecularModel specular_model = SpecularModel::phong;
    bool two_sided = true;  ///< normals are turned towards the ray before shading
};

enum class LightKind { point, directional };

/// A point light at `position`, or a directional one with `position` the vector towards it.
/// The light of a point arrives divided by attenuation.x + attenuation.y·d + attenuation.z·d².
struct Light {
    LightKind kind = LightKind::point;
    glm::dvec3 position{0};
    glm::vec3 color{1};
    glm::vec3 attenuation{1, 0, 0};
};

enum class PrimitiveKind : std::uint32_t { triangle, polygon, sphere, cone };

/// Indices into Scene::vertices and Scene::normals; `normals` is used where `smooth`.
struct Triangle {
    std::uint32_t vertices[3] = {0, 0, 0};
    std::uint32_t normals[3] = {0, 0, 0};
    bool smooth = false;
};

/// A planar polygon, convex or concave, without holes: a range of Scene::polygon_vertices.
struct Polygon {
    std::uint32_t first_vertex = 0;
    std::uint32_t vertex_count = 0;
};

/// `inside_only`: only seen by rays that leave it.
struct Sphere {
    glm::dvec3 center{0};
    double radius = 1;
    bool inside_only = false;
};

/// The open side of a cone, a truncated cone or (equal radii) a cylinder. One radius may be 0.
struct Cone {
    glm::dvec3 base{0};
    glm::dvec3 apex{0, 0, 1};
    double base_radius = 1;
    double apex_radius = 0;
    bool inside_only = false;
};

/// One object. Its position in Scene::primitives is its id; of two hits at the same distance
/// the lower id wins.
struct Primitive {
    PrimitiveKind kind = PrimitiveKind::triangle;
    std::uint32_t index = 0;      ///< into the array of its kind
    std::uint32_t material = 0;   ///< into Scene::materials
    std::uint32_t transform = 0;  ///< into Scene::transforms, world from object
};

struct Scene {
    Camera camera;
    Resolution resolution;
    int depth = 5;  ///< generations after the camera ray
    glm::vec3 background{0};
    std::vector<Light> lights;
    std::vector<Material> materials;
    std::vector<glm::dmat4> transforms{glm::dmat4(1)};  ///< affine; [0] is the identity

    std::vector<Primitive> primitives;
    std::vector<Triangle> triangles;
    std::vector<Polygon> polygons;
    std::vector<Sphere> spheres;
    std::vector<Cone> cones;
    std::vector<glm::vec3> vertices;          ///< of triangles
    std::vector<glm::vec3> normals;           ///< of triangles; any length but 0
    std::vector<glm::vec3> polygon_vertices;  ///< counter-clockwise seen from the front
};

}  // namespace sahl
