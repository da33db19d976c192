#include "engine/render/wavefront.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <utility>
#include <vector>

#include "engine/core/host_steps.h"
#include "engine/render/incoherent_intersect.h"

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

void add_to_film(PendingContributions pending, std::uint32_t capacity, Film& film) {
    {
        const HostStep step("wait");
        pending.light.wait();
        pending.pixels.wait();
    }
    const HostStep step("accumulate");
    const float* light = pending.light.data();
    film.add({pending.pixels.data(), pending.count}, light, light + capacity,
             light + 2 * std::size_t{capacity});
}

std::array<std::uint32_t, SAHL_TOTALS> wait_for(Mapping<std::uint32_t> mapped) {
    const HostStep step("wait");
    Mapping<std::uint32_t> totals(std::move(mapped));  // given back within the step
    totals.wait();
    std::array<std::uint32_t, SAHL_TOTALS> result{};
    std::copy_n(totals.begin(), result.size(), result.begin());
    return result;
}

/// A wave on its way: its ray trees batch by batch, the deepest first, one batch on the device at a time.
class WaveInFlight {
public:
    /// The `number`-th of RayQueues.
    WaveInFlight(Wavefront& wavefront, std::uint32_t number, std::uint32_t depth)
        : wavefront_(wavefront), number_(number), depth_(depth) {
        for (std::uint32_t slot = depth + 1; slot-- > 0;) free_slots_.push_back(number * (depth + 1) + slot);
    }

    /// Whether there is a wave, a batch of which is on the device.
    bool is_active() const { return on_device_.has_value(); }
    /// The wave's place among the samples.
    std::uint64_t first_sample() const { return first_sample_; }

    /// Queues the first batch of `wave`. Not for one that is active.
    void begin(const device::CameraConstants& camera, const device::WaveConstants& wave) {
        first_sample_ = wave.first_low | std::uint64_t{wave.first_high} << 32U;
        const std::uint32_t slot = take_slot();
        {
            const HostStep step("launch");
            launch_generate(wavefront_, camera, wave, wavefront_.queues.batches[slot]);
        }
        trace({slot, wave.count, 0});
    }

    /// Waits for the batch on the device and queues the next one, if there is one. Returns what is to be
    /// added to the film.
    PendingContributions advance(RenderStatistics& statistics) {
        OnDevice done = std::move(*on_device_);
        on_device_.reset();
        const WaitingBatch batch = done.batch;
        const std::array<std::uint32_t, SAHL_TOTALS> totals = wait_for(std::move(done.totals));
        GenerationCounts& counts = statistics.generations[batch.generation];
        counts.rays += batch.count;
        counts.shadow_rays +=
            totals[SAHL_TOTAL_SHADOW_RAYS] | std::uint64_t{totals[SAHL_TOTAL_SHADOW_RAYS + 1]} << 32U;
        const std::uint32_t capacity = wavefront_.queues.capacity;
        const std::uint32_t children = batch.generation < depth_ ? totals[SAHL_TOTAL_CHILDREN] : 0;
        const std::uint32_t generation = batch.generation + 1;
        const bool coherent = are_coherent(totals);
        if (children > capacity) stack_.push_back({take_slot(), children - capacity, generation, coherent});
        if (children > 0) {
            stack_.push_back({batch.slot, std::min(children, capacity), generation, coherent});
        } else {
            free_slots_.push_back(batch.slot);
        }
        if (!stack_.empty()) {
            const WaitingBatch next = stack_.back();
            stack_.pop_back();
            trace(next);
        }
        return std::move(done.contributions);
    }

private:
    struct OnDevice {
        WaitingBatch batch;
        PendingContributions contributions;
        Mapping<std::uint32_t> totals;
    };

    std::uint32_t take_slot() {
        const std::uint32_t slot = free_slots_.back();
        free_slots_.pop_back();
        return slot;
    }

    /// Queues a batch. Its children take its place, as they are staged, and what that cannot hold the next
    /// free one.
    void trace(const WaitingBatch& batch) {
        const HostStep step("launch");
        RayQueues& queues = wavefront_.queues;
        const bool spawn = batch.generation < depth_;
        Contributions& out = queues.contributions[2 * number_ + side_];
        side_ = 1 - side_;
        launch_intersect(wavefront_, batch);
        launch_shade(wavefront_, batch, spawn, out);
        launch_shadow(wavefront_, batch, out);
        launch_count_children(wavefront_, batch);
        launch_sum_children(wavefront_, batch, out);
        if (spawn) {
            launch_compact(wavefront_, batch, queues.batches[batch.slot], queues.batches[free_slots_.back()],
                           out);
        }
        const std::size_t channels = 3 * std::size_t{queues.capacity};
        on_device_.emplace(
            OnDevice{batch,
                     {out.light.enqueue_map<float>(MapMode::read, channels),
                      out.pixels.enqueue_map<std::uint32_t>(MapMode::read, batch.count), batch.count},
                     out.totals.enqueue_map<std::uint32_t>(MapMode::read, SAHL_TOTALS)});
        wavefront_.device.flush();
    }

