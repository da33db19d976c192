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

/// Fills depth_error. A triangle that the line of a ray with shear axis k crosses, its origin between the
/// vertices' depths, has sheared coordinates x, y, z of at most a = E_i + E_k, b = E_j + E_k and E_k, E being
/// the extents of its box; each x and y is off by at most 3u a and 3u b (u = 2^-24), an edge function by 16u
/// ab, and their sum weighted with the depths by 66u ab E_k, for which 2^-16 ab E_k has room.
void set_depth_errors(device::TriangleBlock& block, std::uint32_t count) {
    const float* axes[] = {block.x, block.y, block.z};
    // Beyond the denormals, which are slow.
    std::fill(std::begin(block.depth_error), std::end(block.depth_error), 1e-30F);
    for (std::uint32_t lane = 0; lane < count; ++lane) {
        float extent[3];
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            const float a = axes[axis][lane], b = axes[axis][4 + lane], c = axes[axis][8 + lane];
            extent[axis] = std::max(std::max(a, b), c) - std::min(std::min(a, b), c);
        }
        for (std::uint32_t k = 0; k < 3; ++k) {
            const float a = extent[(k + 1) % 3] + extent[k], b = extent[(k + 2) % 3] + extent[k];
            block.depth_error[k] = std::max(block.depth_error[k], extent[k] * 0x1p-16F * a * b);
        }
    }
}

void pack_triangles(const Scene& scene, const LoweredScene& lowered, const BvhLeaf& leaf,
                    device::TriangleBlock& block) {
    std::fill(std::begin(block.x), std::end(block.x), nan);
    std::fill(std::begin(block.y), std::end(block.y), nan);
    std::fill(std::begin(block.z), std::end(block.z), nan);
    block.count = static_cast<float>(leaf.count);
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
    set_depth_errors(block, leaf.count);
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
