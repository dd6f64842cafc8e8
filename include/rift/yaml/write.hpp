#pragma once

#include <string>
#include <type_traits>

#include <fmt/format.h>

#include "rift/yaml/fields.hpp"
#include "rift/yaml/node.hpp"
#include "rift/yaml/scalar.hpp"

namespace rift::yaml {

/// Canonical YAML: maps as blocks, short lists of scalars on one line, text quoted only when it
/// must be. Parse(Emit(node)) is the same tree, in which every scalar has the same text and is a
/// number, a truth value or neither as before, and emits the same bytes.
/// Throws Error for text that is not UTF-8.
std::string Emit(const Node& node);

/// The value on one line, for tables: `[0.1, 0.2]`, `start`, `3 blocks`.
std::string InlineText(const Node& node);

/// A member of a struct as a tree; `key` names it in messages.
template <class T>
Node ValueNode(const T& value, const std::string& key);

/// A struct of fields as a tree of all its values, keys in the order of Fields. Each entry carries
/// its help as the comment that Emit writes, when asked for. Throws Error for a number that is not
/// finite: it could not be read back.
template <Block S>
Node ToNode(const S& block, bool with_help = false, const std::string& path = {}) {
  Node map = Node::Map();
  VisitFields(block, [&](const FieldInfo& field, const auto& member) {
    const std::string key = Join(path, field.key);
    if constexpr (Block<std::remove_cvref_t<decltype(member)>>) {
      map.Add(std::string(field.key), ToNode(member, with_help, key));
    } else {
      map.Add(std::string(field.key), ValueNode(member, key));
    }
    if (with_help) map.entries.back().comment = field.help;
  });
  return map;
}

template <class T>
Node ValueNode(const T& value, const std::string& key) {
  if constexpr (Hooked<T>) {
    return Hook<T>::ToNode(value);
  } else if constexpr (Block<T>) {
    return ToNode(value, false, key);
  } else if constexpr (kIsBlockMap<T>) {
    Node map = Node::Map();
    for (const auto& [name, entry] : value) map.Add(name, ToNode(entry, false, Join(key, name)));
    return map;
  } else if constexpr (kIsVector<T>) {
    Node list = Node::List();
    for (const auto& item : value) list.items.push_back(ValueNode(item, key));
    return list;
  } else if constexpr (std::is_same_v<T, std::optional<double>>) {
    return value ? Node::Scalar(NumberText(*value, key)) : Node{};
  } else if constexpr (std::is_same_v<T, double>) {
    return Node::Scalar(NumberText(value, key));
  } else if constexpr (std::is_same_v<T, bool>) {
    return Node::Scalar(value ? "true" : "false");
  } else if constexpr (Enumerated<T>) {
    return Node::Text(std::string(EnumNames(value).at(static_cast<std::size_t>(value))));
  } else if constexpr (std::is_same_v<T, std::string>) {
    return Node::Text(value);
  } else {
    static_assert(std::is_integral_v<T>, "a member type that the schema does not know");
    return Node::Scalar(fmt::format("{}", value));
  }
}

}  // namespace rift::yaml
