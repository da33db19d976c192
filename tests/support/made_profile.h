// Profiles with made-up times, as `sahl profile --export-json` writes them.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include <nlohmann/json.hpp>

namespace sahl::tests {

struct MadeProfile {
    std::uint64_t seed = 1;  ///< of the noise
    int repetitions = 15;
    double noise = 0.01;
    std::map<std::string, double> factors{};  ///< how many times as long a kernel takes
};

/// Three generations of all kernels; intersect takes some 10 ms in the first. It is what
/// docs/sahl-profile.schema.json describes.
nlohmann::ordered_json made_profile(const MadeProfile& made = {});

}  // namespace sahl::tests
