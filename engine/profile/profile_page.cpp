#include "engine/profile/profile_page.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <numeric>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/film/image_encode.h"
#include "engine/film/image_format.h"
#include "engine/film/image_io.h"
#include "engine/profile/heat_map.h"
#include "engine/profile/page_parts.h"

namespace sahl {
namespace {

std::string base64(std::span<const unsigned char> bytes) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    constexpr std::uint32_t mask = 63;
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) group = group << 8U | (i + k < bytes.size() ? bytes[i + k] : 0U);
        for (std::size_t k = 0; k < 4; ++k) {
            text += i + k > bytes.size() ? '=' : digits[group >> (18 - 6 * k) & mask];
        }
    }
    return text;
}

/// JSON that no script element ends in: '<' stands in its strings alone.
std::string for_script(std::string_view json) {
    std::string text;
    for (const char c : json) {
        if (c == '<') {
            text += "\\u003c";
        } else {
            text += c;
        }
    }
    return text;
}

/// The address of an image that has itself within it.
std::string data_address(const Image& image) {
    const std::filesystem::path name = "image.png";
    const OutputSettings settings;
    return "data:image/png;base64," + base64(encode(name, image, {}, encoding_of(name, settings), settings));
}

nlohmann::ordered_json counts_json(const PageCounts& of, const Image& size) {
    const HeatMap map = heat_map(of.counts, size.width, size.height);
    nlohmann::ordered_json colors = nlohmann::ordered_json::array();
    for (const auto& [red, green, blue] : heat_colors) {
        colors.push_back(fmt::format("rgb({} {} {})", red, green, blue));
    }
    return {{"title", of.title},
            {"source", data_address(map.image)},
            {"sum", std::accumulate(of.counts.begin(), of.counts.end(), std::uint64_t{0})},
            {"most", *std::max_element(of.counts.begin(), of.counts.end())},
            {"pixels", of.counts.size()},
            {"top", map.top},
            {"colors", std::move(colors)}};
}

std::string pictures_json(const PagePictures& pictures) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    if (pictures.image) {
        list.push_back({{"title", "Image"}, {"source", data_address(*pictures.image)}});
        for (const PageCounts& counts : pictures.counts) list.push_back(counts_json(counts, *pictures.image));
    }
    return list.dump();
}

std::string_view part(std::string_view name) {
    for (const PagePart& known : page_parts()) {
        if (known.name == name) return known.text;
    }
    return {};
}

}  // namespace

std::string profile_page(std::string_view profile_json, const PagePictures& pictures) {
    constexpr std::string_view open = "/*{";
    constexpr std::string_view close = "}*/";
    std::string page;
    std::string_view rest = part("page.html");
    for (std::size_t at = rest.find(open); at != rest.npos; at = rest.find(open)) {
        page += rest.substr(0, at);
        const std::size_t end = rest.find(close, at);
        const std::string_view name = rest.substr(at + open.size(), end - at - open.size());
        if (name == "profile") {
            page += for_script(profile_json);
        } else if (name == "images") {
            page += for_script(pictures_json(pictures));
        } else {
            page += part(name);
        }
        rest.remove_prefix(end + close.size());
    }
    return page.append(rest);
}

}  // namespace sahl
