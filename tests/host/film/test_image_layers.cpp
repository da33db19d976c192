// AOVs in EXR files, compressions, and settings for several files at once.
#include <OpenImageIO/imageio.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "engine/core/error.h"
#include "engine/film/image_io.h"
#include "tests/host/film/output_files.h"
#include "tests/support/temporary_folder.h"

namespace fs = std::filesystem;

namespace sahl {
namespace {

using tests::TemporaryFolder;
using tests::film::content_of;

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr int width = 5;
constexpr int height = 300;  // more than one band of rows
constexpr std::size_t pixel_count = width * height;

/// Channel `channel` of AOV `aov` in pixel `i`: a value that a half does not hold.
float value_of(Aov aov, std::size_t i, std::size_t channel) {
    if (aov == Aov::depth && i % 7 == 3) return infinite;
    return static_cast<float>(static_cast<int>(aov) + 1) + static_cast<float>(3 * i + channel) / 4099.0F;
}

std::uint32_t id_of(Aov aov, std::size_t i) {
    return i % 11 == 5 ? no_aov_id
                       : static_cast<std::uint32_t>(aov) * 100'000'007U + static_cast<std::uint32_t>(i);
}

Image picture() {
    Image image{.width = width, .height = height, .channels = 3, .pixels = {}};
    for (std::size_t i = 0; i < 3 * pixel_count; ++i)
        image.pixels.push_back(static_cast<float>(i) / 4097.0F - 0.1F);
    image.pixels[4] = 1e6F;
    return image;
}

AovImage layer(Aov aov) {
    AovImage image{.aov = aov};
    const std::size_t channels = std::max<std::size_t>(aov_name(aov).components.size(), 1);
    for (std::size_t i = 0; i < pixel_count; ++i) {
        if (aov_name(aov).is_uint) {
            image.uints.push_back(id_of(aov, i));
        } else {
            for (std::size_t c = 0; c < channels; ++c) image.values.push_back(value_of(aov, i, c));
        }
    }
    return image;
}

std::vector<AovImage> all_layers() {
    std::vector<AovImage> layers;
    for (const AovName& name : aov_names) layers.push_back(layer(name.aov));
    return layers;
}

/// Channel types and values by name; integers as they are.
struct Channel {
    OIIO::TypeDesc type;
    std::vector<float> values;
    std::vector<std::uint32_t> ids;
};
using Channels = std::map<std::string, Channel>;

Channels read_channels(const fs::path& path) {
    const auto input = OIIO::ImageInput::open(path.string());
    REQUIRE(input);
    const OIIO::ImageSpec& spec = input->spec();
    CHECK_FALSE(input->seek_subimage(1, 0));
    REQUIRE(input->seek_subimage(0, 0));
    Channels channels;
    for (int c = 0; c < spec.nchannels; ++c) {
        Channel channel{spec.channelformat(c), std::vector<float>(pixel_count), {}};
        if (channel.type == OIIO::TypeDesc::UINT) {
            channel.ids.resize(pixel_count);
            REQUIRE(input->read_image(0, 0, c, c + 1, OIIO::TypeDesc::UINT, channel.ids.data()));
        } else {
            REQUIRE(input->read_image(0, 0, c, c + 1, OIIO::TypeDesc::FLOAT, channel.values.data()));
        }
        channels[spec.channelnames[static_cast<std::size_t>(c)]] = std::move(channel);
    }
    return channels;
}

std::string usage_error_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        CHECK(error.code() == ExitCode::usage);
        return error.what();
    }
    return "no error";
}

std::string compression_in(const fs::path& path) {
    const auto input = OIIO::ImageInput::open(path.string());
    REQUIRE(input);
    return std::string(input->spec().get_string_attribute("compression"));
}

}  // namespace

