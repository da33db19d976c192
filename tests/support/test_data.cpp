#include "tests/support/test_data.h"

#include <cstdlib>
#include <stdexcept>
#include <string>

namespace sahl::tests {

std::optional<std::filesystem::path> test_data() {
    const char* folder = std::getenv("SAHL_TEST_DATA");
    if (folder == nullptr || *folder == '\0') return std::nullopt;
    if (!std::filesystem::is_directory(folder)) {
        throw std::runtime_error("SAHL_TEST_DATA names no folder: " + std::string(folder));
    }
    return folder;
}

}  // namespace sahl::tests
