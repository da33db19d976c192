// `sahl completion` and `sahl man`: what shells and man make of them.
#include <algorithm>
#include <sstream>

#include <catch2/catch.hpp>

#include "tests/cli/sahl_program.h"

namespace sahl::tests {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

/// Runs a program that is found in PATH.
ProcessResult run_tool(std::vector<std::string> command, const fs::path& folder) {
    command.insert(command.begin(), "/usr/bin/env");
    ProcessOptions options;
    options.working_directory = folder;
    options.environment["LC_ALL"] = "C.UTF-8";
    return run_process(command, options);
}

bool is_there(const std::string& tool) {
    return run_tool({"sh", "-c", "command -v " + tool}, ".").status == 0;
}

std::string output_of(const std::vector<std::string>& arguments) {
    const ProcessResult result = run_sahl(arguments);
    INFO(result.err);
    REQUIRE(result.status == 0);
    return result.out;
}

/// A folder with the script and some files to complete.
struct BashRoom {
    TemporaryFolder folder;

    BashRoom() {
        write_file(folder / "sahl.bash", output_of({"completion", "bash"}));
        write_file(folder / "scene one.nff", "");
        write_file(folder / "scene.json", "");
        write_file(folder / "scene.png", "");
        write_file(folder / "OLD.TEST", "");
        fs::create_directory(folder / "scenes");
    }

    /// COMPREPLY, sorted, for the command line `words`, whose last one is being typed.
    std::vector<std::string> complete(const std::vector<std::string>& words) const {
        const std::string script =
            "source ./sahl.bash && COMP_WORDS=(\"$@\") COMP_CWORD=$(($# - 1)) && _sahl && "
            "printf '%s\\n' \"${COMPREPLY[@]}\"";
        std::vector<std::string> command{"bash", "--norc", "-c", script, "bash"};
        command.insert(command.end(), words.begin(), words.end());
        const ProcessResult result = run_tool(command, folder.path());
        INFO(result.err);
        CHECK(result.status == 0);
        CHECK(result.err == "");
        std::vector<std::string> replies = lines_of(result.out);
        if (replies == std::vector<std::string>{""}) replies.clear();
        std::sort(replies.begin(), replies.end());
        return replies;
    }
};

using Words = std::vector<std::string>;

}  // namespace

TEST_CASE("completion: bash completes commands, options, files and words", "[cli]") {
    const BashRoom room;
    struct Case {
        Words typed;
        Words replies;
    };
    const std::vector<Case> cases{
        {{"sahl", "re"}, {"render"}},
        {{"sahl", "--js"}, {"--json"}},
        {{"sahl", "--device", "render", "comp"}, {"compare", "completion"}},
        {{"sahl", "--color", "=", "always", "inf"}, {"info"}},
        {{"sahl", "render", "--pi"}, {"--pixel-type"}},
        {{"sahl", "--json", "render", "--sp"}, {"--spp"}},
        {{"sahl", "compare", "--sp"}, {}},
        {{"sahl", "render", "--transfer", ""}, {"linear", "srgb"}},
        {{"sahl", "render", "--transfer", "=", "l"}, {"linear"}},
        {{"sahl", "render", "--transfer", "="}, {"linear", "srgb"}},
        {{"sahl", "render", "--rounding", "f"}, {"floor"}},
        {{"sahl", "render", "--pixel-type", "u"}, {"uint16", "uint8"}},
        {{"sahl", "render", "--compression", "z"}, {"zip", "zips"}},
        {{"sahl", "render", "--aov", "id.p"}, {"id.primitive"}},
        {{"sahl", "render", "--aov", "al"}, {"albedo", "all"}},
        {{"sahl", "render", "--aov", "Z,al"}, {"Z,albedo"}},
        {{"sahl", "render", "--aov", "Z,albedo,id.primitive,"},
         {"Z,albedo,id.primitive,N", "Z,albedo,id.primitive,cost.nodes", "Z,albedo,id.primitive,cost.rays",
          "Z,albedo,id.primitive,id.instance", "Z,albedo,id.primitive,id.material"}},
        {{"sahl", "render", "--aov", "all,"}, {}},
        {{"sahl", "info", "--color", "a"}, {"always", "auto"}},
        {{"sahl", "render", "--spp", ""}, {}},
        {{"sahl", "render", "sc"}, {"scene one.nff", "scene.json", "scenes"}},
        {{"sahl", "info", ""}, {"OLD.TEST", "scene one.nff", "scene.json", "scenes"}},
        {{"sahl", "convert", "sa"}, {}},
        {{"sahl", "render", "scene.json", "-o", "scene."}, {"scene.json", "scene.png"}},
        {{"sahl", "render", "--asset-root", ""}, {"scenes"}},
        {{"sahl", "compare", "a.png", "sahl"}, {"sahl.bash"}},
        {{"sahl", "completion", ""}, {"bash", "zsh"}},
        {{"sahl", "devices", ""}, {}},
        {{"sahl", "profile", "di"}, {"diff"}},
        {{"sahl", "profile", "diff", "--fo"}, {"--force"}},
        {{"sahl", "profile", "--fo"}, {}},
        {{"sahl", "profile", "diff", "--color", "a"}, {"always", "auto"}},
        {{"sahl", "profile", "diff", "scene.j"}, {"scene.json"}},
    };
    for (const Case& item : cases) {
        std::string line;
        for (const std::string& word : item.typed) line += word + "|";
        INFO(line);
        CHECK(room.complete(item.typed) == item.replies);
    }
    CHECK(room.complete({"sahl", ""}) == Words{"batch", "compare", "completion", "convert", "devices",
                                               "explain", "info", "man", "profile", "render", "warm"});
}

