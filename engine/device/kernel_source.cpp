#include "engine/device/kernel_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>

#include "engine/core/error.h"
#include "engine/device/embedded_kernels.h"

namespace sahl {
namespace {

constexpr std::string_view folder_name = "kernels/";

std::string read_kernel(const std::string& name, const std::string& included_from) {
    const std::string by = included_from.empty() ? "" : " (included from " + included_from + ")";
    if (const char* folder = std::getenv("SAHL_KERNEL_DIR"); folder != nullptr && *folder != '\0') {
        const std::filesystem::path path = std::filesystem::path(folder) / name;
        std::ifstream file(path, std::ios::binary);
        std::string text(std::istreambuf_iterator<char>(file), {});
        if (file.is_open() && !file.bad()) return text;
        throw Error(ExitCode::device,
                    fmt::format("{}: cannot read this kernel source{}; SAHL_KERNEL_DIR must be the "
                                "kernels folder of Sahl's sources, or unset",
                                path.string(), by));
    }
    for (const EmbeddedKernel& kernel : embedded_kernels()) {
        if (kernel.name == name) return std::string(kernel.text);
    }
    throw Error(ExitCode::device,
                fmt::format("{}{}: there is no such kernel source in this build{}", folder_name, name, by));
}

/// The first token of a preprocessor line ("if", "include"), empty for other lines.
std::string_view directive_of(std::string_view line) {
    const auto skip = [&] { line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size())); };
    skip();
    if (line.empty() || line.front() != '#') return {};
    line.remove_prefix(1);
    skip();
    return line.substr(0, line.find_first_of(" \t\"<\r"));
}

/// An include guard is a first directive #ifndef.
bool has_guard(const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        if (const std::string_view directive = directive_of(line); !directive.empty())
            return directive == "ifndef";
    }
    return false;
}

/// X of `#include "X"`.
std::optional<std::string> quoted_include(std::string_view line) {
    if (directive_of(line) != "include") return std::nullopt;
    const std::size_t begin = line.find('"');
    const std::size_t end = begin == line.npos ? begin : line.find('"', begin + 1);
    if (end == line.npos) return std::nullopt;
    return std::string(line.substr(begin + 1, end - begin - 1));
}

class Expander {
public:
    explicit Expander(KernelSource& result) : result_(result) {}

    void add_file(const std::string& name, const std::string& included_from, bool conditional) {
        if (std::find(open_.begin(), open_.end(), name) != open_.end()) return;  // its guard is closed
        const std::string text = read_kernel(name, included_from);
        if (!conditional && has_guard(text) && !once_.insert(name).second) return;
        open_.push_back(name);
        add_text(std::string(folder_name) + name, text, conditional);
        open_.pop_back();
    }

    void add_text(const std::string& label, const std::string& text, bool conditional) {
        result_.files[label] = text;
        result_.text += fmt::format("#line 1 \"{}\"\n", label);
        std::istringstream lines(text);
        std::string line;
        int depth = conditional ? 1 : 0;  // of conditionals around the line, without an include guard
        bool guarded = false;             // a first directive #ifndef is the include guard
        bool first_directive = true;
        for (int number = 1; std::getline(lines, line); ++number) {
            const std::string_view directive = directive_of(line);
            if (const auto name = quoted_include(line)) {
                const std::string here = fmt::format("{}:{}", label, number);
                add_file(kernel_name(*name, here), here, depth > 0);
                result_.text += fmt::format("#line {} \"{}\"\n", number + 1, label);
                continue;
            }
            if (first_directive && directive == "ifndef") {
                guarded = true;
            } else if (directive.substr(0, 2) == "if") {
                ++depth;
            } else if (directive == "endif") {
                if (depth == (conditional ? 1 : 0) && guarded) {
                    guarded = false;
                } else {
                    --depth;
                }
            }
            if (!directive.empty()) first_directive = false;
            result_.text += line;
            result_.text += '\n';
        }
    }

private:
    static std::string kernel_name(const std::string& path, const std::string& here) {
        if (path.rfind(folder_name, 0) == 0) return path.substr(folder_name.size());
        throw Error(ExitCode::device,
                    fmt::format("{}: #include \"{}\": kernel sources are included by the path \"{}NAME\"",
                                here, path, folder_name));
    }

    KernelSource& result_;
    std::set<std::string> once_;
    std::vector<std::string> open_;
};

/// Lines `line - 1` to `line` of the file with a caret below `column`; tabs stay tabs.
std::string excerpt(const std::string& text, int line, int column) {
    std::istringstream lines(text);
    std::string content;
    std::string result;
    for (int number = 1; number <= line && std::getline(lines, content); ++number) {
        if (number + 1 < line) continue;
        result += fmt::format("{:6} | {}\n", number, content);
    }
    if (result.empty() || column < 1) return result;
    std::string indent = content.substr(0, static_cast<std::size_t>(column - 1));
    std::replace_if(
        indent.begin(), indent.end(), [](char c) { return c != '\t'; }, ' ');
    return result + fmt::format("       | {}^\n", indent);
}

}  // namespace

KernelSource expand_files(const std::vector<std::string>& names) {
    KernelSource source;
    Expander expander(source);
    for (const std::string& name : names) expander.add_file(name, "", false);
    return source;
}

KernelSource expand_text(const std::string& text) {
    KernelSource source;
    Expander(source).add_text(text_name, text, false);
    return source;
}

std::string annotate_build_log(const std::string& log, const KernelSource& source) {
    std::istringstream lines(log);
    std::string line;
    std::string result;
    while (std::getline(lines, line)) {
        result += line + '\n';
        // By position: a place in a macro comes with the place where it is used.
        std::map<std::size_t, std::string> excerpts;
        for (const auto& [name, text] : source.files) {
            const std::string label = name + ":";
            for (std::size_t at = line.find(label); at != line.npos; at = line.find(label, at + 1)) {
                const char* const end = line.data() + line.size();
                int number = 0;
                int column = 0;
                const auto first = std::from_chars(line.data() + at + label.size(), end, number);
                if (first.ec != std::errc() || first.ptr == end || *first.ptr != ':') continue;
                const auto second = std::from_chars(first.ptr + 1, end, column);
                if (second.ec == std::errc()) excerpts[at] = excerpt(text, number, column);
            }
        }
        for (const auto& [at, lines_of_it] : excerpts) result += lines_of_it;
    }
    return result;
}

}  // namespace sahl
