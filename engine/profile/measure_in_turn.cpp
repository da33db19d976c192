#include "engine/profile/measure_in_turn.h"

#include <random>
#include <utility>
#include <vector>

namespace sahl {

std::array<ProfileTimes, 2> measure_in_turn(const std::array<Contender, 2>& contenders, int warm_up,
                                            int pairs, const std::function<void()>& between_frames) {
    for (int i = 0; i < warm_up; ++i) {
        between_frames();
        for (const Contender& each : contenders) run_frame(each.device, each.renderer, each.job);
    }
    std::array<std::vector<TimelineRecord>, 2> frames;
    std::mt19937 coin;  // NOLINT: always the same draws
    for (int i = 0; i < pairs; ++i) {
        between_frames();
        const std::size_t first = coin() >> 31U;
        for (const std::size_t side : {first, 1 - first}) {
            const Contender& turn = contenders[side];
            frames[side].push_back(record_frame(turn.device, turn.renderer, turn.job).timeline);
        }
    }
    return {times_of(contenders[0].environment, frames[0]), times_of(contenders[1].environment, frames[1])};
}

}  // namespace sahl
