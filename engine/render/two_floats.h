// Double precision in two floats, for devices and layouts that only take floats.
#pragma once

namespace sahl {

/// high + low is the value to 48 bits; high is the value rounded to float.
struct TwoFloats {
    float high;
    float low;
};

inline TwoFloats split(double value) {
    const auto high = static_cast<float>(value);
    return {high, static_cast<float>(value - static_cast<double>(high))};
}

}  // namespace sahl
