// Every allocation on the host fails once: what comes of it is an exception, and nothing is lost on the way
// (the address sanitizer's leak check sees to that).
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <new>

#include <catch2/catch.hpp>

#include "engine/core/error.h"
#include "engine/film/film.h"
#include "engine/film/image_compare.h"
#include "engine/render/host_scene.h"
#include "engine/scene/load.h"
#include "engine/self_test/every_feature.h"
#include "tests/support/failing_new.h"

namespace sahl::tests {
namespace {

/// Runs `work` with its first, its second, … allocation failing, until all succeed. How many failed. It may
/// do without the memory, as sorting does, and says whether what came out is right.
int fail_each_allocation(const std::function<bool()>& work) {
    REQUIRE(work());  // what is allocated once for all is there now
    for (int nth = 1;; ++nth) {
        bool failed = false;
        bool right = false;
        std::string message;
        {
            const FailingNew failing(static_cast<std::uint64_t>(nth));
            try {
                right = work();
            } catch (const std::bad_alloc&) {
                right = true;
            } catch (const Error& error) {
                right = error.code() == ExitCode::memory;
                message = error.what();
            }
            failed = failing.has_failed();
        }
        if (!failed) return nth - 1;
        INFO("allocation " << nth << " " << message);
        REQUIRE(right);
    }
}

}  // namespace

TEST_CASE("allocations that fail: loading a scene", "[core]") {
    const std::filesystem::path data = std::filesystem::path(std::getenv("SAHL_SOURCE_DIR")) / "tests/data";
    for (const char* name : {"all_features.json", "all_entities.nff", "all_commands.test"}) {
        INFO(name);
        const Scene whole = load_scene(data / name);
        const std::size_t primitives = whole.primitives.size();
        const std::size_t materials = whole.materials.size();
        CHECK(fail_each_allocation([&] {
                  const Scene scene = load_scene(data / name);
                  return scene.primitives.size() == primitives && scene.materials.size() == materials &&
                         !scene.lights.empty();
              }) > 50);
    }
}

TEST_CASE("allocations that fail: making a scene ready for a device", "[core]") {
    const Scene scene = every_feature();
    const std::size_t nodes = make_host_scene(scene).bvh.nodes.size();
    CHECK(fail_each_allocation([&] { return make_host_scene(scene).bvh.nodes.size() == nodes; }) > 20);
}

TEST_CASE("allocations that fail: resolving a film and subtracting images", "[core]") {
    MemoryAccountant accountant;
    const Film film(accountant, 20, 10);
    const Image image = film.resolve(1);
    CHECK(fail_each_allocation([&] {
              const Image half = film.resolve(2);
              return difference_image(half, image).pixels == image.pixels;  // black
          }) > 1);
}

}  // namespace sahl::tests
