#include "engine/scene/write_json.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <unordered_map>
#include <vector>

#include <fmt/format.h>

#include "engine/core/error.h"
#include "engine/scene/json_layout.h"
#include "engine/scene/validate.h"
#include "engine/scene/write_text.h"

namespace sahl {
namespace {

using Lines = JsonLayout::Lines;

constexpr int largest_depth = 64;

// JSON's -0 is a whole number, and 0 to most readers.
template <class Number>
std::string number(Number x) {
    return x == 0 && std::signbit(x) ? "-0.0" : decimal(x);
}

template <class Vector>
std::string vector(const Vector& v) {
    std::string text = "[";
    for (int i = 0; i < v.length(); ++i) text += (i > 0 ? ", " : "") + number(v[i]);
    return text + "]";
}

// Grey is one number.
std::string color(const glm::vec3& c) { return c == glm::vec3(c.r) ? number(c.r) : vector(c); }

std::string boolean(bool value) { return value ? "true" : "false"; }

// Names for all, each once, none that looks like a reference to a parameter.
class Names {
public:
    explicit Names(std::string kind) : kind_(std::move(kind)) {}

    void add(std::string name) {
        name.erase(0, name.find_first_not_of('$'));
        if (name.empty()) name = fmt::format("{}{}", kind_, names_.size() + 1);
        std::string unique = name;
        for (int i = 2; !taken_.insert(unique).second; ++i) unique = fmt::format("{}-{}", name, i);
        names_.push_back(unique);
    }
    const std::string& operator[](std::size_t i) const { return names_[i]; }

private:
    std::string kind_;
    std::vector<std::string> names_{};
    std::set<std::string> taken_{};
};

// What a mesh's corner is: position, normal, uv, as bits.
using Corner = std::array<std::uint32_t, 8>;

struct CornerHash {
    std::size_t operator()(const Corner& corner) const {
        std::uint64_t hash = 0xcbf29ce484222325;  // FNV-1a by words
        for (const std::uint32_t word : corner) hash = (hash ^ word) * 0x100000001b3;
        return hash ^ (hash >> 32U);
    }
};

class JsonWriter {
public:
    explicit JsonWriter(const Scene& scene) : scene_(scene) {}
    std::string write();

private:
    JsonLayout cameras() const;
    JsonLayout lights() const;
    JsonLayout materials() const;
    JsonLayout material(const Material& m) const;
    JsonLayout texture(const Texture& t) const;
    JsonLayout groups() const;
    JsonLayout objects(std::uint32_t first, std::uint32_t count,
                       const std::vector<Instance>& instances) const;
    JsonLayout object(const Primitive& p) const;
    std::uint32_t run_of_triangles(std::uint32_t first, std::uint32_t end) const;
    JsonLayout mesh(std::uint32_t first, std::uint32_t end) const;
    void add_transform(JsonLayout& object, std::uint32_t transform) const;
    void add_surface(JsonLayout& object, const Primitive& p) const;

