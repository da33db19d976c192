// `sahl warm`: compiles the kernels before they are needed.
#include <memory>

#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/driver_failure.h"
#include "cli/options.h"
#include "cli/render_options.h"
#include "cli/standard_output.h"
#include "engine/self_test/self_test.h"

namespace sahl::cli {

namespace {

struct WarmOptions {
    std::string scene;
    LoadOptions loading;
    std::optional<Traversal> traversal;
};

ExitCode warm(const WarmOptions& options, const CommonOptions& common) {
    if (!options.scene.empty()) load_scene(options.scene, options.loading);
    DeviceOptions device_options = common.device;
    device_options.traversal = options.traversal;
    Device device(device_options);
    take_driver_failures();
    const SelfTestReport report = run_self_test(device);
    if (const KernelTest* failed = report.failed()) {
        throw Error(ExitCode::device,
                    fmt::format("device {} computes wrongly: kernel {}, {}; choose another with "
                                "--device",
                                device.info().name, failed->kernel, failed->failure));
    }
    const std::size_t compiled = count_compilations();
    if (common.json) {
        print_event({{"event", "warm"},
                     {"device", device.info().name},
                     {"kernels", report.kernels.size()},
                     {"compiled", compiled}});
    } else if (!common.quiet) {
        print_message(fmt::format("{}: the kernels are ready and have passed their test, {} compiled now\n",
                                  device.info().name, compiled));
    }
    return ExitCode::ok;
}

}  // namespace

Command add_warm_command(CLI::App& app, CommonOptions& common) {
    const auto options = std::make_shared<WarmOptions>();
    CLI::App* command = app.add_subcommand("warm", "compiles the kernels for later runs");
    add_scene_argument(*command, "SCENE", options->scene);
    command->get_option("SCENE")->required(false);
    add_scene_options(*command, options->loading);
    add_traversal_option(*command, options->traversal);
    add_device_options(*command, common);
    add_common_options(*command, common);
    command->footer(
        "They are compiled into the program cache (SAHL_CACHE_DIR, else XDG_CACHE_HOME/sahl, else\n"
        "~/.cache/sahl), for the device and the host's processor, and tested. All scenes have the same\n"
        "kernels; with SCENE that it can be loaded is checked too. Each way of traversal has its own: those "
        "of\n"
        "--traversal, or of the device's default. Kernels that count, for costs of pixels and profiles, are\n"
        "compiled when they are first needed.\n"
        "'sahl render' and 'sahl explain' do without them for up to 262144 rays, samples times generations "
        "times\n"
        "lights and one: until they are compiled it is by kernels that are not optimized, which take half as "
        "long\n"
        "to compile and four to eight times as long to run, to the same pixels.\n"
        "Examples:\n"
        "  sahl warm\n"
        "  sahl warm --traversal stream\n"
        "  sahl warm scene.json && sahl profile scene.json --assert-no-jit");
    return {command, [options, &common] { return warm(*options, common); }};
}

}  // namespace sahl::cli
