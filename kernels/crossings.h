// Where lines cross shapes: crossings_of_width.h for four shapes and one ray, and for one shape and a group
// of rays.
#ifndef SAHL_CROSSINGS_H
#define SAHL_CROSSINGS_H

#define SAHL_WIDTH 4
#include "kernels/crossings_of_width.h"
#undef SAHL_WIDTH

#define SAHL_WIDTH SAHL_GROUP_RAYS
#include "kernels/crossings_of_width.h"
#undef SAHL_WIDTH

#define ObjectRaysg SAHL_OF_WIDTH(ObjectRays, SAHL_GROUP_RAYS)
#define Chordsg SAHL_OF_WIDTH(Chords, SAHL_GROUP_RAYS)

#endif
