#include "engine/batch/batch_job.h"

namespace sahl {

ImageSettings overlay(const ImageSettings& below, const ImageSettings& above) {
    const auto either = [](const auto& high, const auto& low) { return high ? high : low; };
    return {.size = either(above.size, below.size),
            .depth = either(above.depth, below.depth),
            .spp = either(above.spp, below.spp),
            .seed = either(above.seed, below.seed),
            .build_quality = either(above.build_quality, below.build_quality),
            .aovs = either(above.aovs, below.aovs),
            .pixel_type = either(above.pixel_type, below.pixel_type),
            .transfer = either(above.transfer, below.transfer),
            .rounding = either(above.rounding, below.rounding),
            .exposure = either(above.exposure, below.exposure),
            .compression = either(above.compression, below.compression)};
}

OutputSettings encoding_of(const ImageSettings& settings) {
    return {.pixel_type = settings.pixel_type,
            .transfer = settings.transfer,
            .rounding = settings.rounding,
            .exposure = settings.exposure.value_or(0),
            .compression = settings.compression};
}

}  // namespace sahl
