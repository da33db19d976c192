#include "engine/scene/polygon.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace sahl {
namespace {

constexpr double least_area = static_cast<double>(std::numeric_limits<float>::min());

// Positive: a, b, c turn to the left.
double turn(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// The corners seen against the normal, without the axis of its largest component: counter-clockwise.
std::vector<glm::dvec2> project(std::span<const glm::vec3> corners, glm::dvec3 normal) {
    const glm::dvec3 size = glm::abs(normal);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    int right = (axis + 1) % 3;
    int above = (axis + 2) % 3;
    if (normal[axis] < 0) std::swap(right, above);
    std::vector<glm::dvec2> flat;
    flat.reserve(corners.size());
    for (const glm::vec3& corner : corners) flat.emplace_back(corner[right], corner[above]);
    return flat;
}

// The outline that is left, as a ring of corners. Whether a corner is an ear changes only when a
// neighbour goes, so ears wait in a queue and each cut looks at two corners anew.
class EarCutter {
public:
    EarCutter(std::vector<glm::dvec2> points, std::span<const glm::vec3> corners)
        : points_(std::move(points)), corners_(corners), left_(static_cast<std::uint32_t>(points_.size())) {
        const std::uint32_t count = left_;
        for (std::uint32_t i = 0; i < count; ++i) {
            next_.push_back((i + 1) % count);
            previous_.push_back((i + count - 1) % count);
        }
        state_.resize(count);
        version_.resize(count);
        for (std::uint32_t i = 0; i < count; ++i) {
            if (turn_at(i) < 0) concave_list_.push_back(i);
            state_[i] = turn_at(i) < 0 ? State::concave : State::convex;
        }
        look_for_ears();
    }

    std::optional<std::vector<std::array<std::uint32_t, 3>>> cut() {
        while (left_ > 2) {
            if (queue_head_ < queue_.size()) {
                const auto [corner, version] = queue_[queue_head_++];
                if (state_[corner] != State::gone && version == version_[corner]) cut_ear(corner);
            } else if (!remove_flat_corner()) {
                // Rounding may hide an ear from the rule above. Few are ever missed: bounded time.
                if (++searches_ > 16) return std::nullopt;
                look_for_ears();
            }
        }
        return std::move(triangles_);
    }

private:
    enum class State : char { convex, concave, gone };

    double turn_at(std::uint32_t i) const {
        return turn(points_[previous_[i]], points_[i], points_[next_[i]]);
    }

    // Turns left, and no concave corner of the outline lies in or on the triangle but at its corners.
    bool is_ear(std::uint32_t i) {
        const glm::dvec2 a = points_[previous_[i]];
        const glm::dvec2 b = points_[i];
        const glm::dvec2 c = points_[next_[i]];
        if (turn(a, b, c) <= 0) return false;
        std::erase_if(concave_list_, [&](std::uint32_t k) { return state_[k] != State::concave; });
        return std::none_of(concave_list_.begin(), concave_list_.end(), [&](std::uint32_t k) {
            const glm::dvec2 p = points_[k];
            if (p == a || p == b || p == c) return false;
            return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
        });
    }

    // From corner 1 on: a quadrilateral is split between its corners 0 and 2, as is usual.
    void look_for_ears() {
        const auto count = static_cast<std::uint32_t>(points_.size());
        for (std::uint32_t k = 1; k <= count; ++k) look_at(k % count);
    }

    void look_at(std::uint32_t i) {
        if (state_[i] == State::gone) return;
        ++version_[i];  // what waits in the queue about this corner is outdated
        if (is_ear(i)) queue_.push_back({i, version_[i]});
    }

    void cut_ear(std::uint32_t i) {
        const std::uint32_t a = previous_[i];
        const std::uint32_t c = next_[i];
        if (!is_degenerate(corners_[a], corners_[i], corners_[c])) triangles_.push_back({a, i, c});
        remove(i);
    }

    // Corners without area go only when there is no ear, so that a corner on an edge stays a corner
    // of its triangles while it can.
    bool remove_flat_corner() {
        for (std::uint32_t i = 0; i < points_.size(); ++i) {
            if (state_[i] == State::gone || turn_at(i) != 0) continue;
            remove(i);
            return true;
        }
        return false;
    }

    void remove(std::uint32_t i) {
        state_[i] = State::gone;
        const std::uint32_t a = previous_[i];
        const std::uint32_t c = next_[i];
        next_[a] = c;
        previous_[c] = a;
        --left_;
        for (const std::uint32_t neighbour : {a, c}) {
            const bool concave = turn_at(neighbour) < 0;
            if (concave && state_[neighbour] == State::convex) concave_list_.push_back(neighbour);
            state_[neighbour] = concave ? State::concave : State::convex;
        }
        look_at(a);
        look_at(c);
    }

    struct Waiting {
        std::uint32_t corner, version;
    };

    std::vector<glm::dvec2> points_;
    std::span<const glm::vec3> corners_;
    std::uint32_t left_;
    std::vector<std::uint32_t> next_, previous_;
    std::vector<State> state_;
    std::vector<std::uint32_t> version_;  // counts the looks at a corner
    std::vector<std::uint32_t> concave_list_;
    std::vector<Waiting> queue_;
    std::size_t queue_head_ = 0;
    int searches_ = 0;
    std::vector<std::array<std::uint32_t, 3>> triangles_;
};

}  // namespace

bool is_degenerate(glm::vec3 a, glm::vec3 b, glm::vec3 c) {
    const glm::dvec3 origin(a);
    return glm::length(glm::cross(glm::dvec3(b) - origin, glm::dvec3(c) - origin)) < least_area;
}

glm::dvec3 newell_normal(std::span<const glm::vec3> corners) {
    // Relative to a corner, so that a polygon far from the origin loses no digits.
    const glm::dvec3 origin(corners[0]);
    glm::dvec3 normal(0);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec3 next(corners[(i + 1) % corners.size()]);
        normal += glm::cross(glm::dvec3(corners[i]) - origin, next - origin);
    }
    return normal;
}

