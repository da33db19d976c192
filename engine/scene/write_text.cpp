#include "engine/scene/write_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "engine/core/error.h"

namespace sahl {

std::string decimal(float x) {
    std::string text = fmt::format("{}", x);
    // A float between two doubles: read as double first, its shortest text may become its neighbour.
    double read = 0;
    std::from_chars(text.data(), text.data() + text.size(), read);
    if (static_cast<float>(read) != x) text = fmt::format("{}", static_cast<double>(x));
    return text;
}

std::string decimal(double x) { return fmt::format("{}", x); }

std::string decimals(glm::vec3 v, std::string_view separator) {
    return fmt::format("{1}{0}{2}{0}{3}", separator, decimal(v.x), decimal(v.y), decimal(v.z));
}

std::string decimals(glm::dvec3 v, std::string_view separator) {
    return fmt::format("{1}{0}{2}{0}{3}", separator, decimal(v.x), decimal(v.y), decimal(v.z));
}

glm::dvec3 before_normalizing(glm::vec3 normal, std::string_view format) {
    const glm::dvec3 middle(normal);
    if (glm::vec3(glm::normalize(middle)) == normal) return middle;
    // What rounds to `normal` is a box about it. Along the diagonal from its corner nearest to the
    // origin to its farthest the length grows from below 1 to above 1.
    glm::dvec3 near_corner = middle;
    glm::dvec3 far_corner = middle;
    for (int i = 0; i < 3; ++i) {
        if (normal[i] == 0) continue;
        const float outwards = normal[i] > 0 ? 2.0F : -2.0F;
        near_corner[i] += 0.499 * (static_cast<double>(std::nextafter(normal[i], 0.0F)) - middle[i]);
        far_corner[i] += 0.499 * (static_cast<double>(std::nextafter(normal[i], outwards)) - middle[i]);
    }
    constexpr int halvings = 60;
    double low = 0;
    double high = 1;
    for (int i = 0; i < halvings; ++i) {
        const double t = (low + high) / 2;
        (glm::length(near_corner + t * (far_corner - near_corner)) < 1 ? low : high) = t;
    }
    const glm::dvec3 on_sphere = near_corner + low * (far_corner - near_corner);
    if (glm::vec3(glm::normalize(on_sphere)) != normal) {
        cannot_express(format, fmt::format("makes normals unit length, and the length of {} is {:g}",
                                           decimals(normal), glm::length(middle)));
    }
    return on_sphere;
}

glm::dvec3 before_normalizing(glm::dvec3 unit) {
    // Rounding differs with the length; one of a few lengths gives all three components.
    constexpr int lengths = 4096;
    for (int i = 0; i < lengths; ++i) {
        const glm::dvec3 v = unit * (1 + i * 0.001);
        if (glm::normalize(v) == unit) return v;
    }
    throw Error(ExitCode::scene,
                fmt::format("the direction {} has the length {:g}, and scene files only hold "
                            "directions of length 1; normalise it",
                            decimals(unit), glm::length(unit)));
}

std::string object_text(const Scene& scene, std::size_t primitive) {
    const Primitive& p = scene.primitives[primitive];
    constexpr std::array<std::string_view, 6> kinds = {"a triangle", "a polygon", "a sphere",
                                                       "a cone",     "a disc",    "a box"};
    std::string_view kind = kinds[static_cast<std::size_t>(p.kind)];
    if (p.kind == PrimitiveKind::cone && scene.cones[p.index].base_radius == scene.cones[p.index].apex_radius)
        kind = "a cylinder";
    return fmt::format("object {} ({})", primitive + 1, kind);
}

std::string material_text(const Scene& scene, std::uint32_t material) {
    if (!scene.materials[material].name.empty())
        return fmt::format("material '{}'", scene.materials[material].name);
    const auto& all = scene.primitives;
    const auto user =
        std::find_if(all.begin(), all.end(), [&](const Primitive& p) { return p.material == material; });
    if (user == all.end()) return fmt::format("material {}, which nothing uses", material + 1);
    return "the material of " + object_text(scene, static_cast<std::size_t>(user - all.begin()));
}

void cannot_express(std::string_view format, std::string_view lacks) {
    throw Error(ExitCode::scene, fmt::format("{} {}; write .json, which has everything", format, lacks));
}

}  // namespace sahl
