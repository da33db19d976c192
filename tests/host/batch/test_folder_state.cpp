#include <algorithm>
#include <fstream>
#include <iterator>

#include <catch2/catch.hpp>

#include "engine/batch/folder_state.h"
#include "tests/support/temporary_folder.h"

namespace sahl::tests {
namespace {

namespace fs = std::filesystem;

void write_image(const fs::path& path, std::size_t size) {
    std::ofstream(path, std::ios::binary) << std::string(size, 'x');
}

std::string record(int value) { return "{\"hash\":\"" + std::to_string(value) + "\"}"; }

std::string text_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TEST_CASE("folder records: what is added later is found, by its name's last line, and torn lines are not",
          "[batch]") {
    const TemporaryFolder folder;
    const fs::path file = folder / FolderRecords::file_name;
    FolderRecords records(folder.path());
    CHECK(records.find("a.jpg") == nullptr);
    const std::string odd = "b \xc3\xa8\xff\".jpg";  // no UTF-8
    for (const std::string& name : {std::string("a.jpg"), odd}) write_image(folder / name, 3);
    add_folder_record(folder / "a.jpg", record(1));
    REQUIRE(records.find("a.jpg") != nullptr);
    CHECK(records.find("a.jpg")->record == record(1));
    CHECK(records.find("a.jpg")->size == 3);
    CHECK(records.find(odd) == nullptr);
    add_folder_record(folder / odd, record(2));
    CHECK(records.find(odd)->record == record(2));
    // Somebody is killed in the midst of a line; others go on.
    std::ofstream(file, std::ios::app) << R"({"name":"a.jpg","size":3,"record":{"hash":"9)";
    CHECK(records.find("a.jpg")->record == record(1));
    write_image(folder / "a.jpg", 4);
    add_folder_record(folder / "a.jpg", record(3));
    CHECK(records.find("a.jpg")->record == record(3));
    CHECK(records.find("a.jpg")->size == 4);
    fs::remove(file);
    CHECK(records.find("a.jpg") == nullptr);
}

TEST_CASE("folder records: those that were replaced are dropped when nobody has a claim", "[batch]") {
    const TemporaryFolder folder;
    const fs::path file = folder / FolderRecords::file_name;
    write_image(folder / "a.jpg", 1);
    write_image(folder / "b.jpg", 2);
    FolderRecords records(folder.path());
    {
        const auto claim = Claim::take(folder / "a.jpg", Claim::Wait::no);
        add_folder_record(folder / "b.jpg", record(0));
        for (int i = 1; i <= 5; ++i) add_folder_record(folder / "a.jpg", record(i));
        const std::string before = text_of(file);
        CHECK(records.find("a.jpg")->record == record(5));
        tidy_folder(folder.path());
        CHECK(text_of(file) == before);
        CHECK(fs::exists(folder / Claim::file_name));
    }
    tidy_folder(folder.path());
    CHECK_FALSE(fs::exists(folder / Claim::file_name));
    const std::string text = text_of(file);
    CHECK(std::count(text.begin(), text.end(), '\n') == 2);
    CHECK(records.find("a.jpg")->record == record(5));
    CHECK(records.find("b.jpg")->record == record(0));
    add_folder_record(folder / "b.jpg", record(7));
    CHECK(records.find("b.jpg")->record == record(7));
}

}  // namespace sahl::tests
