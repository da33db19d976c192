// A hash that is the same on every machine.
#pragma once

#include <cstdint>
#include <string_view>

namespace sahl {

/// FNV-1a, 64 bits (Fowler, Noll, Vo): each step is a bijection of the state, so that no change
/// of a single byte goes unseen. `hash`: of what comes before.
constexpr std::uint64_t fnv1a(std::string_view bytes, std::uint64_t hash = 0xcbf29ce484222325u) {
    for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
    return hash;
}

}  // namespace sahl
