#include "tests/cli/sahl_program.h"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

namespace sahl::tests {

namespace {

std::string environment(const char* name) {
    const char* value = std::getenv(name);
    if (value == nullptr) throw std::runtime_error(std::string(name) + " is not set");
    return value;
}

}  // namespace

std::vector<std::string> sahl_command(const std::vector<std::string>& arguments) {
    std::vector<std::string> command{environment("SAHL_BINARY")};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return command;
}

ProcessResult run_sahl(const std::vector<std::string>& arguments, const ProcessOptions& options) {
    return run_process(sahl_command(arguments), options);
}

ProcessResult run_sahl_in(const std::filesystem::path& folder, const std::vector<std::string>& arguments) {
    ProcessOptions options;
    options.working_directory = folder;
    return run_sahl(arguments, options);
}

std::string scene_file(const std::string& name) {
    return (std::filesystem::path(environment("SAHL_SOURCE_DIR")) / "tests/data" / name).string();
}

std::vector<nlohmann::json> json_lines(const std::string& text) {
    std::vector<nlohmann::json> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(nlohmann::json::parse(line));
    return lines;
}

void write_file(const std::filesystem::path& path, const std::string& text) { std::ofstream(path) << text; }

std::string content_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace sahl::tests
