// Short words for the scenes that tests are made of.
#pragma once

#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "engine/scene/scene.h"

namespace sahl::oracle {

/// Each adds one object with a material of its own and returns its primitive id. They add to the
/// world until add_group() was called, then to the last group.
std::uint32_t add_sphere(Scene& scene, const Sphere& sphere, const Material& material,
                         const glm::dmat4& world_from_object = glm::dmat4(1));
std::uint32_t add_cone(Scene& scene, const Cone& cone, const Material& material,
                       const glm::dmat4& world_from_object = glm::dmat4(1));
std::uint32_t add_triangle(Scene& scene, const std::vector<glm::vec3>& corners, const Material& material,
                           const glm::dmat4& world_from_object = glm::dmat4(1),
                           const std::vector<glm::vec3>& normals = {});
std::uint32_t add_polygon(Scene& scene, const std::vector<glm::vec3>& corners, const Material& material,
                          const glm::dmat4& world_from_object = glm::dmat4(1));

std::uint32_t add_disc(Scene& scene, const Disc& disc, const Material& material,
                       const glm::dmat4& world_from_object = glm::dmat4(1));
std::uint32_t add_box(Scene& scene, const Box& box, const Material& material,
                      const glm::dmat4& world_from_object = glm::dmat4(1));

/// An empty group; returns its index.
std::uint32_t add_group(Scene& scene);
/// An instance of `group` in the world, or in the group `parent`.
void add_instance(Scene& scene, std::uint32_t group, const glm::dmat4& transform);
void add_instance(Scene& scene, std::uint32_t parent, std::uint32_t group, const glm::dmat4& transform);

/// A square in z = `height`, half side `half`, front towards +z.
std::uint32_t add_square(Scene& scene, float height, float half, const Material& material,
                         const glm::dmat4& world_from_object = glm::dmat4(1));

Light point_light(const glm::dvec3& position, const glm::vec3& color = glm::vec3(1),
                  const glm::vec3& attenuation = {1, 0, 0});
Light directional_light(const glm::dvec3& towards, const glm::vec3& color = glm::vec3(1));

/// Angles in degrees from `direction`.
Light spot_light(const glm::dvec3& position, const glm::dvec3& direction, double inner_angle,
                 double outer_angle, const glm::vec3& color = glm::vec3(1));

/// Index of a texture added to the scene.
std::uint32_t add_texture(Scene& scene, const Texture& texture);

/// Materials of one term.
Material emitting(const glm::vec3& emission);
Material matte(const glm::vec3& diffuse);
Material mirror(const glm::vec3& reflection);
Material glass(const glm::vec3& transmission, float ior);

}  // namespace sahl::oracle
