#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <vector>

#include "rift/yaml/decimal.hpp"
#include "rift/yaml/flag_name.hpp"

namespace rift::flags {

/// CLI::Range lets a NaN through, and what it says of a word, or of 2.5 where whole numbers are
/// meant, is not what is wrong.
template <class Number>
CLI::Validator InRange(Number min, Number max) {
  constexpr bool kIsWhole = std::is_integral_v<Number>;
  std::string range;
  if constexpr (kIsWhole) {
    range = fmt::format("[{}, {}]", min, max);
  } else {
    range = fmt::format("[{:g}, {:g}]", min, max);
  }
  return CLI::Validator(
      [min, max, range](const std::string& text) -> std::string {
        Number value = 0;
        // CLI11 takes 0x1 for 1, and 1e-400 for 0.
        const bool is_number = yaml::ReadDecimal(text, value) == std::errc();
        if (is_number && value >= min && value <= max) return "";
        return fmt::format("'{}' must be a {}number in {}", text, kIsWhole ? "whole " : "", range);
      },
      "in " + range);
}

/// Makes one flag for each field of an Options struct: the same keys, defaults, ranges and help
/// as in the YAML file. Beyond these a field can be what a file has no need of: a number that is
/// not there unless it is said, words, and what the help calls their values.
class FlagMaker {
 public:
  explicit FlagMaker(CLI::App& app) : app_(app) {}

  template <class Words>
  requires std::is_same_v<Words, std::string> || std::is_same_v<Words, std::vector<std::string>>
  void operator()(std::string_view key, Words& value, const char* type, const char* help) {
    CLI::Option* option = app_.add_option(yaml::FlagName(key).flag, value, help)->type_name(type);
    if constexpr (std::is_same_v<Words, std::string>) option->capture_default_str();
  }

  template <class Number>
  requires std::is_arithmetic_v<Number>
  void operator()(std::string_view key, Number& value, auto min, auto max, const char* type,
                  const char* help) {
    (*this)(key, value, min, max, help);
    app_.get_option(yaml::FlagName(key).flag)->type_name(type);
  }

  template <class Number>
  void operator()(std::string_view key, std::optional<Number>& value, auto min, auto max,
                  const char* type, const char* help) {
    app_.add_option(yaml::FlagName(key).flag, value, help)
        ->type_name(type)
        ->check(InRange(static_cast<Number>(min), static_cast<Number>(max)));
  }

  template <class Number>
  void operator()(std::string_view key, Number& value, auto min, auto max, const char* help) {
    const yaml::FlagName name(key);
    CLI::Option* option = app_.add_option(name.flag, value, help)
                              ->capture_default_str()
                              ->check(InRange(static_cast<Number>(min), static_cast<Number>(max)));
    if (!name.unit.empty()) option->type_name(name.unit);
  }

  void operator()(std::string_view key, bool& value, const char* help) {
    app_.add_flag(yaml::FlagName(key).flag, value, help);
  }

  template <class Enum>
  requires std::is_enum_v<Enum>
  void operator()(std::string_view key, Enum& value, const char* help) {
    const auto names = EnumNames(Enum{});
    std::string choices;
    for (const std::string_view name : names)
      choices += (choices.empty() ? "" : "|") + std::string(name);
    app_.add_option_function<std::string>(
            yaml::FlagName(key).flag,
            [&value, names](const std::string& text) {
              value =
                  static_cast<Enum>(std::find(names.begin(), names.end(), text) - names.begin());
            },
            help)
        ->check(CLI::IsMember(std::vector<std::string>(names.begin(), names.end())))
        ->type_name(choices)
        ->default_str(std::string(names[static_cast<size_t>(value)]));
  }

 private:
  CLI::App& app_;
};

template <class Options>
void AddFlags(CLI::App& app, Options& options) {
  Options::Fields(options, FlagMaker(app));
}

}  // namespace rift::flags
