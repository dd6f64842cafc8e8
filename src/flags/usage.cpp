#include "rift/flags/usage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "rift/yaml/suggest.hpp"

namespace rift::flags {
namespace {

using Words = std::vector<std::string>;

Words FlagsOf(const CLI::App& app) {
  Words flags;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) flags.push_back("--" + name);
  }
  return flags;
}

/// What an option takes, in words: its type's name without the range.
std::string TypeOf(const CLI::Option& option) {
  std::string type = option.get_type_name();
  type.resize(std::min(type.find(':'), type.size()));
  if (type == "INT" || type == "UINT") return "a whole number";
  if (type == "FLOAT") return "a number";
  return type.empty() || type == "TEXT" ? "a value" : type;
}

std::string ValueProblem(const std::string& value) {
  if (value.empty()) {
    return "its value is empty: give one, or leave it out (is a variable of the shell not set?)";
  }
  if (value == "~" || value.starts_with("~/")) {
    return fmt::format(
        "'{}': the shell replaces ~ neither within quotes nor after =: write $HOME{}", value,
        value.substr(1));
  }
  return "";
}

/// The option that CLI11's message begins with, or null.
const CLI::Option* OptionIn(const std::string& message, const CLI::App& command) {
  const std::string name = message.substr(0, message.find_first_of(": "));
  const CLI::Option* option = command.get_option_no_throw(name);
  return option != nullptr ? option : command.get_option_no_throw("--" + name);
}

/// `--seed` without its number, `--seed 1 --seed 2`, `--compare A`, `--view=yes`.
std::string MismatchError(const CLI::App& command, const std::string& message,
                          const std::string& help) {
  const CLI::Option* option = OptionIn(message, command);
  if (option == nullptr) return message + help;
  const std::string name = option->get_name();
  const int least = option->get_items_expected_min(), most = option->get_items_expected_max();
  const int given = static_cast<int>(option->count());
  if (most == 0) return fmt::format("{} takes no value: leave out what follows ={}", name, help);
  if (given == 0) return fmt::format("{} needs its value, {}{}", name, TypeOf(*option), help);
  if (given > most && most == 1) {
    return fmt::format("{} is given {} times: give it once{}", name, given, help);
  }
  return fmt::format("{} takes {} values, {}, and {} {} given{}", name,
                     given < least ? least : most, TypeOf(*option), given,
                     given == 1 ? "is" : "are", help);
}

/// `--samples 1e3` where a whole number is needed, `--square 25mm`.
std::string ConversionError(const CLI::App& command, const std::string& message,
                            const std::string& help) {
  const std::string begin = "Could not convert: ";
  if (!message.starts_with(begin)) return message + help;
  const CLI::Option* option = OptionIn(message.substr(begin.size()), command);
  if (option == nullptr) return message + help;
  std::string type = option->get_type_name();
  type.resize(std::min(type.find(':'), type.size()));
  const bool is_whole = type == "INT" || type == "UINT";
  return fmt::format("{}: '{}' must be a {}{}", option->get_name(),
                     fmt::join(option->results(), " "), is_whole ? "whole number" : "number",
                     is_whole || type == "FLOAT" ? "" : ", in " + type + " and without a unit");
}

}  // namespace

void RefuseEmptyValues(CLI::App& subcommand, const ValueRules& rules) {
  const auto is_among = [](const CLI::Option& option, const Words& names) {
    return std::any_of(names.begin(), names.end(),
                       [&](const std::string& name) { return option.check_name(name); });
  };
  for (CLI::Option* option : subcommand.get_options()) {
    const bool is_flag = option->get_items_expected_max() == 0;
    if (is_flag) option->disable_flag_override();
    if (is_flag || is_among(*option, rules.with_own_rule)) continue;
    // A pattern has to be quoted, and its reader replaces the ~.
    const bool may_be_pattern = is_among(*option, rules.patterns);
    option->transform(CLI::Validator(
        [may_be_pattern](std::string& value) {
          return may_be_pattern && !value.empty() ? "" : ValueProblem(value);
        },
        ""));
  }
}

void Refuse(std::initializer_list<WrongUse> uses) {
  for (const WrongUse& use : uses) {
    if (use.is_given) throw std::invalid_argument(use.message);
  }
}

void Exclude(CLI::App& app, const char* flag, std::initializer_list<const char*> others) {
  for (const char* other : others) app.get_option(flag)->excludes(app.get_option(other));
}

void RequireSubcommand(const std::string& word, Words names) {
  if (std::find(names.begin(), names.end(), word) != names.end()) return;
  names.emplace_back("help");
  const std::string nearest = yaml::Nearest(word, names);
  throw std::invalid_argument(
      nearest.empty()
          ? fmt::format("'{}' is no subcommand; there are {}", word, fmt::join(names, ", "))
          : fmt::format("'{}' is no subcommand; did you mean '{}'?", word, nearest));
}

std::string UsageError(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  const CLI::App& command = chosen.empty() ? app : *chosen.front();
  const std::string name = chosen.empty() ? "rift" : "rift " + command.get_name();
  const std::string help = fmt::format("; {} --help lists what it takes", name);
  const std::string message = error.what();
  if (dynamic_cast<const CLI::ValidationError*>(&error) != nullptr) return message;
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
    return MismatchError(command, message, help);
  }
  if (dynamic_cast<const CLI::ConversionError*>(&error) != nullptr) {
    return ConversionError(command, message, help);
  }
  const Words extras = app.remaining(true);
  if (extras.empty()) return message + help;
  const auto is_flag = [](const std::string& word) { return word.starts_with("-"); };
  const auto flag = std::find_if(extras.begin(), extras.end(), is_flag);
  if (flag == extras.end()) {
    const bool is_pattern = extras.size() > 1;  // that the shell has replaced by its files
    return is_pattern
               ? fmt::format(
                     "'{}' and {} more are too many arguments for {}; a pattern such "
                     "as 'run/*.jpg' needs its quotes",
                     extras.front(), extras.size() - 1, name)
               : fmt::format("'{}' is one argument too many for {}{}", extras.front(), name, help);
  }
  const std::string word = flag->substr(0, flag->find('='));
  const std::string nearest = yaml::Nearest(word, FlagsOf(command));
  return nearest.empty() ? fmt::format("{} has no flag {}{}", name, word, help)
                         : fmt::format("{} has no flag {}; did you mean {}?", name, word, nearest);
}

}  // namespace rift::flags
