// What a batch is made of: jobs, an image each.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/accel/bvh.h"
#include "engine/film/aov.h"
#include "engine/film/image_io.h"
#include "engine/scene/scene.h"

namespace sahl {

/// How an image is rendered and stored, as far as it was said; for the rest there are the scene's values and
/// the defaults of `sahl render`.
struct ImageSettings {
    std::optional<Resolution> size{};
    std::optional<int> depth{};
    std::optional<int> spp{};
    std::optional<std::uint64_t> seed{};
    std::optional<BuildQuality> build_quality{};
    std::optional<std::vector<Aov>> aovs{};
    std::optional<PixelType> pixel_type{};
    std::optional<Transfer> transfer{};
    std::optional<Rounding> rounding{};
    std::optional<float> exposure{};
    std::optional<std::string> compression{};
};

/// `above` where it says something, else `below`.
ImageSettings overlay(const ImageSettings& below, const ImageSettings& above);

/// What of the settings counts for the files.
OutputSettings encoding_of(const ImageSettings& settings);

/// One image, in one or several files.
struct BatchJob {
    std::filesystem::path scene;
    std::optional<std::filesystem::path> asset_root{};
    std::vector<std::pair<std::string, std::string>>
        parameters{};              ///< names and values as `--set` takes them
    std::string camera{};          ///< of the scene, or the name of `view`; empty: the scene's first
    std::optional<Camera> view{};  ///< a camera that the scene does not have
    std::optional<int> frame{};
    ImageSettings settings{};
    std::vector<std::filesystem::path> outputs{};
};

}  // namespace sahl
