// AVX2: in which order those of a node's eight children come that a ray meets, from a table. AVX-512 has an
// instruction that packs them, other devices look at them one by one (bvh.h).
//
// Children are visited in rising order of slot ^ octant, so a stack takes them in falling order. Entry
// 256 octant + m of the table lists in that order the slots whose bits are set in m, four bits each from the
// lowest on. It is 8 KiB, as a table for one octant, with masks and slots permuted to suit, takes longer.
#ifndef SAHL_CHILD_ORDER_H
#define SAHL_CHILD_ORDER_H

#include "kernels/simd.h"

#ifdef SAHL_AVX2

#define SAHL_MET(m, s) ((m) >> (s)&1)
#define SAHL_FOR_16(DO, o, hi)                                                                        \
    DO(o, hi, 0), DO(o, hi, 1), DO(o, hi, 2), DO(o, hi, 3), DO(o, hi, 4), DO(o, hi, 5), DO(o, hi, 6), \
        DO(o, hi, 7), DO(o, hi, 8), DO(o, hi, 9), DO(o, hi, 10), DO(o, hi, 11), DO(o, hi, 12),        \
        DO(o, hi, 13), DO(o, hi, 14), DO(o, hi, 15)

// Lists of slots 0 to 3 and of slots 4 to 7, by the octant's lower two bits: each slot before those listed.
#define SAHL_BEFORE(s, m, list) ((list) << 4 * SAHL_MET(m, (s)&3) | (s)*SAHL_MET(m, (s)&3))
#define SAHL_LIST(o, m, first) \
    SAHL_BEFORE(               \
        first + (3 ^ o), m,    \
        SAHL_BEFORE(first + (2 ^ o), m, SAHL_BEFORE(first + (1 ^ o), m, SAHL_BEFORE(first + o, m, 0))))
#define SAHL_LISTS(o, hi, m) sahl_low_##o##_##m = SAHL_LIST(o, m, 0), sahl_high_##o##_##m = SAHL_LIST(o, m, 4)
#define SAHL_SIZE(o, hi, m) sahl_size_##m = SAHL_MET(m, 0) + SAHL_MET(m, 1) + SAHL_MET(m, 2) + SAHL_MET(m, 3)
enum {
    SAHL_FOR_16(SAHL_LISTS, 0, 0),
    SAHL_FOR_16(SAHL_LISTS, 1, 0),
    SAHL_FOR_16(SAHL_LISTS, 2, 0),
    SAHL_FOR_16(SAHL_LISTS, 3, 0),
    SAHL_FOR_16(SAHL_SIZE, 0, 0)
};

// The octant's highest bit says which half comes first.
#define SAHL_HIGH_FIRST(o, hi, lo) sahl_high_##o##_##hi | sahl_low_##o##_##lo << 4 * sahl_size_##hi
#define SAHL_LOW_FIRST(o, hi, lo) sahl_low_##o##_##lo | sahl_high_##o##_##hi << 4 * sahl_size_##lo
#define SAHL_FOR_256(DO, o)                                                                           \
    SAHL_FOR_16(DO, o, 0), SAHL_FOR_16(DO, o, 1), SAHL_FOR_16(DO, o, 2), SAHL_FOR_16(DO, o, 3),       \
        SAHL_FOR_16(DO, o, 4), SAHL_FOR_16(DO, o, 5), SAHL_FOR_16(DO, o, 6), SAHL_FOR_16(DO, o, 7),   \
        SAHL_FOR_16(DO, o, 8), SAHL_FOR_16(DO, o, 9), SAHL_FOR_16(DO, o, 10), SAHL_FOR_16(DO, o, 11), \
        SAHL_FOR_16(DO, o, 12), SAHL_FOR_16(DO, o, 13), SAHL_FOR_16(DO, o, 14), SAHL_FOR_16(DO, o, 15)
constant uint child_order[8 * 256] = {SAHL_FOR_256(SAHL_HIGH_FIRST, 0), SAHL_FOR_256(SAHL_HIGH_FIRST, 1),
                                      SAHL_FOR_256(SAHL_HIGH_FIRST, 2), SAHL_FOR_256(SAHL_HIGH_FIRST, 3),
                                      SAHL_FOR_256(SAHL_LOW_FIRST, 0),  SAHL_FOR_256(SAHL_LOW_FIRST, 1),
                                      SAHL_FOR_256(SAHL_LOW_FIRST, 2),  SAHL_FOR_256(SAHL_LOW_FIRST, 3)};

#endif

#endif
