#include "engine/film/image_io.h"

#include <OpenImageIO/imageio.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>

#include "engine/core/error.h"
#include "tests/host/film/output_files.h"
#include "tests/support/temporary_folder.h"

namespace fs = std::filesystem;

namespace sahl {
namespace {

using tests::TemporaryFolder;
using tests::film::content_of;
using tests::film::NoPrivileges;
using tests::film::put;

/// A smooth picture of odd size with values from 0 to 1, higher than one band of rows.
Image gradient(int width = 37, int height = 300) {
    Image image{.width = width, .height = height, .channels = 3, .pixels = {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float u = static_cast<float>(x) / static_cast<float>(width - 1);
            const float v = static_cast<float>(y) / static_cast<float>(height - 1);
            image.pixels.insert(image.pixels.end(), {u, v, 0.5F * (u + v)});
        }
    return image;
}

Image pixels(std::vector<float> values) {
    const int width = static_cast<int>(values.size() / 3);
    return {.width = width, .height = 1, .channels = 3, .pixels = std::move(values)};
}

/// `image` after writing and reading.
Image through(const fs::path& path, const Image& image, const OutputSettings& settings = {}) {
    write_image(path, image, settings);
    return read_image(path);
}

float largest_difference(const Image& a, const Image& b) {
    REQUIRE(a.width == b.width);
    REQUIRE(a.height == b.height);
    REQUIRE(a.pixels.size() == b.pixels.size());
    float largest = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        largest = std::max(largest, std::fabs(a.pixels[i] - b.pixels[i]));
    return largest;
}

OIIO::ImageSpec spec_of(const fs::path& path) {
    const auto input = OIIO::ImageInput::open(path.string());
    REQUIRE(input);
    return input->spec();
}

std::pair<ExitCode, std::string> error_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        return {error.code(), error.what()};
    }
    return {ExitCode::ok, ""};
}

constexpr double srgb_half = 0.7353569830524495;

}  // namespace

TEST_CASE("image files: integer formats hold the nearest code of the sRGB value", "[image_io]") {
    const TemporaryFolder folder;
    const Image image = gradient();
    Image srgb = image;
    for (float& value : srgb.pixels) value = static_cast<float>(srgb_from_linear(value));
    for (const char* name : {"a.png", "a.tif", "a.tiff", "B.PNG"}) {
        CHECK(largest_difference(through(folder / name, image), srgb) <= 0.5F / 255 + 1e-6F);
        CHECK(spec_of(folder / name).format == OIIO::TypeDesc::UINT8);
        CHECK(spec_of(folder / name).nchannels == 3);
    }
    for (const char* name : {"w.png", "w.tif"}) {
        const OutputSettings settings{.pixel_type = PixelType::uint16};
        CHECK(largest_difference(through(folder / name, image, settings), srgb) <= 0.5F / 65535 + 1e-6F);
        CHECK(spec_of(folder / name).format == OIIO::TypeDesc::UINT16);
    }
    for (const char* name : {"a.jpg", "a.jpeg"})
        CHECK(largest_difference(through(folder / name, image), srgb) < 8.0F / 255);
}

TEST_CASE("image files: linear codes are stored and read without any conversion", "[image_io]") {
    const TemporaryFolder folder;
    std::vector<float> codes;
    for (int k = 0; k < 256; ++k) codes.insert(codes.end(), 3, static_cast<float>(k) / 255);
    for (const char* name : {"a.png", "a.tif"}) {
        const Image read = through(folder / name, pixels(codes), {.transfer = Transfer::linear});
        CHECK((read.pixels == codes));
    }
    const Image words = pixels({1.0F / 65535, 12345.0F / 65535, 65534.0F / 65535});
    for (const char* name : {"w.png", "w.tif"})
        CHECK(through(folder / name, words, {.pixel_type = PixelType::uint16, .transfer = Transfer::linear})
                  .pixels == words.pixels);
}

TEST_CASE("image files: rounding and exposure", "[image_io]") {
    const TemporaryFolder folder;
    const Image image = pixels({0.1F, 0.25F, 0.999F});  // 25.5, 63.75, 254.7 of 255
    const auto codes = [&](const OutputSettings& settings) {
        std::vector<int> all;
        for (const float value : through(folder / "a.png", image, settings).pixels)
            all.push_back(static_cast<int>(std::lround(value * 255)));
        return all;
    };
    CHECK(codes({.transfer = Transfer::linear}) == std::vector{26, 64, 255});
    CHECK(codes({.transfer = Transfer::linear, .rounding = Rounding::floor}) == std::vector{25, 63, 254});
    CHECK(codes({.transfer = Transfer::linear, .exposure = 1}) == std::vector{51, 128, 255});
    CHECK(codes({.exposure = 1})[1] == static_cast<int>(std::lround(srgb_half * 255)));
    CHECK((through(folder / "a.exr", image, {.pixel_type = PixelType::float32, .exposure = -2}).pixels ==
           std::vector<float>{0.1F / 4, 0.25F / 4, 0.999F / 4}));
}

