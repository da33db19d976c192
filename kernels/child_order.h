// AVX2: in which order those of a node's eight children come that a ray meets, from a table. AVX-512 has an
// instruction that packs them, other devices look at them one by one (bvh.h).
//
// Children are visited in rising order of slot ^ octant, so a stack takes them in falling order. Entry
// 256 octant + m of the table lists in that order the slots whose bits are set in m, four bits each from the
// lowest on. It is 8 KiB, as a table for one octant, with masks and slots permuted to suit, is slower. Its
// parts are spelt out, as macros that make them of single slots expand to much text, which every start has to
// read.
#ifndef SAHL_CHILD_ORDER_H
#define SAHL_CHILD_ORDER_H

#include "kernels/simd.h"

#ifdef SAHL_AVX2

// clang-format off
// The slots from 4 on, by the lower two bits of the octant: their list and how long it is, in bits.
#define SAHL_HIGH0(ROW) \
    ROW(0, 0), ROW(4, 4), ROW(5, 4), ROW(0x45, 8), ROW(6, 4), ROW(0x46, 8), \
    ROW(0x56, 8), ROW(0x456, 12), ROW(7, 4), ROW(0x47, 8), ROW(0x57, 8), ROW(0x457, 12), \
    ROW(0x67, 8), ROW(0x467, 12), ROW(0x567, 12), ROW(0x4567, 16)
#define SAHL_HIGH1(ROW) \
    ROW(0, 0), ROW(4, 4), ROW(5, 4), ROW(0x54, 8), ROW(6, 4), ROW(0x46, 8), \
    ROW(0x56, 8), ROW(0x546, 12), ROW(7, 4), ROW(0x47, 8), ROW(0x57, 8), ROW(0x547, 12), \
    ROW(0x76, 8), ROW(0x476, 12), ROW(0x576, 12), ROW(0x5476, 16)
#define SAHL_HIGH2(ROW) \
    ROW(0, 0), ROW(4, 4), ROW(5, 4), ROW(0x45, 8), ROW(6, 4), ROW(0x64, 8), \
    ROW(0x65, 8), ROW(0x645, 12), ROW(7, 4), ROW(0x74, 8), ROW(0x75, 8), ROW(0x745, 12), \
    ROW(0x67, 8), ROW(0x674, 12), ROW(0x675, 12), ROW(0x6745, 16)
#define SAHL_HIGH3(ROW) \
    ROW(0, 0), ROW(4, 4), ROW(5, 4), ROW(0x54, 8), ROW(6, 4), ROW(0x64, 8), \
    ROW(0x65, 8), ROW(0x654, 12), ROW(7, 4), ROW(0x74, 8), ROW(0x75, 8), ROW(0x754, 12), \
    ROW(0x76, 8), ROW(0x764, 12), ROW(0x765, 12), ROW(0x7654, 16)

// The slots below 4, behind those or before: where the octant's third bit is set.
#define SAHL_LOW0_LAST(h, s) \
    h, h, h | 1 << s, h | 1 << s, h | 2 << s, h | 2 << s, \
    h | 0x12 << s, h | 0x12 << s, h | 3 << s, h | 3 << s, h | 0x13 << s, h | 0x13 << s, \
    h | 0x23 << s, h | 0x23 << s, h | 0x123 << s, h | 0x123 << s
#define SAHL_LOW1_LAST(h, s) \
    h, h, h | 1 << s, h | 0x10 << s, h | 2 << s, h | 2 << s, \
    h | 0x12 << s, h | 0x102 << s, h | 3 << s, h | 3 << s, h | 0x13 << s, h | 0x103 << s, \
    h | 0x32 << s, h | 0x32 << s, h | 0x132 << s, h | 0x1032 << s
#define SAHL_LOW2_LAST(h, s) \
    h, h, h | 1 << s, h | 1 << s, h | 2 << s, h | 0x20 << s, \
    h | 0x21 << s, h | 0x201 << s, h | 3 << s, h | 0x30 << s, h | 0x31 << s, h | 0x301 << s, \
    h | 0x23 << s, h | 0x230 << s, h | 0x231 << s, h | 0x2301 << s
#define SAHL_LOW3_LAST(h, s) \
    h, h, h | 1 << s, h | 0x10 << s, h | 2 << s, h | 0x20 << s, \
    h | 0x21 << s, h | 0x210 << s, h | 3 << s, h | 0x30 << s, h | 0x31 << s, h | 0x310 << s, \
    h | 0x32 << s, h | 0x320 << s, h | 0x321 << s, h | 0x3210 << s
#define SAHL_LOW0_FIRST(h, s) \
    h, h << 4, 1 | h << 4, 1 | h << 8, 2 | h << 4, 2 | h << 8, \
    0x12 | h << 8, 0x12 | h << 12, 3 | h << 4, 3 | h << 8, 0x13 | h << 8, 0x13 | h << 12, \
    0x23 | h << 8, 0x23 | h << 12, 0x123 | h << 12, 0x123 | h << 16
#define SAHL_LOW1_FIRST(h, s) \
    h, h << 4, 1 | h << 4, 0x10 | h << 8, 2 | h << 4, 2 | h << 8, \
    0x12 | h << 8, 0x102 | h << 12, 3 | h << 4, 3 | h << 8, 0x13 | h << 8, 0x103 | h << 12, \
    0x32 | h << 8, 0x32 | h << 12, 0x132 | h << 12, 0x1032 | h << 16
#define SAHL_LOW2_FIRST(h, s) \
    h, h << 4, 1 | h << 4, 1 | h << 8, 2 | h << 4, 0x20 | h << 8, \
    0x21 | h << 8, 0x201 | h << 12, 3 | h << 4, 0x30 | h << 8, 0x31 | h << 8, 0x301 | h << 12, \
    0x23 | h << 8, 0x230 | h << 12, 0x231 | h << 12, 0x2301 | h << 16
#define SAHL_LOW3_FIRST(h, s) \
    h, h << 4, 1 | h << 4, 0x10 | h << 8, 2 | h << 4, 0x20 | h << 8, \
    0x21 | h << 8, 0x210 | h << 12, 3 | h << 4, 0x30 | h << 8, 0x31 | h << 8, 0x310 | h << 12, \
    0x32 | h << 8, 0x320 | h << 12, 0x321 | h << 12, 0x3210 | h << 16
// clang-format on

constant uint child_order[8 * 256] = {SAHL_HIGH0(SAHL_LOW0_LAST),  SAHL_HIGH1(SAHL_LOW1_LAST),
                                      SAHL_HIGH2(SAHL_LOW2_LAST),  SAHL_HIGH3(SAHL_LOW3_LAST),
                                      SAHL_HIGH0(SAHL_LOW0_FIRST), SAHL_HIGH1(SAHL_LOW1_FIRST),
                                      SAHL_HIGH2(SAHL_LOW2_FIRST), SAHL_HIGH3(SAHL_LOW3_FIRST)};

#endif

#endif
