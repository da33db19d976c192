#include "tests/render/oracle_image.h"

#include <algorithm>

#include <catch2/catch.hpp>
#include <glm/common.hpp>

namespace sahl::tests {

Comparison compare(const Rendered& rendered, const oracle::Rendering& expected, double tolerance) {
    Comparison result;
    std::size_t pixel = 0;
    for (int y = 0; y < expected.resolution.height; ++y) {
        for (int x = 0; x < expected.resolution.width; ++x, ++pixel) {
            if (expected.near_edge[pixel] != 0) continue;
            ++result.compared;
            const glm::dvec3 difference = glm::abs(rendered.at(x, y) - expected.pixels[pixel]);
            result.mean += (difference.x + difference.y + difference.z) / 3;
            if (!close(rendered.at(x, y), expected.pixels[pixel], tolerance)) ++result.wrong;
        }
    }
    result.mean /= result.compared;
    return result;
}

void check_counts(const RenderStatistics& statistics, const std::vector<oracle::Counts>& expected,
                  double relative, double undecided) {
    REQUIRE(statistics.generations.size() == expected.size());
    for (std::size_t generation = 0; generation < expected.size(); ++generation) {
        const auto allowed = [&](std::uint64_t count) {
            return std::max(relative * static_cast<double>(count), undecided);
        };
        const GenerationCounts& found = statistics.generations[generation];
        INFO("generation " << generation << ": " << found.rays << " rays, " << found.shadow_rays
                           << " shadow rays; oracle " << expected[generation].rays << ", "
                           << expected[generation].shadow_rays);
        const auto distance = [](std::uint64_t a, std::uint64_t b) {
            return static_cast<double>(a > b ? a - b : b - a);
        };
        CHECK(distance(found.rays, expected[generation].rays) <= allowed(expected[generation].rays));
        CHECK(distance(found.shadow_rays, expected[generation].shadow_rays) <=
              allowed(expected[generation].shadow_rays));
    }
}

}  // namespace sahl::tests
