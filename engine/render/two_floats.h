// Double precision in two floats, for devices and layouts that only take floats.
#pragma once

namespace sahl {

/// high + low is the value to 48 bits; high is the value rounded to float.
struct TwoFloats {
    float high;
    float low;
};

inline TwoFloats split(double value) {
    // GCC 12 vectorises neighbouring splits and then takes (double)(float)x for x, which leaves
    // every low part 0. It may not do that through a volatile.
    volatile float high = static_cast<float>(value);
    return {high, static_cast<float>(value - static_cast<double>(high))};
}

}  // namespace sahl
