// What becomes an image file in memory: by OpenImageIO (image_codecs.h), or as PNG (png_encoder.h).
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/film/image_format.h"

namespace sahl {

/// Channels of a file that an AOV takes.
constexpr std::size_t channels_of(Aov aov) {
    return std::max<std::size_t>(aov_name(aov).components.size(), 1);
}

using Metadata = std::vector<std::pair<std::string, std::string>>;

/// What a file is going to hold.
struct FileLayout {
    int width = 0;
    int height = 0;
    Encoding encoding{};
    std::vector<Aov> aovs{};  ///< in channels beside R, G and B
    Metadata metadata{};
};

/// An image file on its way into memory.
class FileEncoder {
public:
    virtual ~FileEncoder() = default;
    /// Rows [y, y_end), where those before were the last that came. `colors`: three values a pixel, from row
    /// y on, of the layout's pixel type if that is an integer, else floats. `aovs`: of the layout, whole
    /// images. False: see error().
    virtual bool write(int y, int y_end, const void* colors, std::span<const AovImage> aovs) = 0;
    /// After the last row. `metadata`: what a PNG file is to have instead of the layout's. False: see
    /// error().
    virtual bool finish(const Metadata& metadata) = 0;
    virtual std::string error() const = 0;
};

}  // namespace sahl
