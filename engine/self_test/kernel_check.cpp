#include "engine/self_test/kernel_check.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>

namespace sahl::self_test {
namespace {

using glm::dvec3;

// The scene reaches 10 from its middle, where single precision rounds to 1e-6; transforms and several
// operations add up to some of these.
constexpr double scene_reach = 10;
constexpr double most_moved = 1e-5;
/// By how much answers change at most between two rays, smoothly, for each unit between them.
constexpr double steepest = 4;

/// Whether `compare` agrees with a ray beside `ray`: moved across its direction, or turned so that its far
/// end goes the other way.
bool agrees_nearby(std::size_t i, const oracle::Ray& ray, double allowed, const Compare& compare) {
    const dvec3 along = glm::normalize(ray.direction);
    const dvec3 other = std::abs(along.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 u = glm::normalize(glm::cross(along, other));
    const dvec3 v = glm::cross(along, u);
    const double length = glm::length(ray.direction);
    for (double moved = most_moved / 16; moved <= most_moved; moved *= 2) {
        for (int k = 0; k < 8; ++k) {
            const double angle = std::numbers::pi / 4 * k + moved / most_moved;
            const dvec3 side = moved * (std::cos(angle) * u + std::sin(angle) * v);
            const dvec3 turned = ray.direction - 2 * length / scene_reach * side;
            for (const dvec3& direction : {ray.direction, glm::normalize(turned) * length}) {
                if (compare(i, {ray.origin + side, direction}).amount() <= allowed + steepest * moved)
                    return true;
            }
        }
    }
    return false;
}

}  // namespace

bool check_rays(KernelTest& test, const RayAnswers& answers, const Compare& compare) {
    struct Answer {
        Difference difference;
        bool right = false;
    };
    std::vector<Answer> compared(answers.count);
    tbb::parallel_for(std::size_t{0}, answers.count, [&](std::size_t i) {
        const oracle::Ray ray = answers.ray(i);
        Answer& answer = compared[i];
        answer.difference = compare(i, ray);
        answer.right = answer.difference.amount() <= answers.allowed;
        if (answer.right || !agrees_nearby(i, ray, answers.allowed, compare)) return;
        answer.right = true;
        answer.difference = {};
    });
    test.allowed = answers.allowed;
    for (std::size_t i = 0; i < answers.count; ++i) {
        const Answer& answer = compared[i];
        ++test.checked;
        if (answer.right) {
            test.worst = std::max(test.worst, answer.difference.amount());
            continue;
        }
        const oracle::Ray ray = answers.ray(i);
        const dvec3& o = ray.origin;
        const dvec3& d = ray.direction;
        test.failure = fmt::format(
            "ray {} of generation {}, origin ({:.9g}, {:.9g}, {:.9g}), direction ({:.9g}, {:.9g}, {:.9g}): "
            "{}",
            i, answers.generation, o.x, o.y, o.z, d.x, d.y, d.z, answer.difference.text());
        return false;
    }
    return true;
}

bool check_exact(KernelTest& test, std::string_view what, std::size_t count,
                 const std::function<std::uint64_t(std::size_t)>& expected,
                 const std::function<std::uint64_t(std::size_t)>& found) {
    for (std::size_t i = 0; i < count; ++i) {
        ++test.checked;
        if (expected(i) == found(i)) continue;
        test.failure = fmt::format("{} {}: expected {}, found {}", what, i, expected(i), found(i));
        return false;
    }
    return true;
}

}  // namespace sahl::self_test
