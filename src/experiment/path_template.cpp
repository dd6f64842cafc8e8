#include "rift/experiment/path_template.hpp"

#include <fmt/args.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "rift/yaml/scalar.hpp"

namespace rift::experiment {
namespace {

using NamedValue = std::pair<std::string, ParameterValue>;
using Arguments = fmt::dynamic_format_arg_store<fmt::format_context>;

bool IsWhole(const ParameterValue& value) {
  return value.number && *value.number == std::round(*value.number) &&
         std::abs(*value.number) < 1e15;
}

/// Without a format specification a value stands as the experiment writes it, so texts go in for
/// those; a specification needs the number, whole or not.
std::string WithPlainNamesFilled(std::string text, const std::vector<NamedValue>& values) {
  for (const auto& [name, value] : values) {
    const std::string field = "{" + name + "}";
    for (size_t at = text.find(field); at != text.npos; at = text.find(field, at)) {
      text.replace(at, field.size(), value.text);
      at += value.text.size();
    }
  }
  return text;
}

Arguments MakeArguments(const std::vector<NamedValue>& values, bool whole_as_integer) {
  Arguments arguments;
  for (const auto& [name, value] : values) {
    if (whole_as_integer && IsWhole(value)) {
      arguments.push_back(fmt::arg(name.c_str(), static_cast<long long>(*value.number)));
    } else if (value.number) {
      arguments.push_back(fmt::arg(name.c_str(), *value.number));
    } else {
      arguments.push_back(fmt::arg(name.c_str(), value.text));
    }
  }
  return arguments;
}

std::string KnownNames(const std::vector<NamedValue>& values) {
  std::string names;
  for (const auto& [name, value] : values) names += (names.empty() ? "" : ", ") + name;
  return names;
}

/// What stands between the braces: `v_min:.2f`.
std::vector<std::string> Fields(const std::string& path_template) {
  std::vector<std::string> fields;
  size_t at = 0;
  while ((at = path_template.find_first_of("{}", at)) != path_template.npos) {
    const size_t end = path_template.find_first_of("{}", at + 1);
    if (path_template[at] == '}' || end == path_template.npos || path_template[end] == '{') {
      throw std::invalid_argument(
          fmt::format("path '{}' has a brace without its partner", path_template));
    }
    fields.push_back(path_template.substr(at + 1, end - at - 1));
    at = end + 1;
  }
  return fields;
}

std::string NameOf(const std::string& field) { return field.substr(0, field.find(':')); }

/// Nothing when its specification does not fit the value.
std::optional<std::string> Filled(const std::string& text, const std::vector<NamedValue>& values) {
  // `{trial:03d}` asks for an integer: the second round.
  for (const bool whole_as_integer : {false, true}) {
    try {
      return fmt::vformat(text, MakeArguments(values, whole_as_integer));
    } catch (const fmt::format_error&) {
    }
  }
  return std::nullopt;
}

/// The field that does not fit its value, and that value, for a message.
std::string Culprit(const std::string& path_template, const std::vector<NamedValue>& values) {
  for (const std::string& field : Fields(path_template)) {
    if (Filled("{" + field + "}", values)) continue;
    const auto named = std::find_if(values.begin(), values.end(), [&](const auto& value) {
      return value.first == NameOf(field);
    });
    return fmt::format("{{{}}} does not fit '{}'", field, named->second.text);
  }
  return "its fields do not go together";
}

}  // namespace

std::vector<std::string> TemplateNames(const std::string& path_template) {
  std::vector<std::string> names;
  for (const std::string& field : Fields(path_template)) names.push_back(NameOf(field));
  return names;
}

std::string FillTemplate(const std::string& path_template, const std::vector<Parameter>& parameters,
                         const std::vector<ParameterValue>& theta, const std::string& trial) {
  std::vector<NamedValue> values;
  for (size_t i = 0; i < parameters.size(); ++i) {
    values.emplace_back(parameters[i].Name(), theta[i]);
  }
  values.emplace_back("trial", ParameterValue{trial, yaml::NumberOf(trial)});
  for (const std::string& name : TemplateNames(path_template)) {
    const auto has_name = [&](const NamedValue& value) { return value.first == name; };
    if (std::none_of(values.begin(), values.end(), has_name)) {
      throw std::invalid_argument(fmt::format("path '{}' names {{{}}}, and the space has only {}",
                                              path_template, name, KnownNames(values)));
    }
  }
  const std::optional<std::string> path =
      Filled(WithPlainNamesFilled(path_template, values), values);
  if (path) return *path;
  throw std::invalid_argument(fmt::format("path '{}' cannot be filled in: {}", path_template,
                                          Culprit(path_template, values)));
}

}  // namespace rift::experiment
