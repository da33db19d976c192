#include "engine/render/explain.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "engine/film/aov.h"
#include "engine/film/film.h"
#include "engine/render/wavefront.h"

namespace sahl {
namespace {

/// A batch that waits, and its rays' places in Explanation::rays.
struct ExplainedBatch {
    WaitingBatch batch;
    std::vector<std::uint32_t> rays;
};

/// The first `count` elements of a buffer.
template <class T>
std::vector<T> read(Buffer& buffer, std::size_t count) {
    const auto mapping = buffer.map<T>(MapMode::read, count);
    return {mapping.begin(), mapping.end()};
}

template <class T>
std::vector<T> read_all(Buffer& buffer) {
    return read<T>(buffer, buffer.bytes() / sizeof(T));
}

glm::vec3 soa3(const std::vector<float>& arrays, std::size_t first, std::size_t capacity, std::size_t i) {
    return {arrays[first * capacity + i], arrays[(first + 1) * capacity + i],
            arrays[(first + 2) * capacity + i]};
}

class Explainer {
public:
    explicit Explainer(Wavefront& wavefront)
        : wavefront_(wavefront),
          queues_(wavefront.queues),
          capacity_(queues_.capacity),
          lights_(wavefront.scene.constants.light_count),
          film_(wavefront.device.memory(), 1, 1) {}

    /// The camera's rays of a wave, in batch `slot`.
    ExplainedBatch begin(const device::WaveConstants& wave, std::uint32_t slot) {
        ExplainedBatch batch{{slot, wave.count, 0}, {}};
        for (std::uint32_t i = 0; i < wave.count; ++i) {
            batch.rays.push_back(static_cast<std::uint32_t>(result_.rays.size()));
            ExplainedRay& ray = result_.rays.emplace_back();
            ray.parent = batch.rays.back();
            ray.sample = wave.first_sample + wave.first_low + i;
        }
        return batch;
    }

    /// Traces and shades a batch; its children wait in `next`, and what that cannot hold in `waiting`.
    void trace(const ExplainedBatch& in_work, bool spawn, RayBatch& next, RayBatch& waiting) {
        Contributions& out = queues_.contributions[0];
        note_rays(in_work);
        launch_intersect(wavefront_, in_work.batch);
        launch_shade(wavefront_, in_work.batch, spawn, out);
        note_hits(in_work, read_all<float>(out.light));
        note_lights(in_work, out);
        launch_shadow(wavefront_, in_work.batch, out);
        note_contributions(in_work, read_all<float>(out.light));
        launch_count_children(wavefront_, in_work.batch);
        launch_sum_children(wavefront_, in_work.batch, out);
        if (spawn) launch_compact(wavefront_, in_work.batch, next, waiting, out);
    }

    /// The children of a batch in the order in which they are compacted: all reflected, then all transmitted.
    std::vector<std::uint32_t> note_children(const ExplainedBatch& parents) {
        const auto outcomes = read<std::uint32_t>(queues_.outcomes, parents.batch.count);
        std::vector<std::uint32_t> children;
        for (const auto& [bit, from] : {std::pair{SAHL_OUTCOME_REFLECTED, RayOrigin::reflection},
                                        std::pair{SAHL_OUTCOME_TRANSMITTED, RayOrigin::transmission}}) {
            for (std::size_t i = 0; i < outcomes.size(); ++i) {
                if ((outcomes[i] & bit) == 0) continue;
                children.push_back(static_cast<std::uint32_t>(result_.rays.size()));
                ExplainedRay child;
                child.from = from;
                child.generation = parents.batch.generation + 1;
                child.parent = parents.rays[i];
                child.sample = result_.rays[parents.rays[i]].sample;
                result_.rays.push_back(std::move(child));
            }
        }
        return children;
    }

    Explanation finish() {
        result_.sum = film_.sum(0);
        return std::move(result_);
    }

private:
    ExplainedRay& ray(const ExplainedBatch& batch, std::size_t i) { return result_.rays[batch.rays[i]]; }

    void note_rays(const ExplainedBatch& batch) {
        const auto rays = read_all<float>(queues_.batches[batch.batch.slot].rays);
        for (std::size_t i = 0; i < batch.rays.size(); ++i) {
            ray(batch, i).origin = soa3(rays, SAHL_RAY_ORIGIN, capacity_, i);
            ray(batch, i).direction = soa3(rays, SAHL_RAY_DIRECTION, capacity_, i);
            ray(batch, i).weight = soa3(rays, SAHL_RAY_WEIGHT, capacity_, i);
        }
    }

