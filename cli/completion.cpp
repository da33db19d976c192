#include "cli/completion.h"

#include "cli/command_table.h"
#include "cli/options.h"

namespace sahl::cli {

namespace {

/// The bash command that completes a value; empty where nothing is known of it.
std::string bash_action(const CLI::Option& option) {
    const OptionWords& words = words_of(option);
    const std::string all = fmt::format("{}", fmt::join(words.words, " "));
    if (words.list) return fmt::format("_sahl_list \"$current\" '{}' {}", words.alone, all);
    if (!all.empty()) return fmt::format("_sahl_words \"$current\" {}", all);
    if (!words.extensions.empty()) {
        return fmt::format("_sahl_files_of \"$current\" {}", fmt::join(words.extensions, " "));
    }
    if (option.get_type_name() == "FILE") return "_sahl_files \"$current\"";
    if (option.get_type_name() == "DIR") return "_sahl_files \"$current\" -d";
    return "";
}

/// The cases `command:option` of values.
std::string bash_values(const CLI::App& command, const std::string& name) {
    std::string text;
    for (const CLI::Option* option : named_options(command)) {
        if (!takes_value(*option)) continue;
        std::string patterns;
        for (const std::string& spelling : names_of(*option)) {
            patterns += fmt::format("{}'{}:{}'", patterns.empty() ? "" : " | ", name, spelling);
        }
        const std::string action = bash_action(*option);
        text += fmt::format("        {}) {}return ;;\n", patterns, action.empty() ? "" : action + "; ");
    }
    return text;
}

std::string option_names(const CLI::App& command) {
    std::vector<std::string> all;
    for (const CLI::Option* option : named_options(command)) {
        for (std::string& name : names_of(*option)) all.push_back(std::move(name));
    }
    return fmt::format("{}", fmt::join(all, " "));
}

/// The commands right below `app`.
std::string command_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
    return fmt::format("{}", fmt::join(names, " "));
}

/// All commands as patterns.
std::string command_patterns(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : commands_of(app)) names.push_back("'" + name_of(*command) + "'");
    return fmt::format("{}", fmt::join(names, " | "));
}

/// What completes the first argument: a command's own, and the commands below it.
std::string bash_argument(const CLI::App& command) {
    const std::vector<const CLI::Option*> arguments = positionals(command);
    const std::string below = command_names(command);
    std::string text = arguments.empty() ? "" : bash_action(*arguments.front());
    if (below.empty()) return text;
    if (!text.empty()) text += "; ";
    text += fmt::format("COMPREPLY+=($(compgen -W '{}' -- \"$current\"))", below);
    return text;
}

/// Options before the command whose next word is a value.
std::string value_options(const CLI::App& app) {
    std::vector<std::string> all;
    for (const CLI::Option* option : named_options(app)) {
        if (!takes_value(*option)) continue;
        for (std::string& name : names_of(*option)) all.push_back(std::move(name));
    }
    return fmt::format("{}", fmt::join(all, " | "));
}

constexpr const char* bash_helpers = R"(_sahl_words() {
    mapfile -t COMPREPLY < <(compgen -W "${*:2}" -- "$1")
}

# The last of words that commas separate, each of which may be there once; $2 stands alone.
_sahl_list() {
    local before= word words=()
    [[ $1 == *,* ]] && before=${1%,*},
    [[ $before ]] || words=("$2")
    [[ $before == "$2", ]] && return
    for word in "${@:3}"; do
        [[ ,$before == *,"$word",* ]] || words+=("$word")
    done
    compopt -o nospace 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -P "$before" -W "${words[*]}" -- "${1##*,}")
}

_sahl_files() {
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen "${2:--f}" -- "$1")
}

# Folders and the files with one of the extensions behind $1, of any case.
_sahl_files_of() {
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -d -- "$1")
    local file extension
    while read -r file; do
        for extension in "${@:2}"; do
            if [[ ${file,,} == *."$extension" && ! -d $file ]]; then COMPREPLY+=("$file"); fi
        done
    done < <(compgen -f -- "$1")
}
)";

constexpr const char* bash_start = R"(
_sahl() {
    local current=${COMP_WORDS[COMP_CWORD]} previous= command= i
    COMPREPLY=()
    ((COMP_CWORD > 0)) && previous=${COMP_WORDS[COMP_CWORD - 1]}
    # '--option=value' comes as three words.
    if [[ $current == = ]]; then
        current=
    elif [[ $previous == = && COMP_CWORD -ge 2 ]]; then
        previous=${COMP_WORDS[COMP_CWORD - 2]}
    fi
)";

std::string quoted_for_zsh(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '\'') {
            result += "'\\''";
        } else {
            if (c == '[' || c == ']' || c == ':' || c == '\\') result += '\\';
            result += c;
        }
    }
    return result;
}

/// ":NAME:what completes it".
std::string zsh_value(const CLI::Option& option, const std::string& name) {
    const OptionWords& words = words_of(option);
    std::string action;
    if (words.list) {
        action = fmt::format("_values -s , {} \"({}){}\"", name, fmt::join(words.words, " "), words.alone);
        for (const std::string& word : words.words) action += fmt::format(" \"({}){}\"", words.alone, word);
    } else if (!words.words.empty()) {
        action = fmt::format("({})", fmt::join(words.words, " "));
    } else if (!words.extensions.empty()) {
        action = fmt::format("_files -g \"(#i)*.({})\"", fmt::join(words.extensions, "|"));
    } else if (option.get_type_name() == "FILE") {
        action = "_files";
    } else if (option.get_type_name() == "DIR") {
        action = "_files -/";
    }
    return fmt::format(":{}:{}", quoted_for_zsh(name), action);
}