PolygonShape classify_polygon(std::span<const glm::vec3> corners) {
    const auto offset = [&](std::size_t i) { return glm::dvec3(corners[i]) - glm::dvec3(corners[0]); };
    glm::dvec3 lo(0);
    glm::dvec3 hi(0);
    glm::dvec3 middle(0);
    std::size_t farthest = 0;
    for (std::size_t i = 1; i < corners.size(); ++i) {
        lo = glm::min(lo, offset(i));
        hi = glm::max(hi, offset(i));
        middle += offset(i) / static_cast<double>(corners.size());
        if (glm::length(offset(i)) > glm::length(offset(farthest))) farthest = i;
    }
    const double size = glm::length(hi - lo);
    if (size * size < least_area) return PolygonShape::line;

    const glm::dvec3 along = glm::normalize(offset(farthest));
    double width = 0;
    for (std::size_t i = 1; i < corners.size(); ++i) {
        width = std::max(width, glm::length(glm::cross(along, offset(i))));
    }
    // Below float's own rounding there is no plane to speak of.
    if (width < 1e-7 * size) return PolygonShape::line;

    const glm::dvec3 normal = newell_normal(corners);
    const double area = glm::length(normal);
    if (area < 1e-9 * size * width || area < least_area) return PolygonShape::no_plane;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        if (std::abs(glm::dot(offset(i) - middle, normal / area)) > 1e-3 * size)
            return PolygonShape::no_plane;
    }
    return PolygonShape::planar;
}

std::optional<std::vector<std::array<std::uint32_t, 3>>> triangulate(std::span<const glm::vec3> corners) {
    return EarCutter(project(corners, newell_normal(corners)), corners).cut();
}

}  // namespace sahl
