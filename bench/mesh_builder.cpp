#include "bench/mesh_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <unordered_map>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

namespace sahl::bench {
namespace {

using Corners = std::array<std::uint32_t, 3>;

std::uint32_t next_vertex(const Scene& scene) { return static_cast<std::uint32_t>(scene.vertices.size()); }

/// The vertices halfway between two others, one for each edge.
class Midpoints {
public:
    explicit Midpoints(std::vector<glm::vec3>& vertices) : vertices_(vertices) {}

    std::uint32_t of(std::uint32_t a, std::uint32_t b) {
        const auto [lower, upper] = std::minmax(a, b);
        const std::uint64_t edge = static_cast<std::uint64_t>(lower) << 32U | upper;
        const auto [place, is_new] = known_.try_emplace(edge, static_cast<std::uint32_t>(vertices_.size()));
        if (is_new) vertices_.push_back(glm::normalize(vertices_[lower] + vertices_[upper]));
        return place->second;
    }

private:
    std::vector<glm::vec3>& vertices_;
    std::unordered_map<std::uint64_t, std::uint32_t> known_;
};

/// The corners lie on three golden rectangles: (0, ±1, ±φ) and its rotations.
std::vector<glm::vec3> icosahedron_corners() {
    std::vector<glm::vec3> corners;
    for (int axis = 0; axis < 3; ++axis) {
        for (const float one : {-1.0F, 1.0F}) {
            for (const float phi : {-std::numbers::phi_v<float>, std::numbers::phi_v<float>}) {
                glm::vec3 corner(0);
                corner[(axis + 1) % 3] = one;
                corner[(axis + 2) % 3] = phi;
                corners.push_back(glm::normalize(corner));
            }
        }
    }
    return corners;
}

/// Three corners are a face when each two are neighbours; counter-clockwise seen from outside.
std::vector<Corners> icosahedron_faces(const std::vector<glm::vec3>& corners) {
    const auto neighbours = [&](std::uint32_t a, std::uint32_t b) {
        return glm::distance(corners[a], corners[b]) < 1.1F;
    };
    std::vector<Corners> faces;
    for (std::uint32_t a = 0; a < 12; ++a) {
        for (std::uint32_t b = a + 1; b < 12; ++b) {
            for (std::uint32_t c = b + 1; c < 12; ++c) {
                if (!neighbours(a, b) || !neighbours(b, c) || !neighbours(c, a)) continue;
                const glm::vec3 normal = glm::cross(corners[b] - corners[a], corners[c] - corners[a]);
                const bool outward = glm::dot(normal, corners[a]) > 0;
                faces.push_back(outward ? Corners{a, b, c} : Corners{a, c, b});
            }
        }
    }
    return faces;
}

}  // namespace

Scene empty_scene(glm::dvec3 eye, glm::dvec3 look_at, double fov_y, glm::dvec3 light) {
    Scene scene;
    scene.cameras[0].eye = eye;
    scene.cameras[0].look_at = look_at;
    scene.cameras[0].fov_y = fov_y;
    scene.lights.push_back({LightKind::point, light});
    scene.materials.emplace_back();
    return scene;
}

void add_primitive(Scene& scene, PrimitiveKind kind, std::size_t index) {
    scene.primitives.push_back({kind, static_cast<std::uint32_t>(index)});
}

void add_triangle(Scene& scene, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    add_primitive(scene, PrimitiveKind::triangle, scene.triangles.size());
    scene.triangles.push_back({{a, b, c}});
}

void add_grid(Scene& scene, int columns, int rows, const std::function<glm::vec3(int, int)>& position) {
    const std::uint32_t first = next_vertex(scene);
    const auto width = static_cast<std::uint32_t>(columns) + 1;
    for (int row = 0; row <= rows; ++row) {
        for (int column = 0; column <= columns; ++column) scene.vertices.push_back(position(column, row));
    }
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            const std::uint32_t corner =
                first + static_cast<std::uint32_t>(row) * width + static_cast<std::uint32_t>(column);
            add_triangle(scene, corner, corner + width, corner + 1);
            add_triangle(scene, corner + 1, corner + width, corner + width + 1);
        }
    }
}

void add_block(Scene& scene, glm::vec3 center, glm::vec3 x, glm::vec3 y, glm::vec3 z) {
    const std::uint32_t first = next_vertex(scene);
    for (std::uint32_t corner = 0; corner < 8; ++corner) {
        const auto side = [&](std::uint32_t bit) { return (corner & bit) != 0U ? 1.0F : -1.0F; };
        scene.vertices.push_back(center + side(1) * x + side(2) * y + side(4) * z);
    }
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
        const std::uint32_t u = 1U << (axis + 1) % 3, v = 1U << (axis + 2) % 3;
        for (const std::uint32_t side : {0U, 1U << axis}) {
            add_triangle(scene, first + side, first + side + u, first + side + u + v);
            add_triangle(scene, first + side, first + side + u + v, first + side + v);
        }
    }
}

void add_bar(Scene& scene, glm::vec3 from, glm::vec3 to, float thickness) {
    const glm::vec3 half = (to - from) / 2.0F;
    const glm::vec3 other =
        std::abs(half.y) > 0.9F * glm::length(half) ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    const glm::vec3 side = glm::normalize(glm::cross(half, other)) * (thickness / 2);
    const glm::vec3 up = glm::normalize(glm::cross(side, half)) * (thickness / 2);
    add_block(scene, (from + to) / 2.0F, half, up, side);
}

void add_lathe(Scene& scene, glm::vec3 foot, std::span<const glm::vec2> profile, int segments) {
    add_grid(scene, segments, static_cast<int>(profile.size()) - 1, [&](int column, int row) {
        const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(column % segments) /
                            static_cast<float>(segments);
        const glm::vec2 point = profile[static_cast<std::size_t>(row)];
        return foot + glm::vec3(point.x * std::cos(angle), point.y, -point.x * std::sin(angle));
    });
}

void add_icosphere(Scene& scene, int levels, const std::function<glm::vec3(glm::vec3)>& place) {
    std::vector<glm::vec3> directions = icosahedron_corners();
    std::vector<Corners> faces = icosahedron_faces(directions);
    for (int level = 0; level < levels; ++level) {
        Midpoints midpoints(directions);
        std::vector<Corners> finer;
        finer.reserve(4 * faces.size());
        for (const auto [a, b, c] : faces) {
            const std::uint32_t ab = midpoints.of(a, b), bc = midpoints.of(b, c), ca = midpoints.of(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        faces = std::move(finer);
    }
    const std::uint32_t first = next_vertex(scene);
    for (const glm::vec3& direction : directions) scene.vertices.push_back(place(direction));
    for (const auto [a, b, c] : faces) add_triangle(scene, first + a, first + b, first + c);
}

}  // namespace sahl::bench
