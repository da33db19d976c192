#include "engine/self_test/readback.h"

#include "kernels/device_types.h"

namespace sahl::self_test {
namespace {

/// The kernels' number for no primitive is another one.
oracle::SurfaceId surface_id(std::uint32_t primitive, std::uint32_t instance) {
    return primitive == SAHL_NO_PRIMITIVE ? oracle::SurfaceId{} : oracle::SurfaceId{primitive, instance};
}

}  // namespace

BatchRays::BatchRays(Buffer& rays, Buffer& ids, std::size_t capacity, std::size_t batches)
    : floats_(rays, capacity, batches * SAHL_RAY_FLOATS), words_(ids, capacity, batches * SAHL_RAY_UINTS) {}

BatchRay BatchRays::at(std::size_t i, std::size_t batch) const {
    const std::size_t floats = batch * SAHL_RAY_FLOATS;
    const std::size_t words = batch * SAHL_RAY_UINTS;
    BatchRay ray;
    ray.traced = {floats_.vector(floats + SAHL_RAY_ORIGIN, i),
                  floats_.vector(floats + SAHL_RAY_DIRECTION, i)};
    ray.exact = {ray.traced.origin + floats_.vector(floats + SAHL_RAY_ORIGIN_LOW, i),
                 ray.traced.direction + floats_.vector(floats + SAHL_RAY_DIRECTION_LOW, i)};
    ray.weight = floats_.vector(floats + SAHL_RAY_WEIGHT, i);
    ray.pixel = words_.at(words + SAHL_RAY_PIXEL, i);
    const std::uint32_t start = words_.at(words + SAHL_RAY_EXCLUDE, i);
    ray.start = surface_id(start & SAHL_ID_MASK, words_.at(words + SAHL_RAY_INSTANCE, i));
    ray.attenuated = (start & SAHL_RAY_ATTENUATED) != 0;
    return ray;
}

BatchHits::BatchHits(RayQueues& queues)
    : floats_(queues.hits, queues.capacity, SAHL_HIT_FLOATS),
      words_(queues.hit_ids, queues.capacity, SAHL_HIT_UINTS) {}

BatchHit BatchHits::at(std::size_t i) const {
    return {floats_.at(SAHL_HIT_T, i), floats_.at(SAHL_HIT_U, i), floats_.at(SAHL_HIT_V, i),
            surface_id(words_.at(SAHL_HIT_PRIMITIVE, i), words_.at(SAHL_HIT_INSTANCE, i))};
}

}  // namespace sahl::self_test
