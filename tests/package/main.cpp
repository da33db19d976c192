// Renders a glowing sphere before a coloured background with the installed engine, prints its two colours,
// which are exact, and writes image.png.
#include <iostream>

#include <engine/sahl.h>

namespace {

void print_pixel(const char* name, const sahl::Image& image, int x, int y) {
    const float* rgb = image.pixels.data() + 3 * (y * image.width + x);
    std::cout << name << ' ' << rgb[0] << ' ' << rgb[1] << ' ' << rgb[2] << '\n';
}

}  // namespace

int main() try {
    sahl::Scene scene;
    scene.cameras[0].eye = {0, 0, 5};
    scene.cameras[0].look_at = {0, 0, 0};
    scene.background = {0.125F, 0.25F, 0.5F};
    sahl::Material glow;
    glow.emission = {0.5F, 0.25F, 1.0F};
    scene.materials.push_back(glow);
    scene.spheres.push_back({});
    sahl::Primitive sphere;
    sphere.kind = sahl::PrimitiveKind::sphere;
    scene.primitives.push_back(sphere);

    sahl::Device device;
    sahl::Renderer renderer(device, scene);
    sahl::RenderSettings settings;
    settings.resolution = {33, 33};
    sahl::Film film(device.memory(), 33, 33);
    renderer.render(settings, film);
    const sahl::Image image = film.resolve(settings.spp);
    print_pixel("centre", image, 16, 16);
    print_pixel("corner", image, 0, 0);
    sahl::write_image("image.png", image, {});
    return 0;
} catch (const sahl::Error& error) {
    std::cerr << error.what() << '\n';
    return static_cast<int>(error.code());
}
