#include "engine/scene/write_cse167.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include "engine/scene/polygon.h"
#include "engine/scene/scene_cse167.h"
#include "engine/scene/write_text.h"

namespace sahl {
namespace {

[[noreturn]] void refuse(std::string_view lacks) { cannot_express(".test", lacks); }

/// rotate(axis, degrees) · scale(factors), or the other way round.
struct TurnAndScale {
    glm::dvec3 axis{0, 0, 1};
    double degrees = 0;
    glm::dvec3 factors{1};
    bool scale_first = false;

    glm::dmat4 matrix() const {
        const glm::dmat4 turn = glm::rotate(glm::dmat4(1), glm::radians(degrees), axis);
        const glm::dmat4 scale = glm::scale(glm::dmat4(1), factors);
        return degrees == 0 ? scale : scale_first ? scale * turn : turn * scale;
    }
};

// To 12 significant digits: what a person or a script wrote before it went through a matrix.
double written(double x) { return std::strtod(fmt::format("{:.12g}", x).c_str(), nullptr); }

// The axis and angle of a rotation. Source: Shepperd 1978, "Quaternion from Rotation Matrix": the
// largest of the four sums is divided by.
std::pair<glm::dvec3, double> axis_and_degrees(const glm::dmat3& r) {
    const glm::dvec3 twice_sine(r[1][2] - r[2][1], r[2][0] - r[0][2], r[0][1] - r[1][0]);
    const double twice_cosine = r[0][0] + r[1][1] + r[2][2] - 1;
    const double degrees = glm::degrees(std::atan2(glm::length(twice_sine), twice_cosine));
    if (glm::length(twice_sine) > 1e-6) return {twice_sine, degrees};
    // Half a turn: R + 1 is twice the outer product of the axis with itself.
    const glm::dmat3 outer = r + glm::dmat3(1);
    int k = 0;
    for (int i = 1; i < 3; ++i) k = outer[i][i] > outer[k][k] ? i : k;
    return {outer[k], degrees};
}

// The rotation and scale that make the linear part of `m`, bit for bit, if it is found.
std::optional<TurnAndScale> find_turn_and_scale(const glm::dmat4& m) {
    const glm::dmat3 linear(m);
    glm::dmat4 wanted(linear);
    for (const bool scale_first : {false, true}) {
        const glm::dmat3 columns = scale_first ? glm::transpose(linear) : linear;
        glm::dvec3 factors(glm::length(columns[0]), glm::length(columns[1]), glm::length(columns[2]));
        if (glm::determinant(linear) < 0) factors.x = -factors.x;
        const glm::dmat3 turn(columns[0] / factors.x, columns[1] / factors.y, columns[2] / factors.z);
        auto [axis, degrees] = axis_and_degrees(scale_first ? glm::transpose(turn) : turn);
        axis /= std::max({std::abs(axis.x), std::abs(axis.y), std::abs(axis.z)});
        for (const double sign : {1.0, -1.0}) {
            TurnAndScale candidate;
            candidate.scale_first = scale_first;
            candidate.degrees = sign * written(degrees);
            for (int i = 0; i < 3; ++i) {
                candidate.axis[i] = sign * written(std::abs(axis[i]) < 1e-12 ? 0 : axis[i]);
                candidate.factors[i] = written(factors[i]);
            }
            if (candidate.matrix() == wanted) return candidate;
        }
    }
    // No rotation: the numbers as they are.
    TurnAndScale scale;
    scale.factors = {m[0][0], m[1][1], m[2][2]};
    if (scale.matrix() == wanted) return scale;
    return {};
}

class Cse167Writer {
public:
    explicit Cse167Writer(const Scene& scene) : scene_(scene) {}
    std::string write();

private:
    void check_whole() const;
    void write_head();
    void write_lights();
    void check_material(std::uint32_t material) const;
    void use_material(std::uint32_t material);
    void use_transform(std::size_t id);
    void write_corners(std::size_t first);
    void write_triangle(const Triangle& triangle);
    bool can_be_hit(const Primitive& p) const;
    template <class... Parts>
    void line(fmt::format_string<Parts...> format, Parts&&... parts) {
        if (indented_) text_ += "  ";
        fmt::format_to(std::back_inserter(text_), format, std::forward<Parts>(parts)...);
        text_ += '\n';
    }