std::string zsh_option(const CLI::Option& option) {
    const std::vector<std::string> names = names_of(option);
    const bool value = takes_value(option);
    std::string spellings;
    for (const std::string& name : names) {
        spellings += (spellings.empty() ? "" : ",") + name;
        if (value) spellings += name.starts_with("--") ? "=" : "+";
    }
    const std::string help = fmt::format("[{}]", quoted_for_zsh(option.get_description()));
    const std::string argument = value ? zsh_value(option, option.get_type_name()) : "";
    const std::string exclusive = is_repeatable(option) ? "*" : fmt::format("({})", fmt::join(names, " "));
    if (names.size() == 1) return fmt::format("'{}{}{}{}'", exclusive, spellings, help, argument);
    return fmt::format("'{}'{{{}}}'{}{}'", exclusive, spellings, help, argument);
}

/// The call of _arguments for a command.
std::string zsh_arguments(const CLI::App& command) {
    std::string text = "                _arguments";
    for (const CLI::Option* option : named_options(command))
        text += " \\\n                    " + zsh_option(*option);
    int number = 0;
    for (const CLI::Option* option : positionals(command)) {
        text += fmt::format(" \\\n                    '{}{}'", ++number,
                            zsh_value(*option, option->get_single_name()));
    }
    return text + "\n";
}

/// The same, or those of the command below it that is typed.
std::string zsh_command(const CLI::App& command) {
    std::string text;
    for (const CLI::App* nested : command.get_subcommands({})) {
        text += fmt::format(
            "                if ((CURRENT > 2)) && [[ $words[2] == {} ]]; then\n"
            "                    shift words\n"
            "                    ((--CURRENT))\n"
            "{}"
            "                    return\n"
            "                fi\n",
            nested->get_name(), zsh_arguments(*nested));
    }
    return text + zsh_arguments(command);
}

}  // namespace

std::string bash_completion(const CLI::App& app) {
    std::string text = "# Completes command lines of sahl in bash; printed by 'sahl completion bash'.\n\n";
    text += bash_helpers;
    text += bash_start;
    text += fmt::format(
        "    for ((i = 1; i < COMP_CWORD; ++i)); do\n"
        "        case $command${{command:+ }}${{COMP_WORDS[i]}} in\n"
        "            {}) [[ ${{COMP_WORDS[i + 1]}} == = ]] && ((++i)); ((++i)) ;;\n"
        "            {}) command+=${{command:+ }}${{COMP_WORDS[i]}} ;;\n"
        "        esac\n"
        "    done\n"
        "    case $command:$previous in\n",
        value_options(app), command_patterns(app));
    text += bash_values(app, "");
    for (const CLI::App* command : commands_of(app)) text += bash_values(*command, name_of(*command));
    text += fmt::format(
        "    esac\n"
        "    local options words=\n"
        "    case $command in\n"
        "        '') options='{}' words='{}' ;;\n",
        option_names(app), command_names(app));
    for (const CLI::App* command : commands_of(app)) {
        text += fmt::format("        '{}') options='{}' ;;\n", name_of(*command), option_names(*command));
    }
    text +=
        "    esac\n"
        "    if [[ $current == -* ]]; then\n"
        "        _sahl_words \"$current\" \"$options\"\n"
        "        return\n"
        "    fi\n"
        "    case $command in\n"
        "        '') _sahl_words \"$current\" \"$words\" ;;\n";
    for (const CLI::App* command : commands_of(app)) {
        const std::string argument = bash_argument(*command);
        if (!argument.empty()) text += fmt::format("        '{}') {} ;;\n", name_of(*command), argument);
    }
    return text + "    esac\n}\n\ncomplete -F _sahl sahl\n";
}

std::string zsh_completion(const CLI::App& app) {
    std::string text =
        "#compdef sahl\n"
        "# Completes command lines of sahl in zsh; printed by 'sahl completion zsh'.\n\n"
        "_sahl() {\n"
        "    local context state state_descr line\n"
        "    typeset -A opt_args\n"
        "    local -a commands=(\n";
    for (const CLI::App* command : app.get_subcommands({})) {
        text +=
            fmt::format("        '{}:{}'\n", command->get_name(), quoted_for_zsh(command->get_description()));
    }
    text += "    )\n    _arguments -C";
    for (const CLI::Option* option : named_options(app)) text += " \\\n        " + zsh_option(*option);
    text +=
        " \\\n        '1:command:->command' '*::argument:->arguments'\n"
        "    case $state in\n"
        "        command) _describe command commands ;;\n"
        "        arguments)\n"
        "            case $words[1] in\n";
    for (const CLI::App* command : app.get_subcommands({})) {
        text += fmt::format("                {})\n{}                ;;\n", command->get_name(),
                            zsh_command(*command));
    }
    return text +
           "            esac\n"
           "            ;;\n"
           "    esac\n"
           "}\n\n"
           "if [[ $funcstack[1] == _sahl ]]; then\n"
           "    _sahl \"$@\"\n"
           "else\n"
           "    compdef _sahl sahl\n"
           "fi\n";
}

}  // namespace sahl::cli
