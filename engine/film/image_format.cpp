#include "engine/film/image_format.h"

#include <algorithm>
#include <cctype>
#include <charconv>

#include "engine/core/atomic_file.h"
#include "engine/core/error.h"

namespace sahl {
namespace {

namespace fs = std::filesystem;

const char* name_of(PixelType type) {
    switch (type) {
        case PixelType::uint8:
            return "uint8";
        case PixelType::uint16:
            return "uint16";
        case PixelType::half:
            return "half";
        case PixelType::float32:
            return "float";
    }
    return "";
}

/// "zip", or "jpeg:1..100" where there is a level.
std::string form_of(const Compression& compression) {
    const std::string name(compression.name);
    if (compression.most == 0) return name;
    return name + ":" + std::to_string(compression.least) + ".." + std::to_string(compression.most);
}

template <typename Range, typename Text>
std::string join(const Range& items, Text text) {
    std::string all;
    for (const auto& item : items) all += (all.empty() ? "" : ", ") + std::string(text(item));
    return all;
}

bool holds(const Format& format, PixelType type) {
    return std::find(format.pixel_types.begin(), format.pixel_types.end(), type) != format.pixel_types.end();
}

PixelType pixel_type_of(const Format& format, const OutputSettings& settings) {
    return settings.pixel_type.value_or(format.pixel_types.front());
}

struct Compressed {
    std::string_view name;
    std::optional<int> level;
};

/// "name" or "name:level" as the format has it.
std::optional<Compressed> find_compression(const Format& format, std::string_view text) {
    const std::size_t colon = text.find(':');
    for (const Compression& known : format.compressions) {
        if (known.name != text.substr(0, colon)) continue;
        if (colon == std::string_view::npos) return Compressed{known.name, {}};
        const std::string_view digits = text.substr(colon + 1);
        int level = 0;
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), level);
        const bool whole = error == std::errc() && end == digits.data() + digits.size();
        if (whole && known.most > 0 && level >= known.least && level <= known.most)
            return Compressed{known.name, level};
    }
    return {};
}

[[noreturn]] void refuse(const fs::path& path, const std::string& message) {
    throw Error(ExitCode::usage, "'" + path.string() + "': " + message);
}

constexpr const char* integer_formats = "uint8 or uint16 pixels (in PNG or TIFF)";

/// Of several files, which can hold a setting; Error(usage) if none does, with what each holds.
template <typename Holds, typename Held>
std::vector<bool> holders(std::span<const fs::path> paths, const std::string& setting, Holds can_hold,
                          Held held) {
    std::vector<bool> result;
    std::string all;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        result.push_back(can_hold(i));
        all += "; '" + paths[i].string() + "' " + held(i);
    }
    if (std::find(result.begin(), result.end(), true) == result.end())
        throw Error(ExitCode::usage, setting + " fits none of the images" + all);
    return result;
}

}  // namespace

const std::array<Format, 5>& image_formats() {
    using enum PixelType;
    static const std::array<Format, 5> table{{
        {.name = "openexr",
         .extensions = {".exr"},
         .pixel_types = {half, float32},
         .compressions = {{"none"},
                          {"rle"},
                          {"zips"},
                          {"zip"},
                          {"piz"},
                          {"pxr24"},
                          {"b44"},
                          {"b44a"},
                          {"dwaa", 1, 500},
                          {"dwab", 1, 500}}},
        {.name = "png",
         .extensions = {".png"},
         .pixel_types = {uint8, uint16},
         .compressions = {{"zip", 0, 9}}},
        {.name = "jpeg",
         .extensions = {".jpg", ".jpeg"},
         .pixel_types = {uint8},
         .compressions = {{"jpeg", 1, 100}}},
        {.name = "hdr", .extensions = {".hdr"}, .pixel_types = {float32}, .compressions = {}},
        {.name = "tiff",
         .extensions = {".tif", ".tiff"},
         .pixel_types = {uint8, uint16, float32},
         .compressions = {{"none"}, {"lzw"}, {"zip"}, {"packbits"}}},
    }};
    return table;
}

