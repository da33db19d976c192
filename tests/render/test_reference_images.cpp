// Scenes and images that others made, within stated numbers of differing pixels.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <OpenImageIO/imageio.h>
#include <catch2/catch.hpp>

#include "engine/scene/load.h"
#include "tests/render/rendered.h"
#include "tests/support/test_data.h"

namespace sahl::tests {
namespace {

namespace fs = std::filesystem;

struct Bytes {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgb;
};

Bytes read_image(const fs::path& path) {
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path.string());
    INFO(path.string());
    REQUIRE(input);
    const OIIO::ImageSpec& spec = input->spec();
    const auto channels = static_cast<std::size_t>(spec.nchannels);
    std::vector<std::uint8_t> stored(spec.image_pixels() * channels);
    REQUIRE(input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, stored.data()));
    Bytes result{spec.width, spec.height, {}};
    for (std::size_t pixel = 0; pixel < spec.image_pixels(); ++pixel) {
        for (std::size_t channel = 0; channel < 3; ++channel) {
            result.rgb.push_back(stored[pixel * channels + std::min(channel, channels - 1)]);
        }
    }
    return result;
}

enum class Rounding { nearest, down };

Bytes quantized(const Image& image, Rounding rounding) {
    Bytes result{image.width, image.height, {}};
    for (const float value : image.pixels) {
        const float scaled = 255 * std::clamp(value, 0.0F, 1.0F);
        result.rgb.push_back(
            static_cast<std::uint8_t>(rounding == Rounding::down ? std::floor(scaled) : std::round(scaled)));
    }
    return result;
}

/// The image of a scene file at its reference's size and its format's own depth.
Bytes render_file(const fs::path& path, const Bytes& reference, Rounding rounding) {
    const Scene scene = load_scene(path);
    RenderSettings settings;
    settings.resolution = {reference.width, reference.height};
    settings.depth = scene.depth;
    return quantized(render(scene, settings).image, rounding);
}

struct Difference {
    std::size_t pixels = 0;    ///< compared
    std::size_t over_two = 0;  ///< pixels whose largest channel difference is above 2
    double mean = 0;           ///< of those largest differences
    double psnr = 0;           ///< dB, over all channels of all pixels
};

/// `mask`: pixels that are white there count; empty: all.
Difference compare(const Bytes& image, const Bytes& reference, const Bytes& mask = {}) {
    Difference result;
    double squares = 0;
    for (std::size_t first = 0; first < reference.rgb.size(); first += 3) {
        if (!mask.rgb.empty() && mask.rgb[first] < 128) continue;
        int largest = 0;
        for (std::size_t i = first; i < first + 3; ++i) {
            const int difference = std::abs(int{image.rgb[i]} - int{reference.rgb[i]});
            largest = std::max(largest, difference);
            squares += difference * difference;
        }
        ++result.pixels;
        result.over_two += largest > 2 ? 1 : 0;
        result.mean += largest;
    }
    result.mean /= static_cast<double>(result.pixels);
    result.psnr = 10 * std::log10(255.0 * 255.0 * 3 * static_cast<double>(result.pixels) / squares);
    return result;
}

TEST_CASE("reference: graded images of the CSE 167 scenes", "[reference]") {
    const auto data = test_data();
    if (!data) {
        WARN("SKIPPED: set SAHL_TEST_DATA to the folder of reference scenes");
        return;
    }
    const fs::path folder = *data / "cse167";
    const Bytes mask = read_image(folder / "reference/graded/valid.png");
    struct Case {
        const char* name;
        std::size_t limit;
    };
    for (const Case& item : {Case{"scene4-ambient", 10}, Case{"scene4-diffuse", 10}, Case{"scene6", 100}}) {
        const std::string name = item.name;
        const Bytes reference = read_image(folder / "reference/graded" / (name + ".png"));
        const Bytes image = render_file(folder / "scenes" / (name + ".test"), reference, Rounding::down);
        const Difference difference = compare(image, reference, mask);
        INFO(name << ": " << difference.over_two << " pixels differ by more than 2, mean "
                  << difference.mean);
        CHECK(difference.pixels == 291350);
        CHECK(difference.over_two <= item.limit);
        CHECK(difference.mean <= 0.02);
    }
}

TEST_CASE("reference: JPEG images of the CSE 167 scenes", "[reference]") {
    const auto data = test_data();
    if (!data) {
        WARN("SKIPPED: set SAHL_TEST_DATA to the folder of reference scenes");
        return;
    }
    const fs::path folder = *data / "cse167";
    struct Case {
        const char* scene;
        const char* image;
    };
    for (const Case& item :
         {Case{"variants/scene1-camera1.test", "scene1-camera1.jpg"},
          Case{"variants/scene1-camera4.test", "scene1-camera4.jpg"},
          Case{"variants/scene2-camera1.test", "scene2-camera1.jpg"}, Case{"scene3.test", "scene3.jpg"}}) {
        const Bytes reference = read_image(folder / "reference/testscenes" / item.image);
        const Bytes image = render_file(folder / "scenes" / item.scene, reference, Rounding::down);
        const Difference difference = compare(image, reference);
        INFO(item.scene << ": PSNR " << difference.psnr << " dB");
        CHECK(difference.psnr >= 30);
    }
}

void check_nff(const fs::path& scene, const fs::path& image, double limit) {
    const Bytes reference = read_image(image);
    const Difference difference = compare(render_file(scene, reference, Rounding::nearest), reference);
    const double share = static_cast<double>(difference.over_two) / static_cast<double>(difference.pixels);
    INFO(scene.stem().string() << ": " << difference.over_two << " of " << difference.pixels
                               << " pixels differ by more than 2, mean " << difference.mean);
    CHECK(share <= limit);
}

TEST_CASE("reference: the small SPD scenes", "[reference]") {
    const auto data = test_data();
    if (!data) {
        WARN("SKIPPED: set SAHL_TEST_DATA to the folder of reference scenes");
        return;
    }
    int scenes = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(*data / "spd/ref-pinned/small")) {
        const fs::path name = entry.path().stem();
        // The reference's own treatment of smooth triangles seen edge on, and of glass inside glass.
        const double limit = name == "teapot-s2" ? 0.01 : name == "gears-s1" ? 0.03 : 0.001;
        check_nff(*data / "spd/nff/small" / (name.string() + ".nff"), entry.path(), limit);
        ++scenes;
    }
    CHECK(scenes >= 13);
}

TEST_CASE("reference: balls and mount", "[reference]") {
    const auto data = test_data();
    if (!data) {
        WARN("SKIPPED: set SAHL_TEST_DATA to the folder of reference scenes");
        return;
    }
    for (const char* name : {"balls", "mount"}) {
        const std::string stem = name;
        check_nff(*data / "spd/nff" / (stem + ".nff"), *data / "spd/ref-pinned" / (stem + ".png"), 0.001);
    }
}

}  // namespace
}  // namespace sahl::tests
