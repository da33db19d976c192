// Rays in the space of an instance's group.
//
// A ray keeps its parameter t: its direction is transformed without normalisation. The arithmetic is
// that of shading (real.h), so that a ray that starts on an instance's surface starts there in the
// group's space too, whatever cancels on the way.
#ifndef SAHL_INSTANCE_H
#define SAHL_INSTANCE_H

#include "kernels/device_types.h"
#include "kernels/real.h"

/// Element `column` (3: translation) of a row of object_from_world.
static inline real instance_element(const global DeviceInstance* instance, uint row, uint column) {
    return (real)instance->rows[row][column] + (real)instance->rows[row][column + 4u];
}

static inline real3 instance_row(const global DeviceInstance* instance, uint row) {
    return (real3)(instance_element(instance, row, 0), instance_element(instance, row, 1),
                   instance_element(instance, row, 2));
}

static inline real3 group_from_world_vector(const global DeviceInstance* instance, real3 v) {
    return (real3)(dot3_real(instance_row(instance, 0), v), dot3_real(instance_row(instance, 1), v),
                   dot3_real(instance_row(instance, 2), v));
}

static inline real3 group_from_world_point(const global DeviceInstance* instance, real3 p) {
    return group_from_world_vector(instance, p) + (real3)(instance_element(instance, 0, 3),
                                                          instance_element(instance, 1, 3),
                                                          instance_element(instance, 2, 3));
}

#endif
