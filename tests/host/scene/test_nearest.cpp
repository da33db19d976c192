#include <catch2/catch.hpp>

#include <array>
#include <string>
#include <string_view>

#include "engine/core/nearest.h"

namespace sahl::tests {

TEST_CASE("The nearest name", "[core]") {
    constexpr std::array<std::string_view, 5> names = {"sphere", "scale", "size", "pushTransform", "s"};
    CHECK(nearest_name("spher", names) == "sphere");
    CHECK(nearest_name("shpere", names) == "sphere");  // two neighbours swapped
    CHECK(nearest_name("SPHERE", names) == "sphere");
    CHECK(nearest_name("pushtransfrom", names) == "pushTransform");
    CHECK(nearest_name("sise", names) == "size");
    CHECK(nearest_name("S", names) == "s");
    CHECK(nearest_name("x", names).empty());
    CHECK(nearest_name("", names).empty());
    CHECK(nearest_name("integrator", names).empty());
    CHECK(nearest_name(std::string(1000000, 's'), names).empty());
    CHECK(did_you_mean("spher", names) == "; did you mean 'sphere'?");
    CHECK(did_you_mean("integrator", names).empty());
    CHECK(join_names(names) == "sphere, scale, size, pushTransform, s");
}

}  // namespace sahl::tests
