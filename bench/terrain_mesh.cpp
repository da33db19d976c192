#include "bench/mesh_builder.h"
#include "bench/noise.h"
#include "bench/scenes.h"

namespace sahl::bench {
namespace {

BenchScene make_terrain(const char* name, int cells) {
    constexpr float size = 10;
    const auto place = [cells](int i) {
        return size * (static_cast<float>(i) / static_cast<float>(cells) - 0.5F);
    };
    Scene scene = empty_scene({0.5, 1.9, 5.2}, {0, 0.1, 0}, 45, {3, 4, -2});
    add_grid(scene, cells, cells, [&](int column, int row) {
        const float x = place(column);
        const float z = place(row);
        return glm::vec3(x, 0.6F * fractal_noise({0.6F * x, 0.35F, 0.6F * z}, 10), z);
    });
    return {name, std::move(scene)};
}

}  // namespace

BenchScene terrain_mesh() { return make_terrain("terrain", 800); }

BenchScene large_terrain_mesh() { return make_terrain("large terrain", 2237); }

}  // namespace sahl::bench
