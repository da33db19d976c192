// A scene as the renderer sees it, as text: tables looked up, every number exact.
#pragma once

#include <string>

#include "engine/scene/scene.h"

namespace sahl::tests {

/// One line a fact. Equal texts: the same cameras, lights and materials, and the same primitives in
/// the same order with the same numbers, wherever the tables hold them.
std::string resolved(const Scene& scene);

}  // namespace sahl::tests
