#include "engine/render/camera_constants.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "engine/render/two_floats.h"

namespace sahl {
namespace {

void split3(float (&high)[3], float (&low)[3], const glm::dvec3& from) {
    for (int k = 0; k < 3; ++k) {
        const TwoFloats parts = split(from[k]);
        high[k] = parts.high;
        low[k] = parts.low;
    }
}

}  // namespace

device::CameraConstants camera_constants(const Camera& camera, const Resolution& resolution) {
    const glm::dvec3 w = glm::normalize(camera.eye - camera.look_at);
    const glm::dvec3 u = glm::normalize(glm::cross(camera.up, w));
    const glm::dvec3 v = glm::cross(w, u);
    const double pixel = 2 * std::tan(camera.fov_y * std::numbers::pi / 360) / resolution.height;
    device::CameraConstants out{};
    split3(out.eye, out.eye_low, camera.eye);
    split3(out.forward, out.forward_low, -w);
    split3(out.step_x, out.step_x_low, u * pixel);
    split3(out.step_y, out.step_y_low, v * -pixel);
    out.half_width = static_cast<float>(resolution.width) / 2;
    out.half_height = static_cast<float>(resolution.height) / 2;
    return out;
}

}  // namespace sahl
