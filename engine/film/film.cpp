#include "engine/film/film.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <string>

#include "engine/core/error.h"
#include "engine/core/host_steps.h"
#include "engine/film/resolve.h"

namespace sahl {
namespace {

constexpr double one = 0x1p32;      ///< 1.0 in Q31.32
constexpr std::size_t block = 512;  ///< contributions converted at once; the block stays in the L1 cache

/// Nearest multiple of 2^-32, halves away from zero, for |value| <= max_contribution. Every
/// operation is exact or truncates, so that the rounding mode does not matter; no branch and no
/// integer over 32 bits before the last line, so that it runs in SIMD lanes on every processor.
[[gnu::always_inline]] inline std::int64_t to_fixed(float value) {
    const auto high = static_cast<std::int32_t>(value * 0x1p13F);                // |high| <= 2^30
    const float rest = (value - static_cast<float>(high) * 0x1p-13F) * 0x1p32F;  // |rest| < 2^19
    const auto low = static_cast<std::int32_t>(rest);
    const float fraction = rest - static_cast<float>(low);
    const auto away = static_cast<std::int32_t>(2 * fraction);  // -1, 0 or 1
    return (std::int64_t{high} << 19) + (low + away);
}

struct Counts {
    std::uint32_t non_finite = 0;
    std::uint32_t clamped = 0;
};

/// Converts up to `block` values of a channel. Compares and clamps bit patterns: as integers,
/// magnitudes are in the order of the floats, and the loop stays free of branches.
[[gnu::always_inline]] inline Counts convert_in_lanes(std::span<const float> values, std::int64_t* fixed) {
    constexpr auto largest = std::bit_cast<std::int32_t>(Film::max_contribution);
    constexpr auto infinity = std::bit_cast<std::int32_t>(std::numeric_limits<float>::infinity());
    std::int32_t non_finite = 0;
    std::int32_t above = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto bits = std::bit_cast<std::int32_t>(values[i]);
        const std::int32_t magnitude = bits & 0x7fffffff;
        const std::int32_t is_finite = magnitude < infinity;
        non_finite += 1 - is_finite;
        above += magnitude > largest;
        const std::int32_t clamped = (magnitude < largest ? magnitude : largest) | (bits ^ magnitude);
        fixed[i] = to_fixed(std::bit_cast<float>(clamped & -is_finite));
    }
    return {.non_finite = static_cast<std::uint32_t>(non_finite),
            .clamped = static_cast<std::uint32_t>(above - non_finite)};
}

#ifdef __x86_64__
[[gnu::target("avx2")]] Counts convert_by_avx2(std::span<const float> values, std::int64_t* fixed) {
    return convert_in_lanes(values, fixed);
}
#endif

/// convert_in_lanes() by what the processor has: the same numbers.
Counts convert(std::span<const float> values, std::int64_t* fixed) {
#ifdef __x86_64__
    static const bool has_avx2 = __builtin_cpu_supports("avx2") != 0;
    if (has_avx2) return convert_by_avx2(values, fixed);
#endif
    return convert_in_lanes(values, fixed);
}

/// Modulo 2^64: what a sum passes through on the way does not matter, only where it ends.
void add_to(std::int64_t& sum, std::int64_t value) {
    sum = static_cast<std::int64_t>(static_cast<std::uint64_t>(sum) + static_cast<std::uint64_t>(value));
}

}  // namespace

void resolve(std::span<const std::int64_t> sums, int samples, std::span<float> colors) {
    const double divisor = one * samples;
    std::transform(sums.begin(), sums.end(), colors.begin(),
                   [=](std::int64_t sum) { return static_cast<float>(static_cast<double>(sum) / divisor); });
}

Film::Film(MemoryAccountant& accountant, int width, int height)
    : width_(width),
      height_(height),
      memory_(accountant,
              film_pixel_bytes * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), "film"),
      sums_(static_cast<std::int64_t*>(memory_.data()), memory_.size() / sizeof(std::int64_t)) {}

void Film::add(std::span<const std::uint32_t> pixels, const float* red, const float* green,
               const float* blue) {
    std::uint32_t last = 0;
    for (const std::uint32_t pixel : pixels) last = std::max(last, pixel);
    if (!pixels.empty() && last >= sums_.size() / 3)
        throw Error(ExitCode::internal, "a contribution names pixel " + std::to_string(last) +
                                            " of a film of " + std::to_string(sums_.size() / 3) +
                                            "; please report this");

    std::array<std::array<std::int64_t, block>, 3> fixed{};
    const std::array<const float*, 3> channels{red, green, blue};
    for (std::size_t begin = 0; begin < pixels.size(); begin += block) {
        const std::size_t count = std::min(block, pixels.size() - begin);
        for (std::size_t c = 0; c < 3; ++c) {
            const Counts counts = convert({channels[c] + begin, count}, fixed[c].data());
            non_finite_ += counts.non_finite;
            clamped_ += counts.clamped;
        }
        for (std::size_t i = 0; i < count; ++i) {
            std::int64_t* sum = &sums_[3 * std::size_t{pixels[begin + i]}];
            add_to(sum[0], fixed[0][i]);
            add_to(sum[1], fixed[1][i]);
            add_to(sum[2], fixed[2][i]);
        }
    }
}

void Film::merge(const Film& other) {
    if (other.width_ != width_ || other.height_ != height_) {
        throw Error(ExitCode::usage, "films of different sizes cannot be merged");
    }
    for (std::size_t i = 0; i < sums_.size(); ++i) add_to(sums_[i], other.sums_[i]);
    non_finite_ += other.non_finite_;
    clamped_ += other.clamped_;
}

std::span<std::int64_t> Film::restore(std::uint64_t non_finite, std::uint64_t clamped) {
    non_finite_ = non_finite;
    clamped_ = clamped;
    return sums_;
}

void Film::clear(std::span<const std::uint32_t> pixels) {
    for (const std::uint32_t pixel : pixels) {
        const auto sums = sums_.subspan(3 * std::size_t{pixel}, 3);
        std::fill(sums.begin(), sums.end(), 0);
    }
}

std::array<std::int64_t, 3> Film::sum(std::size_t pixel) const {
    return {sums_[3 * pixel], sums_[3 * pixel + 1], sums_[3 * pixel + 2]};
}

Image Film::resolve(int samples) const {
    const HostStep step("resolve");
    Image image{
        .width = width_, .height = height_, .channels = 3, .pixels = std::vector<float>(sums_.size())};
    sahl::resolve(sums_, samples, image.pixels);
    return image;
}

}  // namespace sahl
