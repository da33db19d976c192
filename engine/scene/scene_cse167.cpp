#include "engine/scene/scene_cse167.h"

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
#include <glm/gtc/matrix_transform.hpp>

#include "engine/core/nearest.h"
#include "engine/scene/polygon.h"

namespace sahl {
namespace {

class Cse167Reader {
public:
    explicit Cse167Reader(TextReader& reader) : reader_(reader) {
        material_.ambient = glm::vec3(0.2F);
        material_.specular_model = SpecularModel::blinn;
        material_.two_sided = false;
    }

    Scene read();

private:
    struct Command {
        std::string_view name;
        void (Cse167Reader::*read)();
    };
    static const std::array<Command, 24> commands;

    void read_command();
    // One function a command; `word_` is the command's name.
    void read_size();
    void read_camera();
    void read_output();
    void read_depth() {
        scene_.depth = static_cast<int>(reader_.whole_number("the depth", 0, cse167_largest_depth));
    }
    void read_hint() {
        reader_.whole_number("a number of vertices", 0, std::numeric_limits<std::uint32_t>::max());
    }
    void read_vertex();
    void read_vertex_normal();
    void read_triangle() { read_triangle_of(vertices_, "vertex", false); }
    void read_smooth_triangle() { read_triangle_of(normal_vertices_, "vertexnormal", true); }
    void read_sphere();
    void read_translate();
    void read_rotate();
    void read_scale();
    void push() { stack_.push_back(stack_.back()); }
    void pop();
    void read_directional();
    void read_point();
    void read_attenuation();
    void read_ambient() { change_material().ambient = reader_.color("the ambient"); }
    void read_diffuse() { change_material().diffuse = reader_.color("the diffuse"); }
    void read_specular();
    void read_shininess();
    void read_emission() { change_material().emission = reader_.color("the emission"); }

    struct Corner {
        std::uint32_t vertex, normal;  // in the scene's lists
    };
    void read_triangle_of(const std::vector<Corner>& corners, std::string_view list, bool smooth);
    Material& change_material();
    void transform_by(const glm::dmat4& m);
    void add(PrimitiveKind kind, std::size_t index);

