// Device memory by name, and the host's view of it.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "engine/device/device.h"

namespace sahl {

enum class MapMode { read, write, read_write };

/// The host's view of a buffer, unmapped at destruction. Must not outlive the buffer. Move-only.
template <class T>
class Mapping;

/// A device buffer. On CPU devices it is our own huge-page memory used in place; elsewhere the
/// driver's. Mapping and writing wait for the queued commands before them; contents start as zero
/// on zero-copy devices and undefined elsewhere. Move-only.
class Buffer {
public:
    Buffer();
    /// Throws Error(memory) naming the buffer and its size when it cannot be had or when it is
    /// larger than the device's largest allocation. 0 bytes are rounded up to 64.
    Buffer(Device& device, std::size_t bytes, std::string name);
    /// Takes over host memory that is already filled: no copy on zero-copy devices.
    Buffer(Device& device, HostMemory&& memory, std::string name);
    ~Buffer();
    Buffer(Buffer&& other) noexcept;
    Buffer& operator=(Buffer&& other) noexcept;

    std::size_t bytes() const;
    const std::string& name() const;

    /// What the accountant counts for a buffer of `bytes`, at most.
    static std::size_t footprint(std::size_t bytes);

    /// Copies `values` to the start of the buffer (blocking).
    template <class T>
    void write(std::span<const T> values) {
        write_bytes(values.data(), values.size_bytes());
    }
    void write_bytes(const void* source, std::size_t bytes);

    /// The first `count` elements, ready to use: waits for the queue (blocking).
    template <class T>
    Mapping<T> map(MapMode mode, std::size_t count);

    /// The same without waiting: the contents are there after Mapping::wait(). Commands queued
    /// later may run while the host works on the mapping.
    template <class T>
    Mapping<T> enqueue_map(MapMode mode, std::size_t count);

    struct Impl;  ///< for engine/device alone
    Impl* impl() const { return impl_.get(); }

private:
    struct Mapped {
        void* pointer = nullptr;
        void* event = nullptr;  ///< owned; cl_event behind
    };
    Mapped map_bytes(MapMode mode, std::size_t bytes);
    static void wait_and_release(void* event);
    static void unmap(Impl& impl, Mapped mapped) noexcept;
    void check_range(std::size_t bytes, const char* action) const;
    template <class T>
    friend class Mapping;

    std::unique_ptr<Impl> impl_;
};

template <class T>
class Mapping {
public:
    Mapping(Buffer& buffer, MapMode mode, std::size_t count)
        : owner_(buffer.impl()), mapped_(buffer.map_bytes(mode, count * sizeof(T))), count_(count) {}
    ~Mapping() {
        if (owner_ != nullptr) Buffer::unmap(*owner_, mapped_);
    }
    Mapping(Mapping&& other) noexcept
        : owner_(std::exchange(other.owner_, nullptr)),
          mapped_{other.mapped_.pointer, std::exchange(other.mapped_.event, nullptr)},
          count_(other.count_) {}
    Mapping(const Mapping&) = delete;
    Mapping& operator=(const Mapping&) = delete;
    Mapping& operator=(Mapping&&) = delete;

    /// Blocks until the contents are there.
    void wait() {
        if (mapped_.event != nullptr) Buffer::wait_and_release(std::exchange(mapped_.event, nullptr));
    }

    T& operator[](std::size_t i) const { return data()[i]; }
    T* data() const { return static_cast<T*>(mapped_.pointer); }
    std::size_t size() const { return count_; }
    T* begin() const { return data(); }
    T* end() const { return data() + count_; }

private:
    Buffer::Impl* owner_;
    Buffer::Mapped mapped_;
    std::size_t count_;
};

template <class T>
Mapping<T> Buffer::map(MapMode mode, std::size_t count) {
    Mapping<T> mapping(*this, mode, count);
    mapping.wait();
    return mapping;
}

template <class T>
Mapping<T> Buffer::enqueue_map(MapMode mode, std::size_t count) {
    return Mapping<T>(*this, mode, count);
}

}  // namespace sahl
