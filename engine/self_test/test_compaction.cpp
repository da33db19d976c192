// Children on their way to the next batch: numbers and words, so all have to be equal.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "engine/self_test/kernel_check.h"
#include "engine/self_test/kernel_tests.h"

namespace sahl::self_test {
namespace {

using Words = Arrays<std::uint32_t>;

/// What became of the parents of one block.
struct Block {
    std::uint32_t reflected = 0, transmitted = 0, shadow_rays = 0;
};

std::vector<Block> count_blocks(RayQueues& queues, std::uint32_t count) {
    const Words outcomes(queues.outcomes, queues.capacity, 1);
    std::vector<Block> blocks(compact_blocks(count));
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t outcome = outcomes.at(0, i);
        Block& block = blocks[i / SAHL_COMPACT_BLOCK];
        if (outcome & SAHL_OUTCOME_REFLECTED) ++block.reflected;
        if (outcome & SAHL_OUTCOME_TRANSMITTED) ++block.transmitted;
        block.shadow_rays += outcome / SAHL_OUTCOME_SHADOW_RAY;
    }
    return blocks;
}

/// Parent and kind (0 reflected, 1 transmitted) of each child in the order of the next batch.
std::vector<std::pair<std::uint32_t, std::uint32_t>> child_order(RayQueues& queues, std::uint32_t count) {
    const Words outcomes(queues.outcomes, queues.capacity, 1);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> order;
    for (const std::uint32_t kind : {0U, 1U}) {
        const std::uint32_t flag = kind == 0 ? SAHL_OUTCOME_REFLECTED : SAHL_OUTCOME_TRANSMITTED;
        for (std::uint32_t i = 0; i < count; ++i) {
            if (outcomes.at(0, i) & flag) order.emplace_back(i, kind);
        }
    }
    return order;
}

/// Of each family of children, a block's of one kind, the octants and axes that they go along, one bit each.
std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> ways_of(
    RayQueues& queues, const std::vector<std::pair<std::uint32_t, std::uint32_t>>& order) {
    const Arrays<float> rays(queues.children, queues.capacity, 2 * SAHL_RAY_FLOATS);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> ways;
    for (const auto& [parent, kind] : order) {
        std::array<float, 3> length{};
        std::uint32_t octant = 0;
        for (std::uint32_t k = 0; k < 3; ++k) {
            const float part = rays.at(kind * SAHL_RAY_FLOATS + SAHL_RAY_DIRECTION + k, parent);
            length[k] = std::fabs(part);
            if (std::signbit(part)) octant |= 1U << k;
        }
        const auto axis =
            static_cast<std::uint32_t>(std::max_element(length.begin(), length.end()) - length.begin());
        ways[{kind, parent / SAHL_COMPACT_BLOCK}] |= 1U << (8 * axis + octant);
    }
    return ways;
}

}  // namespace

bool test_count_children(KernelTest& test, Wavefront& wavefront, const Generation& generation) {
    RayQueues& queues = wavefront.queues;
    launch_count_children(wavefront, generation.in_work);
    const std::vector<Block> blocks = count_blocks(queues, generation.in_work.count);
    const Words counts(queues.block_counts, blocks.size(), 2);
    const Words shadow_rays(queues.block_shadow_rays, blocks.size(), 1);
    return check_exact(
               test, "reflected rays of block", blocks.size(),
               [&](std::size_t i) { return blocks[i].reflected; },
               [&](std::size_t i) { return counts.at(0, i); }) &&
           check_exact(
               test, "transmitted rays of block", blocks.size(),
               [&](std::size_t i) { return blocks[i].transmitted; },
               [&](std::size_t i) { return counts.at(1, i); }) &&
           check_exact(
               test, "shadow rays of block", blocks.size(),
               [&](std::size_t i) { return blocks[i].shadow_rays; },
               [&](std::size_t i) { return shadow_rays.at(0, i); });
}

bool test_sum_children(KernelTest& test, Wavefront& wavefront, const Generation& generation) {
    RayQueues& queues = wavefront.queues;
    launch_sum_children(wavefront, generation.in_work, wavefront.queues.contributions[0]);
    const std::vector<Block> blocks = count_blocks(queues, generation.in_work.count);
    std::vector<std::uint32_t> places;
    std::uint32_t children = 0;
    std::uint32_t shadow_rays = 0;
    for (const auto member : {&Block::reflected, &Block::transmitted}) {
        for (const Block& block : blocks) {
            places.push_back(children);
            children += block.*member;
        }
    }
    for (const Block& block : blocks) shadow_rays += block.shadow_rays;
    const std::uint32_t sums[] = {children, shadow_rays, 0};
    const Words found_places(queues.block_counts, places.size(), 1);
    const Words totals(queues.contributions[0].totals, SAHL_TOTALS, 1);
    return check_exact(
               test, "place of the children of block", places.size(),
               [&](std::size_t i) { return places[i]; },
               [&](std::size_t i) { return found_places.at(0, i); }) &&
           check_exact(
               test, "total (children, shadow rays in two words)", 3, [&](std::size_t i) { return sums[i]; },
               [&](std::size_t i) { return totals.at(0, i); });
}

bool test_compact(KernelTest& test, Wavefront& wavefront, const Generation& generation,
                  std::uint32_t& children) {
    RayQueues& queues = wavefront.queues;
    const std::size_t capacity = queues.capacity;
    const auto order = child_order(queues, generation.in_work.count);
    children = static_cast<std::uint32_t>(order.size());
    launch_compact(wavefront, generation.in_work, queues.batches[0], queues.batches[1],
                   queues.contributions[0]);
    // Floats as the words that they are: moving changes no bit.
    const auto compare = [&](Buffer& staged, Buffer& next, Buffer& waiting, std::size_t arrays) {
        const Words from(staged, capacity, 2 * arrays);
        const Words to(next, capacity, arrays);
        const Words rest(waiting, capacity, arrays);
        for (std::size_t array = 0; array < arrays; ++array) {
            const auto expected = [&](std::size_t i) {
                return from.at(order[i].second * arrays + array, order[i].first);
            };
            const auto found = [&](std::size_t i) {
                return i < capacity ? to.at(array, i) : rest.at(array, i - capacity);
            };
            const std::string what = fmt::format("word {} of ray", array);
            if (!check_exact(test, what, order.size(), expected, found)) return false;
        }
        return true;
    };
    RayBatch& next = queues.batches[0];
    RayBatch& waiting = queues.batches[1];
    const auto ways = ways_of(queues, order);
    std::uint32_t sum = 0;
    for (const auto& [family, of_family] : ways) sum += static_cast<std::uint32_t>(std::popcount(of_family));
    const std::uint32_t sums[] = {static_cast<std::uint32_t>(ways.size()), sum};
    const Words totals(queues.contributions[0].totals, SAHL_TOTALS, 1);
    return check_exact(
               test, "total (families of children, their ways)", 2, [&](std::size_t i) { return sums[i]; },
               [&](std::size_t i) { return totals.at(0, SAHL_TOTAL_FAMILIES + i); }) &&
           compare(queues.children, next.rays, waiting.rays, SAHL_RAY_FLOATS) &&
           compare(queues.child_ids, next.ids, waiting.ids, SAHL_RAY_UINTS);
}

}  // namespace sahl::self_test
