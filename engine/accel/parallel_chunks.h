// Loops over large sets by several threads, over small ones by the calling thread.
#pragma once

#include <cstddef>
#include <functional>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

namespace sahl {

/// Sets at least this large are the work of several threads.
inline constexpr std::size_t parallel_set_size = 1u << 16;
/// What a thread then takes at a time.
inline constexpr std::size_t parallel_grain = 1u << 14;

/// Calls work(begin, end) for ranges that make up [0, size).
template <class Work>
void for_chunks(std::size_t size, const Work& work) {
    if (size < parallel_set_size) {
        work(std::size_t{0}, size);
    } else {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, size, parallel_grain),
                          [&](const auto& range) { work(range.begin(), range.end()); });
    }
}

/// The sum of what work(begin, end) returns for ranges that make up [begin, end).
template <class Work>
auto sum_chunks(std::size_t begin, std::size_t end, const Work& work) {
    using Sum = decltype(work(begin, end));
    if (end - begin < parallel_set_size) return work(begin, end);
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(begin, end, parallel_grain), Sum{},
        [&](const auto& range, Sum sum) { return sum + work(range.begin(), range.end()); }, std::plus<Sum>());
}

}  // namespace sahl
