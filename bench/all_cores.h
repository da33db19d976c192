// Loops over all cores, as Embree's users run them.
#pragma once

#include <cstddef>
#include <functional>

namespace sahl::bench {

/// Calls work(begin, end) for parts of 0..count of `chunk` each, taken by all cores as they come. Threads
/// flush denormals to zero, as Embree's manual advises.
void for_chunks(std::size_t count, std::size_t chunk,
                const std::function<void(std::size_t, std::size_t)>& work);

}  // namespace sahl::bench
