// How much memory a piece of work takes at its peak.
#pragma once

#include <cstdint>
#include <functional>

namespace sahl::bench {

/// By how many bytes of resident memory the process grows at most while `work` runs, as Linux counts them; 0
/// where it does not let a process reset its peak.
std::uint64_t peak_growth(const std::function<void()>& work);

}  // namespace sahl::bench
