#include "engine/film/image_compare.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "engine/core/error.h"

namespace sahl {
namespace {

std::string size_of(const Image& image) {
    return std::to_string(image.width) + "x" + std::to_string(image.height);
}

void check_sizes(const Image& a, const Image& b) {
    if (a.width != b.width || a.height != b.height || a.channels != b.channels)
        throw Error(ExitCode::compare_failed, "the images differ in size: " + size_of(a) + " and " +
                                                  size_of(b) + "; render both at the same size");
}

double difference(float a, float b) {
    const double difference = std::fabs(static_cast<double>(a) - static_cast<double>(b));
    return std::isfinite(difference) ? difference : std::numeric_limits<double>::infinity();
}

}  // namespace

Comparison compare(const Image& a, const Image& b, float threshold, const Image* mask) {
    check_sizes(a, b);
    if (mask != nullptr && (mask->width != a.width || mask->height != a.height))
        throw Error(ExitCode::usage, "the mask is " + size_of(*mask) + " and the images are " + size_of(a) +
                                         "; give a mask of the images' size");

    const double limit = threshold > 0 ? threshold + 0x1p-23 : 0.0;
    const auto channels = static_cast<std::size_t>(a.channels);
    Comparison result;
    std::size_t worst = 0;
    for (std::size_t pixel = 0; pixel * channels < a.pixels.size(); ++pixel) {
        if (mask != nullptr && !(mask->pixels[pixel * static_cast<std::size_t>(mask->channels)] > 0.5F))
            continue;
        double largest = 0;
        for (std::size_t i = pixel * channels; i < (pixel + 1) * channels; ++i) {
            const double d = difference(a.pixels[i], b.pixels[i]);
            largest = std::max(largest, d);
            result.mean_difference += d;
            result.mse += d * d;
        }
        ++result.pixels;
        if (largest > limit) ++result.pixels_over;
        if (largest > result.max_difference) {
            result.max_difference = largest;
            worst = pixel;
        }
    }
    if (result.pixels == 0)
        throw Error(ExitCode::usage, "the mask leaves no pixel; give one with white pixels");

    const double values = static_cast<double>(result.pixels) * a.channels;
    result.mean_difference /= values;
    result.mse /= values;
    result.psnr = -10 * std::log10(result.mse);
    result.worst_x = static_cast<int>(worst % static_cast<std::size_t>(a.width));
    result.worst_y = static_cast<int>(worst / static_cast<std::size_t>(a.width));
    return result;
}

Image difference_image(const Image& a, const Image& b) {
    check_sizes(a, b);
    Image image = a;
    std::transform(a.pixels.begin(), a.pixels.end(), b.pixels.begin(), image.pixels.begin(),
                   [](float x, float y) { return static_cast<float>(difference(x, y)); });
    return image;
}

}  // namespace sahl
