#include "engine/profile/measure_in_turn.h"

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

#include "engine/profile/block_medians.h"

namespace sahl {
namespace {

constexpr int most_blocks = 20;
constexpr int default_pairs = 15;  ///< of a block
constexpr double most_seconds_of_pairs = 3;

using Contenders = std::array<std::optional<Contender>, 2>;

/// Sides in the order in which it is their turn.
class Lots {
public:
    std::array<std::size_t, 2> draw() {
        const std::size_t first = source_() & 1U;
        return {first, 1 - first};
    }

private:
    std::random_device source_;
};

/// `pairs` in equal parts, the first ones larger by one where they cannot be equal.
int pairs_of_block(int block, int blocks, int pairs) {
    return pairs / blocks + (block < pairs % blocks ? 1 : 0);
}

std::array<ProfileTimes, 2> measure_block(Contenders& contenders, Lots& lots,
                                          const std::function<bool(int, double)>& is_enough,
                                          const std::function<void()>& between_frames) {
    std::array<std::vector<TimelineRecord>, 2> frames;
    const std::uint64_t begin = monotonic_ns();
    const auto seconds = [&] { return static_cast<double>(monotonic_ns() - begin) * 1e-9; };
    for (int pairs = 0; !is_enough(pairs, seconds()); ++pairs) {
        between_frames();
        for (const std::size_t side : lots.draw()) {
            Contender& turn = *contenders[side];
            frames[side].push_back(record_frame(*turn.device, *turn.renderer, turn.job).timeline);
        }
    }
    return {times_of(contenders[0]->environment, frames[0]), times_of(contenders[1]->environment, frames[1])};
}

}  // namespace

TurnTimes measure_in_turn(const std::array<std::function<Contender()>, 2>& makers, const TurnOptions& options,
                          const std::function<void()>& between_frames) {
    TurnTimes times;
    Lots lots;
    const int blocks = std::min(options.pairs.value_or(most_blocks), most_blocks);
    for (int block = 0; block < blocks; ++block) {
        between_frames();
        Contenders contenders;
        for (const std::size_t side : lots.draw()) {
            contenders[side] = makers[side]();
            for (int i = 0; i < options.warm_up; ++i) {
                run_frame(*contenders[side]->device, *contenders[side]->renderer, contenders[side]->job);
            }
        }
        const auto is_enough = [&](int pairs, double seconds) {
            if (options.pairs) return pairs == pairs_of_block(block, blocks, *options.pairs);
            return pairs == default_pairs || (pairs > 0 && seconds > most_seconds_of_pairs);
        };
        const std::array<ProfileTimes, 2> measured =
            measure_block(contenders, lots, is_enough, between_frames);
        times.pairs += static_cast<int>(measured[0].rows.front().samples_ms.size());
        append_block(times.sides, measured);
    }
    return times;
}

}  // namespace sahl
