#include "bench/mesh_builder.h"
#include "bench/noise.h"
#include "bench/scenes.h"

namespace sahl::bench {

BenchScene organic_mesh() {
    Scene scene = empty_scene({0.3, 0.6, 2.7}, {0, 0, 0}, 45, {2.5, 3, 2.5});
    add_icosphere(scene, 7, [](glm::vec3 direction) {
        return direction * (1 + 0.28F * fractal_noise(2.0F * direction + glm::vec3(7.3F), 6));
    });
    return {"organic", std::move(scene)};
}

}  // namespace sahl::bench
