#include "engine/device/buffer.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/device/device_impl.h"

namespace sahl {
namespace {

constexpr std::size_t smallest = 64;

void check_size(const Device& device, std::size_t bytes, const std::string& name) {
    const std::size_t limit = device.info().max_allocation;
    if (bytes <= limit) return;
    throw Error(ExitCode::memory,
                fmt::format("buffer {}: {} bytes, but {} gives at most {} bytes to one buffer; "
                            "make the scene or the image smaller, or choose another --device",
                            name, bytes, device.info().name, limit));
}

cl_map_flags map_flags(MapMode mode) {
    switch (mode) {
        case MapMode::read:
            return CL_MAP_READ;
        case MapMode::write:
            return CL_MAP_WRITE;
        case MapMode::read_write:
            break;
    }
    return CL_MAP_READ | CL_MAP_WRITE;
}

/// The OpenCL buffer over `impl.memory`, or one of the driver's where that is empty.
void create(Buffer::Impl& impl) {
    void* pointer = impl.memory.data();
    if (pointer == nullptr) {
        impl.driver_memory = MemoryReservation(impl.device.memory(), impl.bytes, impl.name);
    }
    const cl_mem_flags place = pointer != nullptr ? CL_MEM_USE_HOST_PTR : 0;
    cl_int status = CL_SUCCESS;
    impl.buffer =
        cl::Buffer(impl.device.impl().context, CL_MEM_READ_WRITE | place, impl.bytes, pointer, &status);
    check_cl(status, fmt::format("creating buffer {} of {} bytes", impl.name, impl.bytes));
}

}  // namespace

Buffer::Impl::~Impl() {
    // Queued kernels may still work on memory that is ours to unmap.
    if (memory.data() != nullptr) device.impl().queue.finish();
    buffer = cl::Buffer();
}

Buffer::Buffer(Device& device, std::size_t bytes, std::string name)
    : impl_(new Impl{device, std::move(name), bytes == 0 ? smallest : bytes, {}, {}, {}}) {
    check_size(device, impl_->bytes, impl_->name);
    if (device.zero_copy()) impl_->memory = HostMemory(device.memory(), impl_->bytes, impl_->name);
    create(*impl_);
}

Buffer::Buffer(Device& device, HostMemory&& memory, std::string name)
    : impl_(new Impl{device, std::move(name), memory.size() == 0 ? smallest : memory.size(), {}, {}, {}}) {
    check_size(device, impl_->bytes, impl_->name);
    if (device.zero_copy() && memory.size() > 0) {
        impl_->memory = std::move(memory);
        create(*impl_);
        return;
    }
    if (device.zero_copy()) impl_->memory = HostMemory(device.memory(), impl_->bytes, impl_->name);
    create(*impl_);
    const HostMemory filled = std::move(memory);
    write_bytes(filled.data(), filled.size());
}

Buffer::Buffer() = default;

Buffer::~Buffer() = default;
Buffer::Buffer(Buffer&&) noexcept = default;
Buffer& Buffer::operator=(Buffer&&) noexcept = default;

std::size_t Buffer::footprint(std::size_t bytes) {
    return HostMemory::mapped_bytes(std::max(bytes, smallest));
}

std::size_t Buffer::bytes() const { return impl_->bytes; }

const std::string& Buffer::name() const { return impl_->name; }

void Buffer::check_range(std::size_t bytes, const char* action) const {
    if (bytes <= impl_->bytes) return;
    throw Error(ExitCode::internal,
                fmt::format("buffer {}: {} {} bytes of {}", impl_->name, action, bytes, impl_->bytes));
}

void Buffer::write_bytes(const void* source, std::size_t bytes) {
    check_range(bytes, "writing");
    if (bytes == 0) return;
    check_cl(impl_->device.impl().queue.enqueueWriteBuffer(impl_->buffer, CL_TRUE, 0, bytes, source),
             "writing buffer " + impl_->name);
}

Buffer::Mapped Buffer::map_bytes(MapMode mode, std::size_t bytes) {
    check_range(bytes, "mapping");
    if (bytes == 0) return {};
    cl::Event event;
    cl_int status = CL_SUCCESS;
    void* pointer = impl_->device.impl().queue.enqueueMapBuffer(impl_->buffer, CL_FALSE, map_flags(mode), 0,
                                                                bytes, nullptr, &event, &status);
    check_cl(status, "mapping buffer " + impl_->name);
    cl_event handle = event();
    clRetainEvent(handle);  // from here on the mapping's
    return {pointer, handle};
}

void Buffer::wait_and_release(void* event) {
    const cl::Event owned(static_cast<cl_event>(event));
    check_cl(owned.wait(), "mapping a buffer");
}

void Buffer::unmap(Impl& impl, Mapped mapped) noexcept {
    if (mapped.event != nullptr) clReleaseEvent(static_cast<cl_event>(mapped.event));
    // In order behind the map command, so that there is nothing to wait for. What fails here
    // fails in the next command too, where it can be reported.
    if (mapped.pointer != nullptr)
        impl.device.impl().queue.enqueueUnmapMemObject(impl.buffer, mapped.pointer);
}

}  // namespace sahl