TEST_CASE("image files: EXR half holds halves exactly, is finite at its ends and linear", "[image_io]") {
    const TemporaryFolder folder;
    constexpr float inf = std::numeric_limits<float>::infinity();
    const std::vector<float> exact{0, 1, -1, 0.5F, 1.0009765625F, 65504, -65504, 0x1p-24F, 1000};
    CHECK((through(folder / "a.exr", pixels(exact)).pixels == exact));
    CHECK(spec_of(folder / "a.exr").format == OIIO::TypeDesc::HALF);
    CHECK((through(folder / "a.exr", pixels({1e5F, -inf, std::nanf("")})).pixels ==
           std::vector<float>{65504, -65504, 0}));
    // Nearest even half: 1 + 1/2048 lies between 1 and 1 + 1/1024.
    CHECK((through(folder / "a.exr", pixels({1 + 0x1p-11F, 1 + 0x1.8p-11F, 0.1F})).pixels ==
           std::vector<float>{1, 1 + 0x1p-10F, 0.0999755859375F}));
    CHECK(largest_difference(through(folder / "b.exr", gradient()), gradient()) <= 0x1p-12F);
}

TEST_CASE("image files: float formats hold floats", "[image_io]") {
    const TemporaryFolder folder;
    const std::vector<float> values{0.1F, -0.3F, 1e-20F, 131072, 3e38F, 1.0F / 3};
    for (const char* name : {"a.exr", "a.tif"}) {
        CHECK((through(folder / name, pixels(values), {.pixel_type = PixelType::float32}).pixels == values));
        CHECK(spec_of(folder / name).format == OIIO::TypeDesc::FLOAT);
    }
}

TEST_CASE("image files: HDR is within 1/128 of a pixel's largest channel", "[image_io]") {
    const TemporaryFolder folder;
    const Image image = gradient();
    const Image read = through(folder / "a.hdr", image);
    for (std::size_t i = 0; i < image.pixels.size(); i += 3) {
        const float largest = std::max({image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]});
        for (std::size_t c = i; c < i + 3; ++c)
            REQUIRE(std::fabs(read.pixels[c] - image.pixels[c]) <= largest / 128);
    }
    const Image edges = through(folder / "a.hdr", pixels({-1, 1, 0.5F, 98304, 0, 1024}));
    CHECK((edges.pixels == std::vector<float>{0, 1, 0.5F, 98304, 0, 1024}));
}

TEST_CASE("image files: metadata stays in EXR and PNG, the colour space is named", "[image_io]") {
    const TemporaryFolder folder;
    OutputSettings settings;
    settings.metadata = {{"Software", "Sahl 0.1"}, {"sahl:depth", "5"}, {"sahl:scene", "käfig, \"a\" 光"}};
    for (const char* name : {"a.png", "a.exr"}) {
        write_image(folder / name, gradient(), settings);
        const OIIO::ImageSpec spec = spec_of(folder / name);
        for (const auto& [key, value] : settings.metadata) CHECK(spec.get_string_attribute(key) == value);
    }
    write_image(folder / "a.tif", gradient(), settings);
    CHECK(spec_of(folder / "a.tif").get_string_attribute("Software") == "Sahl 0.1");
    write_image(folder / "a.jpg", gradient(), settings);
    CHECK(spec_of(folder / "a.jpg").get_string_attribute("Software") == "Sahl 0.1");
    write_image(folder / "a.hdr", gradient(), settings);

    CHECK(spec_of(folder / "a.png").get_string_attribute("oiio:ColorSpace") == "sRGB");
    CHECK_THAT(content_of(folder / "a.png"), Catch::Contains("sRGB") && Catch::Contains("gAMA"));
    settings.transfer = Transfer::linear;
    write_image(folder / "l.png", gradient(), settings);
    CHECK(spec_of(folder / "l.png").get_string_attribute("oiio:ColorSpace") == "linear");
    CHECK_THAT(content_of(folder / "l.png"),
               Catch::Contains(std::string("gAMA\0\1\x86\xa0", 8)) && !Catch::Contains("sRGB"));
    CHECK(spec_of(folder / "a.exr").get_string_attribute("oiio:ColorSpace") == "Linear");
}

