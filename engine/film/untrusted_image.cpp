// Damaged images crash decoders, or keep them busy for ever. So the decoding is done where that does no harm.
#include <algorithm>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/child_process.h"
#include "engine/core/error.h"
#include "engine/film/image_codecs.h"
#include "engine/film/image_decode.h"
#include "engine/film/image_io.h"

namespace sahl {
namespace {

/// What the child writes first; then the pixels or the message follow.
struct Answer {
    bool refused = false;
    ExitCode code = ExitCode::ok;    ///< of the Error, if refused
    std::size_t message_length = 0;  ///< of the Error, if refused
    int width = 0;
    int height = 0;
};

constexpr std::size_t max_message = 1 << 16;
/// What a header, with all its metadata, may cost; and pixels, beside what is in proportion to them.
constexpr std::size_t base_bytes = std::size_t{1} << 30;
constexpr std::size_t base_seconds = 4;
/// The slowest decoders do some millions of values a second.
constexpr std::size_t values_per_second = 1'000'000;
/// Pixels as floats, and as the decoder keeps them: progressive JPEG holds the coefficients of all.
constexpr std::size_t bytes_per_value = 4 * sizeof(float);

void send(const PipeEnd& pipe, const Answer& answer, std::span<const std::byte> rest) {
    if (pipe.write(std::as_bytes(std::span(&answer, 1)))) pipe.write(rest);
}

void decode_and_send(const ImageCodecs& codecs, const std::filesystem::path& path, const PipeEnd& pipe) {
    codecs.use_one_thread();
    limit_process(base_bytes, base_seconds);
    try {
        const Image image = decode(path, [](std::size_t values) {
            limit_process(base_bytes + bytes_per_value * values, base_seconds + values / values_per_second);
        });
        send(pipe, {.width = image.width, .height = image.height}, std::as_bytes(std::span(image.pixels)));
    } catch (const Error& error) {
        const std::string_view message = std::string_view(error.what()).substr(0, max_message);
        send(pipe, {.refused = true, .code = error.code(), .message_length = message.size()},
             std::as_bytes(std::span(message)));
    }
}

/// What the child has sent; neither, if it went before the end. It is not to be trusted either.
struct Received {
    std::optional<Image> image;
    std::optional<Error> refusal;
};

Received receive(const PipeEnd& pipe) {
    Received received;
    Answer answer;
    if (!pipe.read(std::as_writable_bytes(std::span(&answer, 1)))) return received;
    const auto is_size = [](int length) { return length > 0 && length <= max_image_size; };
    if (answer.refused) {
        std::string message(std::min(answer.message_length, max_message), ' ');
        if (pipe.read(std::as_writable_bytes(std::span(message)))) {
            received.refusal.emplace(answer.code, message);
        }
    } else if (is_size(answer.width) && is_size(answer.height)) {
        std::vector<float> pixels(3 * static_cast<std::size_t>(answer.width) *
                                  static_cast<std::size_t>(answer.height));
        if (pipe.read(std::as_writable_bytes(std::span(pixels)))) {
            received.image.emplace(Image{answer.width, answer.height, 3, std::move(pixels)});
        }
    }
    return received;
}

}  // namespace

Image read_untrusted_image(const std::filesystem::path& path) try {
    // Before there is a child: its time and memory are for decoding.
    const ImageCodecs& codecs = image_codecs(ExitCode::scene);
    Received received;
    const std::string misdeed =
        run_in_child([&](const PipeEnd& pipe) { decode_and_send(codecs, path, pipe); },
                     [&](const PipeEnd& pipe) { received = receive(pipe); });
    if (!misdeed.empty()) fail_decoding(path, "its decoder " + misdeed);
    if (received.refusal) throw *received.refusal;
    if (!received.image) fail_decoding(path, "its decoder was cut short");
    return std::move(*received.image);
} catch (const std::bad_alloc&) {
    fail_for_memory(path);
}

}  // namespace sahl
