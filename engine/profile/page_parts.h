// The files of engine/profile/page/ that the build put into the library.
#pragma once

#include <span>
#include <string_view>

namespace sahl {

/// A file, byte for byte. `name` is its name there, e.g. "page.html".
struct PagePart {
    std::string_view name;
    std::string_view text;
};

/// All of them, sorted by name.
std::span<const PagePart> page_parts();

}  // namespace sahl
