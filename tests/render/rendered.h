// The real renderer on the default device, for tests of whole images.
#pragma once

#include <cstddef>

#include <glm/vec3.hpp>

#include "engine/render/renderer.h"
#include "tests/support/oracle_render.h"

namespace sahl::tests {

/// An image that the engine rendered, and what it counted on the way.
struct Rendered {
    Image image;
    RenderStatistics statistics;

    glm::dvec3 at(int x, int y) const;
};

/// One sample a pixel, `size` x `size` pixels.
RenderSettings square_settings(int size, int depth);

Rendered render(const Scene& scene, const RenderSettings& settings);

/// The same with an existing renderer (kernels compiled, scene uploaded).
Rendered render(Renderer& renderer, const RenderSettings& settings);

/// The device that all tests of a process share.
Device& test_device();

/// The oracle's camera ray through the centre of pixel (x, y).
oracle::Ray pixel_ray(const Scene& scene, const RenderSettings& settings, int x, int y);

/// Where `ray` meets the plane z = `height`.
glm::dvec3 meet_plane(const oracle::Ray& ray, double height);

/// Whether all channels agree to `tolerance`, relative above 1 and absolute below.
bool close(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-5);

}  // namespace sahl::tests
