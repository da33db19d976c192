#include "tests/render/rendered.h"

#include <algorithm>
#include <cmath>

namespace sahl::tests {

glm::dvec3 Rendered::at(int x, int y) const {
    const std::size_t first = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                   static_cast<std::size_t>(x));
    return {image.pixels.at(first), image.pixels.at(first + 1), image.pixels.at(first + 2)};
}

RenderSettings square_settings(int size, int depth) {
    RenderSettings settings;
    settings.resolution = {size, size};
    settings.depth = depth;
    return settings;
}

Device& test_device() {
    static Device device;
    return device;
}

Rendered render(const Scene& scene, const RenderSettings& settings) {
    Renderer renderer(test_device(), scene);
    return render(renderer, settings);
}

Rendered render(Renderer& renderer, const RenderSettings& settings) {
    const Crop whole{0, 0, settings.resolution.width, settings.resolution.height};
    const Crop crop = settings.crop.value_or(whole);
    Film film(test_device().memory(), crop.x1 - crop.x0, crop.y1 - crop.y0);
    Rendered result;
    result.statistics = renderer.render(settings, film);
    result.image = film.resolve(settings.spp);
    return result;
}

oracle::Ray pixel_ray(const Scene& scene, const RenderSettings& settings, int x, int y) {
    return oracle::camera_ray(scene.cameras[0], settings.resolution, x + 0.5, y + 0.5);
}

glm::dvec3 meet_plane(const oracle::Ray& ray, double height) {
    return ray.origin + (height - ray.origin.z) / ray.direction.z * ray.direction;
}

bool close(const glm::dvec3& a, const glm::dvec3& b, double tolerance) {
    for (int channel = 0; channel < 3; ++channel) {
        const double size = std::max({1.0, std::abs(a[channel]), std::abs(b[channel])});
        if (!(std::abs(a[channel] - b[channel]) <= tolerance * size)) return false;
    }
    return true;
}

}  // namespace sahl::tests
