// `sahl compare` of damaged images: each is refused by name, or read; nothing crashes, hangs or takes all
// memory.
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "engine/film/image_io.h"
#include "tests/cli/sahl_program.h"
#include "tests/support/test_data.h"

namespace sahl::tests {
namespace {

namespace fs = std::filesystem;

/// Of PNG chunks.
std::uint32_t crc32(const std::string& bytes) {
    std::uint32_t crc = ~0U;
    for (const char byte : bytes) {
        crc ^= static_cast<unsigned char>(byte);
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1U ^ ((crc & 1U) != 0 ? 0xedb88320U : 0U);
    }
    return ~crc;
}

std::string big_endian(std::uint32_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8)
        bytes += static_cast<char>(value >> static_cast<unsigned>(shift));
    return bytes;
}

std::string chunk(const std::string& type, const std::string& data) {
    return big_endian(static_cast<std::uint32_t>(data.size())) + type + data + big_endian(crc32(type + data));
}

/// A PNG file of 4x4 pixels with `more` behind its header.
void write_png(const fs::path& path, const std::string& more) {
    write_image(path, Image{4, 4, 3, std::vector<float>(48, 0.5F)}, {});
    std::ifstream file(path, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(file), {}};
    constexpr std::size_t end_of_header = 8 + 12 + 13;
    bytes.insert(end_of_header, more);
    write_file(path, bytes);
}

TEST_CASE("compare: an image that crashes its decoder is refused by name", "[cli]") {
    const TemporaryFolder folder;
    // XMP metadata nested so deep that OpenImageIO overflows its stack.
    std::string xmp = "XML:com.adobe.xmp";
    xmp.append(5, '\0');
    xmp += "<rdf:Description>";
    for (int level = 0; level < 200'000; ++level) xmp += "<a:b>";
    for (int level = 0; level < 200'000; ++level) xmp += "</a:b>";
    xmp += "</rdf:Description>";
    write_png(folder / "deep.png", chunk("iTXt", xmp));
    write_png(folder / "plain.png", chunk("tEXt", std::string("Comment\0harmless", 16)));
    CHECK(run_sahl_in(folder.path(), {"compare", "plain.png", "plain.png"}).status == 0);

    for (const std::vector<std::string>& images : {std::vector<std::string>{"deep.png", "plain.png"},
                                                   {"plain.png", "deep.png"},
                                                   {"plain.png", "plain.png", "--mask", "deep.png"}}) {
        std::vector<std::string> arguments{"compare"};
        arguments.insert(arguments.end(), images.begin(), images.end());
        const ProcessResult result = run_sahl_in(folder.path(), arguments);
        INFO(result.err);
        CHECK(result.status == 3);
        CHECK(contains(result.err, "cannot read image 'deep.png': its decoder crashes"));
        CHECK(result.out == "");
    }
}

TEST_CASE("compare: gigabytes claimed in a few bytes are refused before they are taken", "[cli]") {
    const TemporaryFolder folder;
    std::string header = big_endian(65536) + big_endian(65536) + std::string("\x08\x02\0\0\0", 5);
    write_file(folder / "bomb.png",
               "\x89PNG\r\n\x1a\n" + chunk("IHDR", header) + chunk("IDAT", "x") + chunk("IEND", ""));
    const ProcessResult result = run_sahl_in(folder.path(), {"compare", "bomb.png", "bomb.png"});
    INFO(result.err);
    CHECK(result.status == 3);
    CHECK(contains(result.err, "cannot read image 'bomb.png': it claims 65536x65536 pixels in 58 bytes"));
}

TEST_CASE("compare: every damaged image of the test data is refused by name or read", "[cli]") {
    const auto data = test_data();
    if (!data) {
        WARN("SKIPPED: no test data");
        return;
    }
    std::vector<fs::path> images;
    for (const char* kind : {"exr", "png", "jpg"})
        for (const auto& entry : fs::recursive_directory_iterator(*data / "bad" / kind))
            if (entry.is_regular_file()) images.push_back(entry.path());
    constexpr std::array of_scenes{".png", ".jpg", ".webp"};
    for (const auto& entry : fs::recursive_directory_iterator(*data / "bad/gltf"))
        if (std::find(of_scenes.begin(), of_scenes.end(), entry.path().extension()) != of_scenes.end())
            images.push_back(entry.path());
    CHECK(images.size() > 100);

    int refused = 0;
    for (const fs::path& image : images) {
        ProcessOptions options;
        options.timeout = std::chrono::seconds(60);  // of a busy machine; its decoder has a few
        const ProcessResult result = run_sahl({"compare", image, image}, options);
        INFO(image << " ended with status " << result.status << '\n' << result.err);
        CHECK_FALSE(result.timed_out);
        if (result.status == 0) continue;
        ++refused;
        CHECK((result.status == 1 || result.status == 3 || result.status == 5));
        // Status 1: there are NaNs in it.
        CHECK((result.status == 1 || contains(result.err, image.filename().string())));
    }
    CHECK(refused > 50);
}

}  // namespace
}  // namespace sahl::tests
