// A profile as a page for browsers: charts and tables, in one file that asks the network for nothing.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "engine/film/film.h"

namespace sahl {

/// A picture on the page.
struct PagePicture {
    std::string title;
    Image image;  ///< linear
};

/// The page (HTML, with its style and scripts) of a profile in JSON, as docs/sahl-profile.schema.json
/// describes it. The figures it shows are those of the JSON, which is in it.
std::string profile_page(std::string_view profile_json, std::span<const PagePicture> pictures);

}  // namespace sahl
