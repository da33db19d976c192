#include "engine/batch/key_frames.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace sahl {
namespace {

/// The slope at key `i`: 0 at a turning point and at the ends of what stands still, else the weighted
/// harmonic mean of the slopes on both sides (Fritsch and Butland's form), which keeps each piece monotone.
double slope(const KeyFrames& keys, std::size_t i, int axis) {
    const auto secant = [&](std::size_t k) {
        return (keys.values[k + 1][axis] - keys.values[k][axis]) / (keys.frames[k + 1] - keys.frames[k]);
    };
    if (i == 0) return secant(0);
    if (i + 1 == keys.frames.size()) return secant(i - 1);
    const double before = secant(i - 1);
    const double behind = secant(i);
    if (before * behind <= 0) return 0;
    const double h0 = keys.frames[i] - keys.frames[i - 1];
    const double h1 = keys.frames[i + 1] - keys.frames[i];
    return 3 * (h0 + h1) / ((2 * h1 + h0) / before + (h1 + 2 * h0) / behind);
}

double hermite(const KeyFrames& keys, std::size_t i, double t, int axis) {
    const double width = keys.frames[i + 1] - keys.frames[i];
    const double a = keys.values[i][axis];
    const double b = keys.values[i + 1][axis];
    const double da = width * slope(keys, i, axis);
    const double db = width * slope(keys, i + 1, axis);
    const double t2 = t * t;
    const double t3 = t2 * t;
    return a * (2 * t3 - 3 * t2 + 1) + da * (t3 - 2 * t2 + t) + b * (3 * t2 - 2 * t3) + db * (t3 - t2);
}

}  // namespace

glm::dvec3 KeyFrames::at(double frame) const {
    const auto next = std::upper_bound(frames.begin(), frames.end(), frame);
    if (next == frames.begin()) return values.front();
    const auto i = static_cast<std::size_t>(next - frames.begin()) - 1;
    // At a key the value is the key's, whatever rounding would make of it.
    if (next == frames.end() || frames[i] == frame) return values[i];
    const double t = (frame - frames[i]) / (frames[i + 1] - frames[i]);
    if (interpolation == Interpolation::linear) return values[i] + t * (values[i + 1] - values[i]);
    glm::dvec3 result(0);
    for (int axis = 0; axis < 3; ++axis) result[axis] = hermite(*this, i, t, axis);
    return result;
}

}  // namespace sahl
