#include "engine/render/trace_aovs.h"

#include <algorithm>
#include <cstddef>

namespace sahl {
namespace {

/// Where an AOV is among the arrays that the kernel writes.
struct Arrays {
    std::size_t first;
    std::size_t count;
    bool ids;
};

Arrays arrays_of(Aov aov) {
    switch (aov) {
        case Aov::depth:
            return {SAHL_AOV_DEPTH, 1, false};
        case Aov::normal:
            return {SAHL_AOV_NORMAL, 3, false};
        case Aov::albedo:
            return {SAHL_AOV_ALBEDO, 3, false};
        case Aov::primitive_id:
            return {SAHL_AOV_PRIMITIVE, 1, true};
        case Aov::instance_id:
            return {SAHL_AOV_INSTANCE, 1, true};
        case Aov::material_id:
            return {SAHL_AOV_MATERIAL, 1, true};
        case Aov::cost_rays:
        case Aov::cost_nodes:
            break;  // no camera ray's first hit knows them
    }
    return {};
}

std::vector<AovImage> blank_images(std::span<const Aov> aovs, std::size_t pixels) {
    std::vector<AovImage> images;
    for (const Aov aov : aovs) {
        const Arrays arrays = arrays_of(aov);
        AovImage& image = images.emplace_back();
        image.aov = aov;
        if (arrays.ids) {
            image.uints.resize(pixels);
        } else {
            image.values.resize(arrays.count * pixels);
        }
    }
    return images;
}

std::size_t value_bytes(std::size_t rays) { return SAHL_AOV_FLOATS * rays * sizeof(float); }

std::size_t id_bytes(std::size_t rays) { return SAHL_AOV_UINTS * rays * sizeof(std::uint32_t); }

}  // namespace

std::size_t aov_queue_bytes(std::uint32_t rays) {
    const std::uint32_t capacity = ray_capacity(rays);
    return ray_queue_bytes(rays, 0, 0) + Buffer::footprint(value_bytes(capacity)) +
           Buffer::footprint(id_bytes(capacity));
}

Program build_aov_program(Device& device, Compilation compilation) {
    return {device, {"aov.cl"}, "", compilation};
}

std::vector<AovImage> trace_aovs(Wavefront& wavefront, Kernel& describe,
                                 const device::CameraConstants& camera, const RenderSettings& settings,
                                 const Crop& crop, std::span<const Aov> aovs) {
    Device& device = wavefront.device;
    const DeviceScene& scene = wavefront.scene;
    RayQueues& queues = wavefront.queues;
    RayBatch& batch = queues.batches.front();
    const std::size_t capacity = queues.capacity;
    Buffer values(device, value_bytes(capacity), "AOV values");
    Buffer ids(device, id_bytes(capacity), "AOV ids");

    device::WaveConstants wave = wave_constants(settings, crop);
    wave.first_sample = 0;
    wave.samples = 1;
    const std::uint64_t pixels = std::uint64_t{wave.crop_width} * wave.crop_height;
    std::vector<AovImage> images = blank_images(aovs, pixels);
    for (std::uint64_t done = 0; done < pixels; done += wave.count) {
        wave.first_low = static_cast<std::uint32_t>(done);
        wave.first_high = static_cast<std::uint32_t>(done >> 32U);
        wave.count = static_cast<std::uint32_t>(std::min<std::uint64_t>(capacity, pixels - done));
        const std::uint32_t items = (wave.count + rays_in_groups(device) - 1) / rays_in_groups(device);
        const Launch launch{items, 0, wave.count};
        launch_generate(wavefront, camera, wave, batch);
        launch_intersect(wavefront, {0, wave.count, 0});
        describe.launch(launch, scene.primitives, scene.shape_data, scene.instances, scene.materials,
                        scene.textures, camera, batch.rays, queues.hits, queues.hit_ids, values, ids,
                        queues.capacity, wave.count);

        const auto pixel_of = batch.ids.map<std::uint32_t>(MapMode::read, wave.count);
        const auto value = values.map<float>(MapMode::read, SAHL_AOV_FLOATS * capacity);
        const auto id = ids.map<std::uint32_t>(MapMode::read, SAHL_AOV_UINTS * capacity);
        for (AovImage& image : images) {
            const Arrays arrays = arrays_of(image.aov);
            for (std::size_t i = 0; i < wave.count; ++i) {
                const std::size_t pixel = pixel_of[i];
                if (arrays.ids) {
                    image.uints[pixel] = id[arrays.first * capacity + i];
                    continue;
                }
                for (std::size_t c = 0; c < arrays.count; ++c) {
                    image.values[arrays.count * pixel + c] = value[(arrays.first + c) * capacity + i];
                }
            }
        }
    }
    return images;
}

}  // namespace sahl
