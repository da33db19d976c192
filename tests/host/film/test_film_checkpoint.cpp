// Films on disk: exactly what was written, or nothing.
#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>

#include <catch2/catch.hpp>

#include "engine/film/film_checkpoint.h"
#include "tests/support/temporary_folder.h"

namespace sahl::tests {
namespace {

const std::string job(40, 'a');

void fill(Film& film) {
    const std::array<std::uint32_t, 4> pixels{0, 7, 8, 9};
    const std::array<float, 4> light{0.1F, -3, 1e9F, 1e-9F};  // one is clamped
    film.add(pixels, light.data(), light.data(), light.data());
}

bool is_black(const Film& film) {
    return std::all_of(film.sums().begin(), film.sums().end(), [](std::int64_t sum) { return sum == 0; });
}

}  // namespace

TEST_CASE("film checkpoint: sums and counts come back exactly, for their job and size alone", "[film]") {
    const TemporaryFolder folder;
    MemoryAccountant accountant;
    Film film(accountant, 5, 4);
    fill(film);
    write_checkpoint(folder / "c", job, 31, film);
    Film read(accountant, 5, 4);
    CHECK(read_checkpoint(folder / "c", job, read) == 31);
    CHECK(std::equal(film.sums().begin(), film.sums().end(), read.sums().begin(), read.sums().end()));
    CHECK(read.clamped_count() == 3);
    Film other(accountant, 4, 5);
    CHECK_FALSE(read_checkpoint(folder / "c", job, other));
    CHECK_FALSE(read_checkpoint(folder / "c", std::string(40, 'b'), other));
    CHECK_FALSE(read_checkpoint(folder / "none", job, other));
    CHECK(is_black(other));
}

TEST_CASE("film checkpoint: a damaged one is none, and leaves the film black", "[film]") {
    const TemporaryFolder folder;
    MemoryAccountant accountant;
    Film film(accountant, 5, 4);
    fill(film);
    write_checkpoint(folder / "c", job, 31, film);
    std::ifstream file(folder / "c", std::ios::binary);
    const std::string whole{std::istreambuf_iterator<char>(file), {}};
    for (std::size_t i = 0; i <= whole.size(); ++i) {
        std::string damaged = whole;
        if (i == whole.size()) {
            damaged.pop_back();
        } else {
            damaged[i] = static_cast<char>(damaged[i] ^ 0x20);
        }
        std::ofstream(folder / "c", std::ios::binary) << damaged;
        Film read(accountant, 5, 4);
        INFO("byte " << i);
        CHECK_FALSE(read_checkpoint(folder / "c", job, read));
        CHECK(is_black(read));
        CHECK(read.clamped_count() == 0);
    }
}

}  // namespace sahl::tests
