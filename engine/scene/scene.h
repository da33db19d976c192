// The scene as every loader leaves it and the renderer takes it: plain structs, world units,
// linear colour. Nothing here knows about files or devices.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace sahl {

/// Pinhole camera. `fov_y` is the full vertical angle in degrees between the image's edges.
struct Camera {
    glm::dvec3 eye{0, 0, 0};
    glm::dvec3 look_at{0, 0, -1};
    glm::dvec3 up{0, 1, 0};
    double fov_y = 45;
    std::string name{"camera"};
};

/// Image size in pixels.
struct Resolution {
    int width = 512;
    int height = 512;
};

/// `checker`: cells of `extent`'s size from `origin` on, colours[0] where the sum of the cell's
/// three numbers is even; an axis of extent 0 does not count. `gradient`: colours[0] at `origin`
/// and before, colours[1] at `origin + extent` and behind, linear in between.
enum class Pattern { checker, gradient };

/// What a pattern is a function of: the world position, or the surface's (u, v, 0).
enum class TextureSpace { position, uv };

/// A procedural colour.
struct Texture {
    Pattern pattern = Pattern::checker;
    TextureSpace space = TextureSpace::position;
    glm::vec3 colors[2] = {glm::vec3(0), glm::vec3(1)};
    glm::dvec3 origin{0};
    glm::dvec3 extent{1};
};

constexpr std::uint32_t no_texture = 0xffffffff;

/// Indices into Scene::textures, or no_texture; a texture multiplies the material's colour.
struct MaterialTextures {
    std::uint32_t ambient = no_texture;
    std::uint32_t diffuse = no_texture;
    std::uint32_t specular = no_texture;
    std::uint32_t emission = no_texture;
    std::uint32_t reflection = no_texture;
};

/// `phong`: (R·V)^n, only where N·L > 0. `blinn`: (N·H)^n, wherever it is positive.
enum class SpecularModel { phong, blinn };

/// Whitted surface: I = ambient · Ia + emission + Σ lights [diffuse N·L + specular highlight]
/// + reflection · I(reflected) · f(d) + transmission · I(transmitted), where d is the reflected
/// ray's length and f(d) = 1/(a.x + a.y d + a.z d²) with a = reflection_attenuation. All colours
/// linear RGB.
struct Material {
    glm::vec3 ambient{0};
    glm::vec3 diffuse{0};
    glm::vec3 specular{0};
    glm::vec3 emission{0};
    glm::vec3 reflection{0};    ///< kr; zero: no reflected ray
    glm::vec3 transmission{0};  ///< kt; zero: opaque
    float shininess = 1;        ///< the highlight's exponent n
    float ior = 1;              ///< index of refraction inside
    SpecularModel specular_model = SpecularModel::phong;
    bool two_sided = true;  ///< normals are turned towards the ray before shading
    float ior_outside = 1;  ///< index of refraction on the side that normals point to
    glm::vec3 reflection_attenuation{1, 0, 0};
    MaterialTextures textures{};
    std::string name{};
};

enum class LightKind { point, directional, spot };

/// A point light at `position`, a directional one with `position` the vector towards it, or a spot
/// at `position` that shines along `direction`: at full strength up to `inner_angle` from it, not at
/// all from `outer_angle` on (degrees), in between by the smooth step of the angle's cosine.
/// The light of points and spots arrives divided by attenuation.x + attenuation.y·d + attenuation.z·d².
struct Light {
    LightKind kind = LightKind::point;
    glm::dvec3 position{0};
    glm::vec3 color{1};
    glm::vec3 attenuation{1, 0, 0};
    glm::dvec3 direction{0, 0, -1};
    double inner_angle = 30;
    double outer_angle = 30;
};

enum class PrimitiveKind : std::uint32_t { triangle, polygon, sphere, cone, disc, box };

/// From where a primitive is seen, by shadow rays too: `front` is the side that its normals point to,
/// the outside of a solid.
enum class Sides { both, front, back };

