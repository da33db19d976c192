// How a manifest writes the settings of images.
#pragma once

#include "engine/batch/batch_job.h"
#include "engine/scene/scene_json_values.h"

namespace sahl {

/// The object `settings`. Throws SceneError at the place of what is wrong.
ImageSettings read_image_settings(const JsonReader& reader, const JsonValue& value);

}  // namespace sahl
