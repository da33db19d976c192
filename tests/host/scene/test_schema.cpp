// The JSON Schema of Sahl scenes against the loader: documents that both accept, and documents made
// wrong at one place: what the schema refuses the loader refuses too, at a place.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/core/error.h"
#include "engine/scene/load.h"
#include "tests/support/json_schema.h"
#include "tests/support/temporary_folder.h"

namespace sahl::tests {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using Pointer = ordered_json::json_pointer;

fs::path source(const std::string& path) { return fs::path(std::getenv("SAHL_SOURCE_DIR")) / path; }

std::string read_text(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    REQUIRE(file.good());
    return {std::istreambuf_iterator<char>(file), {}};
}

void write_text(const fs::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

ordered_json parse(const std::string& text) { return ordered_json::parse(text, nullptr, true, true); }

/// Documents with the name of where they come from.
using Documents = std::vector<std::pair<std::string, std::string>>;

Documents scenes_in(const fs::path& folder) {
    Documents documents;
    if (!fs::exists(folder)) return documents;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (entry.path().extension() == ".json")
            documents.emplace_back(entry.path().string(), read_text(entry.path()));
    }
    std::sort(documents.begin(), documents.end());
    return documents;
}

/// The ```json blocks of the reference page that are whole scenes.
Documents scenes_in_page() {
    const std::string page = read_text(source("docs/scene-format.md"));
    const std::string fence = "```json\n";
    Documents documents;
    for (std::size_t at = page.find(fence); at != std::string::npos; at = page.find(fence, at)) {
        at += fence.size();
        const std::string block = page.substr(at, page.find("```", at) - at);
        const auto line = std::count(page.begin(), page.begin() + static_cast<std::ptrdiff_t>(at), '\n') + 1;
        if (block.find("\"sahl\"") != std::string::npos)
            documents.emplace_back(fmt::format("docs/scene-format.md:{}", line), block);
    }
    return documents;
}

/// What the loader says against a document: nothing, or the message. A message without a place fails the
/// test.
std::string loader_refusal(const fs::path& file, const std::string& text) {
    write_text(file, text);
    try {
        load_scene(file);
        return "";
    } catch (const SceneError& error) {
        const std::string message = error.what();
        if (!message.starts_with(file.parent_path().string())) FAIL_CHECK("no place: " << message);
        return message;
    }
}

/// Places in documents that are not yet another of a kind: `kind` is the way there without indices, with
/// the types of the objects on it.
class Places {
public:
    std::vector<Pointer> of(const ordered_json& document) {
        found_.clear();
        find(document, Pointer(), "");
        return std::move(found_);
    }

private:
    void find(const ordered_json& value, const Pointer& here, std::string kind) {
        constexpr int enough = 2;
        if (value.is_object() && value.contains("type")) kind += value["type"].dump();
        if (++seen_[kind] <= enough) found_.push_back(here);
        if (value.is_array()) {
            for (std::size_t i = 0; i < value.size(); ++i) find(value[i], here / i, kind + "/*");
        }
        if (value.is_object()) {
            for (const auto& [key, member] : value.items()) find(member, here / key, kind + "/" + key);
        }
    }

    std::map<std::string, int> seen_{};
    std::vector<Pointer> found_{};
};

/// The document with one thing changed, in every way that this knows for the value at `place`.
std::vector<ordered_json> mutants_at(const ordered_json& document, const Pointer& place) {
    std::vector<ordered_json> mutants;
    const auto put = [&](const ordered_json& value) { mutants.emplace_back(document)[place] = value; };
    const ordered_json& value = document[place];
    for (const char* other : {"null",
                              "true",
                              "-1",
                              "0",
                              "1",
                              "3",
                              "0.5",
                              "64",
                              "179",
                              "65536",
                              "1e15",
                              "1e-15",
                              "200",
                              "1e16",
                              "-1e16",
                              "70000",
                              "\"\"",
                              "\"text\"",
                              "\"$none\"",
                              "[]",
                              "[1]",
                              "[1,2,3]",
                              "[1,2,3,4]",
                              "[-1,0,0]",
                              "{}",
                              "{\"type\":\"sphere\"}",
                              "[{\"type\":\"sphere\"}]"}) {
        put(ordered_json::parse(other));
    }
    if (value.is_object()) {
        mutants.emplace_back(document)[place]["no_such_key"] = 1;
        for (const auto& [key, member] : value.items()) {
            mutants.emplace_back(document)[place].erase(key);
            ordered_json& renamed = mutants.emplace_back(document)[place];
            renamed.erase(key);
            renamed[key + "x"] = member;
            for (const std::string& name : {std::string(), "$" + key, "1-" + key}) {
                ordered_json& other = mutants.emplace_back(document)[place];
                other.erase(key);
                other[name] = member;
            }
        }
    }
    if (value.is_array() && !value.empty()) {
        mutants.emplace_back(document)[place].push_back(value.back());
        ordered_json& shorter = mutants.emplace_back(document)[place];
        shorter.erase(shorter.size() - 1);
    }
    return mutants;
}

// Every key under "properties" in the schema.
void find_keys(const nlohmann::json& schema, std::map<std::string, bool>& keys) {
    if (schema.is_object()) {
        for (const auto& [key, value] : schema.items()) {
            if (key == "properties") {
                for (const auto& [name, ignored] : value.items()) keys[name] = true;
            }
            find_keys(value, keys);
        }
    } else if (schema.is_array()) {
        for (const nlohmann::json& value : schema) find_keys(value, keys);
    }
}

}  // namespace

