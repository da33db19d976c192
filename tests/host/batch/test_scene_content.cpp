#include "engine/batch/scene_content.h"

#include <catch2/catch.hpp>

namespace sahl {
namespace {

TEST_CASE("scene content: hashes are SHA-1 as records of images have them", "[batch]") {
    // The examples of FIPS 180-2.
    CHECK(content_hash("abc") == "A9993E364706816ABA3E25717850C26C9CD0D89D");
    CHECK(content_hash("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
          "84983E441C3BD26EBAAE4AA1F95129E5E54670F1");
    CHECK(content_hash("") == "DA39A3EE5E6B4B0D3255BFEF95601890AFD80709");
}

}  // namespace
}  // namespace sahl
