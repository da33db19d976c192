// A scene with everything that a scene can have.
#pragma once

#include "engine/scene/scene.h"

namespace sahl {

/// Every primitive, closed and open, one- and two-sided; point, directional, spot and ambient light; all
/// patterns by place and by surface; both highlights; nested, stretched and mirrored instances; glass in
/// water, mirrors that weaken with the distance.
Scene every_feature();

}  // namespace sahl
