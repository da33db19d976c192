#include "tests/device/ray_verdict.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>

namespace sahl::tests {
namespace {

using glm::dvec3;

struct Answer {
    std::uint32_t primitive = SAHL_NO_PRIMITIVE;
    std::uint32_t instance = 0;
    oracle::Crossing crossing{std::numeric_limits<double>::infinity()};
};

Answer nearest(const std::vector<oracle::PlacedShape>& shapes, const oracle::Ray& ray, const TestRay& start) {
    Answer best;
    for (const oracle::PlacedShape& placed : shapes) {
        const bool starts_here =
            placed.primitive == start.exclude && placed.instance == start.exclude_instance;
        const oracle::Crossings crossings = placed.shape.cross(ray, starts_here);
        for (int i = 0; i < crossings.count; ++i) {
            if (crossings.at[i].t > 0 && crossings.at[i].t < best.crossing.t)
                best = {placed.primitive, placed.instance, crossings.at[i]};
        }
    }
    return best;
}

/// Whether `origin` + s `along` comes within `move` of one of the target's tips or lies that close to its
/// plane.
bool undecided(const Target& target, const dvec3& origin, const dvec3& along, double move) {
    for (const dvec3& tip : target.tips) {
        if (glm::length(glm::cross(tip - origin, along)) <= move) return true;
    }
    if (!target.flat) return false;
    const Target::Point& anchor = target.points[0];
    const dvec3 nearest_to_center = origin + glm::dot(target.center - origin, along) * along;
    return std::abs(glm::dot(along, anchor.normal)) * target.size <= move &&
           std::abs(glm::dot(nearest_to_center - anchor.position, anchor.normal)) <= 2 * move;
}

}  // namespace

Verdict judge(const std::vector<oracle::PlacedShape>& shapes, const std::vector<Target>& targets,
              const TestRay& ray, double roundings) {
    const dvec3 origin(ray.origin), direction(ray.direction);
    const double length = glm::length(direction);
    const dvec3 along = direction / length;
    const dvec3 other = std::abs(along.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 u = glm::normalize(glm::cross(along, other));
    const dvec3 v = glm::cross(along, u);
    const Answer itself = nearest(shapes, {origin, direction}, ray);
    Verdict verdict{
        true, itself.primitive, itself.instance, true, itself.crossing.t, itself.crossing.t, itself.crossing,
        0};
    double reach = 0;
    for (const Target& target : targets) {
        verdict.rounding = std::max(verdict.rounding, roundings * rounding_of(ray, target));
        reach = std::max(reach, reach_of(ray, target));
    }
    const double move = verdict.rounding;
    for (const Target& target : targets)
        verdict.sure = verdict.sure && !undecided(target, origin, along, move);
    const auto ask = [&](const dvec3& moved_origin, const dvec3& moved_direction) {
        if (!verdict.sure) return;
        const Answer moved = nearest(shapes, {moved_origin, moved_direction}, ray);
        verdict.sure = moved.primitive == itself.primitive && moved.instance == itself.instance;
        verdict.one_face = verdict.one_face && moved.crossing.part == itself.crossing.part;
        verdict.t_least = std::min(verdict.t_least, moved.crossing.t);
        verdict.t_most = std::max(verdict.t_most, moved.crossing.t);
    };
    for (double far = move; far > move / 10; far /= 2) {
        for (int i = 0; i < 8; ++i) {
            const double angle = std::numbers::pi / 4 * i + far / move;
            const dvec3 side = std::cos(angle) * u + std::sin(angle) * v;
            ask(origin + far * side, direction);
            ask(origin + far * side, direction - 2 * far / reach * length * side);
        }
    }
    ask(origin + move * along, direction);
    ask(origin - move * along, direction);
    verdict.t_least -= move / length;
    verdict.t_most += move / length;
    return verdict;
}

}  // namespace sahl::tests