    Wavefront& wavefront_;
    std::uint32_t number_;
    std::uint32_t depth_;
    std::uint64_t first_sample_ = 0;
    std::vector<std::uint32_t> free_slots_{};
    std::vector<WaitingBatch> stack_{};
    std::optional<OnDevice> on_device_{};
    std::uint32_t side_ = 0;
};

/// The waves of an image, in order.
class Waves {
public:
    Waves(const RenderSettings& settings, const Crop& crop, std::uint64_t first_sample,
          std::uint32_t capacity)
        : wave_(wave_constants(settings, crop)),
          samples_(std::uint64_t{wave_.crop_width} * wave_.crop_height * wave_.samples),
          next_(first_sample),
          capacity_(capacity) {}

    std::uint64_t samples() const { return samples_; }
    std::uint64_t samples_a_pixel() const { return wave_.samples; }
    /// The first sample of the next wave.
    std::uint64_t next() const { return next_; }
    bool are_left() const { return next_ < samples_; }

    device::WaveConstants take() {
        const device::WaveConstants wave = at(next_);
        next_ += wave.count;
        return wave;
    }

    /// Takes the pixels of the waves from sample `first` on that were taken out of the film. Which those are
    /// only the kernel knows: it generates them once more.
    void abandon_from(std::uint64_t first, Wavefront& wavefront, const device::CameraConstants& camera,
                      Film& film) {
        RayBatch& scratch = wavefront.queues.batches.front();
        for (std::uint64_t sample = first; sample < next_;) {
            const device::WaveConstants wave = at(sample);
            launch_generate(wavefront, camera, wave, scratch);
            const auto pixels = scratch.ids.map<std::uint32_t>(MapMode::read, wave.count);
            film.clear({pixels.data(), wave.count});
            sample += wave.count;
        }
    }

private:
    device::WaveConstants at(std::uint64_t first) const {
        device::WaveConstants wave = wave_;
        wave.first_low = static_cast<std::uint32_t>(first);
        wave.first_high = static_cast<std::uint32_t>(first >> 32U);
        wave.count = static_cast<std::uint32_t>(std::min<std::uint64_t>(capacity_, samples_ - first));
        return wave;
    }

    device::WaveConstants wave_;
    std::uint64_t samples_;
    std::uint64_t next_;
    std::uint32_t capacity_;
};

/// Whatever happens, no kernel works on memory that is given back behind this.
class FinishAtEnd {
public:
    explicit FinishAtEnd(Device& device) : device_(device) {}
    ~FinishAtEnd() {
        try {
            device_.finish();
        } catch (...) {  // what failed is on its way already, or fails again
        }
    }
    FinishAtEnd(const FinishAtEnd&) = delete;
    FinishAtEnd& operator=(const FinishAtEnd&) = delete;

private:
    Device& device_;
};

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
    const FinishAtEnd finish(wavefront.device);
    Waves waves(settings, crop, checkpoints.first_sample, wavefront.queues.capacity);
    const auto depth = static_cast<std::uint32_t>(settings.depth);
    std::vector<WaveInFlight> flights;
    for (std::uint32_t number = 0; number < waves_in_flight; ++number)
        flights.emplace_back(wavefront, number, depth);
    /// All samples before it are in the film.
    const auto finished = [&] {
        std::uint64_t first = waves.next();
        for (const WaveInFlight& flight : flights)
            if (flight.is_active()) first = std::min(first, flight.first_sample());
        return first;
    };

    RenderStatistics statistics;
    statistics.generations.resize(depth + 1);
    std::uint64_t reported = checkpoints.first_sample;
    while (waves.are_left()) {
        for (WaveInFlight& flight : flights)
            if (waves.are_left()) flight.begin(camera, waves.take());
        bool is_due = false;  // a checkpoint: no wave begins before it
        for (std::size_t turn = 0; finished() < waves.next(); ++turn) {
            WaveInFlight& flight = flights[turn % waves_in_flight];
            if (!flight.is_active()) continue;
            if (stop.stop_requested()) {
                const std::uint64_t first = finished();
                flights.clear();
                waves.abandon_from(first, wavefront, camera, film);
                statistics.finished_pixels = first / waves.samples_a_pixel();
                statistics.seconds = seconds_since(start);
                return statistics;
            }
            PendingContributions contributions = flight.advance(statistics);
            if (!flight.is_active()) {
                is_due = is_due || (checkpoints.due && checkpoints.due());
                if (waves.are_left() && !is_due) flight.begin(camera, waves.take());
            }
            // While the device is at work on what has been queued.
            add_to_film(std::move(contributions), wavefront.queues.capacity, film);
            if (const std::uint64_t done = finished();
                progress && done > reported && done < waves.samples()) {
                reported = done;
                progress(done, waves.samples());
            }
        }
        if (is_due) checkpoints.save(waves.next());
    }
    if (progress) progress(waves.samples(), waves.samples());
    statistics.finished_pixels = waves.samples() / waves.samples_a_pixel();
    statistics.seconds = seconds_since(start);
    return statistics;
}

}  // namespace sahl