const Format& format_of(const fs::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension.empty() && is_special_file(path)) extension = ".png";
    std::string known;
    for (const Format& format : image_formats()) {
        if (std::find(format.extensions.begin(), format.extensions.end(), extension) !=
            format.extensions.end())
            return format;
        known += (known.empty() ? "" : ", ") + join(format.extensions, [](auto text) { return text; });
    }
    throw Error(ExitCode::usage,
                "'" + path.string() + "' has no extension of an image format; use one of " + known);
}

Encoding encoding_of(const fs::path& path, const OutputSettings& settings) {
    const Format& format = format_of(path);
    const PixelType type = pixel_type_of(format, settings);
    if (!holds(format, type))
        refuse(path, std::string("pixel type ") + name_of(type) + " does not fit this format, which holds " +
                         join(format.pixel_types, name_of));
    const Transfer transfer =
        settings.transfer.value_or(is_integer(type) ? Transfer::srgb : Transfer::linear);
    if (transfer == Transfer::srgb && !is_integer(type))
        refuse(path, std::string(name_of(type)) + " pixels are linear; leave the transfer out, or use " +
                         integer_formats);
    if (settings.rounding && !is_integer(type))
        refuse(path, std::string(name_of(type)) + " pixels are not rounded; leave the rounding out, or use " +
                         integer_formats);
    Compressed compressed;
    if (settings.compression) {
        const std::string& text = *settings.compression;
        const auto found = find_compression(format, text);
        if (!found && format.compressions.empty())
            refuse(path, "this format has no compression to choose; leave '" + text + "' out");
        if (!found)
            refuse(path, "compression '" + text + "' does not fit this format, which has " +
                             join(format.compressions, form_of));
        compressed = *found;
    }
    return {.format = &format,
            .pixel_type = type,
            .transfer = transfer,
            .rounding = settings.rounding.value_or(Rounding::round),
            .compression = compressed.name,
            .level = compressed.level};
}

std::vector<std::string> compression_names() {
    std::vector<std::string> names;
    for (const Format& format : image_formats()) {
        for (const Compression& compression : format.compressions) {
            const std::string name(compression.name);
            if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
        }
    }
    return names;
}

bool can_hold_aovs(const fs::path& path) { return format_of(path).name == std::string_view("openexr"); }

std::vector<OutputSettings> settings_for(std::span<const fs::path> paths, const OutputSettings& settings) {
    std::vector<OutputSettings> each(paths.size(), settings);
    if (paths.size() == 1) return each;
    std::vector<const Format*> formats;
    for (const fs::path& path : paths) formats.push_back(&format_of(path));
    const auto type_of = [&](std::size_t i) { return pixel_type_of(*formats[i], each[i]); };

    if (settings.pixel_type) {
        const std::vector<bool> held = holders(
            paths, std::string("pixel type ") + name_of(*settings.pixel_type),
            [&](std::size_t i) { return holds(*formats[i], *settings.pixel_type); },
            [&](std::size_t i) { return "holds " + join(formats[i]->pixel_types, name_of); });
        for (std::size_t i = 0; i < paths.size(); ++i)
            if (!held[i]) each[i].pixel_type.reset();
    }
    const auto integer = [&](std::size_t i) { return is_integer(type_of(i)); };
    const auto of_integers = [&](std::size_t i) {
        return std::string("has ") + name_of(type_of(i)) + " pixels, which are linear and not rounded";
    };
    if (settings.transfer == Transfer::srgb) {
        const std::vector<bool> held = holders(paths, "the transfer srgb", integer, of_integers);
        for (std::size_t i = 0; i < paths.size(); ++i)
            if (!held[i]) each[i].transfer.reset();
    }
    if (settings.rounding) {
        const std::vector<bool> held = holders(paths, "a rounding", integer, of_integers);
        for (std::size_t i = 0; i < paths.size(); ++i)
            if (!held[i]) each[i].rounding.reset();
    }
    if (settings.compression) {
        const std::vector<bool> held = holders(
            paths, "compression '" + *settings.compression + "'",
            [&](std::size_t i) { return find_compression(*formats[i], *settings.compression).has_value(); },
            [&](std::size_t i) {
                return "has " + (formats[i]->compressions.empty() ? "none to choose"
                                                                  : join(formats[i]->compressions, form_of));
            });
        for (std::size_t i = 0; i < paths.size(); ++i)
            if (!held[i]) each[i].compression.reset();
    }
    return each;
}

}  // namespace sahl
