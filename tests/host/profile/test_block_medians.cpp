// Blocks of pairs on made-up times whose truth is known: what lasts through a block is no difference of the
// sides.
#include <catch2/catch.hpp>

#include <cmath>

#include "engine/profile/block_medians.h"
#include "engine/profile/compare_profiles.h"
#include "engine/profile/rank_tests.h"
#include "tests/host/profile/random_times.h"

namespace sahl::tests {
namespace {

using Sides = std::array<ProfileTimes, 2>;

Sides sides_of(const std::vector<double>& base, const std::vector<double>& other) {
    return {ProfileTimes{{}, {{"wall", std::nullopt, base}}},
            ProfileTimes{{}, {{"wall", std::nullopt, other}}}};
}

/// Blocks of as many pairs. The other side takes `ratio` times as long, and through each block longer or
/// shorter by what a draw of the block says, up to `lasting`.
Sides made_blocks(std::uint64_t seed, int blocks, std::size_t pairs, double ratio, double lasting) {
    RandomTimes random(seed);
    Sides all;
    for (int block = 0; block < blocks; ++block) {
        const double of_block = std::exp(lasting * (2 * random.uniform() - 1));
        const TwoSides times = random.sides(pairs, ratio * of_block, 0.01, true);
        append_block(all, sides_of(times.base, times.other));
    }
    return all;
}

/// All pairs of the same blocks as if each stood for itself.
TwoSides made_pairs(std::uint64_t seed, int blocks, std::size_t pairs, double lasting) {
    RandomTimes random(seed);
    TwoSides all{{}, {}, true};
    for (int block = 0; block < blocks; ++block) {
        const double of_block = std::exp(lasting * (2 * random.uniform() - 1));
        const TwoSides times = random.sides(pairs, of_block, 0.01, true);
        all.base.insert(all.base.end(), times.base.begin(), times.base.end());
        all.other.insert(all.other.end(), times.other.begin(), times.other.end());
    }
    return all;
}

SpeedVerdict verdict(const Sides& sides) {
    return compare_profiles(sides[0], sides[1], true).rows.at(0).verdict;
}

TEST_CASE("blocks: the median of a block's base times, and that times the median quotient", "[profile]") {
    Sides all;
    append_block(all, sides_of({10, 20, 40}, {11, 30, 44}));
    append_block(all, sides_of({8, 8}, {8, 10}));
    CHECK(all[0].rows.at(0).samples_ms == std::vector<double>{20, 8});
    CHECK(all[1].rows.at(0).samples_ms == std::vector<double>{22, 9});
    CHECK(ratio_of({all[0].rows[0].samples_ms, all[1].rows[0].samples_ms, true}) ==
          Approx((1.1 + 1.125) / 2));
}

TEST_CASE("blocks: rows of one side alone keep their medians, sides their environment", "[profile]") {
    Sides block = sides_of({4, 5, 6}, {4, 5, 6});
    block[0].environment.scene = "base.json";
    block[1].environment.scene = "other.json";
    block[1].rows.push_back({"shade", 1, {1, 3, 2}});
    Sides all;
    append_block(all, block);
    CHECK(find_row(all[0], "shade/1") == nullptr);
    REQUIRE(find_row(all[1], "shade/1") != nullptr);
    CHECK(find_row(all[1], "shade/1")->samples_ms == std::vector<double>{2});
    CHECK(all[0].environment.scene == "base.json");
    CHECK(all[1].environment.scene == "other.json");
}

TEST_CASE("blocks: what lasts through blocks is a difference to pairs, not to blocks", "[profile]") {
    constexpr int runs = 200;
    int alarms_of_blocks = 0;
    int alarms_of_pairs = 0;
    for (std::uint64_t seed = 0; seed < runs; ++seed) {
        // Sides that are equally fast on the whole, but 3 % apart for as long as a block.
        alarms_of_blocks +=
            verdict(made_blocks(seed, 20, 15, 1, 0.03)) != SpeedVerdict::no_difference ? 1 : 0;
        const TwoSides pairs = made_pairs(seed, 20, 15, 0.03);
        alarms_of_pairs += rank_test(pairs, Alternative::different) <= comparison_level ? 1 : 0;
    }
    CHECK(alarms_of_blocks <= 6);  // 2 expected
    CHECK(alarms_of_pairs >= 40);
}

TEST_CASE("blocks: a slowdown of 5 % is found beside what lasts through blocks", "[profile]") {
    constexpr int runs = 100;
    int found = 0;
    int exceeded = 0;
    for (std::uint64_t seed = 0; seed < runs; ++seed) {
        const Sides sides = made_blocks(seed, 20, 15, 1.05, 0.03);
        found += verdict(sides) == SpeedVerdict::slower ? 1 : 0;
        exceeded += check_limits(sides[0], sides[1], true, {{"wall", 0}}).at(0).exceeded ? 1 : 0;
    }
    CHECK(found >= 97);
    CHECK(exceeded >= 97);
}

}  // namespace
}  // namespace sahl::tests
