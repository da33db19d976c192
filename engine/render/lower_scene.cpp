#include "engine/render/lower_scene.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_access.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>

#include "engine/core/error.h"
#include "engine/render/two_floats.h"

namespace sahl {
namespace {

using glm::dmat3;
using glm::dmat4;
using glm::dvec3;
using glm::vec3;

dvec3 transform_point(const dmat4& m, const dvec3& p) { return dvec3(m * glm::dvec4(p, 1)); }

/// The box lo..hi in floats that contains it, widened by the rounding that shapes went through on
/// their way to the device.
Bounds outer_bounds(const dvec3& lo, const dvec3& hi) {
    constexpr double slack = 4e-7;
    constexpr float infinity = std::numeric_limits<float>::infinity();
    Bounds bounds{};
    for (int k = 0; k < 3; ++k) {
        const double margin = slack * std::max({std::abs(lo[k]), std::abs(hi[k]), hi[k] - lo[k]});
        bounds.lo[k] = std::nextafter(static_cast<float>(lo[k] - margin), -infinity);
        bounds.hi[k] = std::nextafter(static_cast<float>(hi[k] + margin), infinity);
    }
    return bounds;
}

Bounds point_bounds(const std::vector<vec3>& points) {
    Bounds bounds{};
    for (int k = 0; k < 3; ++k) {
        const auto [lo, hi] =
            std::minmax_element(points.begin(), points.end(), [k](auto a, auto b) { return a[k] < b[k]; });
        bounds.lo[k] = (*lo)[k];
        bounds.hi[k] = (*hi)[k];
    }
    return bounds;
}

/// Normal of a closed outline by Newell's method, unit length.
dvec3 newell_normal(const std::vector<vec3>& points) {
    dvec3 normal(0);
    const dvec3 origin(points[0]);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const dvec3 a = dvec3(points[i]) - origin;
        const dvec3 b = dvec3(points[(i + 1) % points.size()]) - origin;
        normal += glm::cross(a, b);
    }
    return glm::normalize(normal);
}

/// The direction of the first edge that has one.
dvec3 first_edge(const std::vector<vec3>& outline) {
    const auto next =
        std::find_if(outline.begin(), outline.end(), [&](const vec3& p) { return p != outline[0]; });
    return glm::normalize(dvec3(*next) - dvec3(outline[0]));
}

constexpr std::size_t floats_of_group = sizeof(device::OutlineGroup) / sizeof(float);

constexpr std::uint32_t MaterialTextures::*texture_slots[] = {
    &MaterialTextures::ambient, &MaterialTextures::diffuse, &MaterialTextures::specular,
    &MaterialTextures::emission, &MaterialTextures::reflection};

bool is_textured(const Material& material) {
    return std::any_of(std::begin(texture_slots), std::end(texture_slots),
                       [&](auto slot) { return material.textures.*slot != no_texture; });
}

bool uses_uv(const Scene& scene, const Material& material) {
    return std::any_of(std::begin(texture_slots), std::end(texture_slots), [&](auto slot) {
        const std::uint32_t texture = material.textures.*slot;
        return texture != no_texture && scene.textures[texture].space == TextureSpace::uv;
    });
}

/// A right-handed orthonormal frame whose z is `unit`.
dmat3 frame_around(const dvec3& unit) {
    const dvec3 helper = std::abs(unit.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 x = glm::normalize(glm::cross(helper, unit));
    return {x, glm::cross(unit, x), unit};
}

/// Appends shapes one after the other; each writes its data and returns kind and bounds.
class Lowering {
public:
    Lowering(const Scene& scene, LoweredScene& out) : scene_(scene), out_(out) {}

    void add(std::uint32_t id) {
        const Primitive& primitive = scene_.primitives[id];
        transform_ = scene_.transforms[primitive.transform];
        linear_ = dmat3(transform_);
        mirrored_ = glm::determinant(linear_) < 0;
        uses_uv_ = uses_uv(scene_, scene_.materials[primitive.material]);
        lowered_ = {0, primitive.material, static_cast<std::uint32_t>(out_.shape_data.size()), 0};
        switch (primitive.kind) {
            case PrimitiveKind::triangle:
                add_triangle(scene_.triangles[primitive.index]);
                break;
            case PrimitiveKind::polygon:
                add_polygon(scene_.polygons[primitive.index]);
                break;
            case PrimitiveKind::sphere:
                add_sphere(scene_.spheres[primitive.index]);
                break;
            case PrimitiveKind::cone:
                add_cone(scene_.cones[primitive.index]);
                break;
            case PrimitiveKind::disc:
                add_disc(scene_.discs[primitive.index]);
                break;
            case PrimitiveKind::box:
                add_box(scene_.boxes[primitive.index]);
                break;
        }
        for (int k = 0; k < 3; ++k) {
            if (!std::isfinite(bounds_.lo[k]) || !std::isfinite(bounds_.hi[k])) {
                throw Error(ExitCode::scene,
                            "primitive " + std::to_string(id) +
                                " has no finite place in the world; check its coordinates and transform");
            }
        }
        out_.primitives.push_back(lowered_);
        out_.build_primitives.push_back({bounds_, lowered_.kind, id});
    }

private:
    void push(const vec3& v) { out_.shape_data.insert(out_.shape_data.end(), {v.x, v.y, v.z}); }

    /// Three high parts, then three low ones.
    void push_exact(const dvec3& v) {
        const TwoFloats x = split(v.x), y = split(v.y), z = split(v.z);
        out_.shape_data.insert(out_.shape_data.end(), {x.high, y.high, z.high, x.low, y.low, z.low});
    }
    void push_exact(double v) {
        const TwoFloats parts = split(v);
        out_.shape_data.insert(out_.shape_data.end(), {parts.high, parts.low});
    }

    void add_triangle(const Triangle& triangle) {
        // Swapping two corners keeps the winding's normal outward under a mirroring transform.
        const int order[3] = {0, mirrored_ ? 2 : 1, mirrored_ ? 1 : 2};
        points_.clear();
        for (const int corner : order) {
            points_.emplace_back(
                transform_point(transform_, dvec3(scene_.vertices[triangle.vertices[corner]])));
            push(points_.back());
        }
        if (triangle.smooth) {
            const dmat3 normal_from_object = glm::transpose(glm::inverse(linear_));
            for (const int corner : order) {
                // Unit in object space, where they are interpolated, and of any length here.
                const dvec3 n(glm::normalize(dvec3(scene_.normals[triangle.normals[corner]])));
                push(vec3(normal_from_object * n));
            }
            lowered_.flags |= SAHL_PRIMITIVE_SMOOTH;
        }
        // The corners' order decides which barycentrics u and v are.
        if (uses_uv_ && (triangle.has_uv || mirrored_)) {
            const glm::vec2 barycentrics[3] = {{0, 0}, {1, 0}, {0, 1}};
            for (const int corner : order) {
                const glm::vec2 uv =
                    triangle.has_uv ? scene_.uvs[triangle.uvs[corner]] : barycentrics[corner];
                out_.shape_data.insert(out_.shape_data.end(), {uv.x, uv.y});
            }
            lowered_.flags |= SAHL_PRIMITIVE_UV;
        }
        lowered_.kind = SAHL_KIND_TRIANGLE;
        bounds_ = point_bounds(points_);
    }

    void add_polygon(const Polygon& polygon) {
        points_.clear();
        for (std::uint32_t i = 0; i < polygon.vertex_count; ++i) {
            points_.emplace_back(
                transform_point(transform_, dvec3(scene_.polygon_vertices[polygon.first_vertex + i])));
        }
        if (mirrored_) {
            std::reverse(points_.begin() + 1, points_.end());
        }
        push_exact(newell_normal(points_));
        push_exact(dvec3(points_[0]));
        const auto first_group = static_cast<std::uint32_t>(out_.outlines.size() / floats_of_group);
        out_.shape_data.push_back(std::bit_cast<float>(first_group));
        out_.shape_data.push_back(std::bit_cast<float>(polygon.vertex_count));
        push_uv_axes(polygon);
        push_outline();
        lowered_.kind = SAHL_KIND_POLYGON;
        bounds_ = point_bounds(points_);
    }

    /// Of the corners in points_.
    void push_outline() {
        for (std::size_t first = 0; first < points_.size(); first += SAHL_OUTLINE_EDGES) {
            for (int axis = 0; axis < 3; ++axis) {
                for (std::size_t i = first; i <= first + SAHL_OUTLINE_EDGES; ++i)
                    out_.outlines.push_back(points_[i < points_.size() ? i : 0][axis]);
            }
        }
    }

    /// What u and v are the products of with a vector from the (transformed) first vertex.
    void push_uv_axes(const Polygon& polygon) {
        const auto first = scene_.polygon_vertices.begin() + polygon.first_vertex;
        const std::vector<vec3> outline(first, first + polygon.vertex_count);
        const dvec3 u = first_edge(outline);
        const dvec3 v = glm::cross(newell_normal(outline), u);
        const dmat3 axes_from_object = glm::transpose(glm::inverse(linear_));
        push_exact(axes_from_object * u);
        push_exact(axes_from_object * v);
    }

    void add_sphere(const Sphere& sphere) {
        const dvec3 center = transform_point(transform_, sphere.center);
        const dmat3 world_from_unit = linear_ * sphere.radius;
        const dmat3 gram = glm::transpose(world_from_unit) * world_from_unit;
        const double radius2 = gram[0][0];
        double deviation = 0;
        for (int column = 0; column < 3; ++column) {
            for (int row = 0; row < 3; ++row) {
                deviation = std::max(deviation, std::abs(gram[column][row] - (row == column ? radius2 : 0)));
            }
        }
        dvec3 half_extent;
        for (int k = 0; k < 3; ++k) {
            half_extent[k] = glm::length(glm::row(world_from_unit, k));
        }
        if (deviation <= 1e-12 * radius2 && !uses_uv_) {
            lowered_.kind = SAHL_KIND_SPHERE;
            push_exact(center);
            push_exact(std::sqrt(radius2));
        } else {
            lowered_.kind = SAHL_KIND_ELLIPSOID;
            push_object_space(world_from_unit, center);
        }
        bounds_ = outer_bounds(center - half_extent, center + half_extent);
    }

    void add_cone(const Cone& cone) {
        const bool turned = cone.apex_radius > cone.base_radius;  // slopes are never positive
        const dvec3 base = turned ? cone.apex : cone.base;
        const dvec3 axis = (turned ? cone.base : cone.apex) - base;
        const double base_radius = turned ? cone.apex_radius : cone.base_radius;
        const double apex_radius = turned ? cone.base_radius : cone.apex_radius;
        const dmat3 frame = frame_around(glm::normalize(cone.apex - cone.base));
        const dmat3 world_from_cone = linear_ * dmat3(frame[0] * base_radius, frame[1] * base_radius, axis);
        const dvec3 world_base = transform_point(transform_, base);
        const dvec3 world_apex = transform_point(transform_, base + axis);
        dvec3 lo, hi;
        for (int k = 0; k < 3; ++k) {
            const double radius = glm::length(glm::dvec2(world_from_cone[0][k], world_from_cone[1][k]));
            const double far_radius = radius * apex_radius / base_radius;
            lo[k] = std::min(world_base[k] - radius, world_apex[k] - far_radius);
            hi[k] = std::max(world_base[k] + radius, world_apex[k] + far_radius);
        }
        lowered_.kind = cone.capped ? SAHL_KIND_SOLID_CONE : SAHL_KIND_CONE;
        push_object_space(world_from_cone, world_base);
        push_exact((apex_radius - base_radius) / base_radius);
        if (turned) lowered_.flags |= SAHL_PRIMITIVE_TURNED;
        // Where a ray grazes a rim, its distance has the square root of the rounding's error.
        const dvec3 size = hi - lo;
        const dvec3 room(0x1p-12 * std::max({size.x, size.y, size.z}));
        bounds_ = outer_bounds(lo - room, hi + room);
    }

    void add_disc(const Disc& disc) {
        const dmat3 frame = frame_around(glm::normalize(disc.normal));
        const dmat3 world_from_disc =
            linear_ * dmat3(frame[0] * disc.radius, frame[1] * disc.radius, frame[2] * disc.radius);
        const dvec3 center = transform_point(transform_, disc.center);
        dvec3 half_extent;
        for (int k = 0; k < 3; ++k) {
            half_extent[k] = glm::length(glm::dvec2(world_from_disc[0][k], world_from_disc[1][k]));
        }
        lowered_.kind = SAHL_KIND_DISC;
        push_object_space(world_from_disc, center);
        bounds_ = outer_bounds(center - half_extent, center + half_extent);
    }

    void add_box(const Box& box) {
        const dvec3 half = (box.hi - box.lo) / 2.0;
        const dmat3 world_from_box =
            linear_ * dmat3(dvec3(half.x, 0, 0), dvec3(0, half.y, 0), dvec3(0, 0, half.z));
        const dvec3 center = transform_point(transform_, (box.lo + box.hi) / 2.0);
        dvec3 half_extent(0);
        for (int axis = 0; axis < 3; ++axis) half_extent += glm::abs(world_from_box[axis]);
        lowered_.kind = SAHL_KIND_BOX;
        push_object_space(world_from_box, center);
        bounds_ = outer_bounds(center - half_extent, center + half_extent);
    }

    void push_object_space(const dmat3& world_from_object, const dvec3& origin) {
        const dmat3 object_from_world = glm::inverse(world_from_object);
        for (int row = 0; row < 3; ++row) {
            push_exact(glm::row(object_from_world, row));
        }
        push_exact(origin);
    }

    const Scene& scene_;
    LoweredScene& out_;
    dmat4 transform_{1};
    dmat3 linear_{1};
    bool mirrored_ = false;
    bool uses_uv_ = false;
    device::DevicePrimitive lowered_{};
    Bounds bounds_{};
    std::vector<vec3> points_;
};

void copy3(float (&to)[3], const vec3& from) {
    to[0] = from.x;
    to[1] = from.y;
    to[2] = from.z;
}

device::DeviceMaterial lower_material(const Material& material, const vec3& ambient_light) {
    device::DeviceMaterial out{};
    copy3(out.ambient, material.ambient * ambient_light);
    copy3(out.emission, material.emission);
    copy3(out.attenuation, material.reflection_attenuation);
    copy3(out.diffuse, material.diffuse);
    copy3(out.specular, material.specular);
    copy3(out.reflection, material.reflection);
    copy3(out.transmission, material.transmission);
    out.shininess = material.shininess;
    out.ior = material.ior;
    out.ior_outside = material.ior_outside;
    out.ambient_texture = material.textures.ambient;
    out.diffuse_texture = material.textures.diffuse;
    out.specular_texture = material.textures.specular;
    out.emission_texture = material.textures.emission;
    out.reflection_texture = material.textures.reflection;
    out.flags = (material.two_sided ? SAHL_MATERIAL_TWO_SIDED : 0U) |
                (material.specular_model == SpecularModel::blinn ? SAHL_MATERIAL_BLINN : 0U) |
                (material.transmission != vec3(0) ? SAHL_MATERIAL_TRANSMITS : 0U) |
                (is_textured(material) ? SAHL_MATERIAL_TEXTURED : 0U) |
                (material.reflection_attenuation != vec3(1, 0, 0) ? SAHL_MATERIAL_ATTENUATES : 0U);
    return out;
}

device::DeviceLight lower_light(const Light& light) {
    device::DeviceLight out{};
    const bool directional = light.kind == LightKind::directional;
    out.kind = directional                      ? SAHL_LIGHT_DIRECTIONAL
               : light.kind == LightKind::point ? SAHL_LIGHT_POINT
                                                : SAHL_LIGHT_SPOT;
    copy3(out.position, vec3(directional ? glm::normalize(light.position) : light.position));
    copy3(out.direction, vec3(glm::normalize(light.direction)));
    out.cos_inner = static_cast<float>(std::cos(glm::radians(light.inner_angle)));
    out.cos_outer = static_cast<float>(std::cos(glm::radians(light.outer_angle)));
    copy3(out.color, light.color);
    copy3(out.attenuation, light.attenuation);
    return out;
}

device::DeviceTexture lower_texture(const Texture& texture) {
    device::DeviceTexture out{};
    out.pattern = texture.pattern == Pattern::checker ? SAHL_PATTERN_CHECKER : SAHL_PATTERN_GRADIENT;
    out.space = texture.space == TextureSpace::position ? SAHL_TEXTURE_POSITION : SAHL_TEXTURE_UV;
    copy3(out.color0, texture.colors[0]);
    copy3(out.color1, texture.colors[1]);
    for (int k = 0; k < 3; ++k) {
        const TwoFloats origin = split(texture.origin[k]), extent = split(texture.extent[k]);
        out.origin[k] = origin.high;
        out.origin[k + 3] = origin.low;
        out.extent[k] = extent.high;
        out.extent[k + 3] = extent.low;
    }
    return out;
}

}  // namespace

std::size_t outline_floats(const Scene& scene) {
    std::size_t groups = 0;
    for (const Primitive& primitive : scene.primitives) {
        if (primitive.kind != PrimitiveKind::polygon) continue;
        const std::size_t edges = scene.polygons[primitive.index].vertex_count;
        groups += (edges + SAHL_OUTLINE_EDGES - 1) / SAHL_OUTLINE_EDGES;
    }
    return groups * floats_of_group;
}

std::size_t most_shape_data(const Scene& scene) {
    std::size_t count = 0;
    for (const Primitive& primitive : scene.primitives) {
        if (primitive.kind != PrimitiveKind::triangle) {
            count += 26;  // the most of all kinds
            continue;
        }
        const Triangle& triangle = scene.triangles[primitive.index];
        count += 9U + (triangle.smooth ? 9U : 0U) + (scene.textures.empty() ? 0U : 6U);
    }
    return count;
}

LoweredScene lower_scene(const Scene& scene) {
    const std::size_t count = scene.primitives.size();
    if (count > SAHL_MAX_PRIMITIVES) {
        throw Error(ExitCode::scene, "the scene has " + std::to_string(count) + " primitives, at most " +
                                         std::to_string(SAHL_MAX_PRIMITIVES) +
                                         " are possible; split the scene");
    }
    LoweredScene out;
    out.shape_data.reserve(most_shape_data(scene));
    out.outlines.reserve(outline_floats(scene));
    out.primitives.reserve(count);
    out.build_primitives.reserve(most_references(count));  // as build_bvh() wants it
    Lowering lowering(scene, out);
    for (std::uint32_t id = 0; id < count; ++id) {
        lowering.add(id);
    }
    if (out.shape_data.size() > std::numeric_limits<std::uint32_t>::max()) {
        throw Error(ExitCode::scene, "the scene's shapes need more than 2^32 numbers; split the scene");
    }
    for (const Material& material : scene.materials) {
        out.materials.push_back(lower_material(material, scene.ambient));
    }
    for (const Texture& texture : scene.textures) {
        out.textures.push_back(lower_texture(texture));
    }
    for (const Light& light : scene.lights) {
        out.lights.push_back(lower_light(light));
    }
    return out;
}

std::uint32_t block_id(const Scene& scene, std::uint32_t id) {
    const Primitive& primitive = scene.primitives[id];
    const bool transparent = scene.materials[primitive.material].transmission != vec3(0);
    return id | SAHL_ID_BIAS | (primitive.sides == Sides::back ? SAHL_ID_BACK_ONLY : 0U) |
           (primitive.sides == Sides::front ? SAHL_ID_FRONT_ONLY : 0U) |
           (transparent ? SAHL_ID_TRANSPARENT : 0U);
}

}  // namespace sahl
