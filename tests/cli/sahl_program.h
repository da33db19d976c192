// The built `sahl`, run as a user would, in a folder of its own.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/support/run_process.h"
#include "tests/support/temporary_folder.h"

namespace sahl::tests {

/// The command line of the program that the environment variable SAHL_BINARY names.
std::vector<std::string> sahl_command(const std::vector<std::string>& arguments);

/// Runs that program.
ProcessResult run_sahl(const std::vector<std::string>& arguments, const ProcessOptions& options = {});

/// The same in `folder`.
ProcessResult run_sahl_in(const std::filesystem::path& folder, const std::vector<std::string>& arguments);

/// A scene file of tests/data.
std::string scene_file(const std::string& name);

/// Each line of `text` as JSON. Throws nlohmann::json::exception for a line that is none.
std::vector<nlohmann::json> json_lines(const std::string& text);

void write_file(const std::filesystem::path& path, const std::string& text);

/// All bytes of a file; none if there is no such file.
std::string content_of(const std::filesystem::path& path);

bool contains(const std::string& text, const std::string& part);

}  // namespace sahl::tests
