#include "engine/render/incoherent_intersect.h"

#include "engine/self_test/first_use.h"

namespace sahl {
namespace {

/// With as many octants and axes in a family of rays, of 24 that there are, packets and streams take the same
/// time: packets took 0.8 times as long at 6, 1.2 times at 12 to 14 and 2.7 times above 20, in the Standard
/// Procedural Databases.
constexpr std::uint64_t ways_of_incoherent = 10;

/// Building the program takes a tenth of a second, most of which PoCL's compiler takes to read the sources,
/// though the binary is in the cache; a ray saves a third of a microsecond.
constexpr std::uint64_t rays_worth_building = 1U << 18U;

}  // namespace

bool are_coherent(std::span<const std::uint32_t> totals) {
    return totals[SAHL_TOTAL_WAYS] < ways_of_incoherent * totals[SAHL_TOTAL_FAMILIES];
}

IncoherentIntersect::IncoherentIntersect(Device& device, Program& program, WavefrontKernels& others)
    : device_(device), program_of_others_(program), others_(others) {}

TracingKernel& IncoherentIntersect::kernel_for(std::uint32_t rays) {
    rays_ += rays;
    if (!kernel_ && rays_ >= rays_worth_building && program_of_others_.is_optimized()) build(false);
    return kernel_ ? *kernel_ : others_.intersect;
}

void IncoherentIntersect::build(bool counting) {
    const Traversal way = device_.incoherent_traversal();
    if (way == others_.intersect.way) return;
    program_.emplace(build_incoherent_program(device_, counting));
    WavefrontKernels tested(others_.shadow.way, program_of_others_,
                            tracing_kernel("intersect", way, *program_));
    if (!counting) test_before_first_use(device_, *program_, tested);
    kernel_.emplace(std::move(tested.intersect));
}

void IncoherentIntersect::store_binary() {
    if (program_) program_->store_binary();
}

}  // namespace sahl
