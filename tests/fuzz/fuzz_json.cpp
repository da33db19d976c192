#include <cstdint>

#include "engine/scene/scene_json.h"
#include "tests/fuzz/fuzz_loader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

// The scene lies, as far as the loader can tell, among scenes that it may include.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    sahl::tests::fuzz_loader([&] {
        return sahl::read_scene_json(SAHL_SOURCE_DIR "/tests/data/scene.json",
                                     std::string(data, data + size));
    });
    return 0;
}
