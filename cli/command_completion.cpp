// `sahl completion` and `sahl man`: what --help knows, for shells and for man.
#include <memory>

#include "cli/commands.h"
#include "cli/completion.h"
#include "cli/man_page.h"
#include "cli/options.h"
#include "cli/standard_output.h"

namespace sahl::cli {

namespace {

using Completion = std::string (*)(const CLI::App&);

const Choices<Completion>& shells() {
    static const Choices<Completion> choices{{"bash", bash_completion}, {"zsh", zsh_completion}};
    return choices;
}

}  // namespace

Command add_completion_command(CLI::App& app, CommonOptions& common) {
    const auto completion = std::make_shared<Completion>(nullptr);
    CLI::App* command = app.add_subcommand("completion", "prints a script that completes command lines");
    CLI::Option* shell = add_value(
        *command, "SHELL", "",
        [completion](const std::string& text) { *completion = read_choice("SHELL", text, shells()); },
        either(words_of(shells())));
    shell->required();
    set_words(*shell, {words_of(shells())});
    add_common_options(*command, common);
    command->footer(
        "Examples:\n"
        "  source <(sahl completion bash)\n"
        "  sahl completion zsh > ~/.zsh/completions/_sahl");
    return {command, [completion, &app] {
                print((*completion)(app));
                return ExitCode::ok;
            }};
}

Command add_man_command(CLI::App& app, CommonOptions& common) {
    CLI::App* command = app.add_subcommand("man", "prints the manual page");
    add_common_options(*command, common);
    command->footer(
        "Examples:\n"
        "  sahl man | man -l -");
    return {command, [&app] {
                print(man_page(app));
                return ExitCode::ok;
            }};
}

}  // namespace sahl::cli