/// Indices into Scene::vertices, Scene::normals (used where `smooth`) and Scene::uvs (used where
/// `has_uv`; else (u, v) are the barycentrics of vertices 1 and 2).
struct Triangle {
    std::uint32_t vertices[3] = {0, 0, 0};
    std::uint32_t normals[3] = {0, 0, 0};
    bool smooth = false;
    std::uint32_t uvs[3] = {0, 0, 0};
    bool has_uv = false;
};

/// A planar polygon, convex or concave, without holes: a range of Scene::polygon_vertices.
/// u runs along the first edge, v to its left, from the first vertex, both in units of length.
struct Polygon {
    std::uint32_t first_vertex = 0;
    std::uint32_t vertex_count = 0;
};

/// u is the angle about z from x, v that from -z to z, both over the whole range to 0..1.
struct Sphere {
    glm::dvec3 center{0};
    double radius = 1;
};

/// A cone, a truncated cone or (equal radii) a cylinder: its open side, or the solid. One radius may
/// be 0. u is the angle about the axis, 0..1, from x × axis (y × axis where the axis is within 60° of x);
/// v runs from base to apex.
struct Cone {
    glm::dvec3 base{0};
    glm::dvec3 apex{0, 0, 1};
    double base_radius = 1;
    double apex_radius = 0;
    bool capped = false;
};

/// u is the angle about the normal as for cones, v the distance from the centre over the radius.
struct Disc {
    glm::dvec3 center{0};
    glm::dvec3 normal{0, 0, 1};
    double radius = 1;
};

/// The solid lo.x..hi.x, lo.y..hi.y, lo.z..hi.z. (u, v) on a face are the places 0..1 along the other
/// two axes in the order x, y, z.
struct Box {
    glm::dvec3 lo{-1};
    glm::dvec3 hi{1};
};

/// One object. Its position in Scene::primitives is its id; of two hits at the same distance
/// the one with the lower (instance, id) wins.
struct Primitive {
    PrimitiveKind kind = PrimitiveKind::triangle;
    std::uint32_t index = 0;      ///< into the array of its kind
    std::uint32_t material = 0;   ///< into Scene::materials
    std::uint32_t transform = 0;  ///< into Scene::transforms, world (or group) from object
    Sides sides = Sides::both;
};

/// A group placed in the world or in another group.
struct Instance {
    std::uint32_t group = 0;      ///< into Scene::groups
    std::uint32_t transform = 0;  ///< into Scene::transforms
};

/// Primitives and instances that are placed together: a range of Scene::primitives. Groups do not
/// contain themselves.
struct Group {
    std::string name{};
    std::uint32_t first_primitive = 0;
    std::uint32_t primitive_count = 0;
    std::vector<Instance> instances{};
};

struct Scene {
    std::vector<Camera> cameras{Camera{}};  ///< at least one; [0] is used unless another is named
    Resolution resolution;
    int depth = 5;  ///< generations after the camera ray
    glm::vec3 background{0};
    glm::vec3 ambient{1};  ///< Ia, the ambient light
    std::vector<Light> lights;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<glm::dmat4> transforms{glm::dmat4(1)};  ///< affine; [0] is the identity

    /// The world's, then those of groups[0], groups[1], …
    std::vector<Primitive> primitives;
    std::vector<Instance> instances;  ///< in the world
    std::vector<Group> groups;

    std::vector<Triangle> triangles;
    std::vector<Polygon> polygons;
    std::vector<Sphere> spheres;
    std::vector<Cone> cones;
    std::vector<Disc> discs;
    std::vector<Box> boxes;
    std::vector<glm::vec3> vertices;          ///< of triangles
    std::vector<glm::vec3> normals;           ///< of triangles; any length but 0
    std::vector<glm::vec2> uvs;               ///< of triangles
    std::vector<glm::vec3> polygon_vertices;  ///< counter-clockwise seen from the front
};

/// How many of Scene::primitives are the world's own.
inline std::uint32_t world_primitive_count(const Scene& scene) {
    return scene.groups.empty() ? static_cast<std::uint32_t>(scene.primitives.size())
                                : scene.groups.front().first_primitive;
}

}  // namespace sahl
