#include "cli/batch_html.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "engine/core/atomic_file.h"

namespace sahl::cli {

namespace {

constexpr int thumbnail_side = 240;

constexpr std::string_view head = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>Sahl batch</title>
<meta name="viewport" content="width=device-width, initial-scale=1">
<style>
:root { color-scheme: light dark; font: 15px/1.4 system-ui, sans-serif; }
body { margin: 1.5rem; }
main { display: grid; grid-template-columns: repeat(auto-fill, minmax(250px, 1fr)); gap: 1rem; }
figure { margin: 0; }
img, .none { width: 100%; aspect-ratio: 4 / 3; object-fit: contain; background: #8882; display: block; }
.none { display: grid; place-items: center; }
figcaption { overflow-wrap: anywhere; }
small { display: block; opacity: .75; }
.failed figcaption { color: #c33; }
</style></head><body>
)";

std::string escaped(std::string_view text) {
    std::string result;
    for (const char c : text) {
        switch (c) {
            case '&':
                result += "&amp;";
                break;
            case '<':
                result += "&lt;";
                break;
            case '"':
                result += "&quot;";
                break;
            default:
                result += c;
        }
    }
    return result;
}

/// RFC 4648.
std::string base64(std::span<const unsigned char> bytes) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        for (std::size_t k = 0; k < 3; ++k) group = group << 8U | (k < count ? bytes[i + k] : 0U);
        for (std::size_t k = 0; k < 4; ++k) text += k <= count ? digits[group >> (18 - 6 * k) & 63U] : '=';
    }
    return text;
}

/// The mean of the pixels that fall into each of fewer.
Image shrunk(const Image& image, int largest_side) {
    const int side = std::max(image.width, image.height);
    if (side <= largest_side) return image;
    const auto scaled = [&](int size) { return std::max(1, size * largest_side / side); };
    Image small{scaled(image.width), scaled(image.height), 3, {}};
    small.pixels.resize(3 * static_cast<std::size_t>(small.width) * static_cast<std::size_t>(small.height));
    for (int y = 0; y < small.height; ++y) {
        const int y0 = static_cast<int>(std::int64_t{y} * image.height / small.height);
        const int y1 = static_cast<int>(std::int64_t{y + 1} * image.height / small.height);
        for (int x = 0; x < small.width; ++x) {
            const int x0 = static_cast<int>(std::int64_t{x} * image.width / small.width);
            const int x1 = static_cast<int>(std::int64_t{x + 1} * image.width / small.width);
            for (int c = 0; c < 3; ++c) {
                double sum = 0;
                for (int v = y0; v < y1; ++v)
                    for (int u = x0; u < x1; ++u)
                        sum += image.pixels[3 * (static_cast<std::size_t>(v) *
                                                     static_cast<std::size_t>(image.width) +
                                                 static_cast<std::size_t>(u)) +
                                            static_cast<std::size_t>(c)];
                small.pixels[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(small.width) +
                                  static_cast<std::size_t>(x)) +
                             static_cast<std::size_t>(c)] = static_cast<float>(sum / ((y1 - y0) * (x1 - x0)));
            }
        }
    }
    return small;
}

/// A data URI, or nothing if the image cannot be read. It is whole, and Sahl's own by its record: a process
/// of its own for each of thousands (read_untrusted_image) would take minutes.
std::string thumbnail(const std::filesystem::path& path) {
    try {
        const Image image = shrunk(read_image(path), thumbnail_side);
        const std::string extension = path.extension().string();
        const bool is_linear = extension == ".exr" || extension == ".hdr" || extension == ".EXR";
        OutputSettings settings;
        settings.transfer = is_linear ? Transfer::srgb : Transfer::linear;
        settings.compression = "jpeg:80";
        return "data:image/jpeg;base64," + base64(encode_image("thumbnail.jpg", image, settings));
    } catch (const Error&) {
        return "";
    }
}

std::string state_text(const JobOutcome& outcome) {
    switch (outcome.state) {
        case JobState::finished:
            return "finished before";
        case JobState::rendered: {
            std::string text = fmt::format("{:.2f} s", outcome.seconds);
            if (outcome.seconds > 0)
                text += fmt::format(
                    ", {}rays/s",
                    with_prefix(static_cast<double>(outcome.rays + outcome.shadow_rays) / outcome.seconds));
            if (outcome.non_finite > 0) text += fmt::format(", {} values not finite", outcome.non_finite);
            return text;
        }
        case JobState::failed:
            return outcome.message;
        case JobState::waiting:
        case JobState::rendering:
        case JobState::writing:
            break;
    }
    return "not rendered";
}

std::string figure(const BatchJob& job, const JobOutcome& outcome) {
    const bool failed = outcome.state == JobState::failed;
    const bool finished = outcome.state == JobState::finished || outcome.state == JobState::rendered;
    const std::string image = finished ? thumbnail(job.outputs.front()) : "";
    const std::string name = escaped(job.outputs.front().string());
    const std::string picture =
        image.empty() ? fmt::format("<div class=\"none\">{}</div>", failed ? "failed" : "no image")
                      : fmt::format("<img src=\"{}\" alt=\"{}\" loading=\"lazy\">", image, name);
    return fmt::format("<figure{}>{}<figcaption>{}<small>{}</small></figcaption></figure>\n",
                       failed ? " class=\"failed\"" : "", picture, name, escaped(state_text(outcome)));
}

}  // namespace

void write_batch_page(const std::filesystem::path& path, const BatchSetup& setup,
                      const std::vector<JobOutcome>& outcomes) {
    const auto count = [&](JobState state) {
        return std::count_if(outcomes.begin(), outcomes.end(),
                             [&](const auto& o) { return o.state == state; });
    };
    double seconds = 0;
    for (const JobOutcome& outcome : outcomes) seconds += outcome.seconds;
    std::string page(head);
    page += fmt::format(
        "<h1>{} images</h1>\n<p>{} rendered in {} of rendering, {} finished before, {} failed. Sahl "
        "{}</p>\n<main>\n",
        outcomes.size(), count(JobState::rendered), clock_time(seconds), count(JobState::finished),
        count(JobState::failed), SAHL_VERSION);
    for (std::size_t i = 0; i < outcomes.size(); ++i) page += figure(setup.jobs[i], outcomes[i]);
    page += "</main>\n</body></html>\n";
    write_file(path, std::as_bytes(std::span(page)));
}

}  // namespace sahl::cli