TEST_CASE("image layers: names, types and values of all AOVs", "[image_io]") {
    const TemporaryFolder folder;
    const auto type = GENERATE(PixelType::half, PixelType::float32);
    const auto color = type == PixelType::half ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT;
    write_image(folder / "a.exr", picture(), {.pixel_type = type, .exposure = 1}, all_layers());
    const Channels channels = read_channels(folder / "a.exr");

    const std::map<std::string, OIIO::TypeDesc> expected{
        {"R", color},
        {"G", color},
        {"B", color},
        {"Z", OIIO::TypeDesc::FLOAT},
        {"N.X", OIIO::TypeDesc::FLOAT},
        {"N.Y", OIIO::TypeDesc::FLOAT},
        {"N.Z", OIIO::TypeDesc::FLOAT},
        {"albedo.R", color},
        {"albedo.G", color},
        {"albedo.B", color},
        {"id.primitive", OIIO::TypeDesc::UINT},
        {"id.instance", OIIO::TypeDesc::UINT},
        {"id.material", OIIO::TypeDesc::UINT},
        {"cost.rays", OIIO::TypeDesc::UINT},
        {"cost.nodes", OIIO::TypeDesc::UINT},
    };
    REQUIRE(channels.size() == expected.size());
    for (const auto& [name, channel_type] : expected) {
        INFO(name);
        REQUIRE(channels.contains(name));
        CHECK(channels.at(name).type == channel_type);
    }

    const float step = type == PixelType::half ? 0x1p-11F : 0;  // relative error of a half
    int wrong = 0;
    const auto differ = [](float a, float b, float relative) {
        return !(a == b || std::fabs(a - b) <= relative * std::fabs(b) + (relative > 0 ? 1e-7F : 0));
    };
    const Image image = picture();
    for (std::size_t i = 0; i < pixel_count; ++i) {
        // Exposure and the largest half are for the beauty alone.
        for (std::size_t c = 0; c < 3; ++c) {
            const std::string letter(1, "RGB"[c]);
            float beauty = 2 * image.pixels[3 * i + c];
            if (type == PixelType::half) beauty = std::min(beauty, 65504.0F);
            wrong += differ(channels.at(letter).values[i], beauty, step);
            wrong += differ(channels.at("albedo." + letter).values[i], value_of(Aov::albedo, i, c), step);
            const std::string axis(1, "XYZ"[c]);
            wrong += differ(channels.at("N." + axis).values[i], value_of(Aov::normal, i, c), 0);
        }
        wrong += differ(channels.at("Z").values[i], value_of(Aov::depth, i, 0), 0);
        for (const AovName& name : aov_names)
            if (name.is_uint) wrong += channels.at(std::string(name.name)).ids[i] != id_of(name.aov, i);
    }
    CHECK(wrong == 0);
}

TEST_CASE("image layers: the beauty is what it is without AOVs, and reading finds it", "[image_io]") {
    const TemporaryFolder folder;
    write_image(folder / "plain.exr", picture(), {});
    const std::vector<float> plain = read_image(folder / "plain.exr").pixels;
    for (const AovName& name : aov_names) {
        const std::vector<AovImage> one{layer(name.aov)};
        write_image(folder / "a.exr", picture(), {}, one);
        CHECK((read_image(folder / "a.exr").pixels == plain));
    }
    write_image(folder / "a.exr", picture(), {}, all_layers());
    CHECK((read_image(folder / "a.exr").pixels == plain));
}

TEST_CASE("image layers: only EXR has room, and sizes have to agree", "[image_io]") {
    const TemporaryFolder folder;
    for (const char* name : {"a.png", "a.tif", "a.hdr", "a.jpg"}) {
        CHECK_FALSE(can_hold_aovs(folder / name));
        CHECK_THAT(usage_error_of([&] { write_image(folder / name, picture(), {}, all_layers()); }),
                   Catch::Contains(name) && Catch::Contains("EXR"));
    }
    CHECK(can_hold_aovs("a.EXR"));
    std::vector<AovImage> layers = all_layers();
    layers[1].values.pop_back();
    CHECK_THROWS_AS(write_image(folder / "a.exr", picture(), {}, layers), Error);
    CHECK(folder.entries() == 0);
}

TEST_CASE("image layers: the compression asked for is in the file, lossless ones keep every value",
          "[image_io]") {
    const TemporaryFolder folder;
    struct Case {
        const char* file;
        const char* asked;
        const char* stored;
        bool lossless;
    };
    const Case item = GENERATE(values<Case>({
        {"a.exr", "none", "none", true},
        {"a.exr", "rle", "rle", true},
        {"a.exr", "zips", "zips", true},
        {"a.exr", "zip", "zip", true},
        {"a.exr", "piz", "piz", true},
        {"a.exr", "pxr24", "pxr24", true},
        {"a.exr", "b44", "b44", false},
        {"a.exr", "b44a", "b44a", false},
        {"a.exr", "dwaa", "dwaa", false},
        {"a.exr", "dwab:200", "dwab", false},
        {"a.tif", "none", "none", true},
        {"a.tif", "lzw", "lzw", true},
        {"a.tif", "zip", "zip", true},
        {"a.tif", "packbits", "packbits", true},
    }));
    INFO(item.file << " " << item.asked);
    write_image(folder / item.file, picture(), {});
    const std::vector<float> plain = read_image(folder / item.file).pixels;
    CHECK(compression_in(folder / item.file) == "zip");
    write_image(folder / item.file, picture(), {.compression = item.asked});
    CHECK(compression_in(folder / item.file) == item.stored);
    CHECK((read_image(folder / item.file).pixels == plain) == item.lossless);
}

