#include "engine/device/memory.h"

#include <fmt/format.h>
#include <sys/mman.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <utility>

#include "engine/core/error.h"

namespace sahl {
namespace {

constexpr std::size_t page_size = 4096;
constexpr std::size_t huge_page = std::size_t{2} << 20;
constexpr std::size_t huge_from = std::size_t{1} << 20;

std::size_t round_up(std::size_t value, std::size_t unit) { return (value + unit - 1) / unit * unit; }

std::size_t granularity(std::size_t bytes) { return bytes < huge_from ? page_size : huge_page; }

}  // namespace

void MemoryAccountant::add(std::size_t bytes) {
    const std::size_t now = current_.fetch_add(bytes) + bytes;
    std::size_t peak = peak_.load();
    while (peak < now && !peak_.compare_exchange_weak(peak, now)) {
    }
}

void MemoryAccountant::remove(std::size_t bytes) { current_.fetch_sub(bytes); }

std::size_t HostMemory::mapped_bytes(std::size_t bytes) { return round_up(bytes, granularity(bytes)); }

HostMemory::HostMemory(MemoryAccountant& accountant, std::size_t bytes, std::string_view name) {
    if (bytes == 0) return;
    const auto refuse = [&](const char* reason) {
        throw Error(ExitCode::memory, fmt::format("{}: cannot allocate {} bytes: {}; render a smaller "
                                                  "image or scene, or free memory",
                                                  name, bytes, reason));
    };
    if (bytes > SIZE_MAX / 4) refuse(std::strerror(ENOMEM));
    const std::size_t unit = granularity(bytes);
    const std::size_t size = mapped_bytes(bytes);
    // One unit more than needed, so that an aligned range is inside; the ends go back.
    const std::size_t slack = unit == page_size ? 0 : unit;
    void* mapping = mmap(nullptr, size + slack, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (mapping == MAP_FAILED) refuse(std::strerror(errno));
    auto* start = static_cast<std::byte*>(mapping);
    const std::size_t skip = (unit - reinterpret_cast<std::uintptr_t>(mapping) % unit) % unit;
    if (skip > 0) munmap(start, skip);
    if (slack > skip) munmap(start + skip + size, slack - skip);
    data_ = start + skip;
    size_ = bytes;
    // A hint: a system without transparent huge pages refuses it and works with small ones.
    if (unit == huge_page) madvise(data_, size, MADV_HUGEPAGE);
    accountant_ = &accountant;
    accountant_->add(size);
}

HostMemory::~HostMemory() {
    if (data_ == nullptr) return;
    const std::size_t size = mapped_bytes(size_);
    munmap(data_, size);
    accountant_->remove(size);
}

HostMemory::HostMemory(HostMemory&& other) noexcept
    : accountant_(std::exchange(other.accountant_, nullptr)),
      data_(std::exchange(other.data_, nullptr)),
      size_(std::exchange(other.size_, 0)) {}

HostMemory& HostMemory::operator=(HostMemory&& other) noexcept {
    std::swap(accountant_, other.accountant_);
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    return *this;
}

}  // namespace sahl
