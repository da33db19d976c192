// Embree's side of a comparison: device, geometry, scene, owned.
#pragma once

#include <embree3/rtcore.h>

#include <memory>
#include <string>
#include <type_traits>

#include "engine/scene/scene.h"

namespace sahl::bench {

struct EmbreeRelease {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
    void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using EmbreeDevice = std::unique_ptr<std::remove_pointer_t<RTCDevice>, EmbreeRelease>;
using EmbreeScene = std::unique_ptr<std::remove_pointer_t<RTCScene>, EmbreeRelease>;
using EmbreeGeometry = std::unique_ptr<std::remove_pointer_t<RTCGeometry>, EmbreeRelease>;

/// A device on all cores. `config`: as rtcNewDevice() takes it. Throws Error(device).
EmbreeDevice open_embree(const std::string& config = "");

/// Throws Error(device) with `action` if a call since the last check failed.
void check_embree(RTCDevice device, const char* action);

/// The scene's triangles as a committed geometry: primID is the index in Scene::triangles.
EmbreeGeometry embree_triangles(RTCDevice device, const Scene& scene);

/// A scene of one geometry, committed: the tree is built in here.
EmbreeScene embree_scene(RTCDevice device, RTCGeometry geometry, RTCBuildQuality quality,
                         RTCSceneFlags flags);

}  // namespace sahl::bench