    using Corner = std::pair<std::uint32_t, std::uint32_t>;  // vertex, normal
    Corner corner(const Triangle& triangle, int k) const {
        return {triangle.vertices[k], triangle.smooth ? triangle.normals[k] : 0};
    }

    const Scene& scene_;
    std::string text_{};
    std::optional<std::uint32_t> material_{};
    std::uint32_t transform_ = 0;
    bool indented_ = false;                       // between pushTransform and popTransform
    std::map<Corner, std::size_t> corners_[2]{};  // numbers in the file: flat ones, smooth ones
};

std::string Cse167Writer::write() {
    check_whole();
    write_head();
    write_lights();
    for (std::size_t id = 0; id < scene_.primitives.size(); ++id) {
        const Primitive& p = scene_.primitives[id];
        if (p.kind != PrimitiveKind::triangle && p.kind != PrimitiveKind::sphere)
            refuse(fmt::format("has no shapes but triangles and spheres: {}", object_text(scene_, id)));
        if (p.sides != Sides::both)
            refuse(fmt::format("has no one-sided objects: {}", object_text(scene_, id)));
        if (!can_be_hit(p)) continue;
        use_transform(id);
        use_material(p.material);
        if (p.kind == PrimitiveKind::sphere) {
            const Sphere& sphere = scene_.spheres[p.index];
            line("sphere {} {}", decimals(sphere.center), decimal(sphere.radius));
        } else {
            const Triangle& triangle = scene_.triangles[p.index];
            write_corners(id);
            write_triangle(triangle);
        }
    }
    indented_ = false;
    if (transform_ != 0) line("popTransform");
    return std::move(text_);
}

void Cse167Writer::check_whole() const {
    if (scene_.cameras.size() > 1)
        refuse(fmt::format("has one camera, and the scene has {}", scene_.cameras.size()));
    if (scene_.depth > cse167_largest_depth)
        refuse(fmt::format("has depths up to {}, and the scene's is {}", cse167_largest_depth, scene_.depth));
    if (scene_.background != glm::vec3(0)) refuse("has no background but black");
    if (!scene_.groups.empty()) refuse("has no groups and instances");
}

void Cse167Writer::write_head() {
    const Camera& camera = scene_.cameras[0];
    line("size {} {}", scene_.resolution.width, scene_.resolution.height);
    line("maxdepth {}", scene_.depth);
    line("camera {} {} {} {}", decimals(camera.eye), decimals(camera.look_at), decimals(camera.up),
         decimal(camera.fov_y));
}

void Cse167Writer::write_lights() {
    std::optional<glm::vec3> attenuation;
    for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
        const Light& light = scene_.lights[i];
        if (light.kind == LightKind::spot) refuse(fmt::format("has no spot lights: light {}", i + 1));
        if (light.kind == LightKind::directional) {
            line("directional {} {}", decimals(light.position), decimals(light.color));
            continue;
        }
        if (!attenuation && light.attenuation != glm::vec3(1, 0, 0))
            line("attenuation {}", decimals(light.attenuation));
        if (light.attenuation != attenuation.value_or(light.attenuation))
            refuse(fmt::format("has one attenuation for all point lights: light {}", i + 1));
        attenuation = light.attenuation;
        line("point {} {}", decimals(light.position), decimals(light.color));
    }
}

void Cse167Writer::check_material(std::uint32_t material) const {
    const Material& m = scene_.materials[material];
    const auto need = [&](bool holds, std::string_view lacks) {
        if (!holds) refuse(fmt::format("{}: {}", lacks, material_text(scene_, material)));
    };
    need(m.ambient == glm::vec3(0) || scene_.ambient == glm::vec3(1), "has no ambient light but 1 1 1");
    need(m.specular == m.reflection,
         "has one specular for the highlight and the mirror, so both have to be equal");
    need(m.specular == glm::vec3(0) || m.specular_model == SpecularModel::blinn, "has no Phong highlights");
    need(m.transmission == glm::vec3(0), "has no transmission");
    need(!m.two_sided, "has no two-sided materials");
    need(m.reflection_attenuation == glm::vec3(1, 0, 0), "has no attenuation of the reflected light");
    const MaterialTextures& t = m.textures;
    const std::array<std::uint32_t, 5> textures = {t.ambient, t.diffuse, t.specular, t.emission,
                                                   t.reflection};
    need(std::all_of(textures.begin(), textures.end(), [](auto index) { return index == no_texture; }),
         "has no textures");
}

// All of a material's commands: what changed is not worth a reader's memory.
void Cse167Writer::use_material(std::uint32_t material) {
    if (material_ == material) return;
    material_ = material;
    const Material& m = scene_.materials[material];
    check_material(material);
    line("ambient {}", decimals(m.ambient));
    line("diffuse {}", decimals(m.diffuse));
    line("specular {}", decimals(m.specular));
    line("shininess {}", decimal(m.shininess));
    line("emission {}", decimals(m.emission));
}

void Cse167Writer::use_transform(std::size_t id) {
    const std::uint32_t transform = scene_.primitives[id].transform;
    if (transform_ == transform) return;
    indented_ = false;
    if (transform_ != 0) line("popTransform");
    transform_ = transform;
    if (transform == 0) return;
    const glm::dmat4& m = scene_.transforms[transform];
    const auto linear = find_turn_and_scale(m);
    if (!linear) {
        refuse(
            fmt::format("has only translate, rotate and scale, and no turn and scale were found that make "
                        "the transform of {}",
                        object_text(scene_, id)));
    }
    line("pushTransform");
    indented_ = true;
    const glm::dvec3 move(m[3]);
    if (move != glm::dvec3(0)) line("translate {}", decimals(move));
    const auto scale = [&] {
        if (linear->factors != glm::dvec3(1)) line("scale {}", decimals(linear->factors));
    };
    if (linear->scale_first) scale();
    if (linear->degrees != 0) line("rotate {} {}", decimals(linear->axis), decimal(linear->degrees));
    if (!linear->scale_first) scale();
}

// The corners of the triangles from `first` on that come before something else: together they read better.
void Cse167Writer::write_corners(std::size_t first) {
    const Primitive& model = scene_.primitives[first];
    for (std::size_t id = first; id < scene_.primitives.size(); ++id) {
        const Primitive& p = scene_.primitives[id];
        if (p.kind != model.kind || p.transform != model.transform || p.material != model.material) return;
        if (!can_be_hit(p)) continue;
        const Triangle& triangle = scene_.triangles[p.index];
        auto& numbers = corners_[triangle.smooth ? 1 : 0];
        if (numbers.contains(corner(triangle, 0)) && id == first && numbers.contains(corner(triangle, 1)) &&
            numbers.contains(corner(triangle, 2))) {
            return;  // by the first of them
        }
        for (int k = 0; k < 3; ++k) {
            if (!numbers.try_emplace(corner(triangle, k), numbers.size()).second) continue;
            const std::string position = decimals(scene_.vertices[triangle.vertices[k]]);
            if (triangle.smooth) {
                line("vertexnormal {} {}", position,
                     decimals(before_normalizing(scene_.normals[triangle.normals[k]], ".test")));
            } else {
                line("vertex {}", position);
            }
        }
    }
}

void Cse167Writer::write_triangle(const Triangle& triangle) {
    const auto& numbers = corners_[triangle.smooth ? 1 : 0];
    line("{} {} {} {}", triangle.smooth ? "trinormal" : "tri", numbers.at(corner(triangle, 0)),
         numbers.at(corner(triangle, 1)), numbers.at(corner(triangle, 2)));
}

// As read_cse167() sees it: the placed triangle has an area.
bool Cse167Writer::can_be_hit(const Primitive& p) const {
    if (p.kind != PrimitiveKind::triangle) return true;
    const glm::dmat4& m = scene_.transforms[p.transform];
    std::array<glm::vec3, 3> placed;
    for (std::size_t k = 0; k < 3; ++k)
        placed[k] = glm::vec3(m * glm::dvec4(scene_.vertices[scene_.triangles[p.index].vertices[k]], 1));
    return !is_degenerate(placed[0], placed[1], placed[2]);
}

}  // namespace

std::string write_cse167(const Scene& scene) { return Cse167Writer(scene).write(); }

}  // namespace sahl
