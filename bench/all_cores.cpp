#include "bench/all_cores.h"

#include <pmmintrin.h>
#include <xmmintrin.h>

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace sahl::bench {

void for_chunks(std::size_t count, std::size_t chunk,
                const std::function<void(std::size_t, std::size_t)>& work) {
    std::atomic<std::size_t> next{0};
    const auto take_chunks = [&] {
        const unsigned int mode = _mm_getcsr();
        _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
        _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
        for (std::size_t begin = next.fetch_add(chunk); begin < count; begin = next.fetch_add(chunk))
            work(begin, std::min(begin + chunk, count));
        _mm_setcsr(mode);
    };
    std::vector<std::jthread> others;
    for (unsigned int i = 1; i < std::thread::hardware_concurrency(); ++i) others.emplace_back(take_chunks);
    take_chunks();
}

}  // namespace sahl::bench
