// The program around its commands: help, version, devices, standard output that breaks.
#include <filesystem>

#include <catch2/catch.hpp>

#include "tests/cli/sahl_program.h"

namespace sahl::tests {
namespace {

/// An OpenCL loader without drivers.
ProcessOptions without_opencl(const std::filesystem::path& empty_folder) {
    ProcessOptions options;
    options.environment["OCL_ICD_VENDORS"] = empty_folder.string();
    options.environment["OCL_ICD_FILENAMES"] = std::nullopt;
    options.working_directory = empty_folder;
    return options;
}

TEST_CASE("program: --help of each command has examples", "[cli]") {
    for (const std::vector<std::string>& arguments : {std::vector<std::string>{"--help"},
                                                      {"render", "--help"},
                                                      {"compare", "-h"},
                                                      {"info", "--help"},
                                                      {"convert", "--help"},
                                                      {"completion", "--help"},
                                                      {"man", "--help"},
                                                      {"devices", "--help"}}) {
        const ProcessResult result = run_sahl(arguments);
        INFO(result.out << result.err);
        CHECK(result.status == 0);
        CHECK(result.err == "");
        CHECK(contains(result.out, "Examples:"));
        CHECK(contains(result.out, "--json"));
    }
    CHECK(contains(run_sahl({"render", "--help"}).out, "--depth N[,N...]"));
}

TEST_CASE("program: --version names engine, device and driver", "[cli]") {
    const ProcessResult result = run_sahl({"--version"});
    INFO(result.out << result.err);
    CHECK(result.status == 0);
    CHECK(result.out.starts_with("sahl " SAHL_VERSION "\n"));
    CHECK(contains(result.out, "\nOpenCL device: "));
    CHECK(contains(result.out, "\nOpenCL driver: "));

    const std::vector<nlohmann::json> events = json_lines(run_sahl({"--json", "--version"}).out);
    REQUIRE(events.size() == 1);
    CHECK(events[0].at("version") == SAHL_VERSION);
    CHECK(contains(result.out, events[0].at("device").get<std::string>()));
}

TEST_CASE("program: without OpenCL --version works, the rest ends with 4 and says what to install", "[cli]") {
    const TemporaryFolder folder;
    const ProcessOptions options = without_opencl(folder.path());

    const ProcessResult version = run_sahl({"--version"}, options);
    CHECK(version.status == 0);
    CHECK(contains(version.out, "OpenCL device: none"));

    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"devices"}, {"render", scene_file("cli_mirrors.nff")}}) {
        const ProcessResult result = run_sahl(arguments, options);
        INFO(result.err);
        CHECK(result.status == 4);
        CHECK(result.out == "");
        CHECK(contains(result.err, "pocl-opencl-icd"));
    }
    CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("program: devices lists them and marks one", "[cli]") {
    const ProcessResult text = run_sahl({"devices"});
    INFO(text.out << text.err);
    CHECK(text.status == 0);
    CHECK(contains(text.out, "*  "));
    CHECK(contains(text.out, "platform "));
    CHECK(contains(text.out, "driver "));
    CHECK(contains(text.out, "compute units"));
    CHECK(contains(text.out, "largest buffer"));

    const ProcessResult lines = run_sahl({"devices", "--json"});
    CHECK(lines.status == 0);
    int chosen = 0;
    int index = 0;
    for (const nlohmann::json& device : json_lines(lines.out)) {
        CHECK(device.at("event") == "device");
        CHECK(device.at("index") == index++);
        CHECK(device.at("max_allocation").get<std::uint64_t>() > 0);
        CHECK(contains(text.out, device.at("name").get<std::string>()));
        if (device.at("chosen")) ++chosen;
    }
    CHECK(chosen == 1);
    // Common options may stand before the command.
    CHECK(run_sahl({"--json", "devices"}).out == lines.out);
}

TEST_CASE("program: a device that is not there, or is not named clearly", "[cli]") {
    const TemporaryFolder folder;
    const std::string scene = scene_file("cli_mirrors.nff");
    for (const std::string selector : {"9999", "no such device"}) {
        const ProcessResult result = run_sahl_in(folder.path(), {"render", scene, "--device", selector});
        INFO(result.err);
        CHECK(result.status == 4);
        CHECK(contains(result.err, selector));
        CHECK(std::filesystem::is_empty(folder.path()));
    }
}

TEST_CASE("program: --threads reaches the device", "[cli]") {
    const ProcessResult result = run_sahl({"devices", "--json", "--threads", "1"});
    REQUIRE(result.status == 0);
    for (const nlohmann::json& device : json_lines(result.out)) {
        if (device.at("platform") == "Portable Computing Language" && device.at("cpu")) {
            CHECK(device.at("compute_units") == 1);
        }
    }
}

TEST_CASE("program: standard output that takes nothing is exit status 6", "[cli]") {
    ProcessOptions full;
    full.standard_output = "/dev/full";
    ProcessOptions broken;
    broken.broken_pipe = true;
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"--help"}, {"--version"}, {"devices"}, {"devices", "--json"}}) {
        for (const ProcessOptions& options : {full, broken}) {
            const ProcessResult result = run_sahl(arguments, options);
            INFO(arguments.front() << ": " << result.err);
            CHECK(result.status == 6);
            CHECK(contains(result.err, "standard output"));
        }
    }
}

TEST_CASE("program: colour only where it is wanted", "[cli]") {
    const auto error_text = [](const std::vector<std::string>& color, const ProcessOptions& options = {}) {
        std::vector<std::string> arguments{"render", "missing.nff"};
        arguments.insert(arguments.end(), color.begin(), color.end());
        return run_sahl(arguments, options).err;
    };
    ProcessOptions no_color;
    no_color.environment["NO_COLOR"] = std::string("1");
    // Standard error is a pipe here, no terminal.
    CHECK(!contains(error_text({}), "\x1b"));
    CHECK(!contains(error_text({}, no_color), "\x1b"));
    CHECK(!contains(error_text({"--color", "never"}), "\x1b"));
    CHECK(contains(error_text({"--color", "always"}, no_color), "\x1b["));
}

}  // namespace
}  // namespace sahl::tests
