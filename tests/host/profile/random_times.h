// Made-up times with known truths.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "engine/profile/statistics.h"

namespace sahl::tests {

/// The same times with every compiler and library.
class RandomTimes {
public:
    explicit RandomTimes(std::uint64_t seed) : state_(seed) {}

    /// From 0 to 1, neither of them.
    double uniform() {
        state_ = state_ * 6364136223846793005U + 1442695040888963407U;
        return (static_cast<double>(state_ >> 11U) + 0.5) / 9007199254740992.0;
    }

    /// Around `centre` with a spread of some `noise` (0.02: 2 %), now and then much longer, as times are.
    double time(double centre, double noise) {
        const double outlier = uniform() < 0.05 ? 1 + uniform() : 1;
        return centre * outlier * std::exp(noise * std::log(1 / uniform() - 1) * 0.55);
    }

    /// `count` times a side; the other side takes `ratio` times as long. Between pairs the machine's speed
    /// changes by up to a factor of two, within them not.
    TwoSides sides(std::size_t count, double ratio, double noise, bool paired) {
        TwoSides times{{}, {}, paired};
        for (std::size_t i = 0; i < count; ++i) {
            const double speed = paired ? 1 + uniform() : 1;
            times.base.push_back(time(speed, noise));
            times.other.push_back(time(speed * ratio, noise));
        }
        return times;
    }

private:
    std::uint64_t state_;
};

}  // namespace sahl::tests
