// The page of a profile: whole in itself, and in a browser its figures are those of the JSON.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <regex>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/profile/heat_map.h"
#include "engine/profile/profile_page.h"
#include "tests/support/browser.h"
#include "tests/support/made_profile.h"

namespace sahl::tests {
namespace {

using Json = nlohmann::ordered_json;

std::string page_of(const Json& profile) {
    return profile_page(profile.dump(),
                        {Image{2, 1, 3, {0, 0, 0, 1, 1, 1}}, {{"Rays </script><b>", {0, 7}}}});
}

/// What lies in the element with this id, up to the next that has one.
std::string part_of(const std::string& dom, const std::string& id) {
    const std::size_t begin = dom.find("id=\"" + id + "\"");
    REQUIRE(begin != dom.npos);
    return dom.substr(begin, dom.find(" id=\"", begin + 4) - begin);
}

/// A match and its groups. Copies: the text that was searched may be a temporary.
using Groups = std::vector<std::string>;

/// The pattern's groups, for each place where it matches.
std::vector<Groups> all_of(const std::string& text, const std::string& pattern) {
    const std::regex regex(pattern);
    std::vector<Groups> all;
    for (std::sregex_iterator match(text.begin(), text.end(), regex); match != std::sregex_iterator();
         ++match)
        all.emplace_back(match->begin(), match->end());
    return all;
}

/// A cell says `value`: all of it in data-value, rounded to four digits in what is shown.
void check_cell(const Groups& cell, const Json& value) {
    const std::string exact = cell[1];
    std::string shown = cell[2];
    INFO(exact << " shown as " << shown << ", in the profile " << value);
    if (value.is_null()) {
        CHECK(exact.empty());
        CHECK(shown == "–");
    } else if (value.is_string()) {
        CHECK(exact == value.get<std::string>());
        CHECK(shown == exact);
    } else {
        shown.erase(std::remove(shown.begin(), shown.end(), ','), shown.end());
        const auto number = value.get<double>();
        CHECK(std::stod(exact) == number);
        CHECK(std::abs(std::stod(shown) - number) <= 6e-4 * number + 6e-7);
    }
}

void check_table(const BrowsedPage& page, const Json& profile, const std::string& name, std::size_t columns) {
    const std::string table = part_of(page.dom, name);
    const auto headings = all_of(table, "data-key=\"([a-z0-9_]+)\"");
    const auto cells = all_of(table, "<td[^>]* data-value=\"([^\"]*)\">([^<]*)</td>");
    const Json& rows = profile.at(name);
    INFO(name);
    REQUIRE(headings.size() == columns);
    REQUIRE(cells.size() == columns * rows.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
        check_cell(cells[i], rows[i / columns].at(headings[i % columns][1]));
    }
}

/// No browser: nothing to see.
bool skipped() {
    if (!has_browser()) WARN("SKIPPED: chromium is not installed");
    return !has_browser();
}

TEST_CASE("profile page: one file that names no other", "[profile]") {
    const std::string page = page_of(made_profile());
    CHECK_THAT(page, Catch::StartsWith("<!DOCTYPE html>") && Catch::EndsWith("</html>\n"));
    CHECK_THAT(page, Catch::Contains("default-src 'none'"));
    // Placeholders are gone, and namespaces of SVG are the only addresses.
    CHECK(page.find("/*{") == page.npos);
    CHECK(all_of(page, "https?://").size() == all_of(page, "http://www\\.w3\\.org/2000/svg").size());
    CHECK(all_of(page, "<(link|iframe|object|embed)|@import|url\\(").empty());
    // No string of the profile ends the script that it is in.
    CHECK(all_of(page, "</script>").size() == 3);
    CHECK(page.find("<b>CPU") == page.npos);
}

TEST_CASE("profile page: its tables are the profile's, in a browser", "[profile]") {
    if (skipped()) return;
    const Json profile = made_profile();
    const BrowsedPage page = browse(page_of(profile));
    CHECK(page.messages == "");
    CHECK_THAT(page.dom, Catch::Contains("<title>made.json – Sahl profile</title>"));
    check_table(page, profile, "rows", 24);
    check_table(page, profile, "kernel_totals", 23);
    check_table(page, profile, "generation_totals", 22);
    check_table(page, profile, "host_steps", 5);
    CHECK_THAT(part_of(page.dom, "environment"), Catch::Contains("made &lt;b&gt;CPU&lt;/b&gt;") &&
                                                     Catch::Contains("Portable &lt;/script&gt; Language"));
    const std::string summary = part_of(page.dom, "summary");
    const auto wall = all_of(summary, "data-key=\"wall_ms\" data-value=\"([^\"]*)\"");
    REQUIRE(wall.size() == 1);
    CHECK(std::stod(wall[0][1]) == profile["wall_ms"].get<double>());
}

TEST_CASE("profile page: its charts are of the profile's figures, in a browser", "[profile]") {
    if (skipped()) return;
    const Json profile = made_profile();
    const BrowsedPage page = browse(page_of(profile));
    CHECK(page.messages == "");

    std::map<std::string, double> totals;
    for (const Json& row : profile["kernel_totals"]) totals[row["kernel"]] += row["ms_median"].get<double>();
    const auto kernels = all_of(part_of(page.dom, "frame"), "data-kernel=\"([a-z_]+)\" data-ms=\"([^\"]+)\"");
    REQUIRE(kernels.size() == totals.size());
    for (const Groups& bar : kernels) CHECK(std::stod(bar[2]) == Approx(totals.at(bar[1])));
    const auto steps = all_of(part_of(page.dom, "frame"), "data-step=\"([a-z_]*)\" data-ms=\"([^\"]+)\"");
    REQUIRE(steps.size() == 3);
    CHECK(steps[2][1].empty());
    CHECK(std::stod(steps[2][2]) == profile["unattributed_ms"].get<double>());

    const Json& rows = profile["rows"];
    const auto find_row = [&rows](const std::string& kernel, const std::string& generation) {
        return *std::find_if(rows.begin(), rows.end(), [&](const Json& row) {
            return row["kernel"] == kernel && std::to_string(row["generation"].get<int>()) == generation;
        });
    };
    const std::string place = "data-kernel=\"([a-z_]+)\" data-generation=\"([0-9]+)\" ";
    const auto waterfall = all_of(part_of(page.dom, "waterfall"), place + "data-ms=\"([^\"]+)\"");
    REQUIRE(waterfall.size() == rows.size());
    for (const Groups& bar : waterfall) {
        CHECK(std::stod(bar[3]) == find_row(bar[1], bar[2])["ms_median"].get<double>());
    }
    const auto rays = all_of(part_of(page.dom, "rays"), place + "data-rays=\"([0-9]+)\"");
    REQUIRE(rays.size() == 6);
    for (const Groups& bar : rays) {
        CHECK(std::stoull(bar[3]) == find_row(bar[1], bar[2])["rays_in"].get<std::uint64_t>());
    }
    const auto roofline =
        all_of(part_of(page.dom, "roofline"), place + "data-intensity=\"([^\"]+)\" data-gflop=\"([^\"]+)\"");
    REQUIRE(roofline.size() == rows.size());
    for (const Groups& circle : roofline) {
        const Json row = find_row(circle[1], circle[2]);
        CHECK(std::stod(circle[3]) ==
              Approx(row["flop_per_ray"].get<double>() / row["bytes_per_ray"].get<double>()));
        CHECK(std::stod(circle[4]) == row["gflop_per_s"].get<double>());
    }
    const auto walls = all_of(part_of(page.dom, "repetitions"), "data-wall=\"([^\"]+)\"");
    REQUIRE(walls.size() == profile["repetitions"].size());
    for (std::size_t i = 0; i < walls.size(); ++i) {
        CHECK(std::stod(walls[i][1]) == profile["repetitions"][i]["wall_ms"].get<double>());
    }
}

TEST_CASE("profile page: a heading sorts its table, what is not known last", "[profile]") {
    if (skipped()) return;
    Json profile = made_profile();
    profile["rows"][3]["rays_out"] = nullptr;
    const int clicks = GENERATE(1, 2);
    std::string script = "const button = document.querySelector('#rows [data-key=rays_out] button');";
    for (int i = 0; i < clicks; ++i) script += "button.click();";
    const BrowsedPage page = browse(page_of(profile), {.script = script});
    CHECK(page.messages == "");
    const auto cells = all_of(part_of(page.dom, "rows"), "<td[^>]* data-value=\"([^\"]*)\">");
    REQUIRE(cells.size() == 24 * profile["rows"].size());
    std::vector<double> values;
    for (std::size_t i = 5; i + 24 < cells.size(); i += 24) values.push_back(std::stod(cells[i][1]));
    if (clicks == 1) {
        CHECK(std::is_sorted(values.begin(), values.end(), std::greater<>()));
    } else {
        CHECK(std::is_sorted(values.begin(), values.end()));
    }
    CHECK(values.front() != values.back());
    CHECK(cells[cells.size() - 24 + 5][1].empty());
}

TEST_CASE("profile page: costs of pixels are a map from dark to bright, with their sum", "[profile]") {
    if (skipped()) return;
    const std::string script = R"(
        const image = document.images[1], canvas = document.createElement("canvas");
        Object.assign(canvas, {width: image.naturalWidth, height: image.naturalHeight});
        const context = canvas.getContext("2d");
        context.drawImage(image, 0, 0);
        document.documentElement.dataset.colors = [...context.getImageData(0, 0, 2, 1).data].join();
    )";
    const BrowsedPage page = browse(page_of(made_profile()), {.script = script});
    CHECK(page.messages == "");
    const auto& low = heat_colors.front();
    const auto& high = heat_colors.back();
    CHECK(page.data("colors") == fmt::format("{},255,{},255", fmt::join(low, ","), fmt::join(high, ",")));
    const std::string pictures = part_of(page.dom, "pictures");
    CHECK_THAT(pictures, Catch::Contains("data-sum=\"7\" data-most=\"7\" data-top=\"7\"") &&
                             Catch::Contains("3.500 a pixel, 7 at most, 7 in all") &&
                             Catch::Contains("Rays &lt;/script&gt;&lt;b&gt;"));
}

TEST_CASE("profile page: few costly pixels do not darken the map", "[profile]") {
    std::vector<std::uint32_t> counts(1000, 4);
    counts[17] = 0;
    counts[18] = 2;
    counts[500] = 100000;
    const HeatMap map = heat_map(counts, 100, 10);
    CHECK(map.top == 4);
    const auto color = [&map](std::size_t i) {
        const float* at = map.image.pixels.data() + 3 * i;
        return std::vector<float>(at, at + 3);
    };
    const auto sum = [&color](std::size_t i) { return color(i)[0] + color(i)[1] + color(i)[2]; };
    CHECK(color(500) == color(0));
    CHECK(sum(17) < sum(18));
    CHECK(sum(18) < sum(0));
    CHECK(heat_map(std::vector<std::uint32_t>(4, 0), 2, 2).top == 1);
}

TEST_CASE("profile page: it fits a phone, and is readable in the light and in the dark", "[profile]") {
    if (skipped()) return;
    const bool dark = GENERATE(false, true);
    const int width = GENERATE(390, 1200);
    // Chromium's windows have at least 500 pixels: the page gets less of it.
    const std::string script =
        "document.documentElement.style.width = '" + std::to_string(width) + "px';" + R"(
        dispatchEvent(new Event("resize"));
        const style = getComputedStyle(document.body), root = document.documentElement;
        const free = [...document.querySelectorAll("body *")].filter(
            part => !part.parentElement.closest(".scroll, .bar, svg"));
        root.dataset.reach = Math.max(...free.map(part => Math.ceil(part.getBoundingClientRect().right)));
        const channels = color => color.match(/\d+/g).map(Number).map(c => c / 255)
            .map(c => c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
        const light = color => channels(color).reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
        const back = light(style.backgroundColor);
        const contrast = color => (Math.max(back, light(color)) + 0.05) / (Math.min(back, light(color)) + 0.05);
        root.dataset.back = back;
        root.dataset.contrast = contrast(style.color);
        root.dataset.faint = contrast(getComputedStyle(document.querySelector("p")).color);
        root.dataset.pictures = [...document.images].map(image => image.naturalWidth + "x" + image.naturalHeight).join();
    )";
    const BrowsedPage page = browse(page_of(made_profile()), {width, dark, script});
    CHECK(page.messages == "");
    INFO(width << (dark ? " dark" : " light"));
    CHECK(std::stoi(page.data("reach")) <= width);
    CHECK(std::stoi(page.data("reach")) > width - 100);
    CHECK((std::stod(page.data("back")) < 0.1) == dark);
    CHECK(std::stod(page.data("contrast")) >= 7);
    CHECK(std::stod(page.data("faint")) >= 4.5);  // WCAG 2.2, AA
    CHECK(page.data("pictures") == "2x1,2x1");
}

}  // namespace
}  // namespace sahl::tests
