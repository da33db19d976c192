#include "engine/scene/write_json_mesh.h"

#include <array>
#include <bit>
#include <unordered_map>

#include <fmt/format.h>

#include "engine/scene/validate.h"

namespace sahl {
namespace {

// What a mesh's corner is: position, normal, uv, as bits.
using Corner = std::array<std::uint32_t, 8>;

struct CornerHash {
    std::size_t operator()(const Corner& corner) const {
        std::uint64_t hash = 0xcbf29ce484222325;  // FNV-1a by words
        for (const std::uint32_t word : corner) hash = (hash ^ word) * 0x100000001b3;
        return hash ^ (hash >> 32U);
    }
};

}  // namespace

std::uint32_t mesh_end(const Scene& scene, std::uint32_t first, std::uint32_t end) {
    const Primitive& model = scene.primitives[first];
    std::uint32_t i = first;
    for (; i < end; ++i) {
        const Primitive& p = scene.primitives[i];
        if (p.kind != PrimitiveKind::triangle || p.material != model.material ||
            p.transform != model.transform || p.sides != model.sides) {
            break;
        }
        const Triangle& triangle = scene.triangles[p.index];
        const Triangle& first_triangle = scene.triangles[model.index];
        if (triangle.smooth != first_triangle.smooth || triangle.has_uv != first_triangle.has_uv) break;
    }
    return i;
}

JsonLayout mesh_layout(const Scene& scene, std::uint32_t first, std::uint32_t end) {
    const Triangle& model = scene.triangles[scene.primitives[first].index];
    // A transform without an inverse, which a Sahl scene may not have: the renderer only needs the places.
    const glm::dmat4& m = scene.transforms[scene.primitives[first].transform];
    const bool bakes = !is_invertible(m);
    JsonLayout vertices = JsonLayout::array(JsonLayout::Lines::full);
    JsonLayout normals = JsonLayout::array(JsonLayout::Lines::full);
    JsonLayout uvs = JsonLayout::array(JsonLayout::Lines::full);
    JsonLayout triangles = JsonLayout::array(JsonLayout::Lines::full);
    std::unordered_map<Corner, std::size_t, CornerHash> numbers;
    for (std::uint32_t i = first; i < end; ++i) {
        const Triangle& triangle = scene.triangles[scene.primitives[i].index];
        std::size_t corners[3] = {};
        for (int k = 0; k < 3; ++k) {
            glm::vec3 position = scene.vertices[triangle.vertices[k]];
            if (bakes) position = glm::vec3(m * glm::dvec4(position, 1));
            const glm::vec3 normal = model.smooth ? scene.normals[triangle.normals[k]] : glm::vec3(0);
            const glm::vec2 uv = model.has_uv ? scene.uvs[triangle.uvs[k]] : glm::vec2(0);
            const std::array<float, 8> values = {position.x, position.y, position.z, normal.x,
                                                 normal.y,   normal.z,   uv.x,       uv.y};
            const auto [found, is_new] = numbers.try_emplace(std::bit_cast<Corner>(values), numbers.size());
            corners[k] = found->second;
            if (!is_new) continue;
            vertices.add("", json_vector(position));
            if (model.smooth) normals.add("", json_vector(normal));
            if (model.has_uv) uvs.add("", json_vector(uv));
        }
        triangles.add("", fmt::format("[{}, {}, {}]", corners[0], corners[1], corners[2]));
    }
    JsonLayout object = JsonLayout::object();
    object.add("type", std::string("\"mesh\""));
    object.add("vertices", std::move(vertices));
    if (model.smooth) object.add("normals", std::move(normals));
    if (model.has_uv) object.add("uv", std::move(uvs));
    object.add("triangles", std::move(triangles));
    return object;
}

}  // namespace sahl
