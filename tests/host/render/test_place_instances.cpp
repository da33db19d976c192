// Instances of instances as one list, and what is refused of them.
#include <string>

#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/core/error.h"
#include "engine/oracle/build_scene.h"
#include "engine/oracle/shape.h"
#include "engine/render/host_scene.h"
#include "engine/render/place_instances.h"

namespace sahl::tests {
namespace {

std::string refusal(const Scene& scene) {
    try {
        make_host_scene(scene);
    } catch (const Error& error) {
        CHECK(error.code() == ExitCode::scene);
        return error.what();
    }
    return {};
}

TEST_CASE("instances are placed depth first, each before those in its group") {
    Scene scene;
    oracle::add_square(scene, 0, 1, {});
    const std::uint32_t leaf = oracle::add_group(scene);
    oracle::add_square(scene, 0, 1, {});
    const std::uint32_t nest = oracle::add_group(scene);
    const auto moved = [](double x) { return glm::translate(glm::dmat4(1), glm::dvec3(x, 0, 0)); };
    oracle::add_instance(scene, nest, leaf, moved(1));
    oracle::add_instance(scene, nest, leaf, moved(2));
    oracle::add_instance(scene, nest, moved(10));
    oracle::add_instance(scene, leaf, moved(20));
    oracle::add_instance(scene, nest, moved(30));
    const std::vector<PlacedGroup> placed = place_instances(scene);
    const std::vector<double> x{10, 11, 12, 20, 30, 31, 32};
    const std::vector<std::uint32_t> groups{nest, leaf, leaf, leaf, nest, leaf, leaf};
    const std::vector<glm::dmat4> expected = oracle::instance_placements(scene);
    REQUIRE(placed.size() == x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        CHECK(placed[i].world_from_group[3].x == x[i]);
        CHECK(placed[i].group == groups[i]);
        CHECK(placed[i].world_from_group == expected[i]);
    }
    CHECK(refusal(scene).empty());
}

TEST_CASE("instances that cannot be are refused") {
    Scene scene;
    const std::uint32_t group = oracle::add_group(scene);
    oracle::add_square(scene, 0, 1, {});
    SECTION("flattened") {
        oracle::add_instance(scene, group, glm::scale(glm::dmat4(1), glm::dvec3(1, 0, 1)));
        CHECK(refusal(scene).find("instance 1 (of group 'group 0')") != std::string::npos);
    }
    SECTION("in themselves") {
        oracle::add_instance(scene, group, group, glm::dmat4(1));
        oracle::add_instance(scene, group, glm::dmat4(1));
        CHECK(refusal(scene).find("nested deeper") != std::string::npos);
    }
    SECTION("more than can be counted") {
        std::uint32_t inner = group;
        for (int level = 0; level < 40; ++level) {
            const std::uint32_t outer = oracle::add_group(scene);
            for (int i = 0; i < 4; ++i) oracle::add_instance(scene, outer, inner, glm::dmat4(1));
            inner = outer;
        }
        oracle::add_instance(scene, inner, glm::dmat4(1));
        CHECK(refusal(scene).find("instances") != std::string::npos);
    }
}

}  // namespace
}  // namespace sahl::tests