TEST_CASE("image layers: levels of JPEG, PNG and DWA do what they say", "[image_io]") {
    const TemporaryFolder folder;
    const auto size_with = [&](const char* file, std::optional<std::string> compression) {
        write_image(folder / file, picture(), {.compression = std::move(compression)});
        return content_of(folder / file).size();
    };
    CHECK(size_with("a.jpg", "jpeg:20") < size_with("a.jpg", "jpeg:95"));
    CHECK(size_with("a.jpg", "jpeg:95") == size_with("a.jpg", std::nullopt));
    CHECK(size_with("a.jpg", "jpeg") == size_with("a.jpg", std::nullopt));
    CHECK(size_with("a.png", "zip:9") < size_with("a.png", "zip:0"));
    CHECK(size_with("a.png", "zip:1") == size_with("a.png", std::nullopt));
    CHECK(size_with("a.exr", "dwaa:400") < size_with("a.exr", "dwaa:1"));
}

TEST_CASE("image layers: compressions that a format does not have", "[image_io]") {
    const auto refused = [&](const char* name, const char* compression) {
        return usage_error_of([&] { check_output(name, {.compression = compression}); });
    };
    CHECK_THAT(refused("a.png", "dwaa"),
               Catch::EndsWith("'dwaa' does not fit this format, which has zip:0..9"));
    CHECK_THAT(refused("a.tif", "zip:3"), Catch::EndsWith("which has none, lzw, zip, packbits"));
    for (const char* wrong : {"jpeg:0", "jpeg:101", "jpeg:", "jpeg:9x", "jpeg:-1", "zip", "JPEG", ""})
        CHECK_THAT(refused("a.jpg", wrong), Catch::EndsWith("which has jpeg:1..100"));
    CHECK_THAT(refused("a.exr", "dwaa:0"), Catch::Contains("b44a, dwaa:1..500"));
    CHECK_THAT(refused("a.hdr", "rle"), Catch::Contains("no compression"));
}

TEST_CASE("image layers: of several files each gets the settings that it can hold", "[image_io]") {
    const std::vector<fs::path> paths{"a.exr", "b.png", "c.jpg", "d.tif"};
    const std::vector<OutputSettings> types = settings_for(paths, {.pixel_type = PixelType::uint16});
    CHECK_FALSE(types[0].pixel_type);
    CHECK(types[1].pixel_type == PixelType::uint16);
    CHECK_FALSE(types[2].pixel_type);
    CHECK(types[3].pixel_type == PixelType::uint16);

    const OutputSettings mixed{.pixel_type = PixelType::float32,
                               .transfer = Transfer::srgb,
                               .rounding = Rounding::floor,
                               .exposure = 2,
                               .compression = "zip"};
    const std::vector<OutputSettings> each = settings_for(paths, mixed);
    for (std::size_t i = 0; i < paths.size(); ++i) {
        INFO(paths[i]);
        CHECK_NOTHROW(check_output(paths[i], each[i]));
        const bool floats = i == 0 || i == 3;
        CHECK(each[i].pixel_type.has_value() == floats);
        CHECK(each[i].transfer.has_value() != floats);
        CHECK(each[i].rounding.has_value() != floats);
        CHECK(each[i].compression.has_value() == (i != 2));
        CHECK(each[i].exposure == 2);
    }
    // Linear is what floats are.
    for (const OutputSettings& one : settings_for(paths, {.transfer = Transfer::linear}))
        CHECK(one.transfer == Transfer::linear);
}

TEST_CASE("image layers: what none of several files can hold is refused with what each can", "[image_io]") {
    const auto refused = [](std::vector<fs::path> paths, const OutputSettings& settings) {
        return usage_error_of([&] { settings_for(paths, settings); });
    };
    CHECK_THAT(refused({"a.png", "b.jpg"}, {.pixel_type = PixelType::half}),
               Catch::Contains("half fits none") && Catch::Contains("'a.png' holds uint8, uint16") &&
                   Catch::Contains("'b.jpg' holds uint8"));
    CHECK_THAT(refused({"a.exr", "b.hdr"}, {.transfer = Transfer::srgb}),
               Catch::Contains("'a.exr' has half pixels") && Catch::Contains("'b.hdr' has float pixels"));
    CHECK_THAT(refused({"a.exr", "b.hdr"}, {.rounding = Rounding::round}),
               Catch::Contains("rounding fits none"));
    CHECK_THAT(refused({"a.hdr", "b.jpg"}, {.compression = "lzw"}),
               Catch::Contains("'a.hdr' has none to choose; 'b.jpg' has jpeg:1..100"));
    // A single file's are check_output's.
    CHECK(settings_for(std::vector<fs::path>{"a.exr"}, {.pixel_type = PixelType::uint8})[0].pixel_type ==
          PixelType::uint8);
    CHECK_THAT(usage_error_of([] { check_output("a.exr", {.rounding = Rounding::round}); }),
               Catch::Contains("half pixels are not rounded"));
}

}  // namespace sahl
