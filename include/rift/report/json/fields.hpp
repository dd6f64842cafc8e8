#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>

#include "rift/yaml/enum_name.hpp"

namespace rift::report {

/// Indented text; a file name that is no UTF-8 shows replacement characters.
std::string Dump(const nlohmann::ordered_json& json);

/// JSON has no NaN: what was not computed is null.
inline nlohmann::ordered_json NumberOrNull(double value) {
  return std::isnan(value) ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(value);
}

/// An Options struct of plain fields as a JSON object with the keys of the YAML file.
template <class Options>
nlohmann::ordered_json FieldsToJson(const Options& options) {
  nlohmann::ordered_json json;
  Options::Fields(options, [&](const char* key, const auto& value, const auto&...) {
    if constexpr (std::is_enum_v<std::remove_cvref_t<decltype(value)>>) {
      json[key] = yaml::NameOf(value);
    } else {
      json[key] = value;
    }
  });
  return json;
}

}  // namespace rift::report
