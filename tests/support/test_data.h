// The developers' reference scenes and images, which are no part of the project.
#pragma once

#include <filesystem>
#include <optional>

namespace sahl::tests {

/// The folder that SAHL_TEST_DATA names (environment variable, or the CMake option's value);
/// nothing when it is unset or empty. A test that gets nothing says so and ends:
/// `WARN("SKIPPED: …"); return;`. Throws std::runtime_error when there is no such folder.
std::optional<std::filesystem::path> test_data();

}  // namespace sahl::tests
