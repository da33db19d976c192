// The one accountant for what the engine allocates, and the memory that CPU devices use in place.
#pragma once

#include <atomic>
#include <cstddef>
#include <string_view>

namespace sahl {

/// Counts the bytes that the engine holds: device buffers, BVH, film, encoder. Thread-safe.
class MemoryAccountant {
public:
    void add(std::size_t bytes);
    void remove(std::size_t bytes);
    std::size_t current() const { return current_; }
    std::size_t peak() const { return peak_; }

private:
    std::atomic<std::size_t> current_{0};
    std::atomic<std::size_t> peak_{0};
};

/// Zeroed pages. From 1 MB on they are aligned to 2 MB and huge where the system has them
/// (traversal of large trees loses a third on 4 KB pages); smaller ones are aligned to 4 KB.
/// The accountant counts what is mapped, see mapped_bytes(). Move-only.
class HostMemory {
public:
    HostMemory() = default;
    /// Throws Error(memory) naming `name` and the size when the system refuses. 0 bytes map nothing.
    HostMemory(MemoryAccountant& accountant, std::size_t bytes, std::string_view name);
    ~HostMemory();
    HostMemory(HostMemory&& other) noexcept;
    HostMemory& operator=(HostMemory&& other) noexcept;

    void* data() const { return data_; }
    std::size_t size() const { return size_; }

    /// What `bytes` cost: rounded up to 4 KB, from 1 MB on to 2 MB.
    static std::size_t mapped_bytes(std::size_t bytes);

private:
    MemoryAccountant* accountant_ = nullptr;
    void* data_ = nullptr;
    std::size_t size_ = 0;  ///< as asked for, see mapped_bytes()
};

}  // namespace sahl
