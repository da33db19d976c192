#include "engine/film/early_encoder.h"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <span>
#include <stop_token>
#include <thread>

#include "engine/core/atomic_file.h"
#include "engine/core/background.h"
#include "engine/core/host_steps.h"
#include "engine/film/image_encode.h"
#include "engine/film/resolve.h"

namespace sahl {
namespace {

/// Few enough that little is left when the last row is finished, as many as make bands worth their while.
constexpr int least_rows = 32;

}  // namespace

struct EarlyEncoder::Impl {
    Impl(const Film& the_film, int samples_a_pixel, const std::filesystem::path& file,
         const OutputSettings& output)
        : film(the_film),
          samples(samples_a_pixel),
          path(file),
          layout{film.width(), film.height(), encoding_of(file, output), {}, {}},
          encoder(file, layout, output.exposure) {}

    /// The rows that are finished, once those that are not encoded yet are worth a band.
    int wait_for_rows(const std::stop_token& stop) {
        std::unique_lock lock(mutex);
        wanted_rows = std::min(encoded_rows + least_rows, layout.height);
        changed.wait(lock, stop, [&] { return rows >= wanted_rows; });
        return rows;
    }

    /// Until all rows are encoded or it is to stop.
    void encode_rows(const std::stop_token& stop) {
        const std::size_t row = 3 * static_cast<std::size_t>(layout.width);
        std::vector<float> colors;
        while (encoded_rows < layout.height) {
            const int begin = encoded_rows;
            const int end = std::min(wait_for_rows(stop), begin + band_rows);
            if (stop.stop_requested()) return;
            const std::uint64_t start = monotonic_ns();
            colors.resize(row * static_cast<std::size_t>(end - begin));
            resolve(film.sums().subspan(row * static_cast<std::size_t>(begin), colors.size()), samples,
                    colors);
            encoder.add(colors, {});
            encoded_rows = end;
            const std::lock_guard lock(mutex);
            hidden_ns += std::min(monotonic_ns(), wait_ns) - std::min(start, wait_ns);
        }
    }

    void run(const std::stop_token& stop) {
        run_in_background();  // no kernel shall wait for it
        try {
            encode_rows(stop);
        } catch (...) {
            const std::lock_guard lock(mutex);
            failure = std::current_exception();
        }
    }

    void set_finished(int finished_rows) {
        const std::lock_guard lock(mutex);
        if (failure) std::rethrow_exception(failure);
        rows = finished_rows;
        if (rows >= wanted_rows) changed.notify_all();
    }

    /// What is left is encoded here, as fast as can be. Returns the file.
    std::vector<unsigned char> finish(const Metadata& metadata) {
        const HostStep step("encode");
        {
            const std::lock_guard lock(mutex);
            wait_ns = monotonic_ns();
        }
        set_finished(layout.height);
        thread.request_stop();
        thread.join();
        if (failure) std::rethrow_exception(failure);
        encode_rows({});
        std::vector<unsigned char> file = encoder.finish(metadata);
        add_hidden_step("encode", hidden_ns);
        return file;
    }

    const Film& film;
    int samples;
    std::filesystem::path path;
    FileLayout layout;
    ImageEncoder encoder;  ///< the thread's, until it ends
    int encoded_rows = 0;  ///< the thread's, too

    std::mutex mutex{};
    std::condition_variable_any changed{};
    int rows = 0;                        ///< finished
    int wanted_rows = 0;                 ///< finished, before the thread goes on
    std::uint64_t wait_ns = UINT64_MAX;  ///< since when write() waits
    std::uint64_t hidden_ns = 0;         ///< that the thread worked before that
    std::exception_ptr failure{};
    std::jthread thread{};
};

bool can_encode_early(const std::filesystem::path& path) { return is_png(format_of(path)); }

EarlyEncoder::EarlyEncoder(const Film& film, int samples, const std::filesystem::path& path,
                           const OutputSettings& settings)
    : impl_(std::make_unique<Impl>(film, samples, path, settings)) {
    impl_->thread = std::jthread([impl = impl_.get()](const std::stop_token& stop) { impl->run(stop); });
}

EarlyEncoder::~EarlyEncoder() = default;

void EarlyEncoder::set_finished(int rows) { impl_->set_finished(rows); }

void EarlyEncoder::write(const Metadata& metadata) {
    const HostStep step("write");
    const std::vector<unsigned char> file = impl_->finish(metadata);
    write_file(impl_->path, std::as_bytes(std::span(file)));
}

}  // namespace sahl
