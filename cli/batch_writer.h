// Writes images on a thread of its own, while the next one is rendered.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "cli/batch_setup.h"
#include "engine/batch/folder_state.h"

namespace sahl::cli {

/// A rendered image on its way to the disk.
struct ImageToWrite {
    std::size_t job = 0;
    Image image{};
    std::vector<AovImage> aovs{};
    std::vector<BatchOutput> outputs{};  ///< with their metadata, but for the record
    std::filesystem::path checkpoint{};  ///< of no use once the image is written
    MemoryReservation memory{};          ///< what image, AOVs and encoder take
    std::unique_ptr<Claim> claim{};      ///< held until it is written
};

class BatchWriter {
public:
    /// `written` is called on the writer's thread after each image, with what it failed of, if it did.
    using Written = std::function<void(std::size_t job, const std::optional<Error>&)>;
    explicit BatchWriter(Written written);

    /// Takes an image as soon as the one before is written.
    void write(ImageToWrite image);
    /// Waits until nothing is left to write.
    void finish();

private:
    void run(const std::stop_token& stop);

    Written written_;
    std::mutex mutex_;
    std::condition_variable_any changed_;
    std::optional<ImageToWrite> image_{};  ///< until it is written
    std::jthread thread_{};                ///< last: it uses the others
};

}  // namespace sahl::cli