    const Scene& scene_;
    Names material_names_{"material"};
    Names group_names_{"group"};
};

std::string JsonWriter::write() {
    if (scene_.depth > largest_depth) {
        throw Error(ExitCode::scene,
                    fmt::format("the scene's depth is {}, and a Sahl scene (.json) has {} at "
                                "most; lower it in the scene that is read",
                                scene_.depth, largest_depth));
    }
    for (const Material& m : scene_.materials) material_names_.add(m.name);
    for (const Group& g : scene_.groups) group_names_.add(g.name);

    JsonLayout film = JsonLayout::object();
    film.add("width", std::to_string(scene_.resolution.width));
    film.add("height", std::to_string(scene_.resolution.height));
    JsonLayout top = JsonLayout::object(Lines::each);
    top.add("sahl", std::string("1"));
    top.add("film", std::move(film));
    top.add("depth", std::to_string(scene_.depth));
    top.add("background", color(scene_.background));
    top.add("cameras", cameras());
    top.add("lights", lights());
    top.add("materials", materials());
    if (!scene_.groups.empty()) top.add("groups", groups());
    top.add("objects", objects(0, world_primitive_count(scene_), scene_.instances));
    return top.text() + "\n";
}

JsonLayout JsonWriter::cameras() const {
    Names names("camera");
    JsonLayout all = JsonLayout::object(Lines::each);
    for (std::size_t i = 0; i < scene_.cameras.size(); ++i) {
        const Camera& camera = scene_.cameras[i];
        names.add(camera.name);
        JsonLayout one = JsonLayout::object();
        one.add("eye", vector(camera.eye));
        one.add("look_at", vector(camera.look_at));
        one.add("up", vector(camera.up));
        one.add("fov", number(camera.fov_y));
        all.add(names[i], std::move(one));
    }
    return all;
}

JsonLayout JsonWriter::lights() const {
    JsonLayout all = JsonLayout::array(Lines::each);
    if (scene_.ambient != glm::vec3(1)) {
        JsonLayout ambient = JsonLayout::object();
        ambient.add("type", std::string("\"ambient\""));
        ambient.add("color", color(scene_.ambient));
        all.add("", std::move(ambient));
    }
    for (const Light& light : scene_.lights) {
        JsonLayout one = JsonLayout::object();
        const bool directional = light.kind == LightKind::directional;
        const bool spot = light.kind == LightKind::spot;
        one.add("type", json_string(directional ? "directional" : spot ? "spot" : "point"));
        if (directional) {
            // The way the light goes; a scene holds the way to it.
            one.add("direction", vector(glm::dvec3(0) - light.position));
        } else {
            one.add("position", vector(light.position));
        }
        if (spot) {
            one.add("direction", vector(before_normalizing(light.direction)));
            one.add("inner_angle", number(light.inner_angle));
            one.add("outer_angle", number(light.outer_angle));
        }
        one.add("color", color(light.color));
        if (!directional && light.attenuation != glm::vec3(1, 0, 0))
            one.add("attenuation", vector(light.attenuation));
        all.add("", std::move(one));
    }
    return all;
}

JsonLayout JsonWriter::materials() const {
    JsonLayout all = JsonLayout::object(Lines::each);
    for (std::size_t i = 0; i < scene_.materials.size(); ++i)
        all.add(material_names_[i], material(scene_.materials[i]));
    return all;
}

JsonLayout JsonWriter::material(const Material& m) const {
    JsonLayout object = JsonLayout::object();
    if (m.specular_model == SpecularModel::blinn) object.add("model", std::string("\"blinn\""));
    const auto add_color = [&](std::string_view key, const glm::vec3& c, std::uint32_t index) {
        if (index == no_texture) {
            if (c != glm::vec3(0)) object.add(key, color(c));
            return;
        }
        if (c != glm::vec3(1)) {
            throw Error(
                ExitCode::scene,
                fmt::format("material '{}': its {} is a texture times a colour, which no scene format "
                            "has; give the texture's own colours and make the material's 1",
                            m.name, key));
        }
        object.add(key, texture(scene_.textures[index]));
    };
    add_color("ambient", m.ambient, m.textures.ambient);
    add_color("diffuse", m.diffuse, m.textures.diffuse);
    add_color("specular", m.specular, m.textures.specular);
    if (m.shininess != 1) object.add("shininess", number(m.shininess));
    add_color("emission", m.emission, m.textures.emission);
    add_color("reflection", m.reflection, m.textures.reflection);
    if (m.reflection_attenuation != glm::vec3(1, 0, 0))
        object.add("attenuation", vector(m.reflection_attenuation));
    add_color("transmission", m.transmission, no_texture);
    if (m.ior != 1) object.add("ior", number(m.ior));
    if (m.ior_outside != 1) object.add("ior_outside", number(m.ior_outside));
    if (!m.two_sided) object.add("two_sided", boolean(false));
    return object;
}

// The point behind which the gradient is its second colour: a double whose difference from `from` is
// `extent`. The sum may miss it by its rounding.
double gradient_end(double from, double extent) {
    const double sum = from + extent;
    for (const double to : {sum, std::nextafter(sum, -std::numeric_limits<double>::infinity()),
                            std::nextafter(sum, std::numeric_limits<double>::infinity())}) {
        if (to - from == extent) return to;
    }
    throw Error(ExitCode::scene, fmt::format("a gradient from {} over {} has no end that a number can hold; "
                                             "move or shorten it by a little",
                                             from, extent));
}

JsonLayout JsonWriter::texture(const Texture& t) const {
    const bool checker = t.pattern == Pattern::checker;
    JsonLayout object = JsonLayout::object();
    object.add(checker ? "checker" : "gradient",
               json_string(t.space == TextureSpace::uv ? "uv" : "position"));
    object.add("colors", "[" + color(t.colors[0]) + ", " + color(t.colors[1]) + "]");
    if (checker) {
        object.add("size", vector(t.extent));
        if (t.origin != glm::dvec3(0)) object.add("offset", vector(t.origin));
    } else {
        glm::dvec3 to;
        for (int i = 0; i < 3; ++i) to[i] = gradient_end(t.origin[i], t.extent[i]);
        object.add("from", vector(t.origin));
        object.add("to", vector(to));
    }
    return object;
}

JsonLayout JsonWriter::groups() const {
    JsonLayout all = JsonLayout::object(Lines::each);
    for (std::size_t i = 0; i < scene_.groups.size(); ++i) {
        const Group& group = scene_.groups[i];
        all.add(group_names_[i], objects(group.first_primitive, group.primitive_count, group.instances));
    }
    return all;
}

JsonLayout JsonWriter::objects(std::uint32_t first, std::uint32_t count,
                               const std::vector<Instance>& instances) const {
    JsonLayout all = JsonLayout::array(Lines::each);
    const std::uint32_t end = first + count;
    for (std::uint32_t i = first; i < end;) {
        const std::uint32_t next = run_of_triangles(i, end);
        all.add("", next > i ? mesh(i, next) : object(scene_.primitives[i]));
        i = std::max(next, i + 1);
    }
    for (const Instance& instance : instances) {
        JsonLayout one = JsonLayout::object();
        one.add("type", std::string("\"instance\""));
        one.add("group", json_string(group_names_[instance.group]));
        add_transform(one, instance.transform);
        all.add("", std::move(one));
    }
    return all;
}

JsonLayout JsonWriter::object(const Primitive& p) const {
    JsonLayout object = JsonLayout::object();
    switch (p.kind) {
        case PrimitiveKind::triangle:
            break;  // part of a mesh
        case PrimitiveKind::polygon: {
            const Polygon& polygon = scene_.polygons[p.index];
            JsonLayout vertices = JsonLayout::array(Lines::full);
            for (std::uint32_t i = 0; i < polygon.vertex_count; ++i)
                vertices.add("", vector(scene_.polygon_vertices[polygon.first_vertex + i]));
            object.add("type", std::string("\"polygon\""));
            object.add("vertices", std::move(vertices));
            break;
        }
        case PrimitiveKind::sphere: {
            const Sphere& sphere = scene_.spheres[p.index];
            object.add("type", std::string("\"sphere\""));
            object.add("center", vector(sphere.center));
            object.add("radius", number(sphere.radius));
            break;
        }
        case PrimitiveKind::cone: {
            const Cone& cone = scene_.cones[p.index];
            const bool cylinder = cone.base_radius == cone.apex_radius;
            object.add("type", json_string(cylinder ? "cylinder" : "cone"));
            object.add("base", vector(cone.base));
            object.add("top", vector(cone.apex));
            if (cylinder) {
                object.add("radius", number(cone.base_radius));
            } else {
                object.add("base_radius", number(cone.base_radius));
                object.add("top_radius", number(cone.apex_radius));
            }
            if (!cone.capped) object.add("capped", boolean(false));
            break;
        }
        case PrimitiveKind::disc: {
            const Disc& disc = scene_.discs[p.index];
            object.add("type", std::string("\"disc\""));
            object.add("center", vector(disc.center));
            object.add("normal", vector(before_normalizing(disc.normal)));
            object.add("radius", number(disc.radius));
            break;
        }
        case PrimitiveKind::box: {
            const Box& box = scene_.boxes[p.index];
            object.add("type", std::string("\"box\""));
            object.add("min", vector(box.lo));
            object.add("max", vector(box.hi));
            break;
        }
    }
    add_surface(object, p);
    return object;
}

// The end of the triangles from `first` on that can be one mesh; `first` itself if it is none.
std::uint32_t JsonWriter::run_of_triangles(std::uint32_t first, std::uint32_t end) const {
    const Primitive& model = scene_.primitives[first];
    std::uint32_t i = first;
    for (; i < end; ++i) {
        const Primitive& p = scene_.primitives[i];
        if (p.kind != PrimitiveKind::triangle || p.material != model.material ||
            p.transform != model.transform || p.sides != model.sides) {
            break;
        }
        const Triangle& triangle = scene_.triangles[p.index];
        const Triangle& first_triangle = scene_.triangles[model.index];
        if (triangle.smooth != first_triangle.smooth || triangle.has_uv != first_triangle.has_uv) break;
    }
    return i;
}

JsonLayout JsonWriter::mesh(std::uint32_t first, std::uint32_t end) const {
    const Triangle& model = scene_.triangles[scene_.primitives[first].index];
    // A transform without an inverse, which a Sahl scene may not have: the renderer only needs the places.
    const glm::dmat4& m = scene_.transforms[scene_.primitives[first].transform];
    const bool bakes = !is_invertible(m);
    JsonLayout vertices = JsonLayout::array(Lines::full);
    JsonLayout normals = JsonLayout::array(Lines::full);
    JsonLayout uvs = JsonLayout::array(Lines::full);
    JsonLayout triangles = JsonLayout::array(Lines::full);
    std::unordered_map<Corner, std::size_t, CornerHash> numbers;
    for (std::uint32_t i = first; i < end; ++i) {
        const Triangle& triangle = scene_.triangles[scene_.primitives[i].index];
        std::size_t corners[3] = {};
        for (int k = 0; k < 3; ++k) {
            glm::vec3 position = scene_.vertices[triangle.vertices[k]];
            if (bakes) position = glm::vec3(m * glm::dvec4(position, 1));
            const glm::vec3 normal = model.smooth ? scene_.normals[triangle.normals[k]] : glm::vec3(0);
            const glm::vec2 uv = model.has_uv ? scene_.uvs[triangle.uvs[k]] : glm::vec2(0);
            const std::array<float, 8> values = {position.x, position.y, position.z, normal.x,
                                                 normal.y,   normal.z,   uv.x,       uv.y};
            const auto [found, is_new] = numbers.try_emplace(std::bit_cast<Corner>(values), numbers.size());
            corners[k] = found->second;
            if (!is_new) continue;
            vertices.add("", vector(position));
            if (model.smooth) normals.add("", vector(normal));
            if (model.has_uv) uvs.add("", vector(uv));
        }
        triangles.add("", fmt::format("[{}, {}, {}]", corners[0], corners[1], corners[2]));
    }
    JsonLayout object = JsonLayout::object();
    object.add("type", std::string("\"mesh\""));
    object.add("vertices", std::move(vertices));
    if (model.smooth) object.add("normals", std::move(normals));
    if (model.has_uv) object.add("uv", std::move(uvs));
    object.add("triangles", std::move(triangles));
    add_surface(object, scene_.primitives[first]);
    return object;
}

void JsonWriter::add_transform(JsonLayout& object, std::uint32_t transform) const {
    const glm::dmat4& m = scene_.transforms[transform];
    if (m == glm::dmat4(1) || !is_invertible(m)) return;
    JsonLayout rows = JsonLayout::array();
    for (int row = 0; row < 4; ++row)
        rows.add("", vector(glm::dvec4(m[0][row], m[1][row], m[2][row], m[3][row])));
    JsonLayout step = JsonLayout::object();
    step.add("matrix", std::move(rows));
    object.add("transform", std::move(step));
}

void JsonWriter::add_surface(JsonLayout& object, const Primitive& p) const {
    object.add("material", json_string(material_names_[p.material]));
    if (p.sides != Sides::both) object.add("sides", json_string(p.sides == Sides::front ? "front" : "back"));
    add_transform(object, p.transform);
}

}  // namespace

std::string write_json(const Scene& scene) { return JsonWriter(scene).write(); }

}  // namespace sahl
