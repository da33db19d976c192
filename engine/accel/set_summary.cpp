#include "engine/accel/set_summary.h"

#include <string>

#include "engine/accel/cost_model.h"
#include "engine/accel/parallel_chunks.h"
#include "engine/core/error.h"

namespace sahl {

namespace {

void check(BuildPrimitive& primitive) {
    if (primitive.kind >= kind_count) {
        throw Error(ExitCode::internal, "primitive " + std::to_string(primitive.id) + " is of unknown kind " +
                                            std::to_string(primitive.kind) + "; please report this");
    }
    // Most have none and are not written to.
    for (float& value : primitive.bounds.lo) {
        if (value == 0) value = 0;
    }
    for (float& value : primitive.bounds.hi) {
        if (value == 0) value = 0;
    }
}

}  // namespace

SetSummary summarise(std::span<const BuildPrimitive> references) {
    return sum_chunks(0, references.size(), [&](std::size_t begin, std::size_t end) {
        SetSummary summary;
        for (std::size_t i = begin; i < end; ++i) summary.add(references[i]);
        return summary;
    });
}

SetSummary check_and_summarise(std::span<BuildPrimitive> primitives) {
    return sum_chunks(0, primitives.size(), [&](std::size_t begin, std::size_t end) {
        SetSummary summary;
        for (std::size_t i = begin; i < end; ++i) {
            check(primitives[i]);
            summary.add(primitives[i]);
        }
        return summary;
    });
}

}  // namespace sahl
