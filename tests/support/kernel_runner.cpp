#include "tests/support/kernel_runner.h"

#include <cstdlib>
#include <string_view>
#include <utility>

namespace sahl::tests {
namespace {

constexpr const char* kRange = R"(
#define TEST_FOR_EACH(i, count)                                                           \
    for (uint i = (uint)get_global_id(0) * SAHL_RAYS_PER_ITEM,                            \
              i##_end = min(i + (uint)SAHL_RAYS_PER_ITEM, (count)); i < i##_end; ++i)
#define TEST_FOR_EACH_GROUP(i, count)                                                     \
    for (uint i = (uint)get_global_id(0) * SAHL_RAYS_PER_ITEM,                            \
              i##_end = min(i + (uint)SAHL_RAYS_PER_ITEM, (count)); i < i##_end; i += 8u)
// Of lanes of a group that are behind the last index, the last one's; `in` and `count` as the kernel has them.
#define TEST_LANES(type, in, i)                                                           \
    ((type)((in)[min(i, count - 1u)], (in)[min(i + 1u, count - 1u)], (in)[min(i + 2u, count - 1u)],     \
            (in)[min(i + 3u, count - 1u)], (in)[min(i + 4u, count - 1u)], (in)[min(i + 5u, count - 1u)], \
            (in)[min(i + 6u, count - 1u)], (in)[min(i + 7u, count - 1u)]))
#define TEST_LANES_OF(type, in, i, part)                                                  \
    ((type)((in)[min(i, count - 1u)].part, (in)[min(i + 1u, count - 1u)].part,            \
            (in)[min(i + 2u, count - 1u)].part, (in)[min(i + 3u, count - 1u)].part,       \
            (in)[min(i + 4u, count - 1u)].part, (in)[min(i + 5u, count - 1u)].part,       \
            (in)[min(i + 6u, count - 1u)].part, (in)[min(i + 7u, count - 1u)].part))
#define TEST_LANES3(in, i)                                                                \
    ((floatv3){TEST_LANES_OF(floatv, in, i, x), TEST_LANES_OF(floatv, in, i, y), TEST_LANES_OF(floatv, in, i, z)})
)";

}  // namespace

KernelRunner::KernelRunner(const std::string& text, const std::string& options,
                           std::shared_ptr<Device> device)
    : device_(std::move(device)), program_(Program::from_text(*device_, kRange + text, options)) {}

Launch KernelRunner::whole_range(std::size_t count) const {
    // Also for no indices at all and behind the last one: kernels have to bear work-items without work.
    return {.work_items = count / device_->rays_per_item() + 1, .items = count};
}

bool full_tests() {
    const char* value = std::getenv("SAHL_TEST_FULL");
    return value != nullptr && std::string_view(value) == "1";
}

}  // namespace sahl::tests
