#include "bench/mesh_builder.h"
#include "bench/noise.h"
#include "bench/scenes.h"

namespace sahl::bench {

BenchScene terrain_mesh() {
    constexpr int cells = 800;
    constexpr float size = 10;
    Scene scene = empty_scene({0.5, 1.9, 5.2}, {0, 0.1, 0}, 45, {3, 4, -2});
    add_grid(scene, cells, cells, [](int column, int row) {
        const float x = size * (static_cast<float>(column) / cells - 0.5F);
        const float z = size * (static_cast<float>(row) / cells - 0.5F);
        return glm::vec3(x, 0.6F * fractal_noise({0.6F * x, 0.35F, 0.6F * z}, 10), z);
    });
    return {"terrain", std::move(scene)};
}

}  // namespace sahl::bench
