#include <algorithm>
#include <array>
#include <catch2/catch.hpp>

#include "engine/core/error.h"
#include "engine/film/image_io.h"
#include "tests/support/test_data.h"

namespace fs = std::filesystem;

/// Read by the leak sanitizer: libpng leaves OpenImageIO by longjmp, over strings that hold the message
/// "hit end of file".
extern "C" const char* __lsan_default_suppressions() { return "leak:libOpenImageIO"; }

namespace sahl {

TEST_CASE("damaged image files are refused or read, never followed into a crash", "[image_io]") {
    const auto data = tests::test_data();
    if (!data) {
        WARN("SKIPPED: no test data");
        return;
    }
    // OpenImageIO 2.4.7 itself reads out of bounds or overflows its stack in the first three (the
    // ICC profile, IPTC and XMP metadata), and takes tens of gigabytes for the last.
    constexpr std::array left_out{"corrupt-icc-4551.jpg", "corrupt-iptc-8011.jpg", "xmp-deep-nesting.png",
                                  "bomb-progressive-65500x65500.jpg"};

    int files = 0;
    for (const char* kind : {"exr", "png", "jpg"})
        for (const auto& entry : fs::recursive_directory_iterator(*data / "bad" / kind)) {
            if (!entry.is_regular_file()) continue;
            const fs::path& path = entry.path();
            if (std::find(left_out.begin(), left_out.end(), path.filename().string()) != left_out.end()) {
                WARN("left out: " << path.filename());
                continue;
            }
            INFO(path);
            ++files;
            try {
                const Image image = read_image(path);
                CHECK(image.pixels.size() ==
                      3U * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
            } catch (const Error& error) {
                CHECK((error.code() == ExitCode::scene || error.code() == ExitCode::memory));
                CHECK_THAT(error.what(), Catch::Contains(path.filename().string()));
            }
        }
    CHECK(files > 100);
}

}  // namespace sahl
