// Mutants of scene files load, or end in an error with its place, soon and without much memory; they never do
// anything else.
#include <sys/resource.h>
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "engine/core/child_process.h"
#include "engine/scene/scene_format.h"
#include "tests/host/scene/parse.h"
#include "tests/support/sound_scene.h"
#include "tests/support/test_data.h"

namespace sahl::tests {
namespace {

namespace fs = std::filesystem;

constexpr int mutants_per_loader = 10'000;
// What one mutant may cost.
constexpr std::size_t max_bytes = std::size_t{1} << 30;
constexpr std::size_t max_seconds = 5;

std::string text_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

// The file need not be there, what it includes is.
Scene parse(const fs::path& path, const std::string& text) {
    if (path.extension() == ".json") return read_scene_json(path, text);
    TextReader reader(path.string(), text);
    return path.extension() == ".nff" ? read_nff(reader) : read_cse167(reader);
}

class Mutator {
public:
    explicit Mutator(unsigned seed) : random_(seed) {}

    // One to three changes.
    std::string mutate(std::string text) {
        for (std::size_t changes = 1 + below(3); changes > 0 && !text.empty(); --changes) change(text);
        return text;
    }

private:
    std::size_t below(std::size_t n) { return static_cast<std::size_t>(random_() % n); }

    void change(std::string& text) {
        const std::size_t at = below(text.size());
        const std::size_t length = std::min(below(60) + 1, text.size() - at);
        switch (below(12)) {
            case 0:
                text[at] = static_cast<char>(random_());
                break;
            case 1:
                text[at] = static_cast<char>(static_cast<unsigned char>(text[at]) ^ (1U << below(8)));
                break;
            case 2:
                text.erase(at, length);
                break;
            case 3:
                text.insert(at, text.substr(at, length));
                break;
            case 4:
                text.insert(below(text.size()), text.substr(at, length));
                break;
            case 5:
                text.resize(at);
                break;
            case 6:
                swap_words(text, at);
                break;
            case 7:
                text.insert(at, words[below(std::size(words))]);
                break;
            default:  // most often: the text stays JSON
                replace_number(text, at);
        }
    }

    void replace_number(std::string& text, std::size_t at) {
        const std::size_t start = text.find_first_of("0123456789", at);
        if (start == std::string::npos) return;
        const std::size_t end = std::min(text.find_first_not_of("0123456789.eE+-", start), text.size());
        text.replace(start, end - start, numbers[below(std::size(numbers))]);
    }

    // Two quoted words change places: keys, names, types, references.
    void swap_words(std::string& text, std::size_t at) {
        const auto word = [&](std::size_t from) {
            const std::size_t start = text.find('"', from);
            const std::size_t end = start == std::string::npos ? start : text.find('"', start + 1);
            return end == std::string::npos ? std::string() : text.substr(start, end + 1 - start);
        };
        const std::string first = word(at);
        const std::string second = word(below(text.size()));
        if (first.empty() || second.empty()) return;
        const std::size_t place = text.find(first, at);
        text.replace(place, first.size(), second);
        const std::size_t other = text.find(second, (place + second.size()) % text.size());
        if (other != std::string::npos) text.replace(other, second.size(), first);
    }

