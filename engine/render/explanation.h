// Where the light of a pixel comes from: its ray tree, ray by ray.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace sahl {

/// A sum of the film: colour in units of 2^-32, see Film.
using FixedColor = std::array<std::int64_t, 3>;

/// What a light brings to where a ray ends, with the ray's weight.
struct ExplainedLight {
    glm::vec3 unshadowed{0};  ///< as if nothing were in between
    glm::vec3 arriving{0};    ///< what comes through; by itself, before it is added to the others'
};

/// Where a ray comes from.
enum class RayOrigin : std::uint8_t { camera, reflection, transmission };

struct ExplainedRay {
    RayOrigin from = RayOrigin::camera;
    std::uint32_t generation = 0;  ///< 0: the camera's
    std::uint32_t parent = 0;      ///< in Explanation::rays; of camera rays: themselves
    std::uint32_t sample = 0;      ///< of the pixel
    glm::vec3 origin{0};           ///< off the surface that it leaves
    glm::vec3 direction{0};
    glm::vec3 weight{0};        ///< of the light that it finds, a mirror's attenuation left out
    float t = 0;                ///< where it ends, in lengths of `direction`; infinite: it meets nothing
    std::uint32_t primitive{};  ///< that it meets, index in Scene::primitives, or no_aov_id
    std::uint32_t instance{};   ///< as the AOV has it, or no_aov_id
    glm::vec3 own{0};           ///< ambient light and emission, or the background, with the weight
    std::vector<ExplainedLight> lights{};  ///< one for each of the scene; none where nothing is met
    glm::vec3 contribution{0};             ///< `own` and all arriving light: what the film gets
    FixedColor fixed{};                    ///< `contribution` as the film adds it up
};

/// Generation by generation, parents before their children.
struct Explanation {
    std::vector<ExplainedRay> rays;
    /// What the film has of the pixel, exactly: the sum of all `fixed`.
    FixedColor sum{};
};

}  // namespace sahl
