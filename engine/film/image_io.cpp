#include "engine/film/image_io.h"

#include <chrono>
#include <future>
#include <span>

#include "engine/core/atomic_file.h"
#include "engine/core/host_steps.h"
#include "engine/film/image_codecs.h"
#include "engine/film/image_decode.h"
#include "engine/film/image_encode.h"
#include "engine/film/image_format.h"

namespace sahl {

namespace fs = std::filesystem;

void check_output_format(const fs::path& path, const OutputSettings& settings) {
    encoding_of(path, settings);
}

void check_output(const fs::path& path, const OutputSettings& settings) {
    check_output_format(path, settings);
    check_output_file(path);
}

void load_encoder(const fs::path& path) {
    if (is_png(format_of(path))) return;
    static const std::shared_future<void> loading =
        std::async(std::launch::async, [] { image_codecs(ExitCode::output); });
    if (loading.wait_for(std::chrono::seconds(0)) == std::future_status::ready) loading.get();
}

void wait_for_encoder(const fs::path& path) {
    if (!is_png(format_of(path))) image_codecs(ExitCode::output);
}

std::uint64_t encoder_bytes(const fs::path& path, const OutputSettings& settings, int width, int height,
                            std::span<const Aov> aovs) {
    return encoder_bytes(encoding_of(path, settings), width, height, aovs);
}

std::vector<unsigned char> encode_image(const fs::path& path, const Image& image,
                                        const OutputSettings& settings, std::span<const AovImage> aovs) {
    return encode(path, image, aovs, encoding_of(path, settings), settings);
}

void write_image(const fs::path& path, const Image& image, const OutputSettings& settings,
                 std::span<const AovImage> aovs) {
    const std::vector<unsigned char> file = [&] {
        const HostStep step("encode");
        return encode_image(path, image, settings, aovs);
    }();
    const HostStep step("write");
    write_file(path, std::as_bytes(std::span(file)));
}

Image read_image(const fs::path& path) {
    return decode(path, [](std::size_t) {});
}

}  // namespace sahl
