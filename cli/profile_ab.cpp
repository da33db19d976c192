#include "cli/profile_ab.h"

#include <cstdlib>

#include "cli/command_table.h"
#include "cli/options.h"
#include "cli/profile_diff_report.h"
#include "cli/profile_setup.h"
#include "engine/profile/measure_in_turn.h"

namespace sahl::cli {

namespace {

constexpr std::string_view kernel_folder = "SAHL_KERNEL_DIR";

/// The environment variable SAHL_KERNEL_DIR as `setting` says, until the end of its life.
class KernelFolder {
public:
    explicit KernelFolder(const std::string& folder) {
        if (const char* before = std::getenv(kernel_folder.data())) before_ = before;
        ::setenv(kernel_folder.data(), folder.c_str(), 1);
    }
    ~KernelFolder() {
        if (before_) {
            ::setenv(kernel_folder.data(), before_->c_str(), 1);
        } else {
            ::unsetenv(kernel_folder.data());
        }
    }
    KernelFolder(const KernelFolder&) = delete;
    KernelFolder& operator=(const KernelFolder&) = delete;

private:
    std::optional<std::string> before_;
};

/// `options` with `setting`, an option of this command without its dashes.
ProfileOptions with_setting(const ProfileOptions& options, const std::string& setting) {
    ProfileOptions changed = options;
    CLI::App parser;
    add_profile_options(parser, changed);
    const std::string name = "--" + setting.substr(0, setting.find('='));
    const CLI::Option* const option = parser.get_option_no_throw(name);
    if (option == nullptr || option->get_group() == "Measuring" || option->get_group() == "Reports") {
        std::vector<std::string> names{std::string(kernel_folder)};
        for (const CLI::Option* known : parser.get_options()) {
            const bool may_differ = known->get_group() != "Measuring" && known->get_group() != "Reports";
            if (may_differ && known->nonpositional() && takes_value(*known))
                names.push_back(known->get_lnames().front());
        }
        const std::vector<std::string_view> known(names.begin(), names.end());
        throw Error(
            ExitCode::usage,
            fmt::format("--ab '{}': nothing of that name can differ between the two{}; it is KEY=VALUE "
                        "with one of {}",
                        setting, did_you_mean(name.substr(2), known), fmt::join(names, ", ")));
    }
    try {
        std::vector<std::string> arguments{"--" + setting};
        parser.parse(arguments);
    } catch (const CLI::ParseError& error) {
        throw Error(ExitCode::usage, fmt::format("--ab '{}': {}", setting, error.what()));
    }
    return changed;
}

/// What one of the two settings says.
struct Side {
    ProfileOptions options;
    std::optional<std::string> kernels{};  ///< their folder, if it is not that of the environment
};

Side read_side(const ProfileOptions& options, const std::string& setting) {
    if (setting.starts_with(std::string(kernel_folder) + "="))
        return {options, setting.substr(kernel_folder.size() + 1)};
    return {with_setting(options, setting)};
}

Contender make_side(const Side& side, const CommonOptions& common) {
    std::optional<KernelFolder> folder;
    if (side.kernels) folder.emplace(*side.kernels);
    Prepared made = prepare(side.options, common);
    return {std::move(made.device), std::move(made.renderer), made.job, made.measurement.environment};
}

}  // namespace

void add_ab_options(CLI::App& command, AbOptions& options) {
    command
        .add_option_function<std::vector<std::string>>(
            "--ab", [&options](const std::vector<std::string>& both) { options.settings = both; },
            "measures two settings in turn instead, such as traversal=packet traversal=stream; KEY is an "
            "option "
            "that says what is rendered and how, or SAHL_KERNEL_DIR")
        ->expected(2)
        ->type_name("KEY=VALUE KEY=VALUE")
        ->group("Comparing");
    add_fail_if_option(command, options.limits);
    command.get_option("--fail-if")->group("Comparing");
}

ExitCode run_ab(const ProfileOptions& options, const CommonOptions& common) {
    for (const auto& [name, file] : {std::pair{"json", options.json},
                                     {"csv", options.csv},
                                     {"trace", options.trace},
                                     {"html", options.html}}) {
        if (file)
            throw Error(ExitCode::usage,
                        fmt::format("--export-{}: a report is of one profile, without --ab", name));
    }
    const std::vector<std::string>& settings = options.ab.settings;
    const Side base = read_side(options, settings[0]);
    const Side other = read_side(options, settings[1]);
    const auto maker = [&common](const Side& side) {
        return [&side, &common] { return make_side(side, common); };
    };
    const TurnTimes times =
        measure_in_turn({maker(base), maker(other)}, {options.warm_up, options.repeat}, check_interruption);
    return report(diff_profiles(settings[0], times.sides[0], settings[1], times.sides[1], times.pairs,
                                options.ab.limits),
                  common);
}

}  // namespace sahl::cli
