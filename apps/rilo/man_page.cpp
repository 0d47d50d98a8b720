// The manual page.
#include <fmt/format.h>

#include "command_tree.hpp"

namespace rilo::cli {

namespace {

/// Text that roff prints as it stands: its own signs escaped, no line that begins like a request.
std::string roff(const std::string& text) {
  std::string result;
  bool line_start = true;
  for (const char c : text) {
    if (line_start && (c == '.' || c == '\'')) result += "\\&";
    if (c == '\\') {
      result += "\\e";
    } else {
      result += c == '-' ? std::string("\\-") : std::string(1, c);
    }
    line_start = c == '\n';
  }
  return result;
}

std::string roff_value(const TreeOption& option) {
  if (option.value.empty()) return "";
  if (option.choices.empty()) return " \\fI" + roff(option.value) + "\\fR";
  return " " + roff(fmt::format("{}", fmt::join(option.choices, "|")));
}

std::string option_entry(const TreeOption& option, bool positional) {
  std::string names;
  for (const std::string& name : option.names) {
    const std::string bold = positional ? "\\fI" + roff(name) + "\\fR" : "\\fB" + roff(name) + "\\fR";
    names += (names.empty() ? "" : ", ") + bold;
  }
  std::string text = ".TP\n" + names + (positional ? "" : roff_value(option)) + "\n" + roff(option.help);
  if (!option.fallback.empty()) text += roff(fmt::format(" [{}]", option.fallback));
  return text + "\n";
}

std::string synopsis(const TreeCommand& command) {
  std::string text = ".B " + roff(command.path) + "\n";
  if (!command.options.empty()) text += "[\\fIoptions\\fR]\n";
  for (const TreeOption& positional : command.positionals) {
    const std::string name = "\\fI" + roff(positional.names.front()) + "\\fR" + (positional.repeatable ? " ..." : "");
    text += positional.required ? name + "\n" : "[" + name + "]\n";
  }
  if (!command.commands.empty()) text += "\\fIsubcommand\\fR\n";
  return text;
}

std::string details(const TreeCommand& command) {
  std::string text;
  for (const TreeOption& positional : command.positionals) text += option_entry(positional, true);
  for (const TreeOption& option : command.options) text += option_entry(option, false);
  if (!command.footer.empty()) text += ".PP\n.nf\n" + roff(command.footer) + "\n.fi\n";
  return text;
}

}  // namespace

std::string man_page(const TreeCommand& tree, const std::string& version) {
  std::string text = fmt::format(".TH RILO 1 \"\" \"rilo {}\" \"User commands\"\n", version);
  text += ".SH NAME\nrilo \\- " + roff(tree.help) + "\n.SH SYNOPSIS\n" + synopsis(tree);
  text += ".SH OPTIONS\n" + details(tree) + ".SH SUBCOMMANDS\n";
  for (const TreeCommand* command : flattened(tree)) {
    if (command == &tree) continue;
    text +=
        ".SS " + roff(command->path) + "\n" + roff(command->help) + "\n.PP\n" + synopsis(*command) + details(*command);
  }
  return text;
}

}  // namespace rilo::cli
