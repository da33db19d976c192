#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "bench/mesh_builder.h"
#include "bench/noise.h"
#include "bench/scenes.h"

namespace sahl::bench {
namespace {

constexpr float edge = 10;

/// The cell of one object: what lies within `reach` of `center` does not leave it.
struct Cell {
    std::uint32_t number;
    glm::vec3 center;
    float reach;

    /// Uniform in lo..hi, the same for the same cell and dimension.
    float random(std::uint32_t dimension, float lo, float hi) const {
        return lo + (hi - lo) * uniform(number, dimension);
    }
    glm::vec3 random_direction(std::uint32_t dimension) const {
        const float z = random(dimension, -1, 1);
        const float angle = random(dimension + 1, 0, 2 * std::numbers::pi_v<float>);
        const float radius = std::sqrt(1 - z * z);
        return {radius * std::cos(angle), radius * std::sin(angle), z};
    }
};

/// A scene of `count` objects, each added by add(scene, cell).
template <class Add>
Scene make_field(std::uint32_t count, const Add& add) {
    Scene scene = empty_scene({7, 6, 15}, {0, 0, 0}, 40, {10, 20, 10});
    const auto cells = static_cast<std::uint32_t>(std::ceil(std::cbrt(static_cast<double>(count))));
    const float size = edge / static_cast<float>(cells);
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::vec3 place(i % cells, i / cells % cells, i / cells / cells);
        add(scene, Cell{i, (place + 0.5F) * size - edge / 2, 0.5F * size});
    }
    return scene;
}

void add_sphere(Scene& scene, const Cell& cell) {
    const float radius = cell.random(0, 0.3F, 0.9F) * cell.reach;
    const glm::vec3 center = cell.center + (cell.reach - radius) * cell.random_direction(1);
    add_primitive(scene, PrimitiveKind::sphere, scene.spheres.size());
    scene.spheres.push_back({glm::dvec3(center), static_cast<double>(radius)});
}

void add_cone(Scene& scene, const Cell& cell) {
    const glm::vec3 half = cell.random(0, 0.3F, 0.8F) * cell.reach * cell.random_direction(1);
    const auto radius = static_cast<double>(cell.random(3, 0.15F, 0.5F) * cell.reach);
    const bool is_cylinder = cell.number % 2 == 0;
    add_primitive(scene, PrimitiveKind::cone, scene.cones.size());
    scene.cones.push_back({glm::dvec3(cell.center - half), glm::dvec3(cell.center + half), radius,
                           is_cylinder ? radius : static_cast<double>(cell.random(4, 0, 0.5F)) * radius});
}

void add_polygon(Scene& scene, const Cell& cell) {
    const glm::vec3 normal = cell.random_direction(0);
    const glm::vec3 helper = std::abs(normal.x) > 0.5F ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    const glm::vec3 x = glm::normalize(glm::cross(helper, normal)), y = glm::cross(normal, x);
    const auto corners = 5 + static_cast<std::uint32_t>(cell.random(2, 0, 4));
    const bool is_concave = cell.number % 2 == 1;
    add_primitive(scene, PrimitiveKind::polygon, scene.polygons.size());
    scene.polygons.push_back({static_cast<std::uint32_t>(scene.polygon_vertices.size()), corners});
    for (std::uint32_t corner = 0; corner < corners; ++corner) {
        const float angle =
            2 * std::numbers::pi_v<float> * static_cast<float>(corner) / static_cast<float>(corners);
        const float radius = (is_concave && corner % 2 == 1 ? 0.4F : 0.95F) * cell.reach;
        scene.polygon_vertices.push_back(cell.center + radius * (std::cos(angle) * x + std::sin(angle) * y));
    }
}

}  // namespace

std::span<const SceneMaker> field_makers() {
    static constexpr std::uint32_t few = 10000, many = 1000000;
    static constexpr SceneMaker makers[] = {
        {"spheres-10k",
         [] {
             return BenchScene{"spheres-10k", make_field(few, add_sphere)};
         }},
        {"spheres-1M",
         [] {
             return BenchScene{"spheres-1M", make_field(many, add_sphere)};
         }},
        {"cones-10k",
         [] {
             return BenchScene{"cones-10k", make_field(few, add_cone)};
         }},
        {"cones-1M",
         [] {
             return BenchScene{"cones-1M", make_field(many, add_cone)};
         }},
        {"polygons-10k",
         [] {
             return BenchScene{"polygons-10k", make_field(few, add_polygon)};
         }},
        {"polygons-1M",
         [] {
             return BenchScene{"polygons-1M", make_field(many, add_polygon)};
         }},
    };
    return makers;
}

}  // namespace sahl::bench