    static constexpr const char* numbers[] = {"0",
                                              "-1",
                                              "1e308",
                                              "1e999",
                                              "nan",
                                              "-0",
                                              "1e-308",
                                              "1e-20",
                                              "1e15",
                                              "-1e15",
                                              "99999999999999999999",
                                              "4294967296",
                                              "2147483647",
                                              "65536",
                                              "1.5"};
    static constexpr const char* words[] = {"{",           "}",           "[",
                                            "]",           ",",           ":",
                                            "\"",          "\\",          "//",
                                            "/*",          "*/",          "null",
                                            "true",        "\"$radius\"", "\"$x\"",
                                            " nan ",       "\n",          "\r",
                                            " -1 ",        " 1e308 ",     "[[[[",
                                            "\"\\ud800\"", "\xff",        "#",
                                            "\"a.nff\"",   "\"..\"",      "popTransform\n",
                                            " pp "};
    std::mt19937 random_;
};

// "/folder/file.json:12:3: …", the file being one of the folder.
bool has_place(const std::string& message, const fs::path& folder) {
    const std::string start = folder.string() + "/";
    if (!message.starts_with(start)) return false;
    const std::size_t colon = message.find(':', start.size());
    int line = 0;
    int column = 0;
    return colon != std::string::npos &&
           std::sscanf(message.c_str() + colon, ":%d:%d: ", &line, &column) == 2 && line >= 1 && column >= 1;
}

/// What became of a mutant; the child says `started` before it parses one.
struct Report {
    enum class Kind { started, loaded, refused, wrong };
    Kind kind = Kind::started;
    int mutant = 0;
    std::array<char, 500> words{};  ///< of what is wrong
};

Report try_mutant(const fs::path& path, const std::string& text, int number) {
    Report report{Report::Kind::refused, number};
    std::string wrong;
    try {
        wrong = flaw_of(parse(path, text));
        report.kind = Report::Kind::loaded;
    } catch (const Error& error) {
        if (error.code() != ExitCode::scene || !has_place(error.what(), path.parent_path()))
            wrong = fmt::format("an error without its place: {}", error.what());
    }
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    if (static_cast<std::size_t>(used.ru_maxrss) * 1024 > max_bytes)
        wrong = "a mutant that takes much memory";
    if (!wrong.empty()) {
        report.kind = Report::Kind::wrong;
        wrong.copy(report.words.data(), report.words.size() - 1);
    }
    return report;
}

struct Counts {
    int loaded = 0;
    int refused = 0;
};

/// Mutants 0…count - 1 of the scene `seed`, in a child process that each mutant may bring down.
void try_mutants(const fs::path& seed, int count, Counts& counts) {
    const std::string text = text_of(seed);
    REQUIRE(text.size() > 100);
    const fs::path path = seed.parent_path() / ("mutant" + seed.extension().string());
    const auto mutant = [&](int number) { return Mutator(static_cast<unsigned>(number)).mutate(text); };
    const auto bytes_of = [](Report& report) { return std::span(&report, 1); };
    Report report;
    const std::string misdeed = run_in_child(
        [&](const PipeEnd& pipe) {
            for (int number = 0; number < count; ++number) {
                Report started{Report::Kind::started, number};
                pipe.write(std::as_bytes(bytes_of(started)));
                limit_process(max_bytes, max_seconds);
                Report end = try_mutant(path, mutant(number), number);
                pipe.write(std::as_bytes(bytes_of(end)));
            }
        },
        [&](const PipeEnd& pipe) {
            while (report.kind != Report::Kind::wrong &&
                   pipe.read(std::as_writable_bytes(bytes_of(report)))) {
                counts.loaded += report.kind == Report::Kind::loaded ? 1 : 0;
                counts.refused += report.kind == Report::Kind::refused ? 1 : 0;
            }
        });
    if (report.kind == Report::Kind::started || report.kind == Report::Kind::wrong) {
        INFO("mutant " << report.mutant << " of " << seed << ":\n" << mutant(report.mutant));
        FAIL((report.kind == Report::Kind::wrong ? report.words.data() : "the loader " + misdeed));
    }
    CHECK(misdeed == "");
}

/// Our scenes of this format, and small ones of the test data.
std::vector<fs::path> seeds(SceneFormat format) {
    constexpr std::uintmax_t small = 16'384;
    const fs::path sources = std::getenv("SAHL_SOURCE_DIR");
    std::vector<fs::path> folders{sources / "tests/data", sources / "scenes", sources / "docs/examples"};
    if (const auto data = test_data()) {
        folders.push_back(*data / "spd");
        folders.push_back(*data / "cse167");
    }
    std::vector<fs::path> files;
    for (const fs::path& folder : folders) {
        for (const auto& entry : fs::recursive_directory_iterator(folder)) {
            if (entry.is_regular_file() && scene_format(entry.path()) == format && entry.file_size() <= small)
                files.push_back(entry.path());
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

}  // namespace

TEST_CASE("10,000 mutants of scenes for each loader load or end in an error with its place",
          "[scene][json]") {
    for (const SceneFormat format : {SceneFormat::json, SceneFormat::nff, SceneFormat::cse167}) {
        const std::vector<fs::path> files = seeds(format);
        REQUIRE_FALSE(files.empty());
        Counts counts;
        const int each = mutants_per_loader / static_cast<int>(files.size()) + 1;
        for (const fs::path& file : files) try_mutants(file, each, counts);
        INFO(files.front());
        CHECK(counts.loaded + counts.refused >= mutants_per_loader);
        // Most damage is seen; some, such as in comments, is none.
        CHECK(counts.refused > mutants_per_loader / 3);
        CHECK(counts.loaded > mutants_per_loader / 20);
    }
}

}  // namespace sahl::tests
