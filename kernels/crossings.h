// Where lines cross shapes: crossings_of_width.h for four shapes and one ray, and for one shape and
// sixteen rays.
#ifndef SAHL_CROSSINGS_H
#define SAHL_CROSSINGS_H

#define SAHL_WIDTH 4
#include "kernels/crossings_of_width.h"
#undef SAHL_WIDTH

#define SAHL_WIDTH 16
#include "kernels/crossings_of_width.h"
#undef SAHL_WIDTH

#endif
