// Kernel sources: the embedded ones or those on disk, with their includes expanded.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace sahl {

/// One text for the OpenCL compiler. `#line` directives in it name the files, so that build logs
/// speak of the files as they are in the repository.
struct KernelSource {
    std::string text;
    std::map<std::string, std::string> files;  ///< by the name that #line gives, e.g. "kernels/math.h"
};

/// The name that #line gives to the text of expand_text().
inline constexpr const char* text_name = "text.cl";

/// The files (names below kernels/) one after the other. `#include "kernels/NAME"` puts in NAME's
/// text: each time if NAME has no include guard or the line is below a conditional that is not the
/// including file's own guard (whether that branch is taken is the compiler's business), else once.
/// Files come from the folder SAHL_KERNEL_DIR if that is set, else from the library.
/// Throws Error(device) naming a file that is missing and the line that includes it.
KernelSource expand_files(const std::vector<std::string>& names);

/// The same for a text that is in no file.
KernelSource expand_text(const std::string& text);

/// `log` with an excerpt of our sources below each line that speaks of FILE:LINE:COLUMN.
std::string annotate_build_log(const std::string& log, const KernelSource& source);

}  // namespace sahl
