#include <functional>
#include <vector>

#include <catch2/catch.hpp>

#include "engine/scene/load.h"
#include "engine/scene/scene_hash.h"
#include "tests/host/scene/parse.h"

namespace sahl::tests {

TEST_CASE("scene hash: changes with all that makes pixels, and not with names and image sizes", "[scene]") {
    const Scene scene = load_scene(own_scene("all_features.json"));
    const auto hash_after = [&](const std::function<void(Scene&)>& change) {
        Scene changed = scene;
        change(changed);
        return hash_without_cameras(changed);
    };
    const std::uint64_t hash = hash_without_cameras(scene);
    CHECK(hash == hash_without_cameras(load_scene(own_scene("all_features.json"))));
    CHECK(hash_after([](Scene& s) { s.cameras.front().eye.x += 1; }) == hash);
    CHECK(hash_after([](Scene& s) { s.resolution.width += 1; }) == hash);

    const std::vector<std::function<void(Scene&)>> changes{
        [](Scene& s) { s.background.x += 0.125F; },
        [](Scene& s) { s.materials.back().shininess += 1; },
        [](Scene& s) { s.textures.back().colors[1].y += 0.125F; },
        [](Scene& s) { s.lights.back().position.z += 1; },
        [](Scene& s) { s.primitives.back().material ^= 1; },
        [](Scene& s) { s.instances.pop_back(); },
        [](Scene& s) { s.triangles.back().smooth = !s.triangles.back().smooth; },
        [](Scene& s) { s.spheres.back().radius *= 2; },
        [](Scene& s) { s.vertices.back().y += 1; },
    };
    for (std::size_t i = 0; i < changes.size(); ++i) {
        INFO("change " << i);
        CHECK(hash_after(changes[i]) != hash);
    }
}

TEST_CASE("scene hash: with a camera it changes where that looks from, and not with its name", "[scene]") {
    const Scene scene = load_scene(own_scene("all_features.json"));
    const Camera& camera = scene.cameras.front();
    Camera renamed = camera;
    renamed.name += "x";
    CHECK(hash_with_camera(scene, renamed) == hash_with_camera(scene, camera));
    Camera moved = camera;
    moved.eye.y += 1e-12;
    CHECK(hash_with_camera(scene, moved) != hash_with_camera(scene, camera));
    CHECK(hash_with_camera(scene, camera) != hash_without_cameras(scene));
}

}  // namespace sahl::tests