    TextReader& reader_;
    Token word_;
    Scene scene_;
    std::optional<int> camera_line_, size_line_;
    std::vector<Corner> vertices_;  // by their numbers in the file
    std::vector<Corner> normal_vertices_;
    glm::vec3 attenuation_{1, 0, 0};
    std::vector<glm::dmat4> stack_{glm::dmat4(1)};
    Material material_;             // what the next object gets
    bool material_changed_ = true;  // since the last object
};

const std::array<Cse167Reader::Command, 24> Cse167Reader::commands = {{
    {"size", &Cse167Reader::read_size},
    {"camera", &Cse167Reader::read_camera},
    {"output", &Cse167Reader::read_output},
    {"maxdepth", &Cse167Reader::read_depth},
    {"maxverts", &Cse167Reader::read_hint},
    {"maxvertnorms", &Cse167Reader::read_hint},
    {"vertex", &Cse167Reader::read_vertex},
    {"vertexnormal", &Cse167Reader::read_vertex_normal},
    {"tri", &Cse167Reader::read_triangle},
    {"trinormal", &Cse167Reader::read_smooth_triangle},
    {"sphere", &Cse167Reader::read_sphere},
    {"translate", &Cse167Reader::read_translate},
    {"rotate", &Cse167Reader::read_rotate},
    {"scale", &Cse167Reader::read_scale},
    {"pushTransform", &Cse167Reader::push},
    {"popTransform", &Cse167Reader::pop},
    {"directional", &Cse167Reader::read_directional},
    {"point", &Cse167Reader::read_point},
    {"attenuation", &Cse167Reader::read_attenuation},
    {"ambient", &Cse167Reader::read_ambient},
    {"diffuse", &Cse167Reader::read_diffuse},
    {"specular", &Cse167Reader::read_specular},
    {"shininess", &Cse167Reader::read_shininess},
    {"emission", &Cse167Reader::read_emission},
}};

Scene Cse167Reader::read() {
    while (!reader_.at_end()) {
        word_ = reader_.take();
        reader_.bind_to_line(word_);
        read_command();
        reader_.end_line(word_.text);
    }
    const auto fail_missing = [&](std::string_view what) {
        throw SceneError(reader_.place(), fmt::format("the file has no {}; add one", what));
    };
    if (!size_line_) fail_missing("size command (size WIDTH HEIGHT, the first of the file)");
    if (!camera_line_) fail_missing("camera command (camera EYE LOOK_AT UP FOV)");
    for (Light& light : scene_.lights) {
        if (light.kind == LightKind::point) light.attenuation = attenuation_;
    }
    return std::move(scene_);
}

void Cse167Reader::read_command() {
    const auto* command = std::find_if(commands.begin(), commands.end(),
                                       [&](const Command& c) { return c.name == word_.text; });
    if (command == commands.end()) {
        std::vector<std::string_view> names;
        names.reserve(commands.size());
        for (const Command& c : commands) names.push_back(c.name);
        const std::string hint = did_you_mean(word_.text, names);
        throw SceneError(reader_.place(word_),
                         fmt::format("unknown command {}{} commands are {}", in_quotes(word_.text),
                                     hint.empty() ? ";" : hint, join_names(names)));
    }
    if (!size_line_ && word_.text != "size") {
        throw SceneError(reader_.place(word_),
                         fmt::format("{} comes before size; the first command is size WIDTH HEIGHT",
                                     in_quotes(word_.text)));
    }
    (this->*command->read)();
}

void once(std::optional<int>& seen, const SourceLocation& here, std::string_view what) {
    if (seen)
        throw SceneError(here,
                         fmt::format("a second {}; the first is on line {}. Keep one of them", what, *seen));
    seen = here.line;
}

void Cse167Reader::read_size() {
    once(size_line_, reader_.place(word_), "size");
    scene_.resolution.width =
        static_cast<int>(reader_.whole_number("the width in pixels", 1, max_resolution));
    scene_.resolution.height =
        static_cast<int>(reader_.whole_number("the height in pixels", 1, max_resolution));
}

void Cse167Reader::read_camera() {
    once(camera_line_, reader_.place(word_), "camera");
    scene_.cameras[0].eye = reader_.vector("the camera's eye");
    const SourceLocation look_at = reader_.place();
    scene_.cameras[0].look_at = reader_.vector("the camera's look-at point");
    const SourceLocation up = reader_.place();
    scene_.cameras[0].up = reader_.vector("the camera's up vector");
    scene_.cameras[0].fov_y = reader_.number("the camera's vertical angle in degrees", field_of_view);
    check_camera(scene_.cameras[0], look_at, up);
}

// The name, which may hold spaces, is ignored: the user names the image.
void Cse167Reader::read_output() {
    if (reader_.peek().kind != Token::Kind::word) reader_.fail_expected("a file name");
    reader_.skip_line();
}

void Cse167Reader::read_vertex() {
    vertices_.push_back({static_cast<std::uint32_t>(scene_.vertices.size()), 0});
    scene_.vertices.emplace_back(reader_.vector("the vertex"));
}

void Cse167Reader::read_vertex_normal() {
    normal_vertices_.push_back({static_cast<std::uint32_t>(scene_.vertices.size()),
                                static_cast<std::uint32_t>(scene_.normals.size())});
    scene_.vertices.emplace_back(reader_.vector("the vertex"));
    const SourceLocation place = reader_.place();
    const glm::dvec3 normal = reader_.vector("the normal");
    if (glm::length(normal) < min_length) throw SceneError(place, "this normal is zero; give it a direction");
    scene_.normals.emplace_back(glm::normalize(normal));
}

void Cse167Reader::read_triangle_of(const std::vector<Corner>& corners, std::string_view list, bool smooth) {
    if (corners.empty()) {
        throw SceneError(reader_.place(word_),
                         fmt::format("{} needs three {} commands before it", in_quotes(word_.text), list));
    }
    const glm::dmat4& m = stack_.back();
    if (smooth && !is_invertible(m)) {
        throw SceneError(reader_.place(word_),
                         "the transformation flattens this triangle's normals (it has no inverse); "
                         "use no scale factor of 0");
    }
    Triangle triangle;
    triangle.smooth = smooth;
    glm::vec3 world[3];
    for (int i = 0; i < 3; ++i) {
        const SourceLocation place = reader_.place();
        const auto number = static_cast<std::size_t>(reader_.whole_number(
            fmt::format("the number of a {}", list), 0, static_cast<long long>(corners.size()) - 1));
        triangle.vertices[i] = corners[number].vertex;
        triangle.normals[i] = corners[number].normal;
        const glm::dvec3 position(m * glm::dvec4(scene_.vertices[corners[number].vertex], 1));
        for (int axis = 0; axis < 3; ++axis)
            check_range(position[axis], any_number, "the transformed corner", place);
        world[i] = glm::vec3(position);
    }
    if (is_degenerate(world[0], world[1], world[2])) return;
    add(PrimitiveKind::triangle, scene_.triangles.size());
    scene_.triangles.push_back(triangle);
}

void Cse167Reader::read_sphere() {
    Sphere sphere;
    sphere.center = reader_.vector("the sphere's centre");
    sphere.radius = reader_.number("the sphere's radius", positive_length);
    check_sphere_transform(stack_.back(), sphere.center, sphere.radius, reader_.place(word_));
    add(PrimitiveKind::sphere, scene_.spheres.size());
    scene_.spheres.push_back(sphere);
}

void Cse167Reader::read_translate() {
    transform_by(glm::translate(glm::dmat4(1), reader_.vector("the translation")));
}

void Cse167Reader::read_rotate() {
    const SourceLocation place = reader_.place();
    const glm::dvec3 axis = reader_.vector("the axis");
    if (glm::length(axis) < min_length)
        throw SceneError(place, "the axis of this rotation is zero; give it a direction");
    const double degrees = reader_.number("the angle in degrees");
    transform_by(glm::rotate(glm::dmat4(1), glm::radians(degrees), axis));
}

void Cse167Reader::read_scale() { transform_by(glm::scale(glm::dmat4(1), reader_.vector("the scale"))); }

void Cse167Reader::transform_by(const glm::dmat4& m) {
    glm::dmat4& current = stack_.back();
    current = current * m;
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 3; ++row) {
            check_range(current[column][row], any_number, "every element of the transformation",
                        reader_.place(word_));
        }
    }
}

