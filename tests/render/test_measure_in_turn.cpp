// Two sides measured in turn: how often they are made, and which frames are whose.
#include <stdexcept>

#include <catch2/catch.hpp>

#include "engine/profile/measure_in_turn.h"
#include "tests/render/rendered.h"

namespace sahl::tests {
namespace {

Scene empty_scene() {
    Scene scene;
    scene.cameras.push_back({{0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 20, "camera"});
    return scene;
}

/// A side that counts how often it is made. Its name is its scene's.
std::function<Contender()> counted(int& made, const std::string& name) {
    return [&made, name] {
        ++made;
        Contender side;
        side.device = std::make_unique<Device>();
        side.renderer = std::make_unique<Renderer>(*side.device, empty_scene());
        side.job = {square_settings(8, 0), "/dev/null", {}};
        side.environment.scene = name;
        return side;
    };
}

TEST_CASE("measured in turn: sides are made anew for each block, and keep their frames",
          "[render][profile]") {
    int base = 0;
    int other = 0;
    int between = 0;
    const TurnTimes times = measure_in_turn({counted(base, "base"), counted(other, "other")},
                                            {.warm_up = 1, .pairs = 4}, [&between] { ++between; });
    CHECK(base == 4);
    CHECK(other == 4);
    CHECK(times.pairs == 4);
    CHECK(between == 4 + 4);  // blocks and pairs
    for (const std::size_t side : {0U, 1U}) {
        CHECK(times.sides[side].environment.scene == (side == 0 ? "base" : "other"));
        REQUIRE(find_row(times.sides[side], "wall") != nullptr);
        CHECK(find_row(times.sides[side], "wall")->samples_ms.size() == 4);
        CHECK(find_row(times.sides[side], "intersect/0")->samples_ms.size() == 4);
    }
}

TEST_CASE("measured in turn: what is thrown between frames ends the measurement", "[render][profile]") {
    int made = 0;
    int calls = 0;
    const auto stop = [&calls] {
        if (++calls == 3) throw std::runtime_error("stopped");
    };
    const auto side = counted(made, "side");
    CHECK_THROWS_WITH(measure_in_turn({side, side}, {}, stop), "stopped");
    CHECK(made == 2);  // one block, stopped before its second pair
}

}  // namespace
}  // namespace sahl::tests
