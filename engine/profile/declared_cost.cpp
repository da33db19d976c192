#include "engine/profile/declared_cost.h"

#include "kernels/device_types.h"
#include "kernels/rays_per_item.h"

namespace sahl {
namespace {

constexpr std::uint64_t word = 4;
constexpr std::uint64_t ray_bytes = (SAHL_RAY_FLOATS + SAHL_RAY_UINTS) * word;
constexpr std::uint64_t vector_bytes = 3 * word;
constexpr std::uint64_t exact_ray_bytes = 4 * vector_bytes;  ///< origin and direction, and what they lack
constexpr std::uint64_t traced_bytes = 2 * vector_bytes + 2 * word;  ///< and where the ray starts
constexpr std::uint64_t hit_bytes = (SAHL_HIT_FLOATS + SAHL_HIT_UINTS) * word;
constexpr std::uint64_t surface_bytes = SAHL_SURFACE_FLOATS * word;
constexpr std::uint64_t triangle_bytes = 3 * vector_bytes;  ///< the least that shading reads of a shape

/// Groups of neighbours that a kernel handles side by side: they share what is not of a ray.
std::uint64_t groups(std::uint64_t rays) { return (rays + SAHL_LANES - 1) / SAHL_LANES; }

/// The camera's vectors in two parts; of a ray its place in the image, direction and what floats lack of
/// both.
constexpr std::uint64_t camera_flop = 9;
constexpr std::uint64_t camera_ray_flop = 4 + 12 + 8 + 6;
constexpr std::uint64_t drawn_place_flop = 4;  ///< in the pixel, where that has several samples

/// Box test and shear (in vectors of four), check and range of a ray before its first node, ray by ray; a
/// little more than streams do, which prepare eight together.
constexpr std::uint64_t ray_flop = 32 + 4 + 10 + 1;

std::uint64_t visited_bytes(const KernelVisits& visits) {
    return visits.nodes * sizeof(device::BvhNode) + visits.leaf_bytes;
}

std::uint64_t generate_flop(const GenerationWork& work) {
    const std::uint64_t of_ray = camera_ray_flop + (work.spp > 1 ? drawn_place_flop : 0);
    return groups(work.rays) * (SAHL_LANES * of_ray + camera_flop);
}

/// One material a group, shapes no larger than triangles.
std::uint64_t shade_bytes(const GenerationWork& work) {
    const std::uint64_t loaded = 2 * word + vector_bytes + hit_bytes;  // pixel and start, weight
    const std::uint64_t stored = vector_bytes + 2 * word;              // light and its pixel, outcome
    const std::uint64_t of_hit = exact_ray_bytes + sizeof(device::DevicePrimitive) + triangle_bytes +
                                 surface_bytes + work.lights * vector_bytes;
    const std::uint64_t of_group = sizeof(device::DeviceMaterial) + work.lights * sizeof(device::DeviceLight);
    const std::uint64_t hits = work.visits.hits();
    return work.rays * (loaded + stored) + hits * of_hit + groups(hits) * of_group +
           work.children * ray_bytes;
}

std::uint64_t shadow_bytes(const GenerationWork& work) {
    const std::uint64_t of_ray = vector_bytes + surface_bytes + SAHL_HIT_UINTS * word;
    const std::uint64_t of_lit = 3 * vector_bytes;  // what the light brings, added to what others did
    return work.rays * work.lights * word + work.shadow_rays * of_ray +
           groups(work.shadow_rays) * sizeof(device::DeviceLight) + work.visits.lit * of_lit +
           visited_bytes(work.visits.shadow);
}

}  // namespace

DeclaredCost declared_cost(std::string_view kernel, const GenerationWork& work,
                           const IntersectVisits& intersect) {
    const std::uint64_t blocks = (work.rays + SAHL_COMPACT_BLOCK - 1) / SAHL_COMPACT_BLOCK;
    if (kernel == "generate") return {work.rays * ray_bytes, generate_flop(work)};
    if (kernel == "intersect") {
        return {intersect.rays * (traced_bytes + hit_bytes) + visited_bytes(intersect.visits),
                intersect.rays * ray_flop + intersect.visits.flop};
    }
    if (kernel == "shade") return {shade_bytes(work), work.visits.shade.flop};
    if (kernel == "shadow")
        return {shadow_bytes(work), work.shadow_rays * ray_flop + work.visits.shadow.flop};
    if (kernel == "count_children") return {work.rays * word + blocks * 3 * word, 0};
    if (kernel == "sum_children") return {blocks * 5 * word + 3 * word, 0};
    if (kernel == "compact") {
        return {work.rays * word + blocks * 2 * word + work.children * (2 * ray_bytes + vector_bytes), 0};
    }
    return {};
}

}  // namespace sahl