TEST_CASE("image files: impossible requests name what the format holds", "[image_io]") {
    const TemporaryFolder folder;
    const auto refused = [&](const char* name, const OutputSettings& settings) {
        const auto before = error_of([&] { check_output(folder / name, settings); });
        const auto after = error_of([&] { write_image(folder / name, gradient(2, 2), settings); });
        CHECK(before == after);
        CHECK(before.first == ExitCode::usage);
        CHECK_THAT(before.second, Catch::Contains(name));
        return before.second;
    };
    for (const char* name : {"a", "a.bmp", "a.", "png", ".png", "a.png.gz"})
        CHECK_THAT(refused(name, {}), Catch::Contains(".exr, .png, .jpg, .jpeg, .hdr, .tif, .tiff"));
    CHECK_THAT(refused("a.png", {.pixel_type = PixelType::half}),
               Catch::Contains("half") && Catch::Contains("uint8, uint16"));
    CHECK_THAT(refused("a.jpg", {.pixel_type = PixelType::uint16}), Catch::EndsWith("holds uint8"));
    CHECK_THAT(refused("a.exr", {.pixel_type = PixelType::uint8}), Catch::EndsWith("half, float"));
    CHECK_THAT(refused("a.hdr", {.pixel_type = PixelType::half}), Catch::EndsWith("float"));
    CHECK_THAT(refused("a.tif", {.pixel_type = PixelType::half}), Catch::EndsWith("uint8, uint16, float"));
    CHECK_THAT(refused("a.exr", {.transfer = Transfer::srgb}), Catch::Contains("linear"));
    CHECK_THAT(refused("a.tif", {.pixel_type = PixelType::float32, .transfer = Transfer::srgb}),
               Catch::Contains("linear"));
    CHECK(folder.entries() == 0);
}

TEST_CASE("image files: a target that cannot be written", "[image_io]") {
    const TemporaryFolder folder;
    fs::create_directory(folder / "folder.png");
    put(folder / "file", "x");
    for (const fs::path& path : {folder / "folder.png", folder / "file/a.png"}) {
        CHECK(error_of([&] { check_output(path, {}); }).first == ExitCode::output);
        CHECK(error_of([&] { write_image(path, gradient(2, 2), {}); }).first == ExitCode::output);
    }
    const auto [code, message] = error_of([&] {
        const NoPrivileges user;
        write_image("/dev/full", gradient(2, 2), {});
    });
    CHECK(code == ExitCode::output);
    CHECK_THAT(message, Catch::Contains("'/dev/full'") && Catch::Contains("No space left"));
    CHECK(folder.entries() == 2);
}

TEST_CASE("image files: a special file without extension gets a PNG", "[image_io]") {
    const TemporaryFolder folder;
    REQUIRE(::mkfifo((folder / "fifo").c_str(), 0600) == 0);
    const int reader = ::open((folder / "fifo").c_str(), O_RDONLY | O_NONBLOCK);
    check_output(folder / "fifo", {});
    write_image(folder / "fifo", gradient(2, 2), {});
    std::string start(4, ' ');
    CHECK(::read(reader, start.data(), start.size()) == 4);
    ::close(reader);
    CHECK(start == "\x89PNG");
    CHECK(fs::is_fifo(folder / "fifo"));
    check_output("/dev/null", {});
}

TEST_CASE("image files: one channel is replicated, alpha dropped and not multiplied in", "[image_io]") {
    const TemporaryFolder folder;
    const auto put_image = [&](const char* name, int channels, std::vector<unsigned char> values) {
        const auto output = OIIO::ImageOutput::create((folder / name).string());
        OIIO::ImageSpec spec(static_cast<int>(values.size()) / channels, 1, channels, OIIO::TypeDesc::UINT8);
        spec.attribute("oiio:UnassociatedAlpha", 1);
        REQUIRE(output->open((folder / name).string(), spec));
        REQUIRE(output->write_image(OIIO::TypeDesc::UINT8, values.data()));
        REQUIRE(output->close());
    };
    put_image("grey.png", 1, {0, 51, 255});
    CHECK((read_image(folder / "grey.png").pixels == std::vector<float>{0, 0, 0, 0.2F, 0.2F, 0.2F, 1, 1, 1}));
    put_image("greyalpha.png", 2, {51, 10, 255, 0});
    CHECK((read_image(folder / "greyalpha.png").pixels == std::vector<float>{0.2F, 0.2F, 0.2F, 1, 1, 1}));
    put_image("rgba.png", 4, {51, 102, 255, 1, 255, 0, 51, 255});
    CHECK((read_image(folder / "rgba.png").pixels == std::vector<float>{0.2F, 0.4F, 1, 1, 0, 0.2F}));
}

TEST_CASE("image files: reading names the file and the cause", "[image_io]") {
    const TemporaryFolder folder;
    put(folder / "text.png", "no image at all");
    put(folder / "empty.exr", "");
    write_image(folder / "whole.png", gradient(), {});
    put(folder / "cut.png", content_of(folder / "whole.png").substr(0, 700));
    for (const char* name : {"none.png", "text.png", "empty.exr", "cut.png", "."}) {
        const auto [code, message] = error_of([&] { read_image(folder / name); });
        CHECK(code == ExitCode::scene);
        CHECK_THAT(message, Catch::Contains(name) && Catch::Contains("give an image file"));
    }
    CHECK_THAT(error_of([&] { read_image(folder / "none.png"); }).second, Catch::Contains("No such file"));
}

}  // namespace sahl
