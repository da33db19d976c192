// The kernel sources that the build put into the library.
#pragma once

#include <span>
#include <string_view>

namespace sahl {

/// A file of kernels/, byte for byte. `name` is its name there, e.g. "shade.cl".
struct EmbeddedKernel {
    std::string_view name;
    std::string_view text;
};

/// All of them, sorted by name.
std::span<const EmbeddedKernel> embedded_kernels();

}  // namespace sahl
