#include "engine/profile/declared_cost.h"

#include "kernels/device_types.h"

namespace sahl {
namespace {

constexpr std::uint64_t word = 4;
constexpr std::uint64_t ray_bytes = (SAHL_RAY_FLOATS + SAHL_RAY_UINTS) * word;
constexpr std::uint64_t traced_bytes = (3 + 3 + 2) * word;  ///< origin, direction, where it starts
constexpr std::uint64_t hit_bytes = (SAHL_HIT_FLOATS + SAHL_HIT_UINTS) * word;
constexpr std::uint64_t color_bytes = 3 * word;
constexpr std::uint64_t triangle_bytes = 9 * word;  ///< the least that shading reads of a shape

/// Box test, shear, check and range of a ray before its first node, ray by ray.
constexpr std::uint64_t ray_flop = 24 + 2 + 10 + 1;

std::uint64_t visited_bytes(const KernelVisits& visits) {
    return visits.nodes * sizeof(device::BvhNode) + visits.leaf_bytes;
}

std::uint64_t shade_bytes(const GenerationWork& work) {
    const std::uint64_t of_ray = ray_bytes + hit_bytes + color_bytes + word + word;  // pixel, outcome
    const std::uint64_t of_light = sizeof(device::DeviceLight) + color_bytes;
    const std::uint64_t of_hit = sizeof(device::DevicePrimitive) + sizeof(device::DeviceMaterial) +
                                 triangle_bytes + SAHL_SURFACE_FLOATS * word + work.lights * of_light;
    return work.rays * of_ray + work.visits.hits * of_hit + work.children * ray_bytes;
}

std::uint64_t shadow_bytes(const GenerationWork& work) {
    const std::uint64_t of_slot = work.lights * word;  // outcomes, lamp by lamp
    const std::uint64_t of_ray =
        2 * (color_bytes + SAHL_SURFACE_FLOATS * word + sizeof(device::DeviceLight) + SAHL_HIT_UINTS * word) +
        2 * color_bytes;
    return work.rays * of_slot + work.shadow_rays * of_ray + visited_bytes(work.visits.shadow);
}

}  // namespace

DeclaredCost declared_cost(std::string_view kernel, const GenerationWork& work) {
    const std::uint64_t blocks = (work.rays + SAHL_COMPACT_BLOCK - 1) / SAHL_COMPACT_BLOCK;
    if (kernel == "generate") return {work.rays * ray_bytes};
    if (kernel == "intersect") {
        return {work.rays * (traced_bytes + hit_bytes) + visited_bytes(work.visits.intersect),
                work.rays * ray_flop + work.visits.intersect.flop};
    }
    if (kernel == "shade") return {shade_bytes(work)};
    if (kernel == "shadow")
        return {shadow_bytes(work), work.shadow_rays * ray_flop + work.visits.shadow.flop};
    if (kernel == "count_children") return {work.rays * word + blocks * 3 * word, 0};
    if (kernel == "sum_children") return {blocks * 5 * word + 3 * word, 0};
    if (kernel == "compact") return {work.rays * word + blocks * 2 * word + work.children * 2 * ray_bytes, 0};
    return {0};
}

}  // namespace sahl
