#include "engine/scene/scene_json_mesh.h"

#include <array>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "engine/scene/polygon.h"

namespace sahl {
namespace {

void add(Scene& scene, const Surroundings& around, PrimitiveKind kind, std::size_t index) {
    around.target->primitives.push_back({kind, static_cast<std::uint32_t>(index), *around.material,
                                         add_transform(scene, around.transform), around.sides});
}

// The vertices as floats, and whether their transformed places are in range.
std::vector<glm::vec3> read_vertices(const JsonReader& reader, const JsonValue& value,
                                     const glm::dmat4& transform) {
    const bool moves = transform != glm::dmat4(1);
    std::vector<glm::vec3> vertices;
    vertices.reserve(value.count);
    for (const JsonValue& element : reader.array(value, "vertices", "an array of vertices ([x, y, z])")) {
        const glm::dvec3 vertex = reader.vector(element, "vertices");
        if (moves) {
            const glm::dvec3 placed(transform * glm::dvec4(vertex, 1));
            for (int axis = 0; axis < 3; ++axis) {
                if (!any_number.contains(placed[axis])) {
                    check_range(placed[axis], any_number, "the transformed vertex", reader.place(element));
                }
            }
        }
        vertices.emplace_back(vertex);
    }
    return vertices;
}

// A polygon's (u, v): along the first edge and to its left.
glm::vec2 planar_uv(std::span<const glm::vec3> corners, glm::dvec3 corner) {
    const glm::dvec3 origin(corners[0]);
    const glm::dvec3 u = glm::normalize(glm::dvec3(corners[1]) - origin);
    const glm::dvec3 v = glm::cross(glm::normalize(newell_normal(corners)), u);
    return {glm::dot(corner - origin, u), glm::dot(corner - origin, v)};
}

[[noreturn]] void fail_line(const JsonReader& reader, const JsonValue& vertices) {
    reader.fail(vertices,
                "the vertices of this polygon lie on one line, so that no ray can hit it; move one");
}

}  // namespace

void read_polygon(JsonSceneState& state, const JsonObject& object, const Surroundings& around) {
    const JsonReader& reader = object.reader();
    const JsonValue& value = object.at("vertices");
    const std::vector<glm::vec3> corners = read_vertices(reader, value, around.transform);
    if (corners.size() < 3) reader.fail_type(value, "vertices", "at least 3 vertices");
    Scene& scene = state.scene;
    if (corners.size() == 3) {
        if (is_degenerate(corners[0], corners[1], corners[2])) fail_line(reader, value);
        Triangle triangle;
        triangle.has_uv = true;
        for (std::uint32_t i = 0; i < 3; ++i) {
            triangle.vertices[i] = static_cast<std::uint32_t>(scene.vertices.size());
            triangle.uvs[i] = static_cast<std::uint32_t>(scene.uvs.size());
            scene.vertices.push_back(corners[i]);
            scene.uvs.push_back(planar_uv(corners, corners[i]));
        }
        add(scene, around, PrimitiveKind::triangle, scene.triangles.size());
        scene.triangles.push_back(triangle);
        return;
    }
    switch (classify_polygon(corners)) {
        case PolygonShape::line:
            fail_line(reader, value);
        case PolygonShape::no_plane:
            reader.fail(value,
                        "the vertices of this polygon lie in no plane, or its outline crosses itself; divide "
                        "it into triangles");
        case PolygonShape::planar:
            break;
    }
    add(scene, around, PrimitiveKind::polygon, scene.polygons.size());
    scene.polygons.push_back({static_cast<std::uint32_t>(scene.polygon_vertices.size()),
                              static_cast<std::uint32_t>(corners.size())});
    scene.polygon_vertices.insert(scene.polygon_vertices.end(), corners.begin(), corners.end());
}

void read_mesh(JsonSceneState& state, const JsonObject& object, const Surroundings& around) {
    const JsonReader& reader = object.reader();
    Scene& scene = state.scene;
    const std::vector<glm::vec3> vertices = read_vertices(reader, object.at("vertices"), around.transform);
    const auto first_vertex = static_cast<std::uint32_t>(scene.vertices.size());
    const auto first_normal = static_cast<std::uint32_t>(scene.normals.size());
    const auto first_uv = static_cast<std::uint32_t>(scene.uvs.size());
    scene.vertices.insert(scene.vertices.end(), vertices.begin(), vertices.end());

    // One of each for each vertex.
    const auto each = [&](std::string_view key, std::string_view form, const auto& read) {
        const JsonValue* list = object.find(key);
        if (list == nullptr) return false;
        const std::span<const JsonValue> elements = reader.array(*list, key, form);
        if (elements.size() != vertices.size()) {
            reader.fail(*list,
                        fmt::format("'{}' has {} elements, and there are {} vertices; give one for each", key,
                                    elements.size(), vertices.size()));
        }
        for (const JsonValue& element : elements) read(element);
        return true;
    };
    const bool smooth = each("normals", "an array of normals ([x, y, z])", [&](const JsonValue& element) {
        const glm::dvec3 normal = reader.vector(element, "normals");
        if (glm::length(normal) < min_length) {
            reader.fail(element, "this normal is zero; give it a direction");
        }
        scene.normals.emplace_back(normal);
    });
    const bool has_uv = each("uv", "an array of coordinates ([u, v])", [&](const JsonValue& element) {
        std::array<double, 2> uv{};
        reader.numbers(element, "uv", "texture coordinates ([u, v])", uv);
        scene.uvs.emplace_back(uv[0], uv[1]);
    });

    const std::span<const JsonValue> triangles =
        reader.array(object.at("triangles"), "triangles", "an array of triangles ([i, j, k])");
    const bool moves = around.transform != glm::dmat4(1);
    const auto placed = [&](std::uint32_t i) {
        return moves ? glm::vec3(around.transform * glm::dvec4(vertices[i], 1)) : vertices[i];
    };
    for (const JsonValue& element : triangles) {
        if (element.kind != JsonKind::array || element.count != 3) {
            reader.fail_type(element, "triangles", "3 indices of vertices ([i, j, k])");
        }
        const std::span<const JsonValue> indices = reader.document().elements(element);
        std::uint32_t corners[3];
        for (std::size_t k = 0; k < 3; ++k) {
            const double index = reader.integer(indices[k], "triangles");
            if (index < 0 || index >= static_cast<double>(vertices.size())) {
                reader.fail(indices[k],
                            vertices.empty()
                                ? std::string("there is no vertex to refer to; 'vertices' is empty")
                                : fmt::format("there is no vertex {}; they are 0 to {}", number_text(index),
                                              vertices.size() - 1));
            }
            corners[k] = static_cast<std::uint32_t>(index);
        }
        if (is_degenerate(placed(corners[0]), placed(corners[1]), placed(corners[2]))) continue;
        Triangle triangle;
        triangle.smooth = smooth;
        triangle.has_uv = has_uv;
        for (std::size_t k = 0; k < 3; ++k) {
            triangle.vertices[k] = first_vertex + corners[k];
            if (smooth) triangle.normals[k] = first_normal + corners[k];
            if (has_uv) triangle.uvs[k] = first_uv + corners[k];
        }
        add(scene, around, PrimitiveKind::triangle, scene.triangles.size());
        scene.triangles.push_back(triangle);
    }
}

}  // namespace sahl
