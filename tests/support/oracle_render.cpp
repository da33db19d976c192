#include "tests/support/oracle_render.h"

#include <cmath>

#include <tbb/parallel_for.h>
#include <glm/geometric.hpp>

namespace sahl::oracle {
namespace {

using glm::dvec3;

bool decides_otherwise_nearby(const Oracle& oracle, const Ray& ray, int depth, std::uint64_t signature) {
    constexpr double turn = 1e-4;
    const dvec3 other = std::abs(ray.direction.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 first = glm::normalize(glm::cross(ray.direction, other));
    const dvec3 second = glm::cross(ray.direction, first);
    for (const double a : {-turn, turn}) {
        for (const double b : {-turn, turn}) {
            const dvec3 turned = ray.direction + std::sqrt(0.5) * (a * first + b * second);
            if (oracle.trace({ray.origin, turned}, depth).signature != signature) return true;
        }
    }
    return false;
}

}  // namespace

Rendering render(const Oracle& oracle, Resolution resolution, int depth, EdgeSearch search) {
    Rendering result;
    result.resolution = resolution;
    const auto width = static_cast<std::size_t>(resolution.width);
    const auto height = static_cast<std::size_t>(resolution.height);
    result.pixels.resize(width * height);
    if (search == EdgeSearch::on) result.near_edge.resize(width * height);
    std::vector<std::vector<Counts>> row_counts(height,
                                                std::vector<Counts>(static_cast<std::size_t>(depth) + 1));

    tbb::parallel_for(std::size_t{0}, height, [&](std::size_t y) {
        for (std::size_t x = 0; x < width; ++x) {
            const Ray ray = camera_ray(oracle.scene().cameras[0], resolution, static_cast<double>(x) + 0.5,
                                       static_cast<double>(y) + 0.5);
            const PathRecord record = oracle.trace(ray, depth);
            for (std::size_t generation = 0; generation < record.counts.size(); ++generation) {
                result.pixels[y * width + x] += record.radiance[generation];
                row_counts[y][generation].rays += record.counts[generation].rays;
                row_counts[y][generation].shadow_rays += record.counts[generation].shadow_rays;
            }
            if (search == EdgeSearch::on) {
                result.near_edge[y * width + x] =
                    decides_otherwise_nearby(oracle, ray, depth, record.signature) ? 1 : 0;
            }
        }
    });

    result.generations.resize(static_cast<std::size_t>(depth) + 1);
    for (const std::vector<Counts>& row : row_counts) {
        for (std::size_t generation = 0; generation < row.size(); ++generation) {
            result.generations[generation].rays += row[generation].rays;
            result.generations[generation].shadow_rays += row[generation].shadow_rays;
        }
    }
    for (const std::uint8_t flag : result.near_edge) result.near_edge_count += flag;
    return result;
}

}  // namespace sahl::oracle
