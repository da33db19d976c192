// Test kernels: a program from a test's text, which includes kernels/ headers, run over arrays.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/device/program.h"

namespace sahl::tests {

/// A program of test kernels, on the default device unless one is given.
class KernelRunner {
public:
    /// `text`: OpenCL C. A kernel's last parameter is a `uint count`; its work-items share the indices
    /// 0 ≤ i < count by TEST_FOR_EACH(i, count), which this class puts before the text; or by groups of
    /// eight, the first of which is i, by TEST_FOR_EACH_GROUP(i, count), with TEST_LANES for their inputs.
    explicit KernelRunner(const std::string& text, const std::string& options = "",
                          std::shared_ptr<Device> device = std::make_shared<Device>());

    Device& device() { return *device_; }

    template <class T>
    Buffer upload(const std::vector<T>& values) {
        Buffer buffer(device(), values.size() * sizeof(T), "test input");
        if (!values.empty()) buffer.write(std::span<const T>(values));
        return buffer;
    }

    template <class T>
    static std::vector<T> download(Buffer& buffer, std::size_t count) {
        const auto mapping = buffer.map<T>(MapMode::read, count);
        return {mapping.begin(), mapping.end()};
    }

    /// Runs `kernel(arguments..., count)`.
    template <class... Arguments>
    void run(const std::string& kernel, std::size_t count, const Arguments&... arguments) {
        program_.kernel(kernel).launch(whole_range(count), arguments..., static_cast<std::uint32_t>(count));
    }

    /// Runs `kernel(inputs..., global Out* out, count)` over inputs of equal length; `out` has
    /// `per_index` elements for each index.
    template <class Out, class First, class... More>
    std::vector<Out> map(const std::string& kernel, std::size_t per_index, const std::vector<First>& first,
                         const std::vector<More>&... more) {
        Buffer out(device(), first.size() * per_index * sizeof(Out), "test output");
        run(kernel, first.size(), upload(first), upload(more)..., out);
        return download<Out>(out, first.size() * per_index);
    }

private:
    Launch whole_range(std::size_t count) const;

    std::shared_ptr<Device> device_;
    Program program_;
};

/// Whether the environment asks for the big numbers (SAHL_TEST_FULL=1).
bool full_tests();

}  // namespace sahl::tests
