#include <algorithm>
#include <cstring>
#include <random>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <catch2/catch.hpp>

#include "engine/accel/bvh.h"
#include "tests/host/accel/boxes.h"
#include "tests/host/accel/triangles.h"

using namespace sahl;
using namespace sahl::test;

namespace {

Bvh build_with(int threads, const std::vector<BuildPrimitive>& primitives,
               const TriangleCorners& corners = {}, BuildQuality quality = BuildQuality::high) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                      static_cast<std::size_t>(threads));
    // An arena of its own: the default one has no more threads than the machine has processors.
    tbb::task_arena arena(threads);
    Bvh bvh;
    arena.execute([&] { bvh = build_bvh(primitives, corners, quality); });
    return bvh;
}

bool same_bits(const Bvh& a, const Bvh& b) {
    return a.nodes.size() == b.nodes.size() && a.leaves.size() == b.leaves.size() &&
           a.leaf_lines == b.leaf_lines &&
           std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof a.nodes[0]) == 0 &&
           std::memcmp(a.leaves.data(), b.leaves.data(), a.leaves.size() * sizeof a.leaves[0]) == 0 &&
           std::memcmp(&a.bounds, &b.bounds, sizeof a.bounds) == 0 &&
           a.statistics.sah_cost == b.statistics.sah_cost;
}

}  // namespace

TEST_CASE("the tree is the same bits for every number of threads", "[bvh]") {
    for (const Spread spread : {Spread::uniform, Spread::clustered, Spread::negative_zeros, Spread::grid}) {
        CAPTURE(static_cast<int>(spread));
        const auto primitives = make_primitives(spread, 200000, spread == Spread::clustered, 11);
        const Bvh one = build_with(1, primitives);
        for (int run = 0; run < 3; ++run) CHECK(same_bits(one, build_with(4, primitives)));
        CHECK(same_bits(one, build_with(3, primitives)));
    }
}

TEST_CASE("spatial splits: the tree is the same bits for every number of threads and order", "[bvh]") {
    for (const BuildQuality quality : {BuildQuality::high, BuildQuality::fast}) {
        for (const Triangles kind : {Triangles::crossed, Triangles::slivers, Triangles::identical}) {
            CAPTURE(static_cast<int>(quality), static_cast<int>(kind));
            const TriangleSet set = make_triangles(kind, 100000, 11);
            const Bvh one = build_with(1, set.primitives, set.corners(), quality);
            CHECK(same_bits(one, build_with(4, set.primitives, set.corners(), quality)));
            std::vector<BuildPrimitive> shuffled = set.primitives;
            std::mt19937 random(12);
            for (std::size_t i = shuffled.size(); i > 1; --i)
                std::swap(shuffled[i - 1], shuffled[random() % i]);
            CHECK(same_bits(one, build_with(3, shuffled, set.corners(), quality)));
        }
    }
}

TEST_CASE("the tree does not depend on the order in which primitives come", "[bvh]") {
    for (const Spread spread : {Spread::uniform, Spread::same_box, Spread::negative_zeros, Spread::series}) {
        CAPTURE(static_cast<int>(spread));
        auto primitives = make_primitives(spread, 70000, true, 12);
        const Bvh first = build_bvh(primitives);
        std::mt19937 random(13);
        for (std::size_t i = primitives.size(); i > 1; --i) {
            std::swap(primitives[i - 1], primitives[random() % i]);
        }
        CHECK(same_bits(first, build_bvh(primitives)));
    }
}
