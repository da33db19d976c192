#include "cli/batch_writer.h"

#include <new>
#include <utility>

#include "engine/batch/image_record.h"
#include "engine/core/atomic_file.h"

namespace sahl::cli {

namespace {

void write_outputs(const ImageToWrite& task) {
    for (const BatchOutput& output : task.outputs) {
        OutputSettings encoding = output.encoding;
        encoding.metadata.emplace_back(record_name, output.record);
        const auto layers = output.has_aovs ? std::span(task.aovs) : std::span<const AovImage>();
        const std::vector<unsigned char> file = encode_image(output.path, task.image, encoding, layers);
        // A folder of thousands of images is searched once, at the end, and not for each of them.
        write_file(output.path, std::as_bytes(std::span(file)), 0666, Stale::leave);
        if (!keeps_record(output.path)) add_folder_record(output.path, output.record);
    }
    std::error_code ignored;
    std::filesystem::remove(task.checkpoint, ignored);
}

std::optional<Error> try_to_write(const ImageToWrite& task) {
    try {
        write_outputs(task);
        return std::nullopt;
    } catch (const Error& error) {
        return error;
    } catch (const std::bad_alloc&) {
        return Error(ExitCode::memory, "out of memory while the image was encoded");
    } catch (const std::exception& error) {
        return Error(ExitCode::output, error.what());
    }
}

}  // namespace

BatchWriter::BatchWriter(Written written)
    : written_(std::move(written)), thread_([this](const std::stop_token& stop) { run(stop); }) {}

void BatchWriter::write(ImageToWrite image) {
    finish();
    const std::lock_guard lock(mutex_);
    image_.emplace(std::move(image));
    changed_.notify_all();
}

void BatchWriter::finish() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !image_; });
}

void BatchWriter::run(const std::stop_token& stop) {
    for (;;) {
        {
            std::unique_lock lock(mutex_);
            if (!changed_.wait(lock, stop, [this] { return image_.has_value(); })) return;
        }
        // Nobody else touches it until it is reset.
        const std::size_t job = image_->job;
        const std::optional<Error> error = try_to_write(*image_);
        image_->claim.reset();
        written_(job, error);
        const std::lock_guard lock(mutex_);
        image_.reset();
        changed_.notify_all();
    }
}

}  // namespace sahl::cli
