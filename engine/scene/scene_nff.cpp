#include "engine/scene/scene_nff.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "engine/core/nearest.h"
#include "engine/scene/polygon.h"

namespace sahl {
namespace {

constexpr std::array<std::string_view, 6> view_keys = {"from", "at", "up", "angle", "hither", "resolution"};
constexpr std::string_view entities =
    "b (background), v (view), l (light), f (fill), s (sphere), c (cone or cylinder), p (polygon), pp "
    "(patch)";

// Ears are cut in quadratic time.
constexpr long long most_patch_corners = 4096;

class NffReader {
public:
    explicit NffReader(TextReader& reader) : reader_(reader) { scene_.depth = 4; }

    Scene read();

private:
    void read_background(const Token& word);
    void read_view(const Token& word);
    void read_light();
    void read_fill();
    void read_sphere();
    void read_cone();
    void read_polygon();
    void read_patch();
    std::size_t read_corner_count(std::string_view what, std::size_t numbers_per_corner, long long most);
    void need_fill(const Token& word) const;
    void add(PrimitiveKind kind, std::size_t index, Sides sides = Sides::both);

    TextReader& reader_;
    Scene scene_;
    std::optional<SourceLocation> background_;  // where it was read
    std::optional<SourceLocation> view_;
    std::vector<std::size_t> plain_lights_;  // without a colour
};

// The first of an entity that may be there once; `seen` keeps its place.
void once(std::optional<SourceLocation>& seen, const SourceLocation& here, std::string_view what) {
    if (seen) {
        throw SceneError(
            here, fmt::format("a second {}; the first is on line {}. Keep one of them", what, seen->line));
    }
    seen = here;
}

Scene NffReader::read() {
    while (!reader_.at_end()) {
        const Token word = reader_.peek();
        if (reader_.number_follows()) {
            reader_.fail_expected(fmt::format("an entity: {}", entities));
        }
        reader_.take();
        if (word.text == "b") {
            read_background(word);
        } else if (word.text == "v") {
            read_view(word);
        } else if (word.text == "l") {
            read_light();
        } else if (word.text == "f") {
            read_fill();
        } else if (word.text == "s") {
            need_fill(word);
            read_sphere();
        } else if (word.text == "c") {
            need_fill(word);
            read_cone();
        } else if (word.text == "p") {
            need_fill(word);
            read_polygon();
        } else if (word.text == "pp") {
            need_fill(word);
            read_patch();
        } else {
            throw SceneError(reader_.place(word), fmt::format("unknown entity {}; entities are {}",
                                                              in_quotes(word.text), entities));
        }
    }
    if (!view_) {
        throw SceneError(reader_.place(),
                         "the file has no view; add v with from, at, up, angle, hither and resolution");
    }
    // No light has a particular strength in NFF; SPD's own pictures share 1 among them like this.
    for (const std::size_t i : plain_lights_) {
        scene_.lights[i].color = glm::vec3(1 / std::sqrt(static_cast<float>(scene_.lights.size())));
    }
    return std::move(scene_);
}

void NffReader::read_background(const Token& word) {
    once(background_, reader_.place(word), "background (b)");
    scene_.background = reader_.color("the background's");
}

void NffReader::read_view(const Token& word) {
    once(view_, reader_.place(word), "view (v)");
    Camera& camera = scene_.cameras[0];
    std::array<std::optional<SourceLocation>, view_keys.size()> seen;
    while (std::any_of(seen.begin(), seen.end(), [](const auto& place) { return !place; })) {
        const Token key = reader_.peek();
        const auto found = std::find(view_keys.begin(), view_keys.end(), key.text);
        if (found == view_keys.end()) {
            std::vector<std::string_view> missing;
            for (std::size_t i = 0; i < view_keys.size(); ++i) {
                if (!seen[i]) missing.push_back(view_keys[i]);
            }
            reader_.fail_expected(fmt::format("what the view still needs ({})", join_names(missing)),
                                  did_you_mean(key.text, missing));
        }
        once(seen[static_cast<std::size_t>(found - view_keys.begin())], reader_.place(key), *found);
        reader_.take();
        if (*found == "from") camera.eye = reader_.vector("from");
        if (*found == "at") camera.look_at = reader_.vector("at");
        if (*found == "up") camera.up = reader_.vector("up");
        if (*found == "angle") camera.fov_y = reader_.number("the view's angle in degrees", field_of_view);
        if (*found == "hither") reader_.number("hither");
        if (*found == "resolution") {
            scene_.resolution.width =
                static_cast<int>(reader_.whole_number("the width in pixels", 1, max_resolution));
            scene_.resolution.height =
                static_cast<int>(reader_.whole_number("the height in pixels", 1, max_resolution));
        }
    }
    check_camera(camera, *seen[1], *seen[2]);
}

void NffReader::read_light() {
    Light light;
    light.position = reader_.vector("the light's");
    if (reader_.number_follows()) {
        light.color = reader_.color("the light's");
    } else {
        plain_lights_.push_back(scene_.lights.size());
    }
    scene_.lights.push_back(light);
}

void NffReader::read_fill() {
    const glm::vec3 color = reader_.color("the fill's");
    const auto diffuse = static_cast<float>(reader_.number("the fill's Kd", not_negative));
    const auto specular = static_cast<float>(reader_.number("the fill's Ks", not_negative));
    const double shine = reader_.number("the fill's Shine", not_negative);
    const double transmittance = reader_.number("the fill's T", not_negative);
    const SourceLocation ior_place = reader_.place();
    const double ior = reader_.number("the fill's index of refraction", not_negative);
    if (transmittance > 0 && ior < min_length) {
        throw SceneError(
            ior_place, "a fill that transmits (T above 0) needs an index of refraction above 0, such as 1.5");
    }
    Material material;
    material.name = fmt::format("fill{}", scene_.materials.size() + 1);
    material.diffuse = color * diffuse;
    material.specular = glm::vec3(specular);
    material.reflection = glm::vec3(specular);
    material.transmission = glm::vec3(static_cast<float>(transmittance));
    material.shininess = static_cast<float>(shine);
    material.ior = ior < min_length ? 1.0F : static_cast<float>(ior);
    scene_.materials.push_back(material);
}

void NffReader::read_sphere() {
    Sphere sphere;
    sphere.center = reader_.vector("the sphere's centre");
    const SourceLocation place = reader_.place();
    const double radius = reader_.number("the sphere's radius");
    sphere.radius = std::abs(radius);
    check_range(sphere.radius, positive_length, "the size of the sphere's radius", place);
    add(PrimitiveKind::sphere, scene_.spheres.size(), radius < 0 ? Sides::back : Sides::both);
    scene_.spheres.push_back(sphere);
}

void NffReader::read_cone() {
    Cone cone;
    cone.base = reader_.vector("the cone's base");
    const SourceLocation base_place = reader_.place();
    const double base_radius = reader_.number("the cone's base radius");
    const SourceLocation apex_place = reader_.place();
    cone.apex = reader_.vector("the cone's apex");
    const SourceLocation radius_place = reader_.place();
    const double apex_radius = reader_.number("the cone's apex radius");

    if (glm::length(cone.apex - cone.base) < min_length) {
        throw SceneError(apex_place, "the cone's apex is its base; give it a height");
    }
    if (base_radius * apex_radius < 0) {
        throw SceneError(radius_place,
                         "one radius of the cone is negative; make both negative (only its inside is "
                         "seen) or none");
    }
    const bool inside_only = base_radius < 0 || apex_radius < 0;
    cone.base_radius = std::abs(base_radius);
    cone.apex_radius = std::abs(apex_radius);
    if (cone.base_radius == 0 && cone.apex_radius == 0) {
        throw SceneError(radius_place, "both radii of the cone are 0; at most one may be");
    }
    // One radius may be 0, but none so small that its square vanishes.
    if (cone.base_radius != 0)
        check_range(cone.base_radius, positive_length, "the size of the cone's base radius", base_place);
    if (cone.apex_radius != 0)
        check_range(cone.apex_radius, positive_length, "the size of the cone's apex radius", radius_place);
    add(PrimitiveKind::cone, scene_.cones.size(), inside_only ? Sides::back : Sides::both);
    scene_.cones.push_back(cone);
}

void NffReader::read_polygon() {
    const SourceLocation place = reader_.place();
    const std::size_t count = read_corner_count("the polygon", 3, std::numeric_limits<std::int32_t>::max());
    std::vector<glm::vec3> corners;
    for (std::size_t i = 0; i < count; ++i) corners.emplace_back(reader_.vector("the polygon's corner"));
    if (count == 3) {
        if (is_degenerate(corners[0], corners[1], corners[2])) return;
        const auto first = static_cast<std::uint32_t>(scene_.vertices.size());
        scene_.vertices.insert(scene_.vertices.end(), corners.begin(), corners.end());
        add(PrimitiveKind::triangle, scene_.triangles.size());
        scene_.triangles.push_back({{first, first + 1, first + 2}, {0, 0, 0}, false});
        return;
    }
    switch (classify_polygon(corners)) {
        case PolygonShape::line:
            return;
        case PolygonShape::no_plane:
            throw SceneError(place,
                             "the corners of this polygon lie in no plane, or its outline crosses itself; "
                             "divide it into triangles");
        case PolygonShape::planar:
            break;
    }
    add(PrimitiveKind::polygon, scene_.polygons.size());
    scene_.polygons.push_back(
        {static_cast<std::uint32_t>(scene_.polygon_vertices.size()), static_cast<std::uint32_t>(count)});
    scene_.polygon_vertices.insert(scene_.polygon_vertices.end(), corners.begin(), corners.end());
}

void NffReader::read_patch() {
    const SourceLocation place = reader_.place();
    const std::size_t count = read_corner_count("the patch", 6, most_patch_corners);
    std::vector<glm::vec3> corners;
    std::vector<glm::vec3> normals;
    for (std::size_t i = 0; i < count; ++i) {
        corners.emplace_back(reader_.vector("the patch's corner"));
        const SourceLocation normal_place = reader_.place();
        const glm::dvec3 normal = reader_.vector("the patch's normal");
        if (glm::length(normal) < min_length) {
            throw SceneError(normal_place, "this normal is zero; give it a direction");
        }
        normals.emplace_back(glm::normalize(normal));
    }
    if (count > 3 && classify_polygon(corners) == PolygonShape::line) return;
    const auto triangles = triangulate(corners);
    if (!triangles) {
        throw SceneError(place, "the outline of this patch crosses itself; divide it into triangles");
    }
    const auto first_vertex = static_cast<std::uint32_t>(scene_.vertices.size());
    const auto first_normal = static_cast<std::uint32_t>(scene_.normals.size());
    scene_.vertices.insert(scene_.vertices.end(), corners.begin(), corners.end());
    scene_.normals.insert(scene_.normals.end(), normals.begin(), normals.end());
    for (const auto& [a, b, c] : *triangles) {
        add(PrimitiveKind::triangle, scene_.triangles.size());
        scene_.triangles.push_back({{first_vertex + a, first_vertex + b, first_vertex + c},
                                    {first_normal + a, first_normal + b, first_normal + c},
                                    true});
    }
}

// Refuses a count that the rest of the file cannot hold before anything is allocated for it.
std::size_t NffReader::read_corner_count(std::string_view what, std::size_t numbers_per_corner,
                                         long long most) {
    const Token word = reader_.peek();
    const long long count = reader_.whole_number(fmt::format("the number of corners of {}", what), 3, most);
    const std::size_t room = (reader_.bytes_left() + 1) / (2 * numbers_per_corner);
    if (static_cast<std::size_t>(count) > room) {
        throw SceneError(reader_.place(word),
                         fmt::format("{} says it has {} corners, but the rest of the file has room "
                                     "for {} at most",
                                     what, count, room));
    }
    return static_cast<std::size_t>(count);
}

void NffReader::need_fill(const Token& word) const {
    if (scene_.materials.empty()) {
        throw SceneError(reader_.place(word), fmt::format("{} comes before any fill; put an f line before it",
                                                          in_quotes(word.text)));
    }
}

void NffReader::add(PrimitiveKind kind, std::size_t index, Sides sides) {
    scene_.primitives.push_back({kind, static_cast<std::uint32_t>(index),
                                 static_cast<std::uint32_t>(scene_.materials.size() - 1), 0, sides});
}

}  // namespace

Scene read_nff(TextReader& reader) { return NffReader(reader).read(); }

}  // namespace sahl
