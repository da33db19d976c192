#include "tests/support/broken_kernels.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace sahl::tests {

namespace fs = std::filesystem;

void copy_kernels(const fs::path& folder) {
    const char* source = std::getenv("SAHL_SOURCE_DIR");
    if (source == nullptr) throw std::runtime_error("SAHL_SOURCE_DIR is not set");
    fs::copy(fs::path(source) / "kernels", folder);
}

void break_kernel(const fs::path& folder, const Fault& fault) {
    const fs::path path = folder / fault.file;
    std::ifstream in(path, std::ios::binary);
    std::string text(std::istreambuf_iterator<char>(in), {});
    const std::size_t at = text.find(fault.from);
    if (at == std::string::npos || text.find(fault.from, at + 1) != std::string::npos)
        throw std::runtime_error(fault.file + " has not exactly one '" + fault.from + "'");
    std::ofstream(path, std::ios::binary) << text.replace(at, fault.from.size(), fault.to);
}

}  // namespace sahl::tests
