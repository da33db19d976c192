#include "engine/film/film_checkpoint.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>

#include "engine/core/atomic_file.h"

namespace sahl {
namespace {

struct Header {
    std::array<char, 8> magic;
    std::array<char, 40> job;
    std::int32_t width;
    std::int32_t height;
    std::uint64_t samples;
    std::uint64_t non_finite;
    std::uint64_t clamped;
    std::uint64_t sums;      ///< how many follow; the rest is 0
    std::uint64_t checksum;  ///< of these four numbers and the sums
};
constexpr std::array<char, 8> file_magic = {'S', 'A', 'H', 'L', 'F', 'L', 'M', '1'};

/// FNV-1a by words: each step is a bijection of the state, so that no change of a single word goes unseen.
std::uint64_t checksum(const Header& header, std::span<const std::int64_t> sums) {
    std::uint64_t hash = 0xcbf29ce484222325U;
    const auto add = [&hash](std::uint64_t word) { hash = (hash ^ word) * 0x100000001b3U; };
    for (const std::uint64_t word : {header.samples, header.non_finite, header.clamped, header.sums})
        add(word);
    for (const std::int64_t sum : sums) add(static_cast<std::uint64_t>(sum));
    return hash;
}

std::array<char, 40> padded(const std::string& job) {
    std::array<char, 40> text{};
    std::copy_n(job.begin(), std::min(job.size(), text.size()), text.begin());
    return text;
}

}  // namespace

void write_checkpoint(const std::filesystem::path& path, const std::string& job, std::uint64_t samples,
                      const Film& film) {
    // Samples come tile by tile, downwards: what is below the last tile is still black.
    const std::span<const std::int64_t> all = film.sums();
    const auto end = std::find_if(all.rbegin(), all.rend(), [](std::int64_t sum) { return sum != 0; });
    const std::span<const std::int64_t> sums = all.first(static_cast<std::size_t>(all.rend() - end));
    Header header{file_magic,           padded(job), film.width(),
                  film.height(),        samples,     film.non_finite_count(),
                  film.clamped_count(), sums.size(), 0};
    header.checksum = checksum(header, sums);
    const std::array pieces{std::as_bytes(std::span(&header, 1)), std::as_bytes(sums)};
    write_file(path, pieces);
}

std::optional<std::uint64_t> read_checkpoint(const std::filesystem::path& path, const std::string& job,
                                             Film& film) {
    std::ifstream file(path, std::ios::binary);
    Header header{};
    file.read(reinterpret_cast<char*>(&header), sizeof(header));
    if (!file || header.magic != file_magic || header.job != padded(job) || header.width != film.width() ||
        header.height != film.height() || header.sums > film.sums().size())
        return std::nullopt;
    const std::span<std::int64_t> sums =
        film.restore(header.non_finite, header.clamped).first(static_cast<std::size_t>(header.sums));
    file.read(reinterpret_cast<char*>(sums.data()), static_cast<std::streamsize>(sums.size_bytes()));
    if (file && file.peek() == std::ifstream::traits_type::eof() && checksum(header, sums) == header.checksum)
        return header.samples;
    std::fill(sums.begin(), sums.end(), 0);
    film.restore(0, 0);
    return std::nullopt;
}

}  // namespace sahl
