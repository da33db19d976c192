// Counting for profiles: kernels built with SAHL_COUNT_VISITS take one more parameter and add up there what
// they do (SAHL_COUNT_* of device_types.h): for each ray where rays go one by one, else for each work-item.
// Other builds, the timed ones, have nothing of it.
//
// Floating-point operations are additions, multiplications and divisions, also of lanes that stand for
// nothing; a fused multiply-add is two, a comparison none. Only tests that all rays have are declared: what
// follows a hit is left out, and so are lanes' ways apart. `bench/run costs` has them counted in the scalar
// kernels.
#ifndef SAHL_COUNT_VISITS_H
#define SAHL_COUNT_VISITS_H

#include "kernels/device_types.h"

#ifdef SAHL_COUNT_VISITS
#define SAHL_COUNT(bvh, what, n) ((bvh)->counts[what] += (ulong)(n))
#define SAHL_COUNTS_PARAMETER , global ulong* counts
#define SAHL_COUNTS_AT(i) , counts + SAHL_COUNTS*(size_t)(i)
#else
#define SAHL_COUNT(bvh, what, n) ((void)0)
#define SAHL_COUNTS_PARAMETER
#define SAHL_COUNTS_AT(i)
#endif

// Eight boxes of six planes for one ray; for the interval of a packet's rays; one box for one ray of a packet
// whose rays have an origin in common, or not.
#define SAHL_NODE_FLOP 96u
#define SAHL_INTERVAL_FLOP 144u
#define SAHL_COMMON_BOX_FLOP 6u
#define SAHL_BOX_FLOP 12u

/// A block of `kind`, all four lanes, for one ray.
static inline uint block_flop(uint kind) {
    switch (kind) {
        case SAHL_KIND_TRIANGLE:
            return 16u * 10u + 4u * 7u;  // vertices seen from the ray, edge functions; their sum, the depth
        case SAHL_KIND_SPHERE:
            return 4u * 25u + 6u;
        case SAHL_KIND_POLYGON:
            return 4u * 16u + 7u;  // its plane
        case SAHL_KIND_ELLIPSOID:
        case SAHL_KIND_DISC:
            return 4u * (52u + 9u);  // the ray in object space and the rest
        case SAHL_KIND_CONE:
            return 4u * (52u + 42u);
        case SAHL_KIND_SOLID_CONE:
            return 4u * (52u + 46u);
        default:
            return 4u * (52u + 28u);  // a box
    }
}

static inline uint block_bytes(uint kind) {
    switch (kind) {
        case SAHL_KIND_TRIANGLE:
            return sizeof(TriangleBlock);
        case SAHL_KIND_SPHERE:
            return sizeof(SphereBlock);
        case SAHL_KIND_POLYGON:
            return sizeof(PolygonBlock);
        default:
            return sizeof(QuadricBlock);
    }
}

/// A block of `kind` that `rays` rays are tested against.
#define SAHL_COUNT_BLOCK(bvh, kind, rays)                                                              \
    (SAHL_COUNT(bvh, SAHL_COUNT_LEAVES, 1), SAHL_COUNT(bvh, SAHL_COUNT_LEAF_BYTES, block_bytes(kind)), \
     SAHL_COUNT(bvh, SAHL_COUNT_FLOP, (rays)*block_flop(kind)))

/// A node that costs `flop` operations.
#define SAHL_COUNT_NODE(bvh, flop) \
    (SAHL_COUNT(bvh, SAHL_COUNT_NODES, 1), SAHL_COUNT(bvh, SAHL_COUNT_FLOP, flop))

#endif
