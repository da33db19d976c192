#include "engine/device/memory.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

#include "engine/core/error.h"

namespace sahl {
namespace {

constexpr std::size_t page_size = 4096;
constexpr std::size_t huge_page = std::size_t{2} << 20;
constexpr std::size_t huge_from = std::size_t{1} << 20;

std::size_t round_up(std::size_t value, std::size_t unit) { return (value + unit - 1) / unit * unit; }

std::size_t granularity(std::size_t bytes) { return bytes < huge_from ? page_size : huge_page; }

[[noreturn]] void refuse(std::string_view name, std::size_t bytes, const std::string& reason) {
    throw Error(ExitCode::memory, fmt::format("{}: cannot allocate {} bytes: {}; render a smaller "
                                              "image or scene, or free memory",
                                              name, bytes, reason));
}

/// Whether this is the call that SAHL_FAIL_ALLOCATION names.
bool is_to_fail() {
    static const std::uint64_t chosen = [] {
        const char* text = std::getenv("SAHL_FAIL_ALLOCATION");
        return text != nullptr ? std::strtoull(text, nullptr, 10) : 0;
    }();
    static std::atomic<std::uint64_t> calls{0};
    return chosen != 0 && ++calls == chosen;
}

bool is_guarded() {
    static const bool guarded = [] {
        const char* text = std::getenv("SAHL_GUARD");
        return text != nullptr && std::string_view(text) == "1";
    }();
    return guarded;
}

/// How much is mapped for guarded memory: `before` unused bytes, the memory, a page to trap on.
struct GuardedSize {
    explicit GuardedSize(std::size_t bytes)
        : used(round_up(bytes, alignment)), before(round_up(used, page_size) - used) {}

    static constexpr std::size_t alignment = 128;  ///< of what drivers and kernels want, the most
    std::size_t used;
    std::size_t before;
    std::size_t mapped = before + used + page_size;
};

/// Maps `mapped` bytes for the `bytes` that were asked for.
void* map_pages(std::size_t mapped, std::size_t bytes, std::string_view name) {
    void* pages = mmap(nullptr, mapped, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (pages == MAP_FAILED) refuse(name, bytes, std::strerror(errno));
    return pages;
}

void* map_guarded(std::size_t bytes, std::string_view name) {
    const GuardedSize size(bytes);
    auto* pages = static_cast<std::byte*>(map_pages(size.mapped, bytes, name));
    mprotect(pages + size.mapped - page_size, page_size, PROT_NONE);
    return pages + size.before;
}

void* map_aligned(std::size_t bytes, std::string_view name) {
    const std::size_t unit = granularity(bytes);
    const std::size_t size = HostMemory::mapped_bytes(bytes);
    // One unit more than needed, so that an aligned range is inside; the ends go back.
    const std::size_t slack = unit == page_size ? 0 : unit;
    auto* start = static_cast<std::byte*>(map_pages(size + slack, bytes, name));
    const std::size_t skip = (unit - reinterpret_cast<std::uintptr_t>(start) % unit) % unit;
    if (skip > 0) munmap(start, skip);
    if (slack > skip) munmap(start + skip + size, slack - skip);
    // A hint: a system without transparent huge pages refuses it and works with small ones.
    if (unit == huge_page) madvise(start + skip, size, MADV_HUGEPAGE);
    return start + skip;
}

}  // namespace

std::size_t physical_memory_bytes() {
    return static_cast<std::size_t>(::sysconf(_SC_PHYS_PAGES)) *
           static_cast<std::size_t>(::sysconf(_SC_PAGE_SIZE));
}

void MemoryAccountant::add(std::size_t bytes, std::string_view name) {
    if (is_to_fail()) refuse(name, bytes, "SAHL_FAIL_ALLOCATION says so");
    std::size_t now = current_.load();
    do {
        const std::size_t limit = limit_.load();
        if (now > limit || bytes > limit - now) {
            refuse(name, bytes, fmt::format("{} of the {} that may be used are in use", now, limit));
        }
    } while (!current_.compare_exchange_weak(now, now + bytes));
    now += bytes;
    std::size_t peak = peak_.load();
    while (peak < now && !peak_.compare_exchange_weak(peak, now)) {
    }
}

void MemoryAccountant::remove(std::size_t bytes) { current_.fetch_sub(bytes); }

MemoryReservation::MemoryReservation(MemoryAccountant& accountant, std::size_t bytes, std::string_view name)
    : bytes_(bytes) {
    accountant.add(bytes, name);
    accountant_ = &accountant;
}

MemoryReservation::~MemoryReservation() {
    if (accountant_ != nullptr) accountant_->remove(bytes_);
}

MemoryReservation::MemoryReservation(MemoryReservation&& other) noexcept
    : accountant_(std::exchange(other.accountant_, nullptr)), bytes_(std::exchange(other.bytes_, 0)) {}

MemoryReservation& MemoryReservation::operator=(MemoryReservation&& other) noexcept {
    std::swap(accountant_, other.accountant_);
    std::swap(bytes_, other.bytes_);
    return *this;
}

void MemoryReservation::give_back(std::size_t bytes) {
    accountant_->remove(bytes);
    bytes_ -= bytes;
}

std::size_t HostMemory::mapped_bytes(std::size_t bytes) { return round_up(bytes, granularity(bytes)); }

HostMemory::HostMemory(MemoryAccountant& accountant, std::size_t bytes, std::string_view name) {
    if (bytes == 0) return;
    if (bytes > std::numeric_limits<std::size_t>::max() / 4) refuse(name, bytes, std::strerror(ENOMEM));
    reservation_ = MemoryReservation(accountant, mapped_bytes(bytes), name);
    data_ = is_guarded() ? map_guarded(bytes, name) : map_aligned(bytes, name);
    size_ = bytes;
}

HostMemory::~HostMemory() {
    if (data_ == nullptr) return;
    if (is_guarded()) {
        const GuardedSize size(size_);
        munmap(static_cast<std::byte*>(data_) - size.before, size.mapped);
    } else {
        munmap(data_, mapped_bytes(size_));
    }
}

HostMemory::HostMemory(HostMemory&& other) noexcept
    : reservation_(std::move(other.reservation_)),
      data_(std::exchange(other.data_, nullptr)),
      size_(std::exchange(other.size_, 0)) {}

HostMemory& HostMemory::operator=(HostMemory&& other) noexcept {
    std::swap(reservation_, other.reservation_);
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    return *this;
}

}  // namespace sahl
