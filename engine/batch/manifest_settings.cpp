#include "engine/batch/manifest_settings.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "engine/core/nearest.h"

namespace sahl {
namespace {

constexpr double most_samples = 16384;  // a pixel; more could overflow the film's fixed point
constexpr double largest_depth = 64;
constexpr double largest_seed = 9007199254740992.0;  // 2^53: JSON's numbers are doubles to many programs
constexpr double most_stops = 100;

Resolution read_size(const JsonReader& reader, const JsonValue& value) {
    constexpr std::string_view form = "a width and a height ([640, 480])";
    if (value.kind != JsonKind::array || value.count != 2) reader.fail_type(value, "size", form);
    const std::span<const JsonValue> sides = reader.document().elements(value);
    const auto side = [&](const JsonValue& pixels) {
        return static_cast<int>(reader.integer(pixels, "size", {1, max_resolution}));
    };
    return {side(sides[0]), side(sides[1])};
}

std::vector<Aov> read_aovs(const JsonReader& reader, const JsonValue& value) {
    std::vector<std::string_view> names;
    for (const AovName& name : aov_names) names.push_back(name.name);
    if (value.kind == JsonKind::text && reader.text(value, "aov") == "all") return aovs_of_first_hits();
    std::vector<Aov> aovs;
    for (const JsonValue& element : reader.array(value, "aov", "\"all\" or an array of AOVs")) {
        const Aov aov = aov_names.at(reader.choice(element, "aov", "AOVs", names)).aov;
        if (std::find(aovs.begin(), aovs.end(), aov) != aovs.end()) {
            reader.fail(element, fmt::format("the AOV {} is there a second time; remove it",
                                             reader.text(element, "aov")));
        }
        aovs.push_back(aov);
    }
    return aovs;
}

void check_compression(const JsonReader& reader, const JsonValue& value) {
    const std::string_view text = reader.text(value, "compression");
    const std::vector<std::string> known = compression_names();
    const std::vector<std::string_view> names(known.begin(), known.end());
    const std::string_view name = text.substr(0, text.find(':'));
    if (std::find(names.begin(), names.end(), name) != names.end()) return;
    reader.fail(value,
                fmt::format("there is no compression '{}'{}", name, suggest(name, "compressions", names)));
}

}  // namespace

ImageSettings read_image_settings(const JsonReader& reader, const JsonValue& value) {
    const JsonObject object(reader, value, "settings", {},
                            {"size", "depth", "spp", "seed", "build_quality", "aov", "pixel_type", "transfer",
                             "rounding", "exposure", "compression"});
    const auto with = [&](std::string_view key, auto read) {
        if (const JsonValue* found = object.find(key)) read(*found);
    };
    const auto choose = [&](std::string_view key, std::string_view plural, auto& target, const auto& names,
                            const auto& values) {
        with(key, [&](const JsonValue& v) { target = values[reader.choice(v, key, plural, names)]; });
    };
    constexpr std::array<std::string_view, 4> type_names{"uint8", "uint16", "half", "float"};
    constexpr std::array types{PixelType::uint8, PixelType::uint16, PixelType::half, PixelType::float32};
    constexpr std::array<std::string_view, 2> transfer_names{"srgb", "linear"};
    constexpr std::array transfers{Transfer::srgb, Transfer::linear};
    constexpr std::array<std::string_view, 2> rounding_names{"round", "floor"};
    constexpr std::array roundings{Rounding::round, Rounding::floor};
    constexpr std::array<std::string_view, 2> quality_names{"high", "fast"};
    constexpr std::array qualities{BuildQuality::high, BuildQuality::fast};

    ImageSettings settings;
    with("size", [&](const JsonValue& v) { settings.size = read_size(reader, v); });
    with("depth", [&](const JsonValue& v) {
        settings.depth = static_cast<int>(reader.integer(v, "depth", {0, largest_depth}));
    });
    with("spp", [&](const JsonValue& v) {
        settings.spp = static_cast<int>(reader.integer(v, "spp", {1, most_samples}));
    });
    with("seed", [&](const JsonValue& v) {
        settings.seed = static_cast<std::uint64_t>(reader.integer(v, "seed", {0, largest_seed}));
    });
    with("aov", [&](const JsonValue& v) { settings.aovs = read_aovs(reader, v); });
    with("exposure", [&](const JsonValue& v) {
        settings.exposure = static_cast<float>(reader.number(v, "exposure", {-most_stops, most_stops}));
    });
    with("compression", [&](const JsonValue& v) {
        check_compression(reader, v);
        settings.compression = reader.text(v, "compression");
    });
    choose("build_quality", "qualities", settings.build_quality, quality_names, qualities);
    choose("pixel_type", "pixel types", settings.pixel_type, type_names, types);
    choose("transfer", "transfers", settings.transfer, transfer_names, transfers);
    choose("rounding", "roundings", settings.rounding, rounding_names, roundings);
    return settings;
}

}  // namespace sahl
