#include "engine/self_test/every_feature.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include "engine/oracle/build_scene.h"

namespace sahl {
namespace {

using glm::dmat4;
using glm::dvec3;
using glm::vec3;

dmat4 placed(const dvec3& position, double degrees, const dvec3& axis, const dvec3& scale) {
    return glm::scale(glm::rotate(glm::translate(dmat4(1), position), glm::radians(degrees), axis), scale);
}

Material painted(const vec3& color, std::uint32_t texture) {
    Material material;
    material.ambient = 0.3F * color;
    material.diffuse = color;
    material.specular = vec3(0.3F);
    material.shininess = 15;
    material.textures.diffuse = material.textures.ambient = texture;
    return material;
}

/// Two textures of a kind by (u, v): a checker and a gradient.
struct Textures {
    std::uint32_t floor, cells, fade, haze;
};

Textures add_textures(Scene& scene) {
    Texture texture;
    texture.colors[0] = {0.9F, 0.8F, 0.7F};
    texture.colors[1] = {0.2F, 0.1F, 0.1F};
    texture.extent = {0.7, 0.9, 0};
    texture.origin = {0.1, 0.2, 0};
    Textures textures{};
    textures.floor = oracle::add_texture(scene, texture);
    texture.space = TextureSpace::uv;
    texture.extent = {0.125, 0.25, 0};
    textures.cells = oracle::add_texture(scene, texture);
    texture.pattern = Pattern::gradient;
    texture.extent = {0.3, 0.9, 0};
    textures.fade = oracle::add_texture(scene, texture);
    texture.space = TextureSpace::position;
    texture.extent = {1, 0.5, 1.5};
    textures.haze = oracle::add_texture(scene, texture);
    return textures;
}

void add_world(Scene& scene, const Textures& textures) {
    Material floor = painted({0.7F, 0.7F, 0.6F}, textures.floor);
    floor.reflection = vec3(0.5F);
    floor.reflection_attenuation = {1, 0.2F, 0.1F};
    floor.textures.reflection = textures.haze;
    oracle::add_square(scene, 0, 7, floor);
    Material glass = oracle::glass({0.8F, 0.9F, 0.9F}, 1.5F);
    glass.reflection = vec3(0.1F);
    glass.ior_outside = 1.2F;
    glass.reflection_attenuation = {0.8F, 0.1F, 0};
    oracle::add_box(scene, {{-2.4, -2.2, 0.02}, {-1.4, -1.6, 0.9}}, glass);
    oracle::add_sphere(scene, {{0.1, -2, 0.55}, 0.5}, glass);
    oracle::add_cone(scene, {{1.3, -2, 0.02}, {1.5, -1.9, 0.9}, 0.5, 0.2, true}, glass);
    oracle::add_disc(scene, {{-2.9, 0.2, 1.3}, {1, -1, 0.2}, 0.7},
                     painted({0.5F, 0.6F, 0.9F}, textures.cells));
    oracle::add_sphere(scene, {{0, 0, 0}, 1}, painted({0.9F, 0.5F, 0.4F}, textures.cells),
                       placed({2.8, 0.3, 0.8}, 70, {1, 1, 0}, {0.6, 0.7, 0.5}));
    oracle::add_cone(scene, {{0, 0, 0}, {0, 0, 1.3}, 0.2, 0.5}, painted({0.5F, 0.8F, 0.4F}, textures.fade),
                     placed({-1.2, 0.4, 0.05}, 10, {1, 0, 0}, {1, -1, 1}));
    // From behind it is not there, nor does it throw a shadow from there.
    oracle::add_disc(scene, {{0.4, -3.4, 0.4}, {0, 1, 0}, 0.3}, oracle::matte({1, 0, 0}));
    scene.primitives.back().sides = Sides::front;
    oracle::add_box(scene, {{-7, -8, -1}, {7, 6, 6}}, painted({0.5F, 0.5F, 0.6F}, textures.haze));
    scene.primitives.back().sides = Sides::back;
    Material glow;
    glow.emission = {0.3F, 0.3F, 0.1F};
    glow.diffuse = vec3(0.4F);
    glow.textures.emission = textures.fade;
    oracle::add_triangle(scene, {{-3, 1.5F, 0.2F}, {-1, 2, 0.3F}, {-2, 1.6F, 1.8F}}, glow, dmat4(1),
                         {{0, -1, 0}, {0.5F, -1, 0}, {0, -1, 0.5F}});
    scene.uvs = {{0, 0}, {1, 0.2F}, {0.3F, 1}};
    for (std::uint32_t i = 0; i < 3; ++i) scene.triangles.back().uvs[i] = i;
    scene.triangles.back().has_uv = true;
}

void add_groups(Scene& scene, const Textures& textures) {
    const std::uint32_t pillar = oracle::add_group(scene);
    Material column = painted({0.8F, 0.8F, 0.5F}, textures.cells);
    column.reflection = vec3(0.2F);
    oracle::add_cone(scene, {{0, 0, 0}, {0, 0, 1}, 0.25, 0.25, true}, column);
    oracle::add_box(scene, {{-0.3, -0.3, 1.02}, {0.3, 0.3, 1.15}},
                    painted({0.6F, 0.4F, 0.3F}, textures.cells));
    Material one_sided = painted({0.3F, 0.5F, 0.8F}, textures.cells);
    one_sided.specular_model = SpecularModel::blinn;
    one_sided.two_sided = false;
    oracle::add_triangle(scene, {{-0.4F, 0, 0.9F}, {0.4F, 0, 0.9F}, {0, -0.3F, 1.5F}}, one_sided,
                         placed({0, 0, 0}, 20, {0, 0, 1}, {-1, 1, 1}));
    const std::uint32_t row = oracle::add_group(scene);
    oracle::add_polygon(
        scene, {{-0.2F, -0.4F, 1.2F}, {2, -0.4F, 1.2F}, {2, 0.4F, 1.2F}, {1, 0, 1.2F}, {-0.2F, 0.4F, 1.2F}},
        painted({0.7F, 0.3F, 0.6F}, textures.cells));
    oracle::add_instance(scene, row, pillar, dmat4(1));
    oracle::add_instance(scene, row, pillar, placed({1.6, 0, 0}, 30, {0, 0, 1}, {1, -1.3, 1}));
    Material clear = oracle::glass({0.9F, 0.6F, 0.6F}, 1.3F);
    const std::uint32_t lens = oracle::add_group(scene);
    oracle::add_sphere(scene, {{0, 0, 0}, 1}, clear);
    dmat4 sheared = placed({0.2, 2, 0.05}, 10, {0, 0, 1}, {0.9, 0.8, 1.2});
    sheared[2] += 0.3 * sheared[0];
    oracle::add_instance(scene, row, sheared);
    oracle::add_instance(scene, row, placed({-0.6, -0.9, 0.02}, 160, {0, 0, 1}, {0.5, 0.5, 0.5}));
    oracle::add_instance(scene, lens, placed({2.5, -1.6, 0.7}, 40, {0, 1, 1}, {0.2, 0.5, 0.6}));
}

}  // namespace

Scene every_feature() {
    Scene scene;
    scene.cameras[0] = {{0.4, -7, 3.5}, {0, 0, 0.7}, {0, 0, 1}, 42};
    scene.background = {0.1F, 0.2F, 0.4F};
    scene.ambient = {0.5F, 0.6F, 0.7F};
    Light spot = oracle::spot_light({-3, -4, 4.5}, {2, 3, -4}, 15, 30, {8, 8, 6});
    spot.attenuation = {0.5F, 0.1F, 0.1F};
    scene.lights = {oracle::point_light({4, -5, 5}, {14, 13, 12}, {1, 0.1F, 0.5F}),
                    oracle::directional_light({-2, -1, 3}, {0.3F, 0.3F, 0.4F}), spot};
    const Textures textures = add_textures(scene);
    add_world(scene, textures);
    add_groups(scene, textures);
    return scene;
}

}  // namespace sahl
