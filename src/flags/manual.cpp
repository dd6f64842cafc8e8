#include "rift/flags/manual.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>
#include <vector>

#include "rift/files/shell_word.hpp"

namespace rift::flags {
namespace {

using Words = std::vector<std::string>;

Words FlagsOf(const CLI::Option& option) {
  Words flags;
  for (const std::string& name : option.get_snames()) flags.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) flags.push_back("--" + name);
  return flags;
}

bool TakesValue(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

/// CLI11 hangs the range or the set of a validator behind the type.
std::string TypeOf(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return type.substr(0, type.find(':'));
}

/// The words that a flag takes, where its type is a list of such (`rift|tum`) and no name of a kind
/// of value (`FILE.csv|DIR`).
Words ChoicesOf(const CLI::Option& option) {
  const std::string type = TypeOf(option);
  const bool is_list =
      type.find('|') != type.npos && std::all_of(type.begin(), type.end(), [](unsigned char c) {
        return std::islower(c) != 0 || std::isdigit(c) != 0 || c == '_' || c == '|';
      });
  return is_list ? CLI::detail::split(type, '|') : Words{};
}

std::string ToRoff(const std::string& text) {
  std::string roff;
  for (const char c : text) {
    const bool begins = roff.empty() || roff.back() == '\n';
    if (begins && (c == '.' || c == '\'')) roff += "\\&";
    if (c == '\\') {
      roff += "\\e";
    } else if (c == '-') {
      roff += "\\-";
    } else {
      roff += c;
    }
  }
  return roff;
}

std::string OptionRoff(const CLI::Option& option) {
  const Words flags = FlagsOf(option);
  std::string head = flags.empty() ? option.get_name() : fmt::format("{}", fmt::join(flags, ", "));
  if (!flags.empty() && TakesValue(option)) head += " " + TypeOf(option);
  std::string help = option.get_description();
  if (!option.get_default_str().empty()) help += " [" + option.get_default_str() + "]";
  return fmt::format(".TP\n\\fB{}\\fR\n{}\n", ToRoff(head), ToRoff(help));
}

std::string OptionsRoff(const CLI::App& app) {
  std::string text;
  for (const CLI::Option* option : app.get_options()) text += OptionRoff(*option);
  return text;
}

/// Lines as they are, without filling: examples keep their shape.
std::string NotesRoff(const std::string& footer) {
  return fmt::format(".SH NOTES\n.nf\n{}\n.fi\n", ToRoff(footer));
}

/// _arguments takes brackets and colons for its own.
std::string ZshText(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

std::string ZshArgument(const CLI::Option& option, const std::string& flag) {
  std::string text = flag + "[" + ZshText(option.get_description()) + "]";
  if (!TakesValue(option)) return files::ShellQuoted(text);
  const Words choices = ChoicesOf(option);
  const std::string values =
      choices.empty() ? "_files" : fmt::format("({})", fmt::join(choices, " "));
  return files::ShellQuoted(text + ":" + ZshText(TypeOf(option)) + ":" + values);
}

/// Of the subcommand `name`; of rift itself without one.
std::string ManPage(const CLI::App& app, const std::string& name) {
  const std::string page = name.empty() ? "rift" : "rift-" + name;
  const CLI::App& shown = name.empty() ? app : *app.get_subcommand(name);
  std::string text = fmt::format(".TH {} 1 \"\" \"rift {}\" \"rift\"\n", page, RIFT_VERSION);
  text += fmt::format(".SH NAME\n{} \\- {}\n", ToRoff(page), ToRoff(shown.get_description()));
  text += name.empty() ? ".SH SYNOPSIS\n\\fBrift\\fR COMMAND [OPTIONS]\n"
                       : fmt::format(".SH SYNOPSIS\n\\fBrift {}\\fR [OPTIONS]", name);
  if (!name.empty()) {
    for (const CLI::Option* option : app.get_subcommand(name)->get_options()) {
      if (FlagsOf(*option).empty()) text += fmt::format(" [{}]", ToRoff(option->get_name()));
    }
    text += '\n';
  }
  text += ".SH OPTIONS\n" + OptionsRoff(shown);
  if (name.empty()) {
    text += ".SH COMMANDS\n";
    for (const CLI::App* command : app.get_subcommands({})) {
      text += fmt::format(".TP\n\\fBrift\\-{}\\fR(1)\n{}\n", command->get_name(),
                          ToRoff(command->get_description()));
    }
  }
  return text + NotesRoff(shown.get_footer());
}

std::string BashCompletion(const CLI::App& app) {
  Words commands;
  std::string flags, choices;
  for (const CLI::App* command : app.get_subcommands({})) {
    commands.push_back(command->get_name());
    Words all;
    for (const CLI::Option* option : command->get_options()) {
      for (const std::string& flag : FlagsOf(*option)) {
        all.push_back(flag);
        const Words words = ChoicesOf(*option);
        if (words.empty()) continue;
        choices += fmt::format("    '{} {}') words='{}' ;;\n", command->get_name(), flag,
                               fmt::join(words, " "));
      }
    }
    flags += fmt::format("      {}) words='{}' ;;\n", command->get_name(), fmt::join(all, " "));
  }
  return fmt::format(R"(# bash completion of rift; made by `rift help --bash`
_rift() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} words=
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    COMPREPLY=($(compgen -W '{} help --help --version' -- "$current"))
    return
  fi
  case "${{COMP_WORDS[1]}} ${{COMP_WORDS[COMP_CWORD - 1]}}" in
    'help help') words='{}' ;;
{}  esac
  if [[ -z $words && $current == -* ]]; then
    case ${{COMP_WORDS[1]}} in
{}    esac
  fi
  if [[ -n $words ]]; then COMPREPLY=($(compgen -W "$words" -- "$current")); fi
}}
complete -o default -F _rift rift
)",
                     fmt::join(commands, " "), fmt::join(commands, " "), choices, flags);
}

std::string ZshCompletion(const CLI::App& app) {
  std::string described, cases;
  for (const CLI::App* command : app.get_subcommands({})) {
    described += fmt::format("    {}\n", files::ShellQuoted(command->get_name() + ":" +
                                                            ZshText(command->get_description())));
    cases += fmt::format("    {})\n      _arguments \\\n", command->get_name());
    for (const CLI::Option* option : command->get_options()) {
      for (const std::string& flag : FlagsOf(*option)) {
        cases += fmt::format("        {} \\\n", ZshArgument(*option, flag));
      }
    }
    cases += "        '*:file:_files'\n      ;;\n";
  }
  return fmt::format(R"(#compdef rift
# zsh completion of rift; made by `rift help --zsh`
_rift() {{
  local -a commands
  commands=(
{}  )
  if ((CURRENT == 2)); then
    _describe command commands
    return
  fi
  local command=$words[2]
  shift words
  ((CURRENT--))
  case $command in
{}  esac
}}
_rift "$@"
)",
                     described, cases);
}

}  // namespace

std::string Manual(const Words& words, const CLI::App& app) {
  if (words.size() < 2 || words.size() > 3 || words[0] != "help") return "";
  const std::string name = words.size() == 3 ? words[2] : "";
  if (words[1] == "--man") return ManPage(app, name);
  if (words[1] == "--bash") return BashCompletion(app);
  return words[1] == "--zsh" ? ZshCompletion(app) : "";
}

}  // namespace rift::flags
