#include "bench/sahl_tracer.h"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "engine/core/error.h"
#include "engine/render/ray_queues.h"
#include "kernels/rays_per_item.h"

namespace sahl::bench {
namespace {

std::string kernel_source() {
    const std::string name = SAHL_BENCH_DIR "/traversal.cl";
    std::ifstream file(name);
    if (!file) throw Error(ExitCode::internal, name + ": cannot be read");
    return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

SahlTracer::SahlTracer(const DeviceOptions& options)
    : device_(options), program_(Program::from_text(device_, kernel_source())) {}

void SahlTracer::set_scene(const Scene& scene) {
    batch_.reset();
    scene_.reset();
    scene_ = make_device_scene(device_, scene);
}

void SahlTracer::set_rays(const RaySet& rays) {
    batch_.reset();
    const auto count = static_cast<std::uint32_t>(rays.size());
    // One line more: ray_capacity() may be that much less than asked for.
    const std::size_t capacity = ray_capacity(count + 16);
    const auto buffer = [&](std::size_t arrays, const char* name) {
        return Buffer(device_, arrays * capacity * sizeof(float), name);
    };
    batch_ = {buffer(SAHL_RAY_FLOATS, "rays"),
              buffer(SAHL_RAY_UINTS, "ray ids"),
              buffer(1, "t_max"),
              buffer(SAHL_HIT_FLOATS, "hits"),
              buffer(SAHL_HIT_UINTS, "hit ids"),
              static_cast<std::uint32_t>(capacity),
              count,
              rays.occlusion};
    const auto floats = batch_->rays.map<float>(MapMode::write, SAHL_RAY_FLOATS * capacity);
    const auto ids = batch_->ids.map<std::uint32_t>(MapMode::write, SAHL_RAY_UINTS * capacity);
    const auto t_max = batch_->t_max.map<float>(MapMode::write, capacity);
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto k = static_cast<int>(axis);
            floats[(SAHL_RAY_ORIGIN + axis) * capacity + i] = rays.origins[i][k];
            floats[(SAHL_RAY_DIRECTION + axis) * capacity + i] = rays.directions[i][k];
        }
        ids[SAHL_RAY_EXCLUDE * capacity + i] = SAHL_NO_PRIMITIVE;
        ids[SAHL_RAY_INSTANCE * capacity + i] = SAHL_WORLD;
        t_max[i] = rays.t_max;
    }
}

Kernel& SahlTracer::kernel_of(const std::string& name) {
    const auto known = kernels_.find(name);
    return known != kernels_.end() ? known->second
                                   : kernels_.emplace(name, program_.kernel(name)).first->second;
}

std::uint32_t SahlTracer::rays_per_item_of(const std::string& way, bool occlusion) const {
    if (way == "packet") return SAHL_PACKET_RAYS;
    if (way == "stream") return occlusion ? SAHL_SHADOW_RAYS : SAHL_STREAM_RAYS;
    return device_.rays_per_item();
}

double SahlTracer::trace(const std::string& way, Clock clock) {
    const DeviceScene& scene = *scene_;
    Batch& batch = *batch_;
    const std::uint32_t rays_per_item = rays_per_item_of(way, batch.occlusion);
    const Launch launch{(batch.count + rays_per_item - 1) / rays_per_item, 0, batch.count};
    Kernel& kernel = kernel_of((batch.occlusion ? "occluded_" : "intersect_") + way);
    const double start = seconds_now(clock);
    if (batch.occlusion) {
        kernel.launch(launch, scene.nodes, scene.leaves, scene.outlines, scene.instances, scene.constants,
                      batch.rays, batch.ids, batch.t_max, batch.hit_ids, batch.capacity, batch.count);
    } else {
        kernel.launch(launch, scene.nodes, scene.leaves, scene.outlines, scene.instances, scene.constants,
                      batch.rays, batch.ids, batch.hits, batch.hit_ids, batch.capacity, batch.count);
    }
    device_.finish();
    return seconds_now(clock) - start;
}

std::vector<RayHit> SahlTracer::hits() {
    const std::size_t capacity = batch_->capacity;
    std::vector<RayHit> hits(batch_->count);
    const auto ids = batch_->hit_ids.map<std::uint32_t>(MapMode::read, SAHL_HIT_UINTS * capacity);
    const auto floats = batch_->hits.map<float>(MapMode::read, SAHL_HIT_FLOATS * capacity);
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (batch_->occlusion) {
            hits[i].hit = ids[i] != 0;
        } else {
            hits[i] = {ids[SAHL_HIT_PRIMITIVE * capacity + i] != SAHL_NO_PRIMITIVE,
                       floats[SAHL_HIT_T * capacity + i], ids[SAHL_HIT_PRIMITIVE * capacity + i]};
        }
    }
    return hits;
}

std::vector<std::uint32_t> SahlTracer::record() {
    const std::size_t capacity = batch_->capacity;
    std::vector<std::uint32_t> words;
    const auto append = [&](Buffer& buffer, std::size_t arrays) {
        const auto values = buffer.map<std::uint32_t>(MapMode::read, arrays * capacity);
        for (std::size_t k = 0; k < arrays; ++k)
            words.insert(words.end(), values.begin() + k * capacity,
                         values.begin() + k * capacity + batch_->count);
    };
    append(batch_->hit_ids, batch_->occlusion ? 1 : SAHL_HIT_UINTS);
    if (!batch_->occlusion) append(batch_->hits, SAHL_HIT_FLOATS);
    return words;
}

}  // namespace sahl::bench
