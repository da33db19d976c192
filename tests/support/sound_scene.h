// What holds of every scene that a loader lets through.
#pragma once

#include <string>

#include "engine/scene/scene.h"

namespace sahl::tests {

/// What is wrong with `scene`: a number that is not finite, an index that names nothing; empty if nothing is.
std::string flaw_of(const Scene& scene);

}  // namespace sahl::tests
