#include "engine/scene/write_json.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <vector>

#include <fmt/format.h>

#include "engine/core/error.h"
#include "engine/scene/json_layout.h"
#include "engine/scene/scene_json.h"
#include "engine/scene/validate.h"
#include "engine/scene/write_json_mesh.h"
#include "engine/scene/write_text.h"

namespace sahl {
namespace {

using Lines = JsonLayout::Lines;

// Grey is one number.
std::string color(const glm::vec3& c) { return c == glm::vec3(c.r) ? json_number(c.r) : json_vector(c); }

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

class JsonWriter {
public:
    explicit JsonWriter(const Scene& scene) : scene_(scene) {}
    std::string write();

private:
    JsonLayout cameras() const;
    JsonLayout lights() const;
    JsonLayout materials() const;
    JsonLayout material(std::uint32_t index) const;
    JsonLayout texture(const Texture& t) const;
    JsonLayout groups() const;
    JsonLayout objects(std::uint32_t first, std::uint32_t count,
                       const std::vector<Instance>& instances) const;
    JsonLayout object(const Primitive& p) const;
    JsonLayout mesh(std::uint32_t first, std::uint32_t end) const;
    void add_transform(JsonLayout& object, std::uint32_t transform) const;
    void add_surface(JsonLayout& object, const Primitive& p) const;

    const Scene& scene_;
    Names material_names_{"material"};
    Names group_names_{"group"};
};

std::string JsonWriter::write() {
    if (scene_.depth > json_largest_depth) {
        throw Error(ExitCode::scene,
                    fmt::format("the scene's depth is {}, and a Sahl scene (.json) has {} at "
                                "most; lower it in the scene that is read",
                                scene_.depth, json_largest_depth));
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
        one.add("eye", json_vector(camera.eye));
        one.add("look_at", json_vector(camera.look_at));
        one.add("up", json_vector(camera.up));
        one.add("fov", json_number(camera.fov_y));
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
            one.add("direction", json_vector(glm::dvec3(0) - light.position));
        } else {
            one.add("position", json_vector(light.position));
        }
        if (spot) {
            one.add("direction", json_vector(before_normalizing(light.direction)));
            one.add("inner_angle", json_number(light.inner_angle));
            one.add("outer_angle", json_number(light.outer_angle));
        }
        one.add("color", color(light.color));
        if (!directional && light.attenuation != glm::vec3(1, 0, 0))
            one.add("attenuation", json_vector(light.attenuation));
        all.add("", std::move(one));
    }
    return all;
}

JsonLayout JsonWriter::materials() const {
    JsonLayout all = JsonLayout::object(Lines::each);
    for (std::uint32_t i = 0; i < scene_.materials.size(); ++i) all.add(material_names_[i], material(i));
    return all;
}

JsonLayout JsonWriter::material(std::uint32_t index) const {
    const Material& m = scene_.materials[index];
    JsonLayout object = JsonLayout::object();
    if (m.specular_model == SpecularModel::blinn) object.add("model", std::string("\"blinn\""));
    const auto add_color = [&](std::string_view key, const glm::vec3& c, std::uint32_t texture_index) {
        if (texture_index == no_texture) {
            if (c != glm::vec3(0)) object.add(key, color(c));
            return;
        }
        if (c != glm::vec3(1)) {
            throw Error(ExitCode::scene,
                        fmt::format("{}: its {} is a texture times a colour, which no scene format "
                                    "has; give the texture's own colours and make the material's 1",
                                    material_text(scene_, index), key));
        }
        object.add(key, texture(scene_.textures[texture_index]));
    };
    add_color("ambient", m.ambient, m.textures.ambient);
    add_color("diffuse", m.diffuse, m.textures.diffuse);
    add_color("specular", m.specular, m.textures.specular);
    if (m.shininess != 1) object.add("shininess", json_number(m.shininess));
    add_color("emission", m.emission, m.textures.emission);
    add_color("reflection", m.reflection, m.textures.reflection);
    if (m.reflection_attenuation != glm::vec3(1, 0, 0))
        object.add("attenuation", json_vector(m.reflection_attenuation));
    add_color("transmission", m.transmission, no_texture);
    if (m.ior != 1) object.add("ior", json_number(m.ior));
    if (m.ior_outside != 1) object.add("ior_outside", json_number(m.ior_outside));
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
        object.add("size", json_vector(t.extent));
        if (t.origin != glm::dvec3(0)) object.add("offset", json_vector(t.origin));
    } else {
        glm::dvec3 to;
        for (int i = 0; i < 3; ++i) to[i] = gradient_end(t.origin[i], t.extent[i]);
        object.add("from", json_vector(t.origin));
        object.add("to", json_vector(to));
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
        const std::uint32_t next = mesh_end(scene_, i, end);
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
                vertices.add("", json_vector(scene_.polygon_vertices[polygon.first_vertex + i]));
            object.add("type", std::string("\"polygon\""));
            object.add("vertices", std::move(vertices));
            break;
        }
        case PrimitiveKind::sphere: {
            const Sphere& sphere = scene_.spheres[p.index];
            object.add("type", std::string("\"sphere\""));
            object.add("center", json_vector(sphere.center));
            object.add("radius", json_number(sphere.radius));
            break;
        }
        case PrimitiveKind::cone: {
            const Cone& cone = scene_.cones[p.index];
            const bool cylinder = cone.base_radius == cone.apex_radius;
            object.add("type", json_string(cylinder ? "cylinder" : "cone"));
            object.add("base", json_vector(cone.base));
            object.add("top", json_vector(cone.apex));
            if (cylinder) {
                object.add("radius", json_number(cone.base_radius));
            } else {
                object.add("base_radius", json_number(cone.base_radius));
                object.add("top_radius", json_number(cone.apex_radius));
            }
            if (!cone.capped) object.add("capped", boolean(false));
            break;
        }
        case PrimitiveKind::disc: {
            const Disc& disc = scene_.discs[p.index];
            object.add("type", std::string("\"disc\""));
            object.add("center", json_vector(disc.center));
            object.add("normal", json_vector(before_normalizing(disc.normal)));
            object.add("radius", json_number(disc.radius));
            break;
        }
        case PrimitiveKind::box: {
            const Box& box = scene_.boxes[p.index];
            object.add("type", std::string("\"box\""));
            object.add("min", json_vector(box.lo));
            object.add("max", json_vector(box.hi));
            break;
        }
    }
    add_surface(object, p);
    return object;
}

JsonLayout JsonWriter::mesh(std::uint32_t first, std::uint32_t end) const {
    JsonLayout object = mesh_layout(scene_, first, end);
    add_surface(object, scene_.primitives[first]);
    return object;
}

void JsonWriter::add_transform(JsonLayout& object, std::uint32_t transform) const {
    const glm::dmat4& m = scene_.transforms[transform];
    if (m == glm::dmat4(1) || !is_invertible(m)) return;
    JsonLayout rows = JsonLayout::array();
    for (int row = 0; row < 4; ++row)
        rows.add("", json_vector(glm::dvec4(m[0][row], m[1][row], m[2][row], m[3][row])));
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
