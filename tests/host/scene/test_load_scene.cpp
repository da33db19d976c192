#include <catch2/catch.hpp>

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include "engine/scene/load.h"
#include "tests/host/scene/parse.h"

namespace sahl::tests {
namespace {

namespace fs = std::filesystem;

// A folder of the test's own that goes at its end.
class Folder {
public:
    Folder() : path(fs::temp_directory_path() / ("sahl scenes " + std::to_string(getpid()))) {
        fs::create_directories(path);
    }
    ~Folder() { fs::remove_all(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    fs::path write(const fs::path& name, const std::string& text) const {
        std::ofstream(path / name, std::ios::binary) << text;
        return path / name;
    }

    fs::path path;
};

std::string read(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::string with_crlf(const std::string& text) {
    std::string result;
    for (const char c : text) result += c == '\n' ? std::string("\r\n") : std::string(1, c);
    return result;
}

// Everything that a loader fills, as text.
std::string describe(const Scene& scene) {
    std::ostringstream text;
    text.precision(17);
    const auto vector = [&](const auto& v) { text << v.x << ' ' << v.y << ' ' << v.z << '\n'; };
    vector(scene.cameras[0].eye);
    vector(scene.cameras[0].look_at);
    vector(scene.cameras[0].up);
    text << scene.cameras[0].fov_y << ' ' << scene.resolution.width << ' ' << scene.resolution.height << ' '
         << scene.depth;
    vector(scene.background);
    for (const Light& light : scene.lights) {
        vector(light.position);
        vector(light.color);
        vector(light.attenuation);
    }
    for (const Material& m : scene.materials) {
        for (const glm::vec3& c :
             {m.ambient, m.diffuse, m.specular, m.emission, m.reflection, m.transmission})
            vector(c);
        text << m.shininess << ' ' << m.ior << '\n';
    }
    for (const Primitive& p : scene.primitives) {
        text << static_cast<int>(p.kind) << ' ' << p.index << ' ' << p.material << ' ' << p.transform << '\n';
    }
    for (const glm::dmat4& m : scene.transforms) {
        for (int i = 0; i < 4; ++i) vector(m[i]);
    }
    for (const Triangle& t : scene.triangles)
        text << t.vertices[0] << t.vertices[1] << t.vertices[2] << t.normals[2];
    for (const Sphere& s : scene.spheres) {
        vector(s.center);
        text << s.radius << '\n';
    }
    for (const Cone& c : scene.cones) {
        vector(c.base);
        vector(c.apex);
        text << c.base_radius << ' ' << c.apex_radius << '\n';
    }
    for (const auto* list : {&scene.vertices, &scene.normals, &scene.polygon_vertices}) {
        for (const glm::vec3& v : *list) vector(v);
    }
    return text.str();
}

}  // namespace

TEST_CASE("Line ends and a byte order mark change no scene", "[scene]") {
    const Folder folder;
    const std::string name = GENERATE(as<std::string>(), "all_entities.nff", "all_commands.test");
    const std::string text = read(own_scene(name));
    REQUIRE(text.size() > 100);
    const std::string expected = describe(load_scene(own_scene(name)));
    CHECK(describe(load_scene(folder.write(name, with_crlf(text)))) == expected);
    CHECK(describe(load_scene(folder.write(name, "\xef\xbb\xbf" + with_crlf(text)))) == expected);
    std::string lone_returns = text;
    std::replace(lone_returns.begin(), lone_returns.end(), '\n', '\r');
    CHECK(describe(load_scene(folder.write(name, lone_returns))) == expected);
    std::string no_last_line_end = text;
    while (no_last_line_end.back() == '\n') no_last_line_end.pop_back();
    CHECK(describe(load_scene(folder.write(name, no_last_line_end))) == expected);
    // The comparison sees a change.
    CHECK(describe(load_scene(folder.write(
              name, text + (name.ends_with("nff") ? "l 1 2 3" : "point 1 2 3 1 1 1")))) != expected);
}

TEST_CASE("Paths may hold spaces and UTF-8, and messages repeat them", "[scene]") {
    const Folder folder;
    fs::create_directories(folder.path / "größe 大");
    const fs::path good = folder.write("größe 大/a scene ☀.NFF", nff_view);
    CHECK(load_scene(good).resolution.width == 64);
    const fs::path bad = folder.write("größe 大/b.Test", "size 4 x\n");
    CHECK_THROWS_WITH(load_scene(bad), Catch::StartsWith(bad.string() + ":1:8: "));
}

TEST_CASE("Files that cannot be read", "[scene]") {
    const Folder folder;
    const auto check = [&](const fs::path& path, ExitCode code, const std::string& says) {
        INFO(path.string());
        try {
            load_scene(path);
            FAIL_CHECK("was accepted");
        } catch (const Error& error) {
            CHECK(error.code() == code);
            CHECK_THAT(error.what(), Catch::StartsWith(path.string() + ": ") && Catch::Contains(says));
        }
    };
    check(folder.path / "missing.nff", ExitCode::scene, "there is no such file; check the path");
    check(folder.path / "no" / "folder.test", ExitCode::scene, "there is no such file");
    fs::create_directories(folder.path / "folder.nff");
    check(folder.path / "folder.nff", ExitCode::scene, "it is a folder; name a file in it");
    fs::create_symlink(folder.path / "loop.nff", folder.path / "loop.nff");
    check(folder.path / "loop.nff", ExitCode::scene, "cannot read this scene file");
    const fs::path locked = folder.write("locked.nff", nff_view);
    fs::permissions(locked, fs::perms::none);
    if (std::ifstream(locked)) {
        WARN("this user may read every file; the permission check is left out");
    } else {
        check(locked, ExitCode::scene, "check its permissions");
    }
    check(folder.write("scene.obj", ""), ExitCode::usage, "extension '.obj'; formats are .json");
    check(folder.write("scene", ""), ExitCode::usage,
          "formats are .json (Sahl scene), .nff (Neutral File Format) and .test (CSE 167)");
}

TEST_CASE("A binary file is refused at its first strange byte", "[scene]") {
    const Folder folder;
    const fs::path path = folder.write("image.nff", std::string("\x89PNG\r\n\x1a\n\0\0", 10));
    CHECK_THROWS_WITH(load_scene(path), Catch::StartsWith(path.string() + ":2:1: byte 0x1a"));
}

}  // namespace sahl::tests
