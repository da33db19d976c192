// Sahl's public interface: load or build a Scene, open a Device, make a Renderer, render into a Film, write
// the image. Everything throws sahl::Error.
#pragma once

#include "engine/core/error.h"
#include "engine/core/log.h"
#include "engine/core/nearest.h"
#include "engine/core/progress.h"
#include "engine/device/device.h"
#include "engine/device/device_choice.h"
#include "engine/film/film.h"
#include "engine/film/image_compare.h"
#include "engine/film/image_io.h"
#include "engine/profile/compare_profiles.h"
#include "engine/profile/profile.h"
#include "engine/profile/profile_page.h"
#include "engine/profile/profile_times.h"
#include "engine/profile/statistics.h"
#include "engine/render/renderer.h"
#include "engine/scene/load.h"
#include "engine/scene/scene.h"
#include "engine/scene/write_scene.h"
#include "engine/self_test/self_test.h"
