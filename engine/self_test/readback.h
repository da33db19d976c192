// Ray batches and what kernels leave for each other, as the host reads them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/oracle/oracle.h"
#include "engine/render/ray_queues.h"

namespace sahl::self_test {

/// A copy of several arrays of `capacity` numbers each.
template <class T>
class Arrays {
public:
    Arrays(Buffer& buffer, std::size_t capacity, std::size_t arrays) : capacity_(capacity) {
        const auto mapping = buffer.map<T>(MapMode::read, capacity * arrays);
        values_.assign(mapping.begin(), mapping.end());
    }
    T at(std::size_t array, std::size_t i) const { return values_[array * capacity_ + i]; }
    /// Three arrays from `array` on.
    glm::dvec3 vector(std::size_t array, std::size_t i) const {
        return {at(array, i), at(array + 1, i), at(array + 2, i)};
    }

private:
    std::size_t capacity_;
    std::vector<T> values_;
};

/// A ray of a batch.
struct BatchRay {
    oracle::Ray exact;   ///< with what the floats lack
    oracle::Ray traced;  ///< what traversal reads: off the surface, in single precision
    glm::dvec3 weight{0};
    std::uint32_t pixel = 0;
    oracle::SurfaceId start;
    bool attenuated = false;
};

/// The rays of `count` parents or samples in batch `which` of buffers that hold several.
class BatchRays {
public:
    BatchRays(Buffer& rays, Buffer& ids, std::size_t capacity, std::size_t batches = 1);
    BatchRay at(std::size_t i, std::size_t batch = 0) const;

private:
    Arrays<float> floats_;
    Arrays<std::uint32_t> words_;
};

struct BatchHit {
    double t = 0, u = 0, v = 0;
    oracle::SurfaceId id;

    bool hit() const { return id.primitive != oracle::no_primitive; }
};

class BatchHits {
public:
    explicit BatchHits(RayQueues& queues);
    BatchHit at(std::size_t i) const;

private:
    Arrays<float> floats_;
    Arrays<std::uint32_t> words_;
};

}  // namespace sahl::self_test
