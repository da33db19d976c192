#include "engine/film/early_encoder.h"

#include <catch2/catch.hpp>

#include <random>

#include "tests/host/film/output_files.h"
#include "tests/support/temporary_folder.h"

namespace sahl {
namespace {

using tests::TemporaryFolder;
using tests::film::content_of;

constexpr int image_width = 53;
constexpr int image_height = 301;  // more than one band of rows
constexpr int samples = 3;

/// Fills pixels [begin, end) of `film` with noise that is the same each time.
void shine(Film& film, std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t pixel = begin; pixel < end; ++pixel) {
        std::minstd_rand noise(pixel + 1);
        const float value = static_cast<float>(noise() % 4096) / 1024;
        film.add({&pixel, 1}, &value, &value, &value);
    }
}

OutputSettings settings_with(const char* seconds) {
    OutputSettings settings{.exposure = -1};
    settings.metadata = {{"Software", "Sahl"}, {"Sahl:RenderSeconds", seconds}};
    return settings;
}

TEST_CASE("early encoder: the file is that of write_image, however the rows are finished", "[film]") {
    const TemporaryFolder folder;
    MemoryAccountant memory;
    Film whole(memory, image_width, image_height);
    shine(whole, 0, image_width * image_height);
    const OutputSettings settings = settings_with("a longer text than what was there before");
    write_image(folder / "late.png", whole.resolve(samples), settings);

    for (const std::uint32_t step : {1U, 8U, 100U, std::uint32_t{image_height}}) {
        INFO(step << " rows at a time");
        Film film(memory, image_width, image_height);
        EarlyEncoder encoder(film, samples, folder / "early.png", settings_with("1"));
        for (std::uint32_t begin = 0; begin < image_height; begin += step) {
            const std::uint32_t end = std::min<std::uint32_t>(begin + step, image_height);
            shine(film, begin * image_width, end * image_width);
            encoder.set_finished(static_cast<int>(end));
        }
        encoder.write(settings.metadata);
        CHECK(content_of(folder / "early.png") == content_of(folder / "late.png"));
    }
}

TEST_CASE("early encoder: one that is not told to write leaves nothing", "[film]") {
    const TemporaryFolder folder;
    MemoryAccountant memory;
    Film film(memory, image_width, image_height);
    {
        EarlyEncoder encoder(film, samples, folder / "early.png", {});
        encoder.set_finished(image_height / 2);
    }
    CHECK(folder.entries() == 0);
    CHECK_FALSE(can_encode_early("a.exr"));
}

}  // namespace
}  // namespace sahl
