#include "tests/host/scene/resolved_scene.h"

#include <vector>

#include <fmt/format.h>

namespace sahl::tests {
namespace {

class Lines {
public:
    explicit Lines(const Scene& scene) : scene_(scene) {}
    std::string text();

private:
    template <class Vector>
    static std::string exact(const Vector& v) {
        std::string text;
        for (int i = 0; i < v.length(); ++i) text += fmt::format(" {:a}", v[i]);
        return text;
    }
    template <class... Parts>
    void line(fmt::format_string<Parts...> format, Parts&&... parts) {
        text_ += fmt::format(format, std::forward<Parts>(parts)...) + "\n";
    }
    void material(const Material& m);
    void texture(std::uint32_t index);
    void transform(std::uint32_t index);
    void primitive(const Primitive& p);
    void instances(const std::vector<Instance>& all);

    const Scene& scene_;
    std::string text_;
};

std::string Lines::text() {
    for (const Camera& c : scene_.cameras)
        line("camera {}{}{}{} {:a}", c.name, exact(c.eye), exact(c.look_at), exact(c.up), c.fov_y);
    line("film {} {} depth {}", scene_.resolution.width, scene_.resolution.height, scene_.depth);
    line("background{} ambient{}", exact(scene_.background), exact(scene_.ambient));
    for (const Light& l : scene_.lights) {
        line("light {}{}{}", static_cast<int>(l.kind), exact(l.position), exact(l.color));
        if (l.kind != LightKind::directional) line("  attenuation{}", exact(l.attenuation));
        if (l.kind == LightKind::spot)
            line("  spot{} {:a} {:a}", exact(l.direction), l.inner_angle, l.outer_angle);
    }
    for (const Material& m : scene_.materials) material(m);
    std::uint32_t id = 0;
    for (; id < world_primitive_count(scene_); ++id) primitive(scene_.primitives[id]);
    instances(scene_.instances);
    for (const Group& g : scene_.groups) {
        line("group {} {}", g.name, g.primitive_count);
        for (std::uint32_t i = 0; i < g.primitive_count; ++i)
            primitive(scene_.primitives[g.first_primitive + i]);
        instances(g.instances);
    }
    return std::move(text_);
}

void Lines::material(const Material& m) {
    line("material {} {} {} {:a} {:a} {:a}", m.name, static_cast<int>(m.specular_model), m.two_sided,
         m.shininess, m.ior, m.ior_outside);
    for (const glm::vec3& v : {m.ambient, m.diffuse, m.specular, m.emission, m.reflection, m.transmission,
                               m.reflection_attenuation}) {
        line(" {}", exact(v));
    }
    for (const std::uint32_t index : {m.textures.ambient, m.textures.diffuse, m.textures.specular,
                                      m.textures.emission, m.textures.reflection}) {
        texture(index);
    }
}

void Lines::texture(std::uint32_t index) {
    if (index == no_texture) return line("  no texture");
    const Texture& t = scene_.textures[index];
    line("  texture {} {}{}{}{}{}", static_cast<int>(t.pattern), static_cast<int>(t.space),
         exact(t.colors[0]), exact(t.colors[1]), exact(t.origin), exact(t.extent));
}

void Lines::transform(std::uint32_t index) {
    const glm::dmat4& m = scene_.transforms[index];
    if (m == glm::dmat4(1)) return;
    line("  transform{}{}{}{}", exact(m[0]), exact(m[1]), exact(m[2]), exact(m[3]));
}

void Lines::primitive(const Primitive& p) {
    line("primitive {} material {} sides {}", static_cast<int>(p.kind), p.material,
         static_cast<int>(p.sides));
    transform(p.transform);
    switch (p.kind) {
        case PrimitiveKind::triangle: {
            const Triangle& t = scene_.triangles[p.index];
            for (int k = 0; k < 3; ++k) {
                line("  corner{}", exact(scene_.vertices[t.vertices[k]]));
                if (t.smooth) line("  normal{}", exact(scene_.normals[t.normals[k]]));
                if (t.has_uv) line("  uv{}", exact(scene_.uvs[t.uvs[k]]));
            }
            break;
        }
        case PrimitiveKind::polygon: {
            const Polygon& polygon = scene_.polygons[p.index];
            for (std::uint32_t i = 0; i < polygon.vertex_count; ++i)
                line("  corner{}", exact(scene_.polygon_vertices[polygon.first_vertex + i]));
            break;
        }
        case PrimitiveKind::sphere: {
            const Sphere& sphere = scene_.spheres[p.index];
            line(" {} {:a}", exact(sphere.center), sphere.radius);
            break;
        }
        case PrimitiveKind::cone: {
            const Cone& cone = scene_.cones[p.index];
            line(" {}{} {:a} {:a} {}", exact(cone.base), exact(cone.apex), cone.base_radius, cone.apex_radius,
                 cone.capped);
            break;
        }
        case PrimitiveKind::disc: {
            const Disc& disc = scene_.discs[p.index];
            line(" {}{} {:a}", exact(disc.center), exact(disc.normal), disc.radius);
            break;
        }
        case PrimitiveKind::box: {
            const Box& box = scene_.boxes[p.index];
            line(" {}{}", exact(box.lo), exact(box.hi));
            break;
        }
    }
}

void Lines::instances(const std::vector<Instance>& all) {
    for (const Instance& instance : all) {
        line("instance of {}", instance.group);
        transform(instance.transform);
    }
}

}  // namespace

std::string resolved(const Scene& scene) { return Lines(scene).text(); }

}  // namespace sahl::tests
