// An image does not depend on how the work was cut, nor on what did it: the same bits for every ray budget,
// work-group size, version of the kernels, set of crops and partition of the samples.
#include <algorithm>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "engine/scene/load.h"
#include "engine/self_test/every_feature.h"
#include "tests/device/soups.h"
#include "tests/render/rendered.h"
#include "tests/support/kernel_runner.h"
#include "tests/support/test_data.h"

namespace sahl::tests {
namespace {

struct Subject {
    std::string name;
    Scene scene;
    RenderSettings settings;
};

Subject subject(std::string name, Scene scene) {
    Subject result{std::move(name), std::move(scene), square_settings(full_tests() ? 64 : 24, 5)};
    result.settings.resolution.height += 5;
    result.settings.spp = 16;
    result.settings.seed = 11;
    return result;
}

/// Glass, mirrors, nested instances, transparent shadows, every primitive and texture; and scenes of the
/// Standard Procedural Databases where the test data are.
std::vector<Subject> subjects() {
    const std::filesystem::path scenes = std::filesystem::path(std::getenv("SAHL_SOURCE_DIR")) / "scenes";
    std::vector<Subject> all;
    all.push_back(subject("every feature", every_feature()));
    for (const char* name : {"glass.json", "shadows.json", "transforms.json"})
        all.push_back(subject(name, load_scene(scenes / name)));
    if (const auto data = test_data()) {
        std::vector<std::string> names{"balls-s2", "gears-s1", "mount-s3"};
        if (full_tests())
            names = {"balls-s1", "balls-s2", "balls-s3",    "gears-s1", "jacks-s2", "lattice-s2",
                     "mount-s3", "rings-s1", "sombrero-s2", "tetra-s2", "tree-s2",  "shells-s2"};
        for (const std::string& name : names)
            all.push_back(subject(name, load_scene(*data / "spd/nff/small" / (name + ".nff"))));
    }
    return all;
}

/// The image of all samples of the crop, by a device's own renderer.
std::vector<float> pixels_of(Device& device, Renderer& renderer, const RenderSettings& settings) {
    const Crop crop =
        settings.crop.value_or(Crop{0, 0, settings.resolution.width, settings.resolution.height});
    Film film(device.memory(), crop.x1 - crop.x0, crop.y1 - crop.y0);
    renderer.render(settings, film);
    return film.resolve(settings.spp).pixels;
}

/// The image put together of tiles that are not all of one size.
std::vector<float> tiled(Device& device, Renderer& renderer, RenderSettings settings) {
    const auto [width, height] = settings.resolution;
    std::vector<float> image(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    const int x_cuts[] = {0, 7, 8, width};
    const int y_cuts[] = {0, 17, height};
    for (int j = 0; j < 2; ++j) {
        for (int i = 0; i < 3; ++i) {
            const Crop crop{x_cuts[i], y_cuts[j], x_cuts[i + 1], y_cuts[j + 1]};
            settings.crop = crop;
            const std::vector<float> tile = pixels_of(device, renderer, settings);
            const std::ptrdiff_t row = 3 * (crop.x1 - crop.x0);
            for (int y = crop.y0; y < crop.y1; ++y)
                std::copy_n(tile.begin() + (y - crop.y0) * row, row,
                            image.begin() + 3 * (std::ptrdiff_t{y} * width + crop.x0));
        }
    }
    return image;
}

/// The image merged from parts of the samples.
std::vector<float> merged(Device& device, Renderer& renderer, RenderSettings settings) {
    const auto [width, height] = settings.resolution;
    Film sum(device.memory(), width, height);
    for (const SampleRange& part :
         {SampleRange{3, settings.spp}, SampleRange{0, 1}, SampleRange{1, 2}, SampleRange{2, 3}}) {
        settings.samples = part;
        Film film(device.memory(), width, height);
        renderer.render(settings, film);
        sum.merge(film);
    }
    return sum.resolve(settings.spp).pixels;
}

}  // namespace

TEST_CASE("invariance: budgets, repetitions, crops and parts of the samples change no bit", "[invariance]") {
    Device device;
    for (Subject& subject : subjects()) {
        INFO(subject.name);
        RenderSettings& settings = subject.settings;
        Renderer renderer(device, subject.scene);
        settings.ray_budget = 1U << 22U;
        const std::vector<float> whole = pixels_of(device, renderer, settings);
        CHECK(*std::max_element(whole.begin(), whole.end()) > 0);
        CHECK(pixels_of(device, renderer, settings) == whole);
        CHECK(tiled(device, renderer, settings) == whole);
        CHECK(merged(device, renderer, settings) == whole);
        for (const std::uint32_t budget : {least_ray_budget, 1000U, 1U << 15U}) {
            settings.ray_budget = budget;
            INFO("budget " << budget);
            CHECK(pixels_of(device, renderer, settings) == whole);
        }
        settings.ray_budget = 777;
        CHECK(tiled(device, renderer, settings) == whole);
        CHECK(merged(device, renderer, settings) == whole);
    }
}

TEST_CASE("invariance: work-group sizes, versions of the kernels and ways of traversal change no bit",
          "[invariance]") {
    DeviceOptions variants[8];
    variants[1].work_group_size = 2;
    variants[2].work_group_size = 16;
    variants[3].build_options = "-DSAHL_PLAIN_OPENCL";
    variants[4].build_options = "-DSAHL_NO_AVX512";
    variants[5].traversal = Traversal::stream;
    variants[6].traversal = Traversal::scalar;
    variants[7].build_options = "-cl-opt-disable";  // as Compilation::quick has it
    std::vector<std::vector<float>> expected;
    for (const DeviceOptions& variant : variants) {
        Device device(variant);
        std::size_t i = 0;
        for (const Subject& subject : subjects()) {
            INFO(subject.name << ", groups of " << device.local_size() << " " << variant.build_options << " "
                              << name_of(device.traversal()));
            Renderer renderer(device, subject.scene);
            const std::vector<float> pixels = pixels_of(device, renderer, subject.settings);
            if (&variant == variants) {
                expected.push_back(pixels);
            } else {
                CHECK(pixels == expected[i]);
            }
            ++i;
        }
    }
}

}  // namespace sahl::tests
