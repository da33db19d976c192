#include "engine/self_test/difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sahl::self_test {
namespace {

double difference(double expected, double found) {
    if (expected == found) return 0;  // infinities too
    const double size = std::max({1.0, std::abs(expected), std::abs(found)});
    const double amount = std::abs(expected - found) / size;
    return std::isfinite(amount) ? amount : std::numeric_limits<double>::infinity();
}

}  // namespace

void Difference::offer(Kind kind, double amount, std::string_view what, const glm::dvec3& expected,
                       const glm::dvec3& found) {
    if (!(amount > amount_)) return;
    amount_ = amount;
    kind_ = kind;
    what_ = what;
    expected_ = expected;
    found_ = found;
}

void Difference::number(std::string_view what, double expected, double found, double scale) {
    offer(Kind::number, scale * difference(expected, found), what, glm::dvec3(expected), glm::dvec3(found));
}

void Difference::vector(std::string_view what, const glm::dvec3& expected, const glm::dvec3& found) {
    double worst = 0;
    for (int axis = 0; axis < 3; ++axis) worst = std::max(worst, difference(expected[axis], found[axis]));
    offer(Kind::vector, worst, what, expected, found);
}

void Difference::exact(std::string_view what, std::uint64_t expected, std::uint64_t found) {
    offer(Kind::exact, expected == found ? 0 : std::numeric_limits<double>::infinity(), what,
          glm::dvec3(static_cast<double>(expected)), glm::dvec3(static_cast<double>(found)));
}

std::string Difference::text() const {
    const auto value = [this](const glm::dvec3& v) {
        switch (kind_) {
            case Kind::vector:
                return fmt::format("({:.9g}, {:.9g}, {:.9g})", v.x, v.y, v.z);
            case Kind::number:
                return fmt::format("{:.9g}", v.x);
            case Kind::exact:
                break;
        }
        return fmt::format("{:.0f}", v.x);
    };
    const std::string values =
        fmt::format("{}: expected {}, found {}", what_, value(expected_), value(found_));
    return kind_ == Kind::exact ? values : fmt::format("{}, difference {:.2g}", values, amount_);
}

}  // namespace sahl::self_test
