// `sahl render --aov`: what the files hold.
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "engine/film/image_io.h"
#include "tests/cli/sahl_program.h"

namespace sahl::tests {
namespace {

namespace fs = std::filesystem;

ProcessResult render_in(const fs::path& folder, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"render", scene_file("cli_mirrors.nff")});
    return run_sahl_in(folder, arguments);
}

OIIO::ImageSpec spec_of(const fs::path& path) {
    const auto input = OIIO::ImageInput::open(path.string());
    REQUIRE(input);
    return input->spec();
}

template <class T = float>
std::vector<T> channel(const fs::path& path, const std::string& name) {
    const auto input = OIIO::ImageInput::open(path.string());
    REQUIRE(input);
    const OIIO::ImageSpec& spec = input->spec();
    const int index = spec.channelindex(name);
    REQUIRE(index >= 0);
    std::vector<T> values(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height));
    REQUIRE(input->read_image(0, 0, index, index + 1, OIIO::BaseTypeFromC<T>::value, values.data()));
    return values;
}

TEST_CASE("aovs: --aov adds its channels to EXR files alone", "[cli]") {
    const TemporaryFolder folder;
    const ProcessResult result =
        render_in(folder.path(), {"-o", "a.exr", "-o", "a.png", "--aov", "Z,N,id.primitive", "--depth", "0"});
    INFO(result.err);
    REQUIRE(result.status == 0);
    std::vector<std::string> names = spec_of(folder / "a.exr").channelnames;
    std::sort(names.begin(), names.end());
    CHECK(names == std::vector<std::string>{"B", "G", "N.X", "N.Y", "N.Z", "R", "Z", "id.primitive"});
    CHECK(spec_of(folder / "a.png").nchannels == 3);

    REQUIRE(render_in(folder.path(), {"-o", "all.exr", "--aov", "all", "--depth", "0"}).status == 0);
    CHECK(spec_of(folder / "all.exr").nchannels == 13);
    REQUIRE(render_in(folder.path(), {"-o", "plain.exr", "--depth", "0"}).status == 0);
    CHECK(read_image(folder / "all.exr").pixels == read_image(folder / "plain.exr").pixels);

    // The floor z = 0 fills the corners below; normals are unit vectors.
    const std::vector<float> up = channel(folder / "all.exr", "N.Z");
    CHECK(up.at(31 * 48) == 1);
    CHECK(std::isfinite(channel(folder / "all.exr", "Z").at(31 * 48)));
    CHECK(channel(folder / "all.exr", "id.primitive").at(31 * 48) == 0);
    // compare takes the beauty of both.
    CHECK(run_sahl_in(folder.path(), {"compare", "all.exr", "plain.exr", "-q"}).status == 0);
}

TEST_CASE("aovs: costs are of each depth", "[cli]") {
    const TemporaryFolder folder;
    REQUIRE(
        render_in(folder.path(), {"-o", "d{depth}.exr", "--aov", "cost.rays,Z,cost.nodes", "--depth", "0,2"})
            .status == 0);
    CHECK(spec_of(folder / "d0.exr").nchannels == 6);
    CHECK(channel(folder / "d0.exr", "Z") == channel(folder / "d2.exr", "Z"));
    const auto shallow = channel<std::uint32_t>(folder / "d0.exr", "cost.rays");
    const auto deep = channel<std::uint32_t>(folder / "d2.exr", "cost.rays");
    CHECK(*std::min_element(shallow.begin(), shallow.end()) >= 1);
    CHECK(shallow != deep);
    CHECK(std::equal(shallow.begin(), shallow.end(), deep.begin(), std::less_equal<>()));
    const auto nodes = channel<std::uint32_t>(folder / "d2.exr", "cost.nodes");
    CHECK(std::equal(deep.begin(), deep.end(), nodes.begin(), std::less_equal<>()));  // each opens the root
}

TEST_CASE("aovs: AOVs of a crop are that part of the whole", "[cli]") {
    const TemporaryFolder folder;
    REQUIRE(render_in(folder.path(), {"-o", "all.exr", "--aov", "Z"}).status == 0);
    REQUIRE(render_in(folder.path(), {"-o", "crop.exr", "--aov", "Z", "--crop", "10,20,30,25"}).status == 0);
    const std::vector<float> all = channel(folder / "all.exr", "Z");
    const std::vector<float> crop = channel(folder / "crop.exr", "Z");
    REQUIRE(crop.size() == 100);
    int different = 0;
    for (std::size_t i = 0; i < crop.size(); ++i)
        different += crop[i] != all[(20 + i / 20) * 48 + 10 + i % 20];
    CHECK(different == 0);
}

}  // namespace
}  // namespace sahl::tests
