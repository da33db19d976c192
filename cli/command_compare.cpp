// `sahl compare`: how much two images differ, as a report and as an exit status.
#include <cmath>
#include <memory>

#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/interruption.h"
#include "cli/options.h"
#include "cli/standard_output.h"
#include "engine/film/image_compare.h"
#include "engine/film/image_io.h"

namespace sahl::cli {

namespace {

/// So many pixels, or a share of all.
struct PixelLimit {
    double value = 0;
    bool percent = false;

    std::uint64_t of(std::uint64_t pixels) const {
        return static_cast<std::uint64_t>(percent ? std::floor(value * static_cast<double>(pixels) / 100)
                                                  : value);
    }
};

struct CompareOptions {
    std::string a;
    std::string b;
    std::optional<std::string> mask;
    std::optional<std::string> difference;
    double threshold = 0;
    PixelLimit limit;
};

/// "0.01" or "2/255".
double read_threshold(std::string_view option, std::string_view text) {
    constexpr double most = 1e9;
    const std::vector<std::string_view> parts = split(text, '/');
    if (parts.size() > 2) refuse(option, text, "a number or a fraction such as 2/255");
    const double value = read_number(option, parts[0], 0, most);
    return parts.size() == 1 ? value : value / read_number(option, parts[1], 1, most);
}

/// "100" or "0.1%".
PixelLimit read_limit(std::string_view option, std::string_view text) {
    constexpr std::uint32_t most = 1U << 31U;
    if (text.ends_with('%')) return {read_number(option, text.substr(0, text.size() - 1), 0, 100), true};
    return {static_cast<double>(read_whole<std::uint32_t>(option, text, 0, most)), false};
}

std::string report(const Comparison& result, const CompareOptions& options, std::uint64_t allowed) {
    const double share = 100 * static_cast<double>(result.pixels_over) / static_cast<double>(result.pixels);
    return fmt::format(
        "largest difference  {:.6g} ({:.2f} of 255) at pixel {},{}\n"
        "mean difference     {:.6g}\n"
        "MSE                 {:.6g}\n"
        "PSNR                {:.2f} dB\n"
        "pixels over {:.6g}: {} of {} ({:.4f} %), allowed {}\n",
        result.max_difference, 255 * result.max_difference, result.worst_x, result.worst_y,
        result.mean_difference, result.mse, result.psnr, options.threshold, result.pixels_over, result.pixels,
        share, allowed);
}

/// Infinities become null.
nlohmann::ordered_json event(const Comparison& result, const CompareOptions& options, std::uint64_t allowed) {
    return {{"event", "compare"},
            {"a", options.a},
            {"b", options.b},
            {"max_difference", result.max_difference},
            {"worst_pixel", {result.worst_x, result.worst_y}},
            {"mean_difference", result.mean_difference},
            {"mse", result.mse},
            {"psnr", result.psnr},
            {"threshold", options.threshold},
            {"pixels", result.pixels},
            {"pixels_over", result.pixels_over},
            {"pixels_allowed", allowed},
            {"passed", result.pixels_over <= allowed}};
}

ExitCode compare_files(const CompareOptions& options, const CommonOptions& common) {
    // The file holds the differences themselves.
    OutputSettings encoding;
    encoding.transfer = Transfer::linear;
    if (options.difference) check_output(*options.difference, encoding);

    const Image a = read_untrusted_image(options.a);
    const Image b = read_untrusted_image(options.b);
    std::optional<Image> mask;
    if (options.mask) mask = read_untrusted_image(*options.mask);
    const Comparison result = compare(a, b, static_cast<float>(options.threshold), mask ? &*mask : nullptr);
    defer_interruption();  // the file becomes whole
    if (options.difference) write_image(*options.difference, difference_image(a, b), encoding);

    const std::uint64_t allowed = options.limit.of(result.pixels);
    if (common.json) {
        print_event(event(result, options, allowed));
    } else if (!common.quiet) {
        print(report(result, options, allowed));
    }
    return result.pixels_over <= allowed ? ExitCode::ok : ExitCode::compare_failed;
}

}  // namespace

Command add_compare_command(CLI::App& app, CommonOptions& common) {
    const auto options = std::make_shared<CompareOptions>();
    CLI::App* command = app.add_subcommand("compare", "says how much two images differ");
    command->add_option("A", options->a, "image")->required()->type_name("FILE");
    command->add_option("B", options->b, "image of the same size")->required()->type_name("FILE");
    add_value(
        *command, "--threshold", "VALUE",
        [options](const std::string& text) { options->threshold = read_threshold("--threshold", text); },
        "a pixel counts where a channel differs by more (default: 0; 8-bit steps: 2/255)");
    add_value(
        *command, "--max-pixels", "N|P%",
        [options](const std::string& text) { options->limit = read_limit("--max-pixels", text); },
        "so many pixels may count (default: 0)");
    add_value(
        *command, "--mask", "FILE", [options](const std::string& text) { options->mask = text; },
        "compares only where this image is white");
    add_value(
        *command, "--diff", "FILE", [options](const std::string& text) { options->difference = text; },
        "writes the image of the differences");
    add_common_options(*command, common);
    command->footer(
        "Exit status 1: more pixels than allowed, or different sizes.\n"
        "Values are compared as stored: 8-bit v is v/255.\n"
        "Examples:\n"
        "  sahl compare image.png reference.png\n"
        "  sahl compare image.png reference.png --threshold 2/255 --max-pixels 0.1%\n"
        "  sahl compare a.exr b.exr --mask valid.png --diff difference.exr");
    return {command, [options, &common] { return compare_files(*options, common); }};
}

}  // namespace sahl::cli
