#include "engine/render/wavefront.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <utility>
#include <vector>

#include "engine/core/host_steps.h"

namespace sahl {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Contributions on their way to the film: ready once the commands queued before them have run.
struct PendingContributions {
    Mapping<float> light;
    Mapping<std::uint32_t> pixels;
    std::uint32_t count;
};

void add_to_film(std::optional<PendingContributions>& pending, std::uint32_t capacity, Film& film) {
    if (!pending) {
        return;
    }
    {
        const HostStep step("wait");
        pending->light.wait();
        pending->pixels.wait();
    }
    const HostStep step("accumulate");
    const float* light = pending->light.data();
    film.add({pending->pixels.data(), pending->count}, light, light + capacity,
             light + 2 * std::size_t{capacity});
    pending.reset();
}

/// What the host takes of a generation once its kernels have run.
struct GenerationResults {
    PendingContributions contributions;
    Mapping<std::uint32_t> totals;  ///< see sum_children
};

/// Queues one generation of a batch. `next` may be the batch itself: children are staged. Both `next` and
/// `waiting` are written only where `spawn`.
GenerationResults trace_generation(Wavefront& wavefront, const WaitingBatch& in_work, bool spawn,
                                   Contributions& out, RayBatch& next, RayBatch& waiting) {
    const HostStep step("launch");
    launch_intersect(wavefront, in_work);
    launch_shade(wavefront, in_work, spawn, out);
    launch_shadow(wavefront, in_work, out);
    launch_count_children(wavefront, in_work);
    launch_sum_children(wavefront, in_work);
    if (spawn) launch_compact(wavefront, in_work, next, waiting);
    const std::size_t channels = 3 * std::size_t{wavefront.queues.capacity};
    GenerationResults results{
        {out.light.enqueue_map<float>(MapMode::read, channels),
         out.pixels.enqueue_map<std::uint32_t>(MapMode::read, in_work.count), in_work.count},
        wavefront.queues.totals.enqueue_map<std::uint32_t>(MapMode::read, 3)};
    wavefront.device.flush();
    return results;
}

std::array<std::uint32_t, 3> wait_for(Mapping<std::uint32_t> mapped) {
    const HostStep step("wait");
    Mapping<std::uint32_t> totals(std::move(mapped));  // given back within the step
    totals.wait();
    return {totals[0], totals[1], totals[2]};
}

/// Takes the pixels of a wave whose ray trees are not finished out of the film. Which those are only
/// the kernel knows: it generates them once more.
void abandon(Wavefront& wavefront, const device::CameraConstants& camera, const device::WaveConstants& wave,
             RayBatch& scratch, Film& film) {
    launch_generate(wavefront, camera, wave, scratch);
    const auto pixels = scratch.ids.map<std::uint32_t>(MapMode::read, wave.count);
    film.clear({pixels.data(), wave.count});
}

}  // namespace

device::WaveConstants wave_constants(const RenderSettings& settings, const Crop& crop) {
    device::WaveConstants wave{};
    wave.spp = static_cast<std::uint32_t>(settings.spp);
    wave.crop_x = static_cast<std::uint32_t>(crop.x0);
    wave.crop_y = static_cast<std::uint32_t>(crop.y0);
    wave.crop_width = static_cast<std::uint32_t>(crop.x1 - crop.x0);
    wave.crop_height = static_cast<std::uint32_t>(crop.y1 - crop.y0);
    wave.seed_low = static_cast<std::uint32_t>(settings.seed);
    wave.seed_high = static_cast<std::uint32_t>(settings.seed >> 32U);
    const SampleRange samples = settings.samples.value_or(SampleRange{0, settings.spp});
    wave.first_sample = static_cast<std::uint32_t>(samples.begin);
    wave.samples = static_cast<std::uint32_t>(samples.count());
    return wave;
}

RenderStatistics trace_waves(Wavefront& wavefront, const device::CameraConstants& camera,
                             const RenderSettings& settings, const Crop& crop, Film& film,
                             const ProgressCallback& progress, const std::stop_token& stop,
                             const Checkpoints& checkpoints) {
    const auto start = Clock::now();
    RayQueues& queues = wavefront.queues;
    device::WaveConstants wave = wave_constants(settings, crop);
    const std::uint64_t samples = std::uint64_t{wave.crop_width} * wave.crop_height * wave.samples;
    const auto depth = static_cast<std::uint32_t>(settings.depth);

    RenderStatistics statistics;
    statistics.generations.resize(depth + 1);
    std::optional<PendingContributions> pending;
    std::vector<WaitingBatch> stack;
    std::vector<std::uint32_t> free_slots;
    for (std::uint32_t slot = depth + 1; slot-- > 0;) {
        free_slots.push_back(slot);
    }
    int side = 0;

    for (std::uint64_t done = checkpoints.first_sample; done < samples; done += wave.count) {
        wave.first_low = static_cast<std::uint32_t>(done);
        wave.first_high = static_cast<std::uint32_t>(done >> 32U);
        wave.count = static_cast<std::uint32_t>(std::min<std::uint64_t>(queues.capacity, samples - done));
        stack.push_back({free_slots.back(), wave.count, 0});
        free_slots.pop_back();
        {
            const HostStep step("launch");
            launch_generate(wavefront, camera, wave, queues.batches[stack.back().slot]);
        }

        while (!stack.empty()) {
            if (stop.stop_requested()) {
                add_to_film(pending, queues.capacity, film);
                abandon(wavefront, camera, wave, queues.batches.front(), film);
                statistics.finished_pixels = done / wave.samples;
                statistics.seconds = seconds_since(start);
                return statistics;
            }
            const WaitingBatch batch = stack.back();
            stack.pop_back();
            const bool spawn = batch.generation < depth;
            Contributions& out = queues.contributions[side];
            RayBatch& next = queues.batches[batch.slot];
            RayBatch& waiting = queues.batches[spawn ? free_slots.back() : batch.slot];
            GenerationResults results = trace_generation(wavefront, batch, spawn, out, next, waiting);

            // The host adds the last generation to the film while the device works on this one.
            add_to_film(pending, queues.capacity, film);
            pending.emplace(std::move(results.contributions));
            side = 1 - side;

            const std::array<std::uint32_t, 3> totals = wait_for(std::move(results.totals));
            // The film has the last wave now, and no kernel runs that an error here would take memory from.
            if (progress && batch.generation == 0 && done > checkpoints.first_sample) progress(done, samples);
            GenerationCounts& counts = statistics.generations[batch.generation];
            counts.rays += batch.count;
            counts.shadow_rays += totals[1] | std::uint64_t{totals[2]} << 32U;
            const std::uint32_t children = spawn ? totals[0] : 0;
            if (children > queues.capacity) {
                stack.push_back({free_slots.back(), children - queues.capacity, batch.generation + 1});
                free_slots.pop_back();
            }
            if (children > 0) {
                stack.push_back({batch.slot, std::min(children, queues.capacity), batch.generation + 1});
            } else {
                free_slots.push_back(batch.slot);
            }
        }
        if (checkpoints.due && checkpoints.due()) {
            add_to_film(pending, queues.capacity, film);
            checkpoints.save(done + wave.count);
        }
    }
    add_to_film(pending, queues.capacity, film);
    if (progress) progress(samples, samples);
    statistics.finished_pixels = samples / wave.samples;
    statistics.seconds = seconds_since(start);
    return statistics;
}

}  // namespace sahl
