// How the self-test compares answers: what differs, by how much, and what rounding excuses.
#include <limits>
#include <string>

#include <catch2/catch.hpp>

#include "engine/self_test/kernel_check.h"

namespace sahl::self_test {
namespace {

using glm::dvec3;

constexpr double infinity = std::numeric_limits<double>::infinity();

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

double number_difference(double expected, double found, double scale = 1) {
    Difference difference;
    difference.number("x", expected, found, scale);
    return difference.amount();
}

TEST_CASE("self-test: numbers differ absolutely below 1, relatively above, infinitely if they are none",
          "[self_test]") {
    CHECK(number_difference(0.25, 0.5) == Approx(0.25));
    CHECK(number_difference(100, 101) == Approx(1.0 / 101));
    CHECK(number_difference(2, 4, 0.5) == Approx(0.25));
    CHECK(number_difference(infinity, infinity) == 0);
    CHECK(number_difference(infinity, 5) == infinity);
    CHECK(number_difference(5, std::numeric_limits<double>::quiet_NaN()) == infinity);
}

TEST_CASE("self-test: the worst quantity is told", "[self_test]") {
    Difference difference;
    difference.exact("id", 7, 7);
    CHECK(difference.amount() == 0);
    difference.number("t", 0.5, 0.625);
    difference.vector("direction", {0, 0, 1}, {0, 0.25, 1});
    difference.vector("origin", {1, 2, 3}, {1, 2, 3});
    CHECK(difference.amount() == Approx(0.25));
    CHECK(difference.text() == "direction: expected (0, 0, 1), found (0, 0.25, 1), difference 0.25");
    difference.exact("instance", 3, 4);
    CHECK(difference.text() == "instance: expected 3, found 4");
}

/// Answers to rays along z at x = 0, 1, 2, …; `compare` is asked for each.
bool check(KernelTest& test, const Compare& compare) {
    const auto ray = [](std::size_t i) { return oracle::Ray{{static_cast<double>(i), 0, 0}, {0, 0, 2}}; };
    return check_rays(test, {2, 10, 1e-5, ray}, compare);
}

TEST_CASE("self-test: the first wrong answer is told with its ray, and the right ones before it are counted",
          "[self_test]") {
    KernelTest test{"intersect"};
    CHECK_FALSE(check(test, [](std::size_t i, const oracle::Ray&) {
        Difference difference;
        difference.number("t", 1, i == 6 || i == 8 ? 1.5 : 1 + 1e-6 * static_cast<double>(i));
        return difference;
    }));
    CHECK(test.checked == 7);
    CHECK(test.worst == Approx(5e-6).epsilon(1e-3));
    CHECK(test.allowed == 1e-5);
    CHECK(contains(test.failure,
                   "ray 6 of generation 2, origin (6, 0, 0), direction (0, 0, 2): t: expected 1, "
                   "found 1.5, difference 0.33"));
}

TEST_CASE("self-test: an answer that is right beside the ray is right, one that is right farther off is not",
          "[self_test]") {
    // A step at x = 3 + distance: the reference has 1 before it and 2 behind, the kernel has 2 for ray 3.
    const auto passes = [](double distance) {
        KernelTest test{"intersect"};
        const bool passed = check(test, [distance](std::size_t i, const oracle::Ray& ray) {
            Difference difference;
            difference.number("step", ray.origin.x < 3 + distance ? 1 : 2, i < 3 ? 1 : 2);
            return difference;
        });
        CHECK(passed == test.failure.empty());
        return passed;
    };
    CHECK(passes(0));
    CHECK(passes(5e-6));
    CHECK_FALSE(passes(2e-5));
}

TEST_CASE("self-test: counts have to be equal", "[self_test]") {
    KernelTest test{"compact"};
    const auto expected = [](std::size_t i) { return i; };
    CHECK(check_exact(test, "block", 5, expected, expected));
    CHECK(test.checked == 5);
    CHECK_FALSE(check_exact(test, "block", 5, expected, [](std::size_t i) { return i == 3 ? 4 : i; }));
    CHECK(test.failure == "block 3: expected 3, found 4");
}

}  // namespace
}  // namespace sahl::self_test
