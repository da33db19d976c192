// The `sahl` program: finds the command, runs it, and turns every failure into a message and an
// exit status.
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <exception>
#include <new>

#include <nlohmann/json.hpp>

#include "cli/batch_process.h"
#include "cli/batch_worker.h"
#include "cli/command_table.h"
#include "cli/commands.h"
#include "cli/driver_failure.h"
#include "cli/interruption.h"
#include "cli/options.h"
#include "cli/standard_output.h"
#include "engine/core/log.h"
#include "engine/core/nearest.h"
#include "engine/device/compile_helper.h"
#include "engine/device/device_choice.h"
#include "engine/self_test/first_use.h"

namespace sahl::cli {

namespace {

bool use_color(ColorMode mode) {
    if (mode != ColorMode::automatic) return mode == ColorMode::always;
    const char* no_color = std::getenv("NO_COLOR");  // https://no-color.org
    const char* terminal = std::getenv("TERM");
    const bool wanted = no_color == nullptr || *no_color == '\0';
    const bool able = terminal == nullptr || std::string_view(terminal) != "dumb";
    return wanted && able && isatty(STDERR_FILENO) != 0;
}

void configure_log(const CommonOptions& common) {
    if (common.quiet && common.verbose)
        throw Error(ExitCode::usage, "-q and -v contradict each other; give one");
    set_log_color(use_color(common.color));
    if (common.quiet) set_log_level(LogLevel::quiet);
    if (common.verbose) set_log_level(LogLevel::verbose);
}

void print_version(const CommonOptions& common) {
    nlohmann::ordered_json event{{"event", "version"}, {"version", SAHL_VERSION}, {"device", nullptr}};
    std::string text = "sahl " SAHL_VERSION "\nOpenCL device: ";
    try {
        const std::vector<DeviceInfo> devices = list_devices(common.device.threads);
        const DeviceInfo& device = devices[choose_device(devices, common.device.selector)];
        text += fmt::format("{} ({})\nOpenCL driver: {}\n", device.name, device.platform, device.driver);
        event["device"] = device.name;
        event["driver"] = device.driver;
    } catch (const Error& error) {
        text += fmt::format("none ({})\n", error.what());
    }
    if (common.json) {
        print_event(event);
    } else {
        print(text);
    }
}

/// The selected command, or the whole program before there is one.
CLI::App& selected(CLI::App& app) {
    const std::vector<CLI::App*> commands = app.get_subcommands();
    return commands.empty() ? app : selected(*commands.front());
}

std::string help_hint(CLI::App& app) {
    const CLI::App& command = selected(app);
    return fmt::format("\n'sahl {}--help' shows what there is",
                       &command == &app ? "" : name_of(command) + " ");
}

/// What to say of an argument that nothing takes, with the name it may have been meant to be.
std::string unexpected(CLI::App& app, const std::string& argument) {
    CLI::App& command = selected(app);
    const bool is_option = argument.size() > 1 && argument.front() == '-';
    std::vector<std::string> names;
    if (is_option) {
        for (const CLI::Option* option : command.get_options()) {
            for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
        }
    } else if (&command == &app) {
        for (const CLI::App* known : app.get_subcommands({})) names.push_back(known->get_name());
    }
    const std::vector<std::string_view> known(names.begin(), names.end());
    const std::string name = argument.substr(0, is_option ? argument.find('=') : std::string::npos);
    if (is_option) return fmt::format("there is no option {}{}", name, did_you_mean(name, known));
    if (&command == &app) return fmt::format("there is no command '{}'{}", name, did_you_mean(name, known));
    return fmt::format("nothing takes the argument '{}'", argument);
}

/// The first argument that nobody took, an option rather than what was meant as its value.
std::string first_unexpected(CLI::App& app) {
    const std::vector<std::string> arguments = app.remaining(true);
    for (const std::string& argument : arguments) {
        if (argument.starts_with('-')) return unexpected(app, argument);
    }
    return unexpected(app, arguments.front());
}

/// Error(usage) for whatever is wrong with the command line.
void parse(CLI::App& app, int argc, char** argv) {
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        throw;
    } catch (const CLI::ExtrasError&) {
        throw Error(ExitCode::usage, first_unexpected(app) + help_hint(app));
    } catch (const CLI::ParseError& error) {
        throw Error(ExitCode::usage, error.what() + help_hint(app));
    } catch (const Error& error) {
        throw Error(error.code(), error.what() + help_hint(app));
    }
}

ExitCode run(int argc, char** argv, CommonOptions& common) {
    CLI::App app{"Sahl renders scenes with OpenCL.", "sahl"};
    app.get_formatter()->column_width(34);
    app.footer(
        "Examples:\n"
        "  sahl render scene.nff -o image.png\n"
        "  sahl batch night.json\n"
        "  sahl compare image.png reference.png --threshold 2/255\n"
        "  sahl info scene.json\n"
        "  sahl devices\n"
        "Each command has its own --help.");
    bool version = false;
    app.add_flag("--version", version, "versions of Sahl, the OpenCL device and its driver");
    add_device_options(app, common);
    add_common_options(app, common);
    const Command profile = add_profile_command(app, common);
    const std::vector<Command> commands{add_profile_diff_command(*profile.app, common),
                                        profile,
                                        add_render_command(app, common),
                                        add_explain_command(app, common),
                                        add_batch_command(app, common),
                                        add_compare_command(app, common),
                                        add_info_command(app, common),
                                        add_convert_command(app, common),
                                        add_devices_command(app, common),
                                        add_warm_command(app, common),
                                        add_completion_command(app, common),
                                        add_man_command(app, common)};
    try {
        parse(app, argc, argv);
    } catch (const CLI::CallForHelp&) {
        print(app.help());
        return ExitCode::ok;
    }
    configure_log(common);
    if (common.json) {
        report_interruption_as_event();
        report_driver_failure_as_event();
    }
    if (version) {
        print_version(common);
        return ExitCode::ok;
    }
    for (const Command& command : commands) {
        if (command.app->parsed()) return command.run();
    }
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
    throw Error(ExitCode::usage, "which command? " + either(names) + help_hint(app));
}

/// Says it on standard error, and as an event for who reads those. Returns the exit status.
int report(ExitCode code, const std::string& message, const CommonOptions& common) {
    log_error(message);
    if (common.json) {
        try {
            print_event({{"event", "error"}, {"code", static_cast<int>(code)}, {"message", message}});
        } catch (const Error&) {
            // Standard output does not work: it may be what the message is about.
        }
    }
    return static_cast<int>(code);
}

int guarded_run(int argc, char** argv) {
    CommonOptions common;
    common.device.takes_compile_orders = true;  // see main()
    try {
        return static_cast<int>(run(argc, argv, common));
    } catch (const Interrupted& interrupted) {
        return report(interrupted);
    } catch (const Error& error) {
        return report(error.code(), error.what(), common);
    } catch (const std::bad_alloc&) {
        return report(ExitCode::memory, "out of memory: what was asked for needs more than this machine has",
                      common);
    } catch (const std::exception& error) {
        return report(ExitCode::internal,
                      fmt::format("internal error: {}; please report this with the command line and "
                                  "the scene",
                                  error.what()),
                      common);
    }
}

}  // namespace

}  // namespace sahl::cli

// What is thrown while a failure is reported has nobody left to tell.
int main(int argc, char** argv) {  // NOLINT(bugprone-exception-escape)
    sahl::cli::reserve_standard_streams();
    // A reader that went away and a file size limit are failed writes with a message, not a silent death.
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    // Its supervisor tells it of signals.
    if (const auto socket = sahl::cli::worker_socket(argc, argv)) sahl::cli::run_batch_worker(*socket);
    if (const auto device = sahl::take_compile_order(argc, argv)) sahl::compile_for_another_process(*device);
    sahl::cli::take_signals();
    const int status = sahl::cli::guarded_run(argc, argv);
    sahl::cli::defer_interruption();  // it is at its end: nothing to tell any more
    sahl::cli::expect_end();
    return status;
}
