// A profile as a page for browsers: charts and tables, in one file that asks the network for nothing.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/film/film.h"

namespace sahl {

/// Counts by pixel, which the page shows as a heat map.
struct PageCounts {
    std::string title;
    std::vector<std::uint32_t> counts;  ///< as many as the image has pixels
};

/// What was rendered, and what its pixels cost.
struct PagePictures {
    std::optional<Image> image{};  ///< linear
    std::vector<PageCounts> counts{};
};

/// The page (HTML, with its style and scripts) of a profile in JSON, as docs/sahl-profile.schema.json
/// describes it. The figures it shows are those of the JSON, which is in it.
std::string profile_page(std::string_view profile_json, const PagePictures& pictures);

}  // namespace sahl
