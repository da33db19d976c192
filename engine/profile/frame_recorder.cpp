#include "engine/profile/frame_recorder.h"

#include <ctime>
#include <utility>

#include "engine/film/early_encoder.h"
#include "engine/render/pixel_order.h"

namespace sahl {
namespace {

std::uint64_t on_host(std::uint64_t device_ns, const ClockOffset& clock) {
    return device_ns + static_cast<std::uint64_t>(clock.offset_ns);
}

}  // namespace

void TimelineRecorder::add(Device& device) {
    device.launches().take();
    device.launches().enable(true);
}

TimelineRecord TimelineRecorder::stop(Device& device, const ClockOffset& clock) {
    {
        const HostStep step("wait");
        device.finish();
    }
    TimelineRecord record{begin_ns_, monotonic_ns(), device.launches().take(), steps_.take(),
                          steps_.take_hidden()};
    device.launches().enable(false);
    for (LaunchRecord& launch : record.launches) {
        for (std::uint64_t* time :
             {&launch.queued_ns, &launch.submitted_ns, &launch.started_ns, &launch.ended_ns}) {
            *time = on_host(*time, clock);
        }
    }
    return record;
}

RenderStatistics run_frame(Device& device, Renderer& renderer, const FrameJob& job) {
    const RenderSettings& settings = job.settings;
    const Resolution size = settings.crop ? Resolution{settings.crop->x1 - settings.crop->x0,
                                                       settings.crop->y1 - settings.crop->y0}
                                          : settings.resolution;
    std::optional<Film> film;
    {
        const HostStep step("allocate");
        film.emplace(device.memory(), size.width, size.height);
    }
    const int samples = settings.samples ? settings.samples->count() : settings.spp;
    Image image;
    RenderStatistics statistics;
    std::optional<EarlyEncoder> encoder;
    if (can_encode_early(job.output)) {
        {
            const HostStep step("encode");
            encoder.emplace(*film, samples, job.output, job.encoding);
        }
        statistics = renderer.render(settings, *film, [&](std::uint64_t done, std::uint64_t) {
            const HostStep step("encode");
            encoder->set_finished(
                finished_rows(done / static_cast<std::uint64_t>(samples), size.width, size.height));
        });
        encoder->write(job.encoding.metadata);
    } else {
        statistics = renderer.render(settings, *film);
        image = film->resolve(samples);
        write_image(job.output, image, job.encoding);
    }
    const HostStep step("release");
    encoder.reset();
    film.reset();
    image = {};
    return statistics;
}

std::uint64_t processor_ns() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<std::uint64_t>(time.tv_sec) * 1'000'000'000U +
           static_cast<std::uint64_t>(time.tv_nsec);
}

RecordedFrame record_frame(Device& device, Renderer& renderer, const FrameJob& job) {
    RecordedFrame frame;
    frame.clock = measure_clock(device);
    const std::uint64_t begin = processor_ns();
    TimelineRecorder recorder;
    recorder.add(device);
    frame.statistics = run_frame(device, renderer, job);
    frame.timeline = recorder.stop(device, frame.clock);
    frame.processor_ns = processor_ns() - begin;
    return frame;
}

}  // namespace sahl
