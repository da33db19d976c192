// A hall of 24 × 8 × 40, y up, its floor at 0.
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "bench/mesh_builder.h"
#include "bench/noise.h"
#include "bench/scenes.h"

namespace sahl::bench {
namespace {

constexpr float half_width = 12, height = 8, half_length = 20;

/// A box with edges along the axes.
void add_box_between(Scene& scene, glm::vec3 lo, glm::vec3 hi) {
    const glm::vec3 half = (hi - lo) / 2.0F;
    add_block(scene, (lo + hi) / 2.0F, {half.x, 0, 0}, {0, half.y, 0}, {0, 0, half.z});
}

void add_walls(Scene& scene) {
    constexpr float wall = 0.2F;
    const glm::vec3 lo(-half_width, 0, -half_length), hi(half_width, height, half_length);
    add_box_between(scene, {lo.x, -wall, lo.z}, {hi.x, 0, hi.z});
    add_box_between(scene, {lo.x, hi.y, lo.z}, {hi.x, hi.y + wall, hi.z});
    add_box_between(scene, {lo.x - wall, 0, lo.z}, {lo.x, hi.y, hi.z});
    add_box_between(scene, {hi.x, 0, lo.z}, {hi.x + wall, hi.y, hi.z});
    add_box_between(scene, {lo.x, 0, lo.z - wall}, {hi.x, hi.y, lo.z});
    add_box_between(scene, {lo.x, 0, hi.z}, {hi.x, hi.y, hi.z + wall});
}

/// Fluted, thinner towards the top, on a square base and under a square capital.
void add_column(Scene& scene, float x, float z) {
    constexpr int around = 48, upward = 24;
    constexpr float base = 0.3F, capital = 7.6F;
    add_box_between(scene, {x - 0.9F, 0, z - 0.9F}, {x + 0.9F, base, z + 0.9F});
    add_box_between(scene, {x - 0.9F, capital, z - 0.9F}, {x + 0.9F, height, z + 0.9F});
    add_grid(scene, around, upward, [&](int column, int row) {
        const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(column % around) / around;
        const float up = static_cast<float>(row) / upward;
        const float radius = (0.65F - 0.12F * up * up) * (1 + 0.05F * std::cos(12 * angle));
        return glm::vec3(x + radius * std::cos(angle), base + (capital - base) * up,
                         z - radius * std::sin(angle));
    });
}

/// A hand rail on turned balusters from one point of a floor to another.
void add_railing(Scene& scene, glm::vec3 from, glm::vec3 to, int balusters) {
    constexpr int steps = 14;
    std::array<glm::vec2, steps + 1> profile;
    for (int i = 0; i <= steps; ++i) {
        const float up = static_cast<float>(i) / steps;
        const float bulge = std::sin(std::numbers::pi_v<float> * up);
        profile[static_cast<std::size_t>(i)] = {0.03F + 0.05F * bulge * bulge * (1.3F - up), 0.9F * up};
    }
    for (int i = 0; i < balusters; ++i) {
        const float along = (static_cast<float>(i) + 0.5F) / static_cast<float>(balusters);
        add_lathe(scene, from + along * (to - from), profile, 16);
    }
    const glm::vec3 rail(0, 0.93F, 0);
    add_bar(scene, from + rail, to + rail, 0.08F);
}

/// Along both long walls: a gallery on the columns' outer side, reached by stairs.
void add_gallery(Scene& scene, float side) {
    constexpr float floor = 4, inner = 8;
    const float edge = side * inner, wall = side * half_width;
    add_box_between(scene, {std::min(edge, wall), floor - 0.2F, -half_length + 6},
                    {std::max(edge, wall), floor, half_length});
    add_railing(scene, {edge, floor, -half_length + 6}, {edge, floor, half_length}, 150);
    constexpr int steps = 24;
    for (int i = 0; i < steps; ++i) {
        const float top = floor * static_cast<float>(i + 1) / steps;
        const float z = -half_length + 6 * static_cast<float>(i) / steps;
        add_box_between(scene, {std::min(edge, wall), 0, z}, {std::max(edge, wall), top, z + 6.0F / steps});
    }
    add_railing(scene, {edge, 0.15F, -half_length}, {edge, floor, -half_length + 6}, 24);
}

/// Statues of no shape in particular.
void add_statue(Scene& scene, glm::vec3 foot, float seed) {
    add_box_between(scene, foot - glm::vec3(0.7F, 0, 0.7F), foot + glm::vec3(0.7F, 0.6F, 0.7F));
    add_icosphere(scene, 5, [&](glm::vec3 direction) {
        const float radius = 1 + 0.35F * fractal_noise(1.5F * direction + glm::vec3(seed), 5);
        return foot + glm::vec3(0, 1.7F, 0) + glm::vec3(0.6F, 1, 0.6F) * (radius * direction);
    });
}

void add_vase(Scene& scene, glm::vec3 foot, float size) {
    constexpr int steps = 16;
    std::array<glm::vec2, steps + 1> profile;
    for (int i = 0; i <= steps; ++i) {
        const float up = static_cast<float>(i) / steps;
        profile[static_cast<std::size_t>(i)] = size * glm::vec2(0.3F + 0.2F * std::sin(5 * up), 1.2F * up);
    }
    add_lathe(scene, foot, profile, 24);
}

/// Bars across the hall, 23.6 long and 0.012 thick, and cables every way through it.
void add_bars(Scene& scene) {
    for (int curtain = 0; curtain < 10; ++curtain) {
        const float z = -19 + 3.8F * static_cast<float>(curtain);
        for (int bar = 0; bar < 20; ++bar) {
            const float y = 4.4F + 0.16F * static_cast<float>(bar);
            add_bar(scene, {-11.8F, y, z}, {11.8F, y, z}, 0.012F);
        }
    }
    for (std::uint32_t cable = 0; cable < 150; ++cable) {
        const auto end = [&](std::uint32_t dimension) {
            return glm::vec3(22 * uniform(cable, dimension) - 11, 7.5F * uniform(cable, dimension + 1),
                             38 * uniform(cable, dimension + 2) - 19);
        };
        add_bar(scene, end(0), end(3), 0.03F);
    }
}

}  // namespace

BenchScene architecture_mesh() {
    Scene scene = empty_scene({-3, 3.2, 18}, {1, 2.6, -6}, 60, {1, 7, 3});
    add_walls(scene);
    for (int i = 0; i < 9; ++i) {
        for (const float side : {-1.0F, 1.0F}) add_column(scene, side * 6, -16 + 4 * static_cast<float>(i));
    }
    for (const float side : {-1.0F, 1.0F}) add_gallery(scene, side);
    for (int i = 0; i < 4; ++i) {
        add_statue(scene, {i % 2 == 0 ? -2 : 2.5F, 0, 9 - 6 * static_cast<float>(i)},
                   3.1F * static_cast<float>(i));
    }
    for (std::uint32_t i = 0; i < 60; ++i) {
        const glm::vec3 foot(10 * uniform(i, 6) - 5, 0, 36 * uniform(i, 7) - 18);
        add_vase(scene, foot, 0.3F + 0.5F * uniform(i, 8));
    }
    add_bars(scene);
    return {"architecture", std::move(scene)};
}

}  // namespace sahl::bench
