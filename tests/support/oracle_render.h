// Whole images by the oracle.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/oracle/camera.h"
#include "engine/oracle/oracle.h"

namespace sahl::oracle {

/// Whether render() looks for pixels whose rays pass close to an edge, at five times the cost.
enum class EdgeSearch { off, on };

struct Rendering {
    Resolution resolution;
    std::vector<glm::dvec3> pixels;       ///< row-major from the top left
    std::vector<Counts> generations;      ///< sums over all pixels
    std::vector<std::uint8_t> near_edge;  ///< per pixel, empty when not searched
    std::size_t near_edge_count = 0;
};

/// One ray through each pixel's centre. A pixel is near an edge when a ray whose direction is
/// turned by 1e-4 rad towards one of four diagonals takes another decision anywhere in its tree:
/// another primitive, side, shadow, refraction or total reflection.
Rendering render(const Oracle& oracle, Resolution resolution, int depth, EdgeSearch search = EdgeSearch::off);

}  // namespace sahl::oracle
