#include "engine/render/leaf_blocks.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <tbb/parallel_for.h>

namespace sahl {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr std::uint32_t unused_id = SAHL_NO_PRIMITIVE | SAHL_ID_BIAS;

/// Calls lane(k, data, id) for the leaf's primitives; the block's unused lanes keep their filling.
template <class Lane>
void for_each_lane(const Scene& scene, const LoweredScene& lowered, const BvhLeaf& leaf, const Lane& lane) {
    for (std::uint32_t k = 0; k < leaf.count; ++k) {
        const std::uint32_t id = leaf.ids[k];
        lane(k, &lowered.shape_data[lowered.primitives[id].data], block_id(scene, id));
    }
}

template <class Block>
void fill_ids(Block& block) {
    std::fill(std::begin(block.id), std::end(block.id), unused_id);
}

void pack_triangles(const Scene& scene, const LoweredScene& lowered, const BvhLeaf& leaf,
                    device::TriangleBlock& block) {
    std::fill(std::begin(block.x), std::end(block.x), nan);
    std::fill(std::begin(block.y), std::end(block.y), nan);
    std::fill(std::begin(block.z), std::end(block.z), nan);
    block.count = static_cast<float>(leaf.count);
    std::fill(std::begin(block.spare_y), std::end(block.spare_y), 1.0F);
    std::fill(std::begin(block.spare_z), std::end(block.spare_z), 1.0F);
    fill_ids(block);
    for_each_lane(scene, lowered, leaf, [&](std::uint32_t k, const float* data, std::uint32_t id) {
        for (std::uint32_t corner = 0; corner < 3; ++corner) {
            block.x[4 * corner + k] = data[3 * corner];
            block.y[4 * corner + k] = data[3 * corner + 1];
            block.z[4 * corner + k] = data[3 * corner + 2];
        }
        block.id[k] = id;
    });
}

void pack_spheres(const Scene& scene, const LoweredScene& lowered, const BvhLeaf& leaf,
                  device::SphereBlock& block) {
    std::fill(std::begin(block.radius), std::end(block.radius), nan);
    fill_ids(block);
    for_each_lane(scene, lowered, leaf, [&](std::uint32_t k, const float* data, std::uint32_t id) {
        block.x[k] = data[0];
        block.y[k] = data[1];
        block.z[k] = data[2];
        block.radius[k] = data[6];
        block.id[k] = id;
    });
}

void pack_quadrics(const Scene& scene, const LoweredScene& lowered, const BvhLeaf& leaf,
                   device::QuadricBlock& block) {
    for (auto& row : block.m) {
        std::fill(std::begin(row), std::end(row), nan);
    }
    fill_ids(block);
    for_each_lane(scene, lowered, leaf, [&](std::uint32_t k, const float* data, std::uint32_t id) {
        for (std::uint32_t element = 0; element < 9; ++element) {
            block.m[element][k] = data[element / 3 * 6 + element % 3];
        }
        block.x[k] = data[18];
        block.y[k] = data[19];
        block.z[k] = data[20];
        const bool cone = leaf.kind == SAHL_KIND_CONE || leaf.kind == SAHL_KIND_SOLID_CONE;
        block.slope[k] = cone ? data[24] : 0.0F;
        block.id[k] = id;
    });
}

void pack_polygon(const Scene& scene, const LoweredScene& lowered, const BvhLeaf& leaf,
                  device::PolygonBlock& block) {
    for_each_lane(scene, lowered, leaf, [&](std::uint32_t, const float* data, std::uint32_t id) {
        block.first_group = std::bit_cast<std::uint32_t>(data[12]);
        block.corner_count = std::bit_cast<std::uint32_t>(data[13]);
        block.id = id;
        const auto* outline =
            reinterpret_cast<const device::OutlineGroup*>(lowered.outlines.data()) + block.first_group;
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            block.normal[axis] = data[axis];
            block.point[axis] = data[6 + axis];
            block.lo[axis] = block.hi[axis] = data[6 + axis];
        }
        for (std::uint32_t i = 0; i < block.corner_count; ++i) {
            const device::OutlineGroup& group = outline[i / SAHL_OUTLINE_EDGES];
            const std::uint32_t lane = i % SAHL_OUTLINE_EDGES;
            const float corner[3] = {group.x[lane], group.y[lane], group.z[lane]};
            for (std::uint32_t axis = 0; axis < 3; ++axis) {
                block.lo[axis] = std::min(block.lo[axis], corner[axis]);
                block.hi[axis] = std::max(block.hi[axis], corner[axis]);
            }
        }
    });
}

void pack(const Scene& scene, const LoweredScene& lowered, const BvhLeaf& leaf, std::byte* block) {
    switch (leaf.kind) {
        case SAHL_KIND_TRIANGLE:
            pack_triangles(scene, lowered, leaf, *reinterpret_cast<device::TriangleBlock*>(block));
            break;
        case SAHL_KIND_SPHERE:
            pack_spheres(scene, lowered, leaf, *reinterpret_cast<device::SphereBlock*>(block));
            break;
        case SAHL_KIND_POLYGON:
            pack_polygon(scene, lowered, leaf, *reinterpret_cast<device::PolygonBlock*>(block));
            break;
        case SAHL_KIND_INSTANCE:
            break;
        default:
            pack_quadrics(scene, lowered, leaf, *reinterpret_cast<device::QuadricBlock*>(block));
            break;
    }
}

// Leaves that a thread packs at a time.
constexpr std::size_t chunk_size = 1U << 12;

std::span<const BvhLeaf> chunk_of(std::span<const BvhLeaf> leaves, std::size_t chunk) {
    const std::size_t begin = chunk * chunk_size;
    return leaves.subspan(begin, std::min(chunk_size, leaves.size() - begin));
}

// Where the chunks' blocks begin, in lines.
std::vector<std::size_t> chunk_begins(std::span<const BvhLeaf> leaves, std::size_t chunks) {
    std::vector<std::size_t> begins(chunks, 0);
    std::size_t lines = 0;
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
        begins[chunk] = lines;
        for (const BvhLeaf& leaf : chunk_of(leaves, chunk)) lines += block_lines(leaf.kind);
    }
    return begins;
}

}  // namespace

HostMemory pack_leaf_blocks(MemoryAccountant& accountant, const Scene& scene, const HostScene& host) {
    HostMemory memory(accountant, std::size_t{host.bvh.leaf_lines} * SAHL_LEAF_LINE_BYTES, "leaf blocks");
    const std::size_t chunks = (host.bvh.leaves.size() + chunk_size - 1) / chunk_size;
    const std::vector<std::size_t> begins = chunk_begins(host.bvh.leaves, chunks);
    tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
        auto* block = static_cast<std::byte*>(memory.data()) + begins[chunk] * SAHL_LEAF_LINE_BYTES;
        for (const BvhLeaf& leaf : chunk_of(host.bvh.leaves, chunk)) {
            pack(scene, host.lowered, leaf, block);
            block += std::size_t{block_lines(leaf.kind)} * SAHL_LEAF_LINE_BYTES;
        }
    });
    return memory;
}

}  // namespace sahl
