#include "bench/embree_scene.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "engine/core/error.h"

namespace sahl::bench {

EmbreeDevice open_embree(const std::string& config) {
    EmbreeDevice device(rtcNewDevice(config.c_str()));
    check_embree(device.get(), "opening a device");
    return device;
}

void check_embree(RTCDevice device, const char* action) {
    if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
        throw Error(ExitCode::device, fmt::format("Embree: error {} in {}", static_cast<int>(error), action));
}

EmbreeGeometry embree_triangles(RTCDevice device, const Scene& scene) {
    EmbreeGeometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
    auto* vertices = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX,
                                                                     0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3),
                                                                     scene.vertices.size()));
    auto* indices = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), scene.triangles.size()));
    check_embree(device, "making buffers");
    std::copy(scene.vertices.begin(), scene.vertices.end(), vertices);
    for (const Triangle& triangle : scene.triangles)
        indices = std::copy(std::begin(triangle.vertices), std::end(triangle.vertices), indices);
    rtcCommitGeometry(geometry.get());
    check_embree(device, "making triangles");
    return geometry;
}

EmbreeScene embree_scene(RTCDevice device, RTCGeometry geometry, RTCBuildQuality quality,
                         RTCSceneFlags flags) {
    EmbreeScene scene(rtcNewScene(device));
    rtcSetSceneBuildQuality(scene.get(), quality);
    rtcSetSceneFlags(scene.get(), flags);
    rtcAttachGeometry(scene.get(), geometry);
    rtcCommitScene(scene.get());
    check_embree(device, "building a scene");
    return scene;
}

}  // namespace sahl::bench
