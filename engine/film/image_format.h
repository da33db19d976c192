// What each image format can hold, and what a file is going to be.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/film/image_io.h"

namespace sahl {

/// A compression, with a level where `most` > 0: `name:level` or `name` for the format's default.
struct Compression {
    std::string_view name;
    int least = 0;
    int most = 0;
};

struct Format {
    const char* name;  ///< OpenImageIO's
    std::vector<std::string_view> extensions;
    std::vector<PixelType> pixel_types;  ///< the default first
    std::vector<Compression> compressions;
};

const std::array<Format, 5>& image_formats();

inline bool is_png(const Format& format) { return std::string_view(format.name) == "png"; }

/// By the extension, of any case; a special file without one is a PNG. Throws Error(usage) for others.
const Format& format_of(const std::filesystem::path& path);

constexpr bool is_integer(PixelType type) { return type == PixelType::uint8 || type == PixelType::uint16; }

struct Encoding {
    const Format* format;
    PixelType pixel_type;
    Transfer transfer;
    Rounding rounding;
    std::string_view compression;  ///< empty: the format's default
    std::optional<int> level;
};

/// Throws Error(usage) where the settings contradict themselves or the format.
Encoding encoding_of(const std::filesystem::path& path, const OutputSettings& settings);

}  // namespace sahl
