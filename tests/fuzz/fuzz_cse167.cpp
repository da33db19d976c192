#include <cstdint>

#include "engine/scene/scene_cse167.h"
#include "tests/fuzz/fuzz_loader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    sahl::tests::fuzz_loader([&] {
        sahl::TextReader reader("scene", std::string(data, data + size));
        return sahl::read_cse167(reader);
    });
    return 0;
}
