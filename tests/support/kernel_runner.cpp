#include "tests/support/kernel_runner.h"

#include <cstdlib>
#include <string_view>

namespace sahl::tests {
namespace {

constexpr const char* kRange = R"(
#define TEST_FOR_EACH(i, count)                                                           \
    for (uint i = (uint)get_global_id(0) * SAHL_RAYS_PER_ITEM,                            \
              i##_end = min(i + (uint)SAHL_RAYS_PER_ITEM, (count)); i < i##_end; ++i)
)";

}  // namespace

KernelRunner::KernelRunner(const std::string& text, const std::string& options)
    : program_(Program::from_text(device_, kRange + text, options)) {}

Launch KernelRunner::whole_range(std::size_t count) const {
    const std::size_t each = device_.rays_per_item();
    return {.work_items = (count + each - 1) / each, .items = count};
}

bool full_tests() {
    const char* value = std::getenv("SAHL_TEST_FULL");
    return value != nullptr && std::string_view(value) == "1";
}

}  // namespace sahl::tests
