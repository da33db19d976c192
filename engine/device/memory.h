// The one accountant for what the engine allocates, and the memory that CPU devices use in place.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace sahl {

/// What this machine has.
std::size_t physical_memory_bytes();

/// Counts the bytes that the engine holds: device buffers, scene, trees, film, encoder. Thread-safe.
class MemoryAccountant {
public:
    /// From now on add() refuses what would bring current() over `bytes`.
    void set_limit(std::size_t bytes) { limit_ = bytes; }
    std::size_t limit() const { return limit_; }

    /// `bytes` more are held by `name`. Throws Error(memory) with name, size and limit, and counts
    /// nothing, when they would not fit.
    /// For tests of what happens then, the environment variable SAHL_FAIL_ALLOCATION=N makes the
    /// process's N-th call (from 1) fail as if the system had refused.
    void add(std::size_t bytes, std::string_view name);
    void remove(std::size_t bytes);
    std::size_t current() const { return current_; }
    std::size_t peak() const { return peak_; }

private:
    friend class UncountedMemory;
    std::atomic<std::size_t> current_{0};
    std::atomic<std::size_t> peak_{0};
    std::atomic<std::size_t> limit_{SIZE_MAX};
};

/// Work on the side, which belongs to what the runtime itself takes: what is allocated while this lives, and
/// given back before it ends, counts neither against the limit nor for the peak. One thread at a time.
class UncountedMemory {
public:
    explicit UncountedMemory(MemoryAccountant& accountant)
        : accountant_(accountant), limit_(accountant.limit_.exchange(SIZE_MAX)), peak_(accountant.peak_) {}
    ~UncountedMemory() {
        accountant_.limit_ = limit_;
        accountant_.peak_ = peak_;
    }
    UncountedMemory(const UncountedMemory&) = delete;
    UncountedMemory& operator=(const UncountedMemory&) = delete;

private:
    MemoryAccountant& accountant_;
    std::size_t limit_;
    std::size_t peak_;
};

/// The accountant's count of memory that something else allocates, such as a std::vector. Move-only.
class MemoryReservation {
public:
    MemoryReservation() = default;
    /// Throws as MemoryAccountant::add.
    MemoryReservation(MemoryAccountant& accountant, std::size_t bytes, std::string_view name);
    ~MemoryReservation();
    MemoryReservation(MemoryReservation&& other) noexcept;
    MemoryReservation& operator=(MemoryReservation&& other) noexcept;

    /// Some of it is held no longer; at most all.
    void give_back(std::size_t bytes);

private:
    MemoryAccountant* accountant_ = nullptr;
    std::size_t bytes_ = 0;
};

/// Zeroed pages. From 1 MB on they are aligned to 2 MB and huge where the system has them
/// (traversal of large trees loses a third on 4 KB pages); smaller ones are aligned to 4 KB.
/// The accountant counts what is mapped, see mapped_bytes(). Move-only.
/// With SAHL_GUARD=1 in the environment the memory ends, but for what aligns it to 128 bytes, at a page
/// that may not be touched, so that the first access beyond it, a kernel's too, ends the process with
/// SIGSEGV; pages are small ones then.
class HostMemory {
public:
    HostMemory() = default;
    /// Throws Error(memory) naming `name` and the size when the system or the accountant refuses.
    /// 0 bytes map nothing.
    HostMemory(MemoryAccountant& accountant, std::size_t bytes, std::string_view name);
    ~HostMemory();
    HostMemory(HostMemory&& other) noexcept;
    HostMemory& operator=(HostMemory&& other) noexcept;

    void* data() const { return data_; }
    std::size_t size() const { return size_; }

    /// What `bytes` cost: rounded up to 4 KB, from 1 MB on to 2 MB.
    static std::size_t mapped_bytes(std::size_t bytes);

private:
    MemoryReservation reservation_;
    void* data_ = nullptr;
    std::size_t size_ = 0;  ///< as asked for, see mapped_bytes()
};

}  // namespace sahl