TEST_CASE("completion: bash offers exactly the options of --help", "[cli]") {
    const BashRoom room;
    for (const std::string command :
         {"render", "profile", "compare", "info", "convert", "devices", "completion", "man"}) {
        Words expected;
        for (const std::string& line : lines_of(output_of({command, "--help"}))) {
            std::istringstream words(line);
            std::string names;
            words >> names;
            if (!line.starts_with("  -")) continue;
            std::istringstream stream(names);
            for (std::string name; std::getline(stream, name, ',');) expected.push_back(name);
        }
        std::sort(expected.begin(), expected.end());
        INFO(command);
        CHECK(expected.size() >= 6);
        CHECK(room.complete({"sahl", command, "-"}) == expected);
    }
}

TEST_CASE("completion: zsh takes the script and completes", "[cli]") {
    const TemporaryFolder folder;
    write_file(folder / "_sahl", output_of({"completion", "zsh"}));
    if (!is_there("zsh")) {
        WARN("SKIPPED: zsh is not installed");
        return;
    }
    const ProcessResult syntax = run_tool({"zsh", "-f", "-n", "_sahl"}, folder.path());
    INFO(syntax.err);
    CHECK(syntax.status == 0);

    write_file(folder / "one.nff", "");
    write_file(folder / "OLD.TEST", "");
    write_file(folder / "image.png", "");
    fs::create_directory(folder / "folder");
    // A shell on a pseudo terminal, which is asked to list what could follow.
    write_file(folder / "ask", R"(zmodload zsh/zpty
zpty shell zsh -f -i
zpty -w shell "PS1=; autoload -Uz compinit; compinit -u -D; source ./_sahl; bindkey '^I' list-choices; print rea''dy"
zpty -r -m shell discarded '*ready*'
zpty -n -w shell "$1"$'\t'
sleep 1
while zpty -r -t shell piece; do print -rn -- "$piece"; done
zpty -d shell
)");
    const auto listed = [&](const std::string& typed) {
        return run_tool({"zsh", "-f", "ask", typed}, folder.path()).out;
    };
    CHECK_THAT(listed("sahl re"), Catch::Contains("render"));
    CHECK_THAT(listed("sahl render --transfer "), Catch::Contains("srgb") && Catch::Contains("linear"));
    CHECK_THAT(listed("sahl render --pix"), Catch::Contains("--pixel-type"));
    CHECK_THAT(listed("sahl render --aov="), Catch::Contains("all ") && Catch::Contains("albedo"));
    CHECK_THAT(listed("sahl render --aov=Z,"), Catch::Contains("albedo") && !Catch::Contains("all "));
    CHECK_THAT(listed("sahl info "), Catch::Contains("one.nff") && Catch::Contains("OLD.TEST") &&
                                         Catch::Contains("folder") && !Catch::Contains("image.png"));
    CHECK_THAT(listed("sahl render --aov=Z,id"),
               Catch::Contains("id.primitive") && Catch::Contains("id.material"));
}

TEST_CASE("completion: a shell that there is none for", "[cli]") {
    const ProcessResult result = run_sahl({"completion", "fish"});
    CHECK(result.status == 2);
    CHECK_THAT(result.err, Catch::Contains("'fish': one of bash, zsh is wanted"));
    CHECK(run_sahl({"completion"}).status == 2);
}

TEST_CASE("man page: every command and option of --help is in it", "[cli]") {
    const std::string page = output_of({"man"});
    for (const char* title : {"NAME", "SYNOPSIS", "DESCRIPTION", "COMMANDS", "OPTIONS", "EXIT STATUS",
                              "ENVIRONMENT", "FILES", "EXAMPLES"})
        CHECK_THAT(page, Catch::Contains(std::string(".SH ") + title + "\n"));
    std::string plain = page;  // as it reads, but for fonts
    for (const auto& [escape, character] : {std::pair{"\\-", "-"}, {"\\(aq", "'"}, {"\\(ti", "~"}}) {
        const std::string from = escape;
        for (std::size_t at = plain.find(from); at != std::string::npos; at = plain.find(from, at + 1))
            plain.replace(at, from.size(), character);
    }
    for (const std::string command :
         {"render", "compare", "info", "convert", "devices", "completion", "man"}) {
        CHECK(contains(plain, ".SS sahl " + command + "\n"));
        for (const std::string& line : lines_of(output_of({command, "--help"}))) {
            INFO(command << ": " << line);
            if (line.starts_with("  sahl ")) CHECK(contains(plain, "\n" + line.substr(2) + "\n"));
            if (!line.starts_with("  -")) continue;
            std::istringstream words(line);
            std::string names;
            words >> names;
            std::istringstream stream(names);
            for (std::string name; std::getline(stream, name, ',');)
                CHECK(contains(plain, "\\fB" + name + "\\fR"));
        }
    }
}

TEST_CASE("man page: groff and man have nothing to complain of", "[cli]") {
    const TemporaryFolder folder;
    write_file(folder / "sahl.1", output_of({"man"}));
    int checked = 0;
    if (is_there("groff")) {
        const ProcessResult result = run_tool({"groff", "-man", "-ww", "-Tutf8", "sahl.1"}, folder.path());
        CHECK(result.status == 0);
        CHECK(result.err == "");
        ++checked;
    }
    if (is_there("man")) {
        const ProcessResult result = run_tool({"man", "--warnings", "-l", "sahl.1"}, folder.path());
        CHECK(result.err == "");
        // A system without manual pages has a `man` that only says so.
        if (contains(result.out, "SAHL(1)")) ++checked;
    }
    if (checked == 0) WARN("SKIPPED: neither groff nor man is installed");
}

}  // namespace sahl::tests
