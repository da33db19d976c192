#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "engine/device/kernel_source.h"
#include "engine/device/program.h"
#include "kernels/device_types.h"

namespace sahl::tests {
namespace {

/// A struct (no field: its size) or a field of one (its offset), as the host's compiler lays it out.
struct Layout {
    std::string type;
    std::string field;
    std::size_t bytes;
};

#define SIZE(type) \
    Layout { #type, "", sizeof(device::type) }
#define FIELD(type, field) \
    Layout { #type, #field, offsetof(device::type, field) }

const std::vector<Layout> layouts = {
    SIZE(BvhNode),
    FIELD(BvhNode, lo_x),
    FIELD(BvhNode, lo_y),
    FIELD(BvhNode, lo_z),
    FIELD(BvhNode, hi_x),
    FIELD(BvhNode, hi_y),
    FIELD(BvhNode, hi_z),
    FIELD(BvhNode, child),
    SIZE(TriangleBlock),
    FIELD(TriangleBlock, x),
    FIELD(TriangleBlock, id),
    FIELD(TriangleBlock, y),
    FIELD(TriangleBlock, count),
    FIELD(TriangleBlock, depth_error),
    FIELD(TriangleBlock, z),
    SIZE(SphereBlock),
    FIELD(SphereBlock, x),
    FIELD(SphereBlock, y),
    FIELD(SphereBlock, z),
    FIELD(SphereBlock, radius),
    FIELD(SphereBlock, id),
    SIZE(QuadricBlock),
    FIELD(QuadricBlock, m),
    FIELD(QuadricBlock, x),
    FIELD(QuadricBlock, y),
    FIELD(QuadricBlock, z),
    FIELD(QuadricBlock, slope),
    FIELD(QuadricBlock, id),
    SIZE(PolygonBlock),
    FIELD(PolygonBlock, normal),
    FIELD(PolygonBlock, point),
    FIELD(PolygonBlock, lo),
    FIELD(PolygonBlock, hi),
    FIELD(PolygonBlock, first_group),
    FIELD(PolygonBlock, corner_count),
    FIELD(PolygonBlock, id),
    SIZE(OutlineGroup),
    FIELD(OutlineGroup, x),
    FIELD(OutlineGroup, y),
    FIELD(OutlineGroup, z),
    SIZE(DeviceInstance),
    FIELD(DeviceInstance, rows),
    FIELD(DeviceInstance, root),
    FIELD(DeviceInstance, extent),
    SIZE(DevicePrimitive),
    FIELD(DevicePrimitive, kind),
    FIELD(DevicePrimitive, material),
    FIELD(DevicePrimitive, data),
    FIELD(DevicePrimitive, flags),
    SIZE(DeviceMaterial),
    FIELD(DeviceMaterial, ambient),
    FIELD(DeviceMaterial, shininess),
    FIELD(DeviceMaterial, diffuse),
    FIELD(DeviceMaterial, ior),
    FIELD(DeviceMaterial, specular),
    FIELD(DeviceMaterial, flags),
    FIELD(DeviceMaterial, reflection),
    FIELD(DeviceMaterial, ior_outside),
    FIELD(DeviceMaterial, transmission),
    FIELD(DeviceMaterial, ambient_texture),
    FIELD(DeviceMaterial, emission),
    FIELD(DeviceMaterial, diffuse_texture),
    FIELD(DeviceMaterial, attenuation),
    FIELD(DeviceMaterial, specular_texture),
    FIELD(DeviceMaterial, emission_texture),
    FIELD(DeviceMaterial, reflection_texture),
    SIZE(DeviceTexture),
    FIELD(DeviceTexture, color0),
    FIELD(DeviceTexture, pattern),
    FIELD(DeviceTexture, color1),
    FIELD(DeviceTexture, space),
    FIELD(DeviceTexture, origin),
    FIELD(DeviceTexture, extent),
    SIZE(DeviceLight),
    FIELD(DeviceLight, position),
    FIELD(DeviceLight, kind),
    FIELD(DeviceLight, color),
    FIELD(DeviceLight, cos_inner),
    FIELD(DeviceLight, attenuation),
    FIELD(DeviceLight, cos_outer),
    FIELD(DeviceLight, direction),
    SIZE(SceneConstants),
    FIELD(SceneConstants, background),
    FIELD(SceneConstants, extent),
    FIELD(SceneConstants, light_count),
    SIZE(CameraConstants),
    FIELD(CameraConstants, eye),
    FIELD(CameraConstants, half_width),
    FIELD(CameraConstants, forward),
    FIELD(CameraConstants, half_height),
    FIELD(CameraConstants, step_x),
    FIELD(CameraConstants, step_y),
    FIELD(CameraConstants, eye_low),
    FIELD(CameraConstants, forward_low),
    FIELD(CameraConstants, step_x_low),
    FIELD(CameraConstants, step_y_low),
    SIZE(WaveConstants),
    FIELD(WaveConstants, first_low),
    FIELD(WaveConstants, first_high),
    FIELD(WaveConstants, count),
    FIELD(WaveConstants, spp),
    FIELD(WaveConstants, crop_x),
    FIELD(WaveConstants, crop_y),
    FIELD(WaveConstants, crop_width),
    FIELD(WaveConstants, crop_height),
    FIELD(WaveConstants, seed_low),
    FIELD(WaveConstants, seed_high),
    FIELD(WaveConstants, first_sample),
    FIELD(WaveConstants, samples),
};

/// The structs of device_types.h and their fields but the spare ones, by its text.
std::map<std::string, std::set<std::string>> declared() {
    std::map<std::string, std::set<std::string>> result;
    std::set<std::string> fields;
    bool inside = false;
    std::istringstream lines(expand_files({"device_types.h"}).text);
    for (std::string line; std::getline(lines, line);) {
        line = line.substr(0, line.find("//"));
        if (line == "typedef struct {") {
            inside = true;
        } else if (inside && line[0] == '}') {
            result[line.substr(2, line.find(';') - 2)] = std::exchange(fields, {});
            inside = false;
        } else if (inside) {
            // "    float x[4], y[4];": what stands before each comma, semicolon or first bracket.
            std::istringstream declarators(line.substr(line.find_first_of(' ', line.find_first_not_of(' '))));
            for (std::string field; std::getline(declarators, field, ',');) {
                field = field.substr(field.find_first_not_of(' '));
                field = field.substr(0, field.find_first_of("[; "));
                if (field.rfind("spare", 0) != 0) fields.insert(field);
            }
        }
    }
    return result;
}

}  // namespace

TEST_CASE("the layouts below are all of device_types.h") {
    std::map<std::string, std::set<std::string>> listed;
    for (const Layout& layout : layouts) {
        std::set<std::string>& fields = listed[layout.type];
        if (!layout.field.empty()) fields.insert(layout.field);
    }
    CHECK(listed.size() >= 11);
    CHECK(listed == declared());
}

TEST_CASE("host and device agree about every struct they share") {
    std::string text = "#include \"kernels/device_types.h\"\n__kernel void lay_out(__global uint* out) {\n";
    std::string type;
    for (std::size_t i = 0; i < layouts.size(); ++i) {
        const Layout& layout = layouts[i];
        if (layout.type != type) {
            type = layout.type;
            text += type + " a_" + type + ";\n";
        }
        const std::string object = "a_" + layout.type;
        text += "out[" + std::to_string(i) + "] = ";
        if (layout.field.empty()) {
            text += "sizeof(" + layout.type + ");\n";
        } else {
            text += "(uint)((uchar*)&" + object + "." + layout.field + " - (uchar*)&" + object + ");\n";
        }
    }
    Device device;
    Program program = Program::from_text(device, text + "}\n");
    Buffer out(device, 4 * layouts.size(), "layouts");
    program.kernel("lay_out").launch({.work_items = 1}, out);
    const auto bytes = out.map<std::uint32_t>(MapMode::read, layouts.size());
    for (std::size_t i = 0; i < layouts.size(); ++i) {
        CAPTURE(layouts[i].type, layouts[i].field);
        CHECK(bytes[i] == layouts[i].bytes);
    }
}

}  // namespace sahl::tests
