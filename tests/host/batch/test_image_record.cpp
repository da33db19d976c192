// Records in image files, and files that are not what they seem.
#include <fstream>
#include <iterator>
#include <random>

#include <catch2/catch.hpp>

#include "engine/batch/image_record.h"
#include "engine/batch/job_record.h"
#include "engine/film/image_io.h"
#include "tests/support/temporary_folder.h"

namespace sahl::tests {
namespace {

namespace fs = std::filesystem;

void write_with_record(const fs::path& path, const std::string& record, const std::string& compression) {
    Image image{.width = 20, .height = 70, .channels = 3, .pixels = std::vector<float>(20 * 70 * 3)};
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<float>(i % 97) / 97;
    OutputSettings settings;
    if (!compression.empty()) settings.compression = compression;
    settings.metadata = {{"Software", "test"}, {record_name, record}};
    write_image(path, image, settings);
}

std::string bytes_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TEST_CASE("image record: it is found in EXR of every compression and in PNG, and a cut file is no image",
          "[batch]") {
    const TemporaryFolder folder;
    const std::string record = "{\"long\":\"" + std::string(20000, 'r') + "\"}";
    const auto check = [&](const fs::path& path, const std::string& compression) {
        INFO(path << " " << compression);
        write_with_record(path, record, compression);
        const StoredRecord stored = read_image_record(path);
        CHECK(stored.problem == "");
        CHECK(stored.record == record);
        const std::string whole = bytes_of(path);
        for (const std::size_t size :
             {std::size_t{0}, std::size_t{3}, std::size_t{100}, whole.size() / 2, whole.size() - 1}) {
            std::ofstream(path, std::ios::binary) << whole.substr(0, size);
            CHECK(read_image_record(path).problem != "");
        }
    };
    for (const char* name : {"none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"})
        check(folder / "a.exr", name);
    check(folder / "a.png", "");
    CHECK(read_image_record(folder / "none.png").problem == "it is not there");
    CHECK(read_image_record(folder.path()).problem == "it is no regular file");
}

TEST_CASE("image record: files with any bytes changed are read without harm", "[batch]") {
    const TemporaryFolder folder;
    std::mt19937 random(3);
    for (const char* name : {"a.exr", "a.png"}) {
        write_with_record(folder / name, "{\"a\":1}", "");
        const std::string whole = bytes_of(folder / name);
        int refused = 0;
        for (int i = 0; i < 2000; ++i) {
            std::string mutant = whole;
            for (int k = 0; k < 3; ++k)
                mutant[random() % std::min<std::size_t>(mutant.size(), 800)] = static_cast<char>(random());
            std::ofstream(folder / name, std::ios::binary) << mutant;
            const StoredRecord stored = read_image_record(folder / name);
            refused += stored.problem.empty() ? 0 : 1;
        }
        CHECK(refused > 0);
    }
}

}  // namespace sahl::tests