TEST_CASE("Documented scenes and our own are valid by the schema and load", "[scene][schema]") {
    const JsonSchema schema("sahl-scene.schema.json");
    const Documents examples = scenes_in(source("docs/examples"));
    REQUIRE(examples.size() >= 20);
    for (const Documents& documents : {examples, scenes_in(source("scenes"))}) {
        for (const auto& [name, text] : documents) {
            INFO(name);
            CHECK(schema.refusal(parse(text)) == "");
            CHECK_NOTHROW(load_scene(name));
        }
    }
    const Documents blocks = scenes_in_page();
    REQUIRE(!blocks.empty());
    const TemporaryFolder folder;
    for (const auto& [name, text] : blocks) {
        INFO(name);
        CHECK(schema.refusal(parse(text)) == "");
        CHECK(loader_refusal(folder / "block.json", text) == "");
    }
}

TEST_CASE("What the schema refuses the loader refuses, too, and says where", "[scene][schema]") {
    const JsonSchema schema("sahl-scene.schema.json");
    const TemporaryFolder folder;
    for (const auto& entry : fs::directory_iterator(source("docs/examples")))
        fs::copy(entry.path(), folder / entry.path().filename().string());
    Places places;
    int refused = 0;
    int accepted = 0;
    for (const auto& [name, text] : scenes_in(source("docs/examples"))) {
        const ordered_json document = parse(text);
        for (const Pointer& place : places.of(document)) {
            for (const ordered_json& mutant : mutants_at(document, place)) {
                const std::string reason = schema.refusal(mutant);
                const std::string changed = mutant.dump();
                if (reason.empty()) {
                    ++accepted;
                    continue;
                }
                ++refused;
                if (loader_refusal(folder / "mutant.json", changed).empty()) {
                    FAIL_CHECK(name << " at " << place.to_string() << " became "
                                    << (mutant.contains(place) ? mutant[place].dump() : "nothing")
                                    << ": loaded, and the schema says\n"
                                    << reason);
                }
            }
        }
    }
    CHECK(refused > 10000);
    CHECK(accepted > 100);
}

TEST_CASE("Every key of the schema is on the reference page", "[scene][schema]") {
    const std::string page = read_text(source("docs/scene-format.md"));
    std::map<std::string, bool> keys;
    find_keys(nlohmann::json::parse(read_text(source("docs/sahl-scene.schema.json"))), keys);
    CHECK(keys.size() > 60);
    for (const auto& [key, ignored] : keys) {
        INFO(key);
        CHECK(page.find("`" + key + "`") != std::string::npos);
    }
}

TEST_CASE("Every example has its picture and its place on the reference page", "[scene][schema]") {
    const std::string page = read_text(source("docs/scene-format.md"));
    for (const auto& [name, text] : scenes_in(source("docs/examples"))) {
        const std::string stem = fs::path(name).stem().string();
        INFO(stem);
        CHECK(page.find("](images/examples/" + stem + ".png)") != std::string::npos);
        CHECK(page.find("](examples/" + stem + ".json)") != std::string::npos);
        CHECK(fs::exists(source("docs/images/examples/" + stem + ".png")));
    }
}

}  // namespace sahl::tests
