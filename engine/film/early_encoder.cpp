#include "engine/film/early_encoder.h"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
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
          layout{film.width(), film.height(), encoding_of(file, output), {}, output.metadata},
          exposure(output.exposure) {}

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
            // Not before rows are finished: loading the codecs would keep PoCL from loading kernels.
            if (!encoder) encoder.emplace(path, layout, exposure);
            colors.resize(row * static_cast<std::size_t>(end - begin));
            resolve(film.sums().subspan(row * static_cast<std::size_t>(begin), colors.size()), samples,
                    colors);
            encoder->add(colors, {});
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

    const Film& film;
    int samples;
    std::filesystem::path path;
    FileLayout layout;
    float exposure;
    std::optional<ImageEncoder> encoder{};  ///< the thread's, until it ends
    int encoded_rows = 0;                   ///< the thread's, too

    std::mutex mutex{};
    std::condition_variable_any changed{};
    int rows = 0;                        ///< finished
    int wanted_rows = 0;                 ///< finished, before the thread goes on
    std::uint64_t wait_ns = UINT64_MAX;  ///< since when write() waits
    std::uint64_t hidden_ns = 0;         ///< that the thread worked before that
    std::exception_ptr failure{};
    std::jthread thread{};
};

bool can_encode_early(const std::filesystem::path& path) { return takes_metadata_last(format_of(path)); }

EarlyEncoder::EarlyEncoder(const Film& film, int samples, const std::filesystem::path& path,
                           const OutputSettings& settings)
    : impl_(std::make_unique<Impl>(film, samples, path, settings)) {
    impl_->thread = std::jthread([impl = impl_.get()](const std::stop_token& stop) { impl->run(stop); });
}

EarlyEncoder::~EarlyEncoder() = default;

void EarlyEncoder::set_finished(int rows) {
    const std::lock_guard lock(impl_->mutex);
    if (impl_->failure) std::rethrow_exception(impl_->failure);
    impl_->rows = rows;
    if (rows >= impl_->wanted_rows) impl_->changed.notify_all();
}

void EarlyEncoder::write(const Metadata& metadata) {
    std::vector<unsigned char> file;
    {
        const HostStep step("encode");
        {
            const std::lock_guard lock(impl_->mutex);
            impl_->wait_ns = monotonic_ns();
        }
        set_finished(impl_->layout.height);
        // What is left is done here, as fast as can be.
        impl_->thread.request_stop();
        impl_->thread.join();
        if (impl_->failure) std::rethrow_exception(impl_->failure);
        impl_->encode_rows({});
        file = impl_->encoder->finish(metadata);
        add_hidden_step("encode", impl_->hidden_ns);
    }
    const HostStep step("write");
    write_file(impl_->path, std::as_bytes(std::span(file)));
}

}  // namespace sahl
