#include "bench/scenes.h"

namespace sahl::bench {

std::span<const SceneMaker> mesh_makers() {
    static constexpr SceneMaker makers[] = {
        {"organic", organic_mesh}, {"terrain", terrain_mesh}, {"architecture", architecture_mesh}};
    return makers;
}

}  // namespace sahl::bench
