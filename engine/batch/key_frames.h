// Values given at some frames, and in between.
#pragma once

#include <vector>

#include <glm/vec3.hpp>

namespace sahl {

enum class Interpolation {
    linear,
    /// Monotone cubic (Fritsch and Carlson, SIAM J. Numer. Anal. 17, 1980): no corner at a key, and no value
    /// beyond those of the keys around it.
    smooth,
};

/// A number (x alone counts) or a vector as a function of the frame.
struct KeyFrames {
    bool is_vector = false;
    Interpolation interpolation = Interpolation::linear;
    std::vector<double> frames;      ///< ascending, at least one
    std::vector<glm::dvec3> values;  ///< as many

    /// Before the first key and behind the last their values hold.
    glm::dvec3 at(double frame) const;
};

}  // namespace sahl
