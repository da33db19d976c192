// Command lines that cannot be meant: exit status 2 and a message that says what is allowed.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "tests/cli/sahl_program.h"

namespace sahl::tests {
namespace {

struct Mistake {
    std::vector<std::string> arguments;
    std::string message;            ///< what standard error has to say, among other things
    std::string more_message = {};  ///< and this
};

void check_refused(const Mistake& mistake) {
    const TemporaryFolder folder;
    const ProcessResult result = run_sahl_in(folder.path(), mistake.arguments);
    std::string line;
    for (const std::string& argument : mistake.arguments) line += " " + argument;
    INFO("sahl" << line << "\n" << result.err);
    CHECK(result.status == 2);
    CHECK(result.out == "");
    CHECK(result.err.starts_with("sahl: error: "));
    CHECK(result.err.find(mistake.message) != std::string::npos);
    CHECK(result.err.find(mistake.more_message) != std::string::npos);
    CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("usage: commands, options and arguments that do not exist", "[cli]") {
    const auto mistake = GENERATE(values<Mistake>({
        {{}, "which command?"},
        {{"rendr", "a.nff"}, "no command 'rendr'; did you mean 'render'?"},
        {{"--jsn"}, "no option --jsn; did you mean '--json'?"},
        {{"render"}, "SCENE is required"},
        {{"render", "a.nff", "--sise", "4x4"}, "no option --sise; did you mean '--size'?"},
        {{"render", "--sise=4x4", "a.nff"}, "no option --sise; did you mean '--size'?"},
        {{"render", "a.nff", "b.nff"}, "nothing takes the argument 'b.nff'"},
        {{"render", "a.nff", "--spp"}, "--spp"},
        {{"render", "a.nff", "--spp", "1", "--spp", "2"}, "--spp"},
        {{"render", "a.nff", "-q", "-v"}, "contradict"},
        {{"compare", "a.png"}, "B is required"},
        {{"compare", "a.png", "b.png", "--device", "0"}, "no option --device"},
        {{"devices", "0"}, "nothing takes the argument '0'"},
    }));
    check_refused(mistake);
}

TEST_CASE("usage: the hint names the command's own help", "[cli]") {
    CHECK(run_sahl({"render", "--sise"}).err.find("'sahl render --help'") != std::string::npos);
    CHECK(run_sahl({"rendr"}).err.find("'sahl --help'") != std::string::npos);
}

struct Refusal {
    std::string option;
    std::string wanted;  ///< what the message says is allowed
    std::vector<std::string> texts;
};

TEST_CASE("usage: values outside their range", "[cli]") {
    const auto refusal = GENERATE(values<Refusal>({
        {"--spp",
         "1 to 16384",
         {"0", "16385", "-1", "4.5", "many", "", "1 ", "0x10", "99999999999999999999"}},
        {"--depth", "0 to 64", {"-1", "65", "", "1,", ",1", "1,,2", "1;2", "two"}},
        {"--depth", "each depth once", {"1,1", "0,1,2,0"}},
        {"--size", "1 to 65536", {"0x10", "10x0", "65537x1", "x", "-4x4", "4 x4", "4.0x4"}},
        {"--size", "WIDTHxHEIGHT", {"64", "64x64x64", "64*64", ""}},
        {"--crop", "X0,Y0,X1,Y1", {"1", "0,0,4", "0,0,4,4,4", "4x4"}},
        {"--crop", "0 to 65536", {"a,0,4,4", "-1,0,4,4", "0,0,4,65537"}},
        {"--crop", "X0 < X1", {"4,0,4,4", "0,4,4,4", "8,0,4,4"}},
        {"--samples", "A..B", {"4", "0.4", "0-4", ""}},
        {"--samples", "0 to 16384", {"..4", "0..", "-1..4", "0..16385", "0...4"}},
        {"--samples", "A < B", {"4..4", "5..4"}},
        {"--seed", "0 to 18446744073709551615", {"-1", "1.5", "x", "18446744073709551616"}},
        {"--exposure", "-100 to 100", {"nan", "inf", "101", "-1e3", "one", "1,5", ""}},
        {"--transfer", "srgb, linear", {"gamma", "sRGB", ""}},
        {"--rounding", "round, floor", {"ceil"}},
        {"--pixel-type", "half, float, uint8, uint16", {"int8", "double"}},
        {"--threads", "1 to 1024", {"0", "-1", "1025", "two"}},
        {"--color", "auto, always, never", {"yes"}},
    }));
    for (const std::string& text : refusal.texts) {
        const std::vector<std::string> arguments{"render", scene_file("cli_mirrors.nff"), refusal.option,
                                                 text};
        check_refused({arguments, fmt::format("{} '", refusal.option), refusal.wanted});
    }
}

TEST_CASE("usage: a crop outside the image", "[cli]") {
    // The scene is 48x32.
    check_refused({{"render", scene_file("cli_mirrors.nff"), "--crop", "0,0,49,32"}, "48x32"});
    check_refused({{"render", scene_file("cli_mirrors.nff"), "--crop", "0,0,5,4", "--size", "4x4"}, "4x4"});
}

TEST_CASE("usage: samples that a pixel does not have", "[cli]") {
    check_refused({{"render", scene_file("cli_mirrors.nff"), "--samples", "0..2"}, "--spp 1"});
    check_refused({{"render", scene_file("cli_mirrors.nff"), "--spp", "8", "--samples", "4..9"}, "--spp 8"});
}

TEST_CASE("usage: names of several images", "[cli]") {
    const std::string scene = scene_file("cli_mirrors.nff");
    check_refused({{"render", scene, "--depth", "0,1"}, "-o 'cli_mirrors_{depth}.png'"});
    check_refused({{"render", scene, "--depth", "0,1", "-o", "a.png"}, "{depth}"});
    check_refused({{"render", scene, "-o", "a{spp}.png"}, "no placeholder {spp}; there is {depth}"});
    check_refused({{"render", scene, "--depth", "0,1", "-o", "{depth}{}.png"}, "no placeholder {}"});
}

TEST_CASE("usage: files of no known format", "[cli]") {
    check_refused({{"render", scene_file("cli_mirrors.nff"), "-o", "a.xyz"}, "xyz"});
    check_refused({{"render", scene_file("cli_mirrors.nff"), "-o", "noextension"}, "noextension"});
    check_refused({{"render", "scene.doc"}, ".nff"});
}

}  // namespace
}  // namespace sahl::tests
