#include "tests/device/closed_meshes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "kernels/rays_per_item.h"

namespace sahl::tests {
namespace {

using glm::dvec3;
using glm::vec3;

glm::dmat3 random_rotation(Random& random) {
    const dvec3 x = unit_vector(random);
    const dvec3 y = glm::normalize(glm::cross(x, unit_vector(random)));
    return {x, y, glm::cross(x, y)};
}

/// Puts points of a cube of half side 1 together by their place, turned and moved into the world.
class CubeBuilder {
public:
    CubeBuilder(Random& random, double half, const dvec3& center)
        : turn_(random_rotation(random)), half_(half) {
        mesh_.center = vec3(center);
        mesh_.core = static_cast<float>(0.5 * half);
    }

    std::uint32_t vertex(const dvec3& p) {
        const auto key = std::pair(std::pair(p.x, p.y), p.z);
        const auto [at, is_new] = index_.try_emplace(key, static_cast<std::uint32_t>(mesh_.vertices.size()));
        if (is_new) mesh_.vertices.emplace_back(dvec3(mesh_.center) + half_ * (turn_ * p));
        return at->second;
    }

    /// Calls face(point) for the six faces, where point(a, b) is at -1 <= a, b <= 1 of the face.
    template <class Face>
    ClosedMesh build(const Face& face) {
        for (int axis = 0; axis < 3; ++axis) {
            for (const double side : {-1.0, 1.0}) {
                face([&](double a, double b) {
                    dvec3 p;
                    p[axis] = side;
                    p[(axis + 1) % 3] = a;
                    p[(axis + 2) % 3] = side * b;
                    return vertex(p);
                });
            }
        }
        return std::move(mesh_);
    }

    std::vector<std::vector<std::uint32_t>>& faces() { return mesh_.faces; }

private:
    glm::dmat3 turn_;
    double half_;
    ClosedMesh mesh_;
    std::map<std::pair<std::pair<double, double>, double>, std::uint32_t> index_;
};

}  // namespace

Scene ClosedMesh::scene() const {
    Scene scene;
    scene.materials.emplace_back();
    scene.vertices = vertices;
    for (const std::vector<std::uint32_t>& face : faces) {
        Primitive primitive;
        if (face.size() == 3) {
            primitive.kind = PrimitiveKind::triangle;
            primitive.index = static_cast<std::uint32_t>(scene.triangles.size());
            scene.triangles.push_back({{face[0], face[1], face[2]}, {}, false});
        } else {
            primitive.kind = PrimitiveKind::polygon;
            primitive.index = static_cast<std::uint32_t>(scene.polygons.size());
            scene.polygons.push_back({static_cast<std::uint32_t>(scene.polygon_vertices.size()),
                                      static_cast<std::uint32_t>(face.size())});
            for (const std::uint32_t corner : face) scene.polygon_vertices.push_back(vertices[corner]);
        }
        scene.primitives.push_back(primitive);
    }
    return scene;
}

ClosedMesh icosphere(Random& random, int subdivisions, double radius, double roughness, const dvec3& center) {
    const double golden = (1 + std::sqrt(5.0)) / 2;
    std::vector<dvec3> points;
    for (const double a : {-1.0, 1.0}) {
        for (const double b : {-golden, golden}) {
            points.emplace_back(a, b, 0);
            points.emplace_back(0, a, b);
            points.emplace_back(b, 0, a);
        }
    }
    ClosedMesh mesh;
    const auto near = [&](std::size_t i, std::size_t j) { return glm::distance(points[i], points[j]) < 2.1; };
    for (std::uint32_t i = 0; i < 12; ++i) {
        for (std::uint32_t j = i + 1; j < 12; ++j) {
            for (std::uint32_t k = j + 1; k < 12; ++k) {
                if (!near(i, j) || !near(j, k) || !near(k, i)) continue;
                const bool outward =
                    glm::dot(glm::cross(points[j] - points[i], points[k] - points[i]), points[i]) > 0;
                mesh.faces.push_back(outward ? std::vector{i, j, k} : std::vector{i, k, j});
            }
        }
    }
    for (int level = 0; level < subdivisions; ++level) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [at, is_new] =
                middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(points.size()));
            if (is_new) points.push_back(glm::normalize(points[a]) + glm::normalize(points[b]));
            return at->second;
        };
        std::vector<std::vector<std::uint32_t>> finer;
        for (const auto& face : mesh.faces) {
            const std::uint32_t a = face[0], b = face[1], c = face[2];
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        mesh.faces = std::move(finer);
    }
    mesh.center = vec3(center);
    mesh.core = static_cast<float>(0.3 * radius * (1 - roughness));
    for (const dvec3& point : points) {
        const double distance = radius * (1 + roughness * uniform(random, -1, 1));
        mesh.vertices.emplace_back(dvec3(mesh.center) + distance * glm::normalize(point));
    }
    return mesh;
}

