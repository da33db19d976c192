// The verdict on one kernel, ray by ray.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "engine/oracle/shape.h"
#include "engine/self_test/difference.h"
#include "engine/self_test/self_test.h"

namespace sahl::self_test {

/// What a kernel's answer number i differs by from the reference's answer to `ray`. May be called from
/// several threads.
using Compare = std::function<Difference(std::size_t i, const oracle::Ray& ray)>;

/// What is compared: `count` rays of a bounce generation, ray(i) each, and by how much answers may differ.
struct RayAnswers {
    std::uint32_t generation;
    std::size_t count;
    double allowed;
    std::function<oracle::Ray(std::size_t i)> ray;
};

/// Compares all answers and counts them. The reference decides in double precision what single precision
/// cannot tell apart: which side of an edge a ray passes, or whether it is reflected totally. So an answer
/// is right as well when it is the reference's to a ray that is less than a few roundings away.
/// False at the first wrong one, which `test` then tells of.
bool check_rays(KernelTest& test, const RayAnswers& answers, const Compare& compare);

/// The same for `count` numbers that have to be equal; number i is of "WHAT i".
bool check_exact(KernelTest& test, std::string_view what, std::size_t count,
                 const std::function<std::uint64_t(std::size_t)>& expected,
                 const std::function<std::uint64_t(std::size_t)>& found);

}  // namespace sahl::self_test
