// The film: where weighted contributions of all generations add up. Sums are signed Q31.32 fixed
// point, so they do not depend on the order of addition.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/device/memory.h"

namespace sahl {

/// Linear colour, row-major from the top left, `channels` interleaved floats a pixel.
struct Image {
    int width = 0;
    int height = 0;
    int channels = 3;
    std::vector<float> pixels;
};

/// What a Film takes for a pixel.
inline constexpr std::size_t film_pixel_bytes = 3 * sizeof(std::int64_t);

/// Sums are taken modulo 2^64 and are right whenever the true sum lies within ±2^31, whatever came in
/// between: for every pixel whose resolved value is below 131072 at 16384 samples. One thread at a time.
class Film {
public:
    /// Largest magnitude of one contribution; larger ones are clamped and counted.
    static constexpr float max_contribution = 131072.0F;

    /// Throws Error(memory) when there is no room for 24 bytes a pixel.
    Film(MemoryAccountant& accountant, int width, int height);

    int width() const { return width_; }
    int height() const { return height_; }

    /// Adds contribution i (red[i], green[i], blue[i]) to pixel pixels[i] (row-major index).
    /// A non-finite channel value adds 0 and is counted, one beyond ±max_contribution is clamped
    /// and counted. Each is rounded to the nearest 2^-32, halves away from zero.
    void add(std::span<const std::uint32_t> pixels, const float* red, const float* green, const float* blue);

    /// Adds the sums and counts of a film of the same size: parts of a job, in any order, make the film
    /// of the whole. Throws Error(usage) for another size.
    void merge(const Film& other);

    /// The sums, 3 a pixel, row-major: what a checkpoint keeps.
    std::span<const std::int64_t> sums() const { return sums_; }
    /// The same to be filled in, and the counts that go with them.
    std::span<std::int64_t> restore(std::uint64_t non_finite, std::uint64_t clamped);

    /// Makes these pixels black again, whatever was added to them. The counts stay.
    void clear(std::span<const std::uint32_t> pixels);

    /// The sums of a pixel (row-major index), in units of 2^-32.
    std::array<std::int64_t, 3> sum(std::size_t pixel) const;

    /// The sums divided by `samples` (a pixel).
    Image resolve(int samples) const;

    std::uint64_t non_finite_count() const { return non_finite_; }
    std::uint64_t clamped_count() const { return clamped_; }

private:
    int width_;
    int height_;
    HostMemory memory_;
    std::span<std::int64_t> sums_;  ///< 3 a pixel
    std::uint64_t non_finite_ = 0;
    std::uint64_t clamped_ = 0;
};

}  // namespace sahl
