#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "rift/yaml/fields.hpp"
#include "rift/yaml/suggest.hpp"
#include "rift/yaml/write.hpp"

namespace rift::yaml {

/// One line of the list of keys.
struct KeyInfo {
  std::string key;   ///< dotted; `waypoints[].x_m` and `surfaces.<name>.friction` are patterns
  std::string type;  ///< `number in [0, 1]`, `none | start | se2`, ...
  std::string default_text;  ///< as it would be written; empty for patterns
  std::string help;
};

/// Every key of a schema, its values being the defaults, in the order of Fields.
template <Block S>
std::vector<KeyInfo> Describe(const S& defaults = {});

/// Every full key that SetValue knows for this very struct: leaves, whole lists and maps, and the
/// entries that it holds (`waypoints[0].x_m`, `surfaces.ground.friction`).
template <Block S>
std::vector<std::string> ListKeys(const S& block);

/// The same among the keys of a struct.
template <Block S>
std::string ResolveKey(std::string_view name, const S& block) {
  return ResolveKey(name, ListKeys(block));
}

/// The value under a key that ListKeys lists as a tree, the counterpart of SetValue; quoted where
/// it is a text. Throws Error for any other key.
template <Block S>
Node GetValue(const S& block, std::string_view key);

inline std::string ListTypeText(std::string_view item) {
  return item == "block" ? "list of blocks" : fmt::format("list, each {}", item);
}

inline std::string NumberTypeText(std::string_view noun, const std::optional<Range>& range) {
  return range ? fmt::format("{} {}", noun, RangeText(*range)) : std::string(noun);
}

template <class T>
std::string TypeText(const std::optional<Range>& range) {
  if constexpr (Hooked<T>) {
    if constexpr (requires { Hook<T>::kTypeText; }) return std::string(Hook<T>::kTypeText);
    return "see the documentation";
  } else if constexpr (kIsBlockMap<T>) {
    return "blocks by name";
  } else if constexpr (kIsVector<T>) {
    return ListTypeText(TypeText<typename T::value_type>(range));
  } else if constexpr (Enumerated<T>) {
    return fmt::format("{}", fmt::join(EnumNames(T{}), " | "));
  } else if constexpr (std::is_same_v<T, bool>) {
    return "true | false";
  } else if constexpr (std::is_same_v<T, std::string>) {
    return "text";
  } else if constexpr (std::is_same_v<T, std::optional<double>>) {
    return NumberTypeText("number", range) + ", or null";
  } else if constexpr (Block<T>) {
    return "block";
  } else {
    return NumberTypeText(std::is_same_v<T, double> ? "number" : "whole number", range);
  }
}

/// Walks a struct and those in it; the visitor gets (path, FieldInfo, member) for each member that
/// is not itself a nested struct. `patterns` visits one example of lists and maps of blocks under
/// `[]` and `<name>`; without it, the entries that are there.
template <Block S, class Visit>
void WalkKeys(const S& block, const std::string& path, bool patterns, const Visit& visit) {
  VisitFields(block, [&](const FieldInfo& field, const auto& member) {
    using T = std::remove_cvref_t<decltype(member)>;
    const std::string key = Join(path, field.key);
    if constexpr (Block<T>) {
      WalkKeys(member, key, patterns, visit);
    } else {
      visit(key, field, member);
    }
    if constexpr (kIsBlockMap<T>) {
      if (patterns) WalkKeys(typename T::mapped_type{}, key + ".<name>", patterns, visit);
      for (const auto& [name, entry] : member) {
        if (!patterns) WalkKeys(entry, Join(key, name), patterns, visit);
      }
    } else if constexpr (kIsVector<T>) {
      if constexpr (Block<typename T::value_type>) {
        if (patterns) WalkKeys(typename T::value_type{}, key + "[]", patterns, visit);
        for (std::size_t i = 0; i < member.size() && !patterns; ++i) {
          WalkKeys(member[i], fmt::format("{}[{}]", key, i), patterns, visit);
        }
      }
    }
  });
}

template <Block S>
std::vector<KeyInfo> Describe(const S& defaults) {
  std::vector<KeyInfo> keys;
  WalkKeys(defaults, "", true, [&](const std::string& key, const FieldInfo& field, const auto& m) {
    const bool is_pattern = key.find_first_of("[<") != std::string::npos;
    keys.push_back({key, TypeText<std::remove_cvref_t<decltype(m)>>(field.range),
                    is_pattern ? "" : InlineText(ValueNode(m, key)), std::string(field.help)});
  });
  return keys;
}

template <Block S>
std::vector<std::string> ListKeys(const S& block) {
  std::vector<std::string> keys;
  WalkKeys(block, "", false,
           [&](const std::string& key, const FieldInfo&, const auto&) { keys.push_back(key); });
  return keys;
}

template <Block S>
Node GetValue(const S& block, std::string_view key) {
  std::optional<Node> value;
  WalkKeys(block, "", false, [&](const std::string& at, const FieldInfo&, const auto& member) {
    if (at == key) value = ValueNode(member, at);
  });
  if (!value) throw Error(fmt::format("no such key: '{}'", key));
  return *value;
}

}  // namespace rift::yaml