ClosedMesh crumpled(ClosedMesh mesh, float grid) {
    for (vec3& vertex : mesh.vertices) {
        for (int k = 0; k < 3; ++k) vertex[k] = std::round(vertex[k] / grid) * grid;
    }
    return mesh;
}

ClosedMesh zigzag_cube(Random& random, double half, const dvec3& center) {
    CubeBuilder builder(random, half, center);
    return builder.build([&](const auto& point) {
        std::vector<std::uint32_t> path;
        constexpr int teeth = 12;
        for (int i = 0; i <= teeth; ++i) {
            const double along = 2.0 * i / teeth - 1;
            const double across = i == 0 || i == teeth ? 0 : (i % 2 ? 1 : -1) * uniform(random, 0.05, 0.15);
            path.push_back(point(along + across, along - across));
        }
        std::vector<std::uint32_t> below = path, above(path.rbegin(), path.rend());
        below.insert(below.begin() + teeth + 1, point(-1, 1));
        above.insert(above.begin() + teeth + 1, point(1, -1));
        builder.faces().push_back(below);
        builder.faces().push_back(above);
    });
}

ClosedMesh quadrangle_cube(Random& random, int cuts, double half, const dvec3& center) {
    CubeBuilder builder(random, half, center);
    std::vector<double> at{-1};
    for (int i = 1; i < cuts; ++i) at.push_back((2.0 * i + uniform(random, -0.8, 0.8)) / cuts - 1);
    at.push_back(1);
    // Symmetric, so that neighbouring faces meet in the same points.
    for (std::size_t i = 0; i < at.size() / 2; ++i) at[at.size() - 1 - i] = -at[i];
    if (at.size() % 2 == 1) at[at.size() / 2] = 0;
    return builder.build([&](const auto& point) {
        for (std::size_t i = 0; i + 1 < at.size(); ++i) {
            for (std::size_t j = 0; j + 1 < at.size(); ++j) {
                builder.faces().push_back({point(at[i], at[j]), point(at[i + 1], at[j]),
                                           point(at[i + 1], at[j + 1]), point(at[i], at[j + 1])});
            }
        }
    });
}

std::vector<TestRay> rays_at(Random& random, const ClosedMesh& mesh, std::size_t count) {
    std::vector<TestRay> rays;
    rays.reserve(count);
    const auto pick = [&](std::size_t size) {
        return static_cast<std::size_t>(uniform(random, 0, static_cast<double>(size)));
    };
    constexpr std::size_t run = SAHL_PACKET_RAYS;
    const auto in_core = [&] {
        return vec3(dvec3(mesh.center) + static_cast<double>(mesh.core) * in_ball(random));
    };
    const auto far_off = [&] {
        const double far = static_cast<double>(mesh.core) * std::pow(10.0, uniform(random, 1, 5));
        return vec3(dvec3(mesh.center) + far * unit_vector(random));
    };
    vec3 eye(0), far_eye(0);
    std::size_t first_face = 0;
    while (rays.size() < count) {
        const std::size_t i = rays.size();
        const bool together = i / run % 2 == 1;
        if (i % run == 0) {
            eye = in_core();
            far_eye = far_off();
            first_face = pick(mesh.faces.size());
        }
        const std::size_t kind = together ? i / run / 2 % 4 : i % 4;
        const std::size_t face_index =
            together ? (first_face + pick(16)) % mesh.faces.size() : pick(mesh.faces.size());
        const auto& face = mesh.faces[face_index];
        const std::size_t corner = pick(face.size());
        const dvec3 a(mesh.vertices[face[corner]]), b(mesh.vertices[face[(corner + 1) % face.size()]]);
        TestRay ray{together ? eye : in_core(), vec3(0)};
        if (kind == 0) {
            ray.direction = vec3(a) - ray.origin;
        } else if (kind == 1) {
            ray.direction = vec3(a + uniform(random, 0, 1) * (b - a)) - ray.origin;
        } else if (kind == 2) {
            ray.direction = vec3(static_cast<double>(mesh.core) * 10.0 * unit_vector(random));
        } else {
            ray.origin = together ? far_eye : far_off();
            ray.direction = in_core() - ray.origin;
        }
        if (glm::dot(ray.direction, ray.direction) > 0) rays.push_back(ray);
    }
    return rays;
}

}  // namespace sahl::tests
