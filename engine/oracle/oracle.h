// The independent reference for the kernels: Whitted ray tracing by brute force in double
// precision, written from the formulas, without acceleration structure, offsets or batches.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/oracle/shape.h"
#include "engine/scene/scene.h"

namespace sahl::oracle {

inline constexpr std::uint32_t no_primitive = 0xffffffffU;
inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// A primitive in its place.
struct SurfaceId {
    std::uint32_t primitive = no_primitive;
    std::uint32_t instance = 0;  ///< 0: the world's own; else as Aov::instance_id counts

    friend bool operator==(const SurfaceId&, const SurfaceId&) = default;
};

struct Hit {
    double t = 0;
    glm::dvec3 position{0};
    glm::dvec3 ng{0};  ///< unit, front or outward
    glm::dvec3 ns{0};  ///< unit, not turned to the ray
    glm::dvec2 uv{0};
    glm::dvec2 barycentric{0};  ///< of a triangle's vertices 1 and 2
    SurfaceId id;
    int part = 0;              ///< Crossing::part
    double edge_distance = 0;  ///< Crossings::margin
};

/// Rays of one bounce generation.
struct Counts {
    std::uint64_t rays = 0;
    std::uint64_t shadow_rays = 0;
};

/// What a camera ray brought, by generation, and the decisions on the way.
struct PathRecord {
    std::vector<glm::dvec3> radiance;  ///< weighted; depth n sees the sum of the first n + 1
    std::vector<Counts> counts;
    std::uint64_t signature = 0;  ///< hash of all discrete decisions of the ray tree in order
};

struct SurfaceColors;

class Oracle {
public:
    /// Keeps a reference to `scene`.
    explicit Oracle(const Scene& scene);

    /// The nearest crossing with t_min < t < t_max; of equal ones the lowest (instance, primitive).
    /// `start`: what the ray starts on.
    std::optional<Hit> closest_hit(const Ray& ray, double t_min = 0, double t_max = infinity,
                                   const SurfaceId& start = {}) const;

    /// The crossing with surface `id` alone that is nearest to distance `t`; none where the ray misses it.
    std::optional<Hit> hit_near(const Ray& ray, const SurfaceId& id, double t) const;

    /// The part of the light that passes 0 < t < t_max: 0 behind an opaque surface, else the
    /// product of `transmission` over all surfaces crossed; `crossed` counts those.
    glm::dvec3 transmittance(const Ray& ray, double t_max, const SurfaceId& start, int& crossed) const;

    /// Least Crossings::margin of the ray's line over all primitives.
    double edge_distance(const Ray& ray) const;

    /// Whitted's ray tree of one camera ray, `depth` generations after it.
    PathRecord trace(const Ray& ray, int depth) const;

    const Material& material_of(const Hit& hit) const {
        return scene_.materials[scene_.primitives[hit.id.primitive].material];
    }

    const Scene& scene() const { return scene_; }

private:
    struct Branch;
    void trace(const Branch& branch, int depth, PathRecord& record) const;
    glm::dvec3 direct_light(const Branch& branch, const Hit& hit, const SurfaceColors& colors,
                            PathRecord& record) const;

    const Scene& scene_;
    std::vector<PlacedShape> shapes_;
};

}  // namespace sahl::oracle
