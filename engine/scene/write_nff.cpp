#include "engine/scene/write_nff.h"

#include <algorithm>
#include <array>
#include <vector>

#include <fmt/format.h>

#include "engine/scene/polygon.h"
#include "engine/scene/write_text.h"

namespace sahl {
namespace {

constexpr int depth_of_nff = 4;

bool is_grey(const glm::vec3& c) { return c.r == c.g && c.g == c.b; }

[[noreturn]] void fail(std::string_view lacks) { cannot_express("NFF", lacks); }

class NffWriter {
public:
    explicit NffWriter(const Scene& scene) : scene_(scene) {}
    std::string write();

private:
    void check_whole() const;
    void write_head();
    void write_lights();
    void write_fill(std::uint32_t material);
    void use_material(std::uint32_t material);
    void write_object(std::size_t id);
    void write_cone(const Primitive& p, std::string_view id);
    void write_triangle(const Triangle& triangle);
    template <class... Parts>
    void line(fmt::format_string<Parts...> format, Parts&&... parts) {
        fmt::format_to(std::back_inserter(text_), format, std::forward<Parts>(parts)...);
        text_ += '\n';
    }

    const Scene& scene_;
    std::string text_;
    std::uint32_t fills_ = 0;     // materials that have their line
    std::int64_t material_ = -1;  // of the last line
};

std::string NffWriter::write() {
    check_whole();
    write_head();
    write_lights();
    for (std::size_t id = 0; id < scene_.primitives.size(); ++id) write_object(id);
    while (fills_ < scene_.materials.size()) write_fill(fills_++);
    return std::move(text_);
}

void NffWriter::check_whole() const {
    if (scene_.cameras.size() > 1)
        fail(fmt::format("has one camera, and the scene has {}", scene_.cameras.size()));
    if (scene_.depth != depth_of_nff)
        fail(fmt::format("is always rendered with depth {}, and the scene's depth is {}", depth_of_nff,
                         scene_.depth));
    if (!scene_.groups.empty()) fail("has no groups and instances");
}

void NffWriter::write_head() {
    const Camera& camera = scene_.cameras[0];
    line("b {}", decimals(scene_.background));
    line("v");
    line("from {}", decimals(camera.eye));
    line("at {}", decimals(camera.look_at));
    line("up {}", decimals(camera.up));
    line("angle {}", decimal(camera.fov_y));
    line("hither 0");
    line("resolution {} {}", scene_.resolution.width, scene_.resolution.height);
}

void NffWriter::write_lights() {
    for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
        const Light& light = scene_.lights[i];
        if (light.kind == LightKind::directional)
            fail(fmt::format("has no directional lights: light {}", i + 1));
        if (light.kind == LightKind::spot) fail(fmt::format("has no spot lights: light {}", i + 1));
        if (light.attenuation != glm::vec3(1, 0, 0))
            fail(fmt::format("has no attenuation of light by distance: light {}", i + 1));
        line("l {} {}", decimals(light.position), decimals(light.color));
    }
}

void NffWriter::write_fill(std::uint32_t material) {
    const Material& m = scene_.materials[material];
    const auto need = [&](bool holds, std::string_view lacks) {
        if (!holds) fail(fmt::format("{}: {}", lacks, material_text(scene_, material)));
    };
    need(m.ambient == glm::vec3(0) || scene_.ambient == glm::vec3(0), "has no ambient light");
    need(m.emission == glm::vec3(0), "has no emission");
    need(m.specular == m.reflection, "has one Ks for the highlight and the mirror, so both have to be equal");
    need(is_grey(m.specular), "has no coloured Ks");
    need(is_grey(m.transmission), "has no coloured T");
    need(m.specular == glm::vec3(0) || m.specular_model == SpecularModel::phong, "has no Blinn highlights");
    need(m.two_sided, "has no one-sided materials");
    need(m.ior_outside == 1, "has no index of refraction outside");
    need(m.reflection_attenuation == glm::vec3(1, 0, 0), "has no attenuation of the reflected light");
    const MaterialTextures& t = m.textures;
    const std::array<std::uint32_t, 5> textures = {t.ambient, t.diffuse, t.specular, t.emission,
                                                   t.reflection};
    need(std::all_of(textures.begin(), textures.end(), [](auto index) { return index == no_texture; }),
         "has no textures");
    line("f {} 1 {} {} {} {}", decimals(m.diffuse), decimal(m.specular.r), decimal(m.shininess),
         decimal(m.transmission.r), decimal(m.ior));
}

// Each material once and in order, as long as the objects let it.
void NffWriter::use_material(std::uint32_t material) {
    if (material == material_) return;
    material_ = material;
    if (material < fills_) return write_fill(material);
    while (fills_ <= material) write_fill(fills_++);
}

void NffWriter::write_object(std::size_t id) {
    const Primitive& p = scene_.primitives[id];
    const std::string object = object_text(scene_, id);
    if (scene_.transforms[p.transform] != glm::dmat4(1)) fail(fmt::format("has no transforms: {}", object));
    const bool round = p.kind == PrimitiveKind::sphere || p.kind == PrimitiveKind::cone;
    if (p.sides == Sides::front || (p.sides == Sides::back && !round)) {
        fail(fmt::format("has no one-sided objects but the insides of spheres and cones: {}", object));
    }
    use_material(p.material);
    switch (p.kind) {
        case PrimitiveKind::triangle:
            return write_triangle(scene_.triangles[p.index]);
        case PrimitiveKind::polygon: {
            const Polygon& polygon = scene_.polygons[p.index];
            if (polygon.vertex_count == 3)
                fail(fmt::format("makes a polygon of three corners a triangle: {}", object));
            line("p {}", polygon.vertex_count);
            for (std::uint32_t i = 0; i < polygon.vertex_count; ++i)
                line("{}", decimals(scene_.polygon_vertices[polygon.first_vertex + i]));
            return;
        }
        case PrimitiveKind::sphere: {
            const Sphere& sphere = scene_.spheres[p.index];
            return line("s {} {}", decimals(sphere.center),
                        decimal(p.sides == Sides::back ? -sphere.radius : sphere.radius));
        }
        case PrimitiveKind::cone:
            return write_cone(p, object);
        case PrimitiveKind::disc:
            fail(fmt::format("has no discs: {}", object));
        case PrimitiveKind::box:
            fail(fmt::format("has no boxes: {}", object));
    }
}

void NffWriter::write_cone(const Primitive& p, std::string_view id) {
    const Cone& cone = scene_.cones[p.index];
    if (cone.capped) fail(fmt::format("has no capped cones and cylinders: {}", id));
    const double sign = p.sides == Sides::back ? -1 : 1;
    line("c");
    line("{} {}", decimals(cone.base), decimal(sign * cone.base_radius));
    line("{} {}", decimals(cone.apex), decimal(sign * cone.apex_radius));
}

void NffWriter::write_triangle(const Triangle& triangle) {
    std::array<glm::vec3, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = scene_.vertices[triangle.vertices[k]];
    if (is_degenerate(corners[0], corners[1], corners[2])) return;
    if (!triangle.smooth) {
        line("p 3");
        for (const glm::vec3& corner : corners) line("{}", decimals(corner));
        return;
    }
    // The reader cuts patches into triangles and may begin one at another corner.
    for (std::size_t start = 0; start < 3; ++start) {
        const std::array<std::size_t, 3> order = {start, (start + 1) % 3, (start + 2) % 3};
        const auto cut = triangulate(std::array{corners[order[0]], corners[order[1]], corners[order[2]]});
        if (!cut || cut->empty()) continue;
        const auto& [a, b, c] = cut->front();
        if (order[a] != 0 || order[b] != 1 || order[c] != 2) continue;
        line("pp 3");
        for (const std::size_t k : order) {
            line("{} {}", decimals(corners[k]),
                 decimals(before_normalizing(scene_.normals[triangle.normals[k]], "NFF")));
        }
        return;
    }
}

}  // namespace

std::string write_nff(const Scene& scene) { return NffWriter(scene).write(); }

}  // namespace sahl