    void note_hits(const ExplainedBatch& batch, const std::vector<float>& contributions) {
        const auto hits = read_all<float>(queues_.hits);
        const auto ids = read_all<std::uint32_t>(queues_.hit_ids);
        for (std::size_t i = 0; i < batch.rays.size(); ++i) {
            ExplainedRay& to = ray(batch, i);
            to.own = soa3(contributions, 0, capacity_, i);
            to.primitive = ids[SAHL_HIT_PRIMITIVE * std::size_t{capacity_} + i];
            to.instance = ids[SAHL_HIT_INSTANCE * std::size_t{capacity_} + i];
            to.t = hits[SAHL_HIT_T * std::size_t{capacity_} + i];
            if (to.primitive != SAHL_NO_PRIMITIVE) continue;
            to.primitive = to.instance = no_aov_id;
            to.t = std::numeric_limits<float>::infinity();
        }
    }

    /// Shadow rays of one light after the other: the kernel adds up those that bring anything.
    void note_lights(const ExplainedBatch& batch, Contributions& out) {
        if (lights_ == 0) return;
        const auto own = read_all<float>(out.light);
        const auto brought = read_all<float>(queues_.shadow_light);
        const std::size_t of_light = 3 * std::size_t{capacity_};
        for (std::uint32_t l = 0; l < lights_; ++l) {
            std::vector<float> alone(brought.size());
            std::copy_n(brought.begin() + static_cast<std::ptrdiff_t>(l * of_light), of_light,
                        alone.begin() + static_cast<std::ptrdiff_t>(l * of_light));
            queues_.shadow_light.write(std::span<const float>(alone));
            const std::vector<float> nothing(own.size());
            out.light.write(std::span<const float>(nothing));
            launch_shadow(wavefront_, batch.batch, out);
            const auto arriving = read_all<float>(out.light);
            for (std::size_t i = 0; i < batch.rays.size(); ++i) {
                if (ray(batch, i).primitive == no_aov_id) continue;
                ray(batch, i).lights.push_back(
                    {soa3(brought, 3 * std::size_t{l}, capacity_, i), soa3(arriving, 0, capacity_, i)});
            }
        }
        queues_.shadow_light.write(std::span<const float>(brought));
        out.light.write(std::span<const float>(own));
    }

    void note_contributions(const ExplainedBatch& batch, const std::vector<float>& contributions) {
        constexpr std::uint32_t pixel = 0;
        for (std::size_t i = 0; i < batch.rays.size(); ++i) {
            ExplainedRay& to = ray(batch, i);
            to.contribution = soa3(contributions, 0, capacity_, i);
            const FixedColor before = film_.sum(0);
            film_.add({&pixel, 1}, &to.contribution.x, &to.contribution.y, &to.contribution.z);
            const FixedColor after = film_.sum(0);
            for (std::size_t c = 0; c < after.size(); ++c) to.fixed[c] = after[c] - before[c];
        }
    }

    Wavefront& wavefront_;
    RayQueues& queues_;
    std::uint32_t capacity_;
    std::uint32_t lights_;
    Film film_;
    Explanation result_;
};

}  // namespace

Explanation explain_pixel(Wavefront& wavefront, const device::CameraConstants& camera,
                          const RenderSettings& settings, const Crop& pixel) {
    RayQueues& queues = wavefront.queues;
    Explainer explainer(wavefront);
    device::WaveConstants wave = wave_constants(settings, pixel);
    const auto depth = static_cast<std::uint32_t>(settings.depth);
    std::vector<std::uint32_t> free_slots(std::size_t{depth} + 1);
    for (std::uint32_t slot = 0; slot <= depth; ++slot) free_slots[slot] = slot;
    const auto take_slot = [&free_slots] {
        const std::uint32_t slot = free_slots.back();
        free_slots.pop_back();
        return slot;
    };
    for (std::uint32_t done = 0; done < wave.samples; done += wave.count) {
        wave.first_low = done;
        wave.count = std::min(queues.capacity, wave.samples - done);
        std::vector<ExplainedBatch> stack{explainer.begin(wave, take_slot())};
        launch_generate(wavefront, camera, wave, queues.batches[stack.back().batch.slot]);
        while (!stack.empty()) {
            const ExplainedBatch parents = std::move(stack.back());
            stack.pop_back();
            const std::uint32_t slot = parents.batch.slot;
            const std::uint32_t generation = parents.batch.generation;
            const bool spawn = generation < depth;
            explainer.trace(parents, spawn, queues.batches[slot],
                            queues.batches[spawn ? free_slots.back() : slot]);
            const std::vector<std::uint32_t> children =
                spawn ? explainer.note_children(parents) : std::vector<std::uint32_t>{};
            const std::size_t held = std::min<std::size_t>(children.size(), queues.capacity);
            const auto middle = children.begin() + static_cast<std::ptrdiff_t>(held);
            if (middle != children.end()) {
                const auto more = static_cast<std::uint32_t>(children.size() - held);
                stack.push_back({{take_slot(), more, generation + 1}, {middle, children.end()}});
            }
            if (held > 0) {
                stack.push_back(
                    {{slot, static_cast<std::uint32_t>(held), generation + 1}, {children.begin(), middle}});
            } else {
                free_slots.push_back(slot);
            }
        }
    }
    return explainer.finish();
}

}  // namespace sahl
