// The library of image codecs, and OpenImageIO with it: loaded by those who need it, missed with a message.
#include <catch2/catch.hpp>

#include "tests/cli/sahl_program.h"

namespace sahl::tests {
namespace {

namespace fs = std::filesystem;

/// What the dynamic linker says of the libraries that `sahl` loads.
std::string libraries_of(const fs::path& folder, const std::vector<std::string>& arguments) {
    ProcessOptions options;
    options.environment["LD_DEBUG"] = "files";
    options.working_directory = folder;
    const ProcessResult result = run_sahl(arguments, options);
    REQUIRE(result.status == 0);
    REQUIRE(contains(result.err, "libOpenCL.so"));
    return result.err;
}

/// The program alone, in a folder of its own.
class LoneProgram {
public:
    LoneProgram() {
        fs::create_directories(folder_ / "bin");
        fs::copy_file(sahl_command({}).front(), program());
    }
    fs::path program() const { return folder_ / "bin/sahl"; }
    ProcessResult run(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), program());
        ProcessOptions options;
        options.working_directory = folder_.path();
        return run_process(arguments, options);
    }
    const TemporaryFolder& folder() const { return folder_; }

private:
    TemporaryFolder folder_;
};

TEST_CASE("image codecs: only what reads images, or writes others than PNG, loads OpenImageIO", "[cli]") {
    const TemporaryFolder folder;
    const std::string scene = scene_file("cli_mirrors.nff");
    for (const std::vector<std::string>& arguments : {std::vector<std::string>{"--help"},
                                                      {"info", scene},
                                                      {"devices"},
                                                      {"render", scene, "--dry-run"},
                                                      {"render", scene, "--depth", "0", "-o", "a.png"}}) {
        INFO(arguments.front());
        CHECK_FALSE(contains(libraries_of(folder.path(), arguments), "OpenImageIO"));
    }
    const std::string rendering =
        libraries_of(folder.path(), {"render", scene, "--depth", "0", "-o", "a.png", "-o", "a.exr"});
    CHECK(contains(rendering, "libOpenImageIO.so"));
    // After the kernels: loading it keeps PoCL from loading them.
    CHECK(rendering.find("libOpenImageIO.so") > rendering.find("generate.so"));
    CHECK(contains(libraries_of(folder.path(), {"compare", "a.png", "a.png"}), "libOpenImageIO.so"));
}

TEST_CASE("image codecs: a render without them ends soon, with a message and nothing written", "[cli]") {
    const LoneProgram sahl;
    const std::vector<std::string> endless{
        "render", scene_file("cli_mirrors.nff"), "--size", "4096x4096", "--spp", "16384", "-o", "a.exr",
        "-q"};
    const ProcessResult missing = sahl.run(endless);
    INFO(missing.err);
    CHECK(missing.status == 6);
    CHECK(contains(missing.err, "libsahl_image_codecs.so: cannot open shared object file"));
    CHECK(contains(missing.err, "install Sahl again"));
    CHECK_FALSE(fs::exists(sahl.folder() / "a.exr"));

    write_file(sahl.folder() / "bin/libsahl_image_codecs.so", "no library");
    const ProcessResult broken = sahl.run(endless);
    INFO(broken.err);
    CHECK(broken.status == 6);
    CHECK(contains(broken.err, "libsahl_image_codecs.so"));
}

TEST_CASE("image codecs: without them compare says so, and what has no images goes on", "[cli]") {
    const LoneProgram sahl;
    const std::string scene = scene_file("cli_mirrors.nff");
    write_file(sahl.folder() / "a.png", "an image");
    const ProcessResult compared = sahl.run({"compare", "a.png", "a.png"});
    INFO(compared.err);
    CHECK(compared.status == 3);
    CHECK(contains(compared.err, "images can be neither read nor written"));
    CHECK(sahl.run({"info", scene}).status == 0);

    const ProcessResult batch = sahl.run({"batch", scene, "-o", "{scene}.exr", "-q"});
    INFO(batch.err);
    CHECK(batch.status == 8);
    CHECK(contains(batch.err, "libsahl_image_codecs.so: cannot open shared object file"));
}

}  // namespace
}  // namespace sahl::tests