void Cse167Reader::pop() {
    if (stack_.size() == 1) {
        throw SceneError(reader_.place(word_), "popTransform without a pushTransform before it; remove it");
    }
    stack_.pop_back();
}

void Cse167Reader::read_directional() {
    Light light;
    light.kind = LightKind::directional;
    const SourceLocation place = reader_.place();
    light.position = reader_.vector("the direction to the light");
    if (glm::length(light.position) < min_length) {
        throw SceneError(place, "the direction to this light is zero; give it a direction");
    }
    light.color = reader_.color("the light's");
    scene_.lights.push_back(light);
}

void Cse167Reader::read_point() {
    Light light;
    light.position = reader_.vector("the light's");
    light.color = reader_.color("the light's");
    scene_.lights.push_back(light);
}

void Cse167Reader::read_attenuation() {
    const SourceLocation place = reader_.place();
    attenuation_.x = static_cast<float>(reader_.number("the constant attenuation", not_negative));
    attenuation_.y = static_cast<float>(reader_.number("the linear attenuation", not_negative));
    attenuation_.z = static_cast<float>(reader_.number("the quadratic attenuation", not_negative));
    if (attenuation_.x + attenuation_.y + attenuation_.z < static_cast<float>(min_length)) {
        throw SceneError(place, "the attenuation is zero, and light is divided by it; 1 0 0 is none");
    }
}

void Cse167Reader::read_specular() {
    Material& material = change_material();
    material.specular = reader_.color("the specular");
    material.reflection = material.specular;
}

void Cse167Reader::read_shininess() {
    change_material().shininess = static_cast<float>(reader_.number("the shininess", not_negative));
}

Material& Cse167Reader::change_material() {
    material_changed_ = true;
    return material_;
}

void Cse167Reader::add(PrimitiveKind kind, std::size_t index) {
    if (material_changed_) {
        material_.name = fmt::format("material{}", scene_.materials.size() + 1);
        scene_.materials.push_back(material_);
    }
    material_changed_ = false;
    // The identity is there from the start; otherwise objects in a row share one.
    std::size_t transform = 0;
    if (stack_.back() != glm::dmat4(1)) {
        if (scene_.transforms.back() != stack_.back()) scene_.transforms.push_back(stack_.back());
        transform = scene_.transforms.size() - 1;
    }
    scene_.primitives.push_back({kind, static_cast<std::uint32_t>(index),
                                 static_cast<std::uint32_t>(scene_.materials.size() - 1),
                                 static_cast<std::uint32_t>(transform)});
}

}  // namespace

Scene read_cse167(TextReader& reader) { return Cse167Reader(reader).read(); }

}  // namespace sahl
