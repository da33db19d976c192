#include "cli/man_page.h"

#include <utility>

#include "cli/command_table.h"
#include "cli/options.h"

namespace sahl::cli {

namespace {

/// `text` as roff prints it: nothing is a command or turns into a typographic character.
std::string roff(std::string_view text) {
    std::string result;
    for (const char c : text) {
        switch (c) {
            case '\\':
                result += "\\e";
                break;
            case '-':
                result += "\\-";
                break;
            case '\'':
                result += "\\(aq";
                break;
            case '"':
                result += "\\(dq";
                break;
            case '~':
                result += "\\(ti";
                break;
            case '^':
                result += "\\(ha";
                break;
            case '`':
                result += "\\(ga";
                break;
            default:
                result += c;
        }
    }
    if (result.starts_with('.')) result.insert(0, "\\&");
    return result;
}

std::string bold(std::string_view text) { return "\\fB" + roff(text) + "\\fR"; }
std::string italic(std::string_view text) { return "\\fI" + roff(text) + "\\fR"; }

std::string tagged(const std::string& tag, std::string_view text) {
    return ".TP\n" + tag + "\n" + roff(text) + "\n";
}

std::string option_entry(const CLI::Option& option) {
    std::string tag;
    for (const std::string& name : names_of(option)) tag += (tag.empty() ? "" : ", ") + bold(name);
    if (takes_value(option)) tag += " " + italic(option.get_type_name());
    return tagged(tag, option.get_description());
}

/// A footer's lines: examples are indented.
struct Footer {
    std::vector<std::string> notes;
    std::vector<std::string> examples;
};

Footer footer_of(const CLI::App& command) {
    Footer footer;
    const std::string text = command.get_footer();
    for (const std::string_view line : split(text, '\n')) {
        if (line.starts_with("  ")) {
            footer.examples.emplace_back(line.substr(2));
        } else if (!line.empty() && line != "Examples:") {
            footer.notes.emplace_back(line);
        }
    }
    return footer;
}

std::string command_section(const CLI::App& command) {
    std::string text = fmt::format(".SS {}\n", roff("sahl " + name_of(command)));
    std::string usage = bold("sahl " + name_of(command)) + " [" + italic("OPTIONS") + "]";
    for (const CLI::Option* option : positionals(command)) usage += " " + italic(option->get_single_name());
    text += usage + "\n.PP\n" + roff(command.get_description()) + ".\n";
    for (const std::string& note : footer_of(command).notes) text += roff(note) + "\n";
    for (const CLI::Option* option : positionals(command)) {
        text += tagged(italic(option->get_single_name()), option->get_description());
    }
    for (const CLI::Option* option : named_options(command)) text += option_entry(*option);
    return text;
}

using Entries = std::vector<std::pair<const char*, const char*>>;

std::string section(const char* title, const Entries& entries) {
    std::string text = fmt::format(".SH {}\n", title);
    for (const auto& [name, meaning] : entries) text += tagged(bold(name), meaning);
    return text;
}

const Entries& exit_statuses() {
    static const Entries entries{
        {"0", "done"},
        {"1", "compare found more difference than its limits allow"},
        {"2", "wrong usage"},
        {"3", "the scene or an image is wrong or cannot be read"},
        {"4", "OpenCL device or driver"},
        {"5", "out of memory"},
        {"6", "the output was not written"},
        {"9", "a row of a profile is slower than it may be"},
        {"70", "internal error, worth a report"},
        {"130, 143", "interrupted by SIGINT, by SIGTERM"},
    };
    return entries;
}

const Entries& variables() {
    static const Entries entries{
        {"NO_COLOR", "when set, messages have no colour unless --color asks for it"},
        {"SAHL_CACHE_DIR",
         "folder of compiled kernels (default: $XDG_CACHE_HOME/sahl, else $HOME/.cache/sahl)"},
        {"SAHL_KERNEL_DIR", "folder of kernel sources that are used instead of the built-in ones"},
        {"TMPDIR", "where the private folder of an OpenCL driver lies while sahl runs (default: /tmp)"},
    };
    return entries;
}

const Entries& files() {
    static const Entries entries{{"~/.cache/sahl", "compiled kernels; may be deleted at any time"}};
    return entries;
}

}  // namespace

std::string man_page(const CLI::App& app) {
    std::string text = ".TH SAHL 1 \"\" \"Sahl " SAHL_VERSION "\" \"User Commands\"\n";
    text += ".nh\n.ad l\n";
    text += ".SH NAME\nsahl \\- " + roff("OpenCL ray tracer") + "\n";
    text += ".SH SYNOPSIS\n";
    for (const CLI::App* command : commands_of(app)) {
        text += bold("sahl " + name_of(*command)) + " [" + italic("OPTIONS") + "]";
        for (const CLI::Option* option : positionals(*command))
            text += " " + italic(option->get_single_name());
        text += "\n.br\n";
    }
    text += bold("sahl --version") + "\n";
    text += ".SH DESCRIPTION\n" + roff(app.get_description()) + "\n";
    text +=
        "Options may stand before and behind the arguments, those below OPTIONS before the command too.\n";
    text += ".SH COMMANDS\n";
    for (const CLI::App* command : commands_of(app)) text += command_section(*command);
    text += ".SH OPTIONS\n";
    for (const CLI::Option* option : named_options(app)) text += option_entry(*option);
    text += section("EXIT STATUS", exit_statuses());
    text += section("ENVIRONMENT", variables());
    text += section("FILES", files());
    text += ".SH EXAMPLES\n.nf\n";
    for (const CLI::App* command : commands_of(app)) {
        for (const std::string& example : footer_of(*command).examples) text += roff(example) + "\n";
    }
    return text + ".fi\n";
}

}  // namespace sahl::cli
