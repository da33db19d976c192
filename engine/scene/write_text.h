// What all scene writers share: numbers as text, and the refusal of what a format has no words for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <glm/vec3.hpp>

#include "engine/scene/scene.h"

namespace sahl {

/// The shortest decimal text that readers of double and then float turn into the same float again.
std::string decimal(float x);
/// The shortest decimal text that is read as the same double again.
std::string decimal(double x);

/// The three components with `separator` in between.
std::string decimals(glm::vec3 v, std::string_view separator = " ");
std::string decimals(glm::dvec3 v, std::string_view separator = " ");

/// A vector that is a unit normal again, bit for bit, after a loader has normalised it in double and
/// made it float: a point of the unit sphere that rounds to `normal`. Throws Error(scene) naming
/// `format` if there is none, because `normal` is no unit vector.
glm::dvec3 before_normalizing(glm::vec3 normal, std::string_view format);

/// A vector that is the direction `unit` again, bit for bit, after a loader has normalised it. Throws
/// Error(scene) if there is none, because `unit` is no unit vector.
glm::dvec3 before_normalizing(glm::dvec3 unit);

/// "object 3 (a sphere)": a primitive for a message, counted from 1 in the order of Scene::primitives.
std::string object_text(const Scene& scene, std::size_t primitive);

/// "material 'red'", or "the material of object 3 (a sphere)" where it has no name.
std::string material_text(const Scene& scene, std::uint32_t material);

/// Throws Error(scene) "`format` `lacks`; write .json, which has everything".
[[noreturn]] void cannot_express(std::string_view format, std::string_view lacks);

}  // namespace sahl
