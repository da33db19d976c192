#include "tests/support/failing_new.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::uint64_t> allocations_left{0};  // 0: none fails

void* allocate(std::size_t bytes) noexcept {
    if (allocations_left.load(std::memory_order_relaxed) != 0 && --allocations_left == 0) return nullptr;
    return std::malloc(bytes > 0 ? bytes : 1);
}

}  // namespace

// All of them, so that none is left to a sanitizer, which would miss its own kind of `new` at `delete`.
void* operator new(std::size_t bytes) {
    if (void* memory = allocate(bytes)) return memory;
    throw std::bad_alloc();
}
void* operator new[](std::size_t bytes) { return operator new(bytes); }
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept { return allocate(bytes); }
void* operator new[](std::size_t bytes, const std::nothrow_t&) noexcept { return allocate(bytes); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { std::free(memory); }

namespace sahl::tests {

FailingNew::FailingNew(std::uint64_t nth) { allocations_left = nth; }
FailingNew::~FailingNew() { allocations_left = 0; }
bool FailingNew::has_failed() const { return allocations_left == 0; }

}  // namespace sahl::tests
