#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "rift/yaml/block_rules.hpp"
#include "rift/yaml/describe.hpp"
#include "rift/yaml/fields.hpp"
#include "rift/yaml/node.hpp"
#include "rift/yaml/scalar.hpp"

namespace rift::yaml {

/// Lets a tree's values into a struct of fields (see fields.hpp), over what it holds already:
/// keys that are not written keep their value, maps of blocks are merged entry by entry, lists are
/// replaced. Throws Error, and then leaves the struct alone, for: an unknown key, a wrong type, a
/// number that is not finite or out of range, an unknown enum value, a missing required key, and
/// what the struct's own Check() refuses.
template <Block S>
void Bind(const Node& node, S& out);

/// Binds one value of any member type.
class Binder {
 public:
  /// `all_keys` are the full keys of the whole schema, for suggestions.
  explicit Binder(std::vector<std::string> all_keys) : all_keys_(std::move(all_keys)) {}

  template <class T>
  void Value(const Node& node, const Place& place, T& out) const {
    if constexpr (Hooked<T>) {
      ByHand(node, place, out);
    } else if constexpr (Block<T>) {
      BlockOf(node, place, out);
    } else if constexpr (kIsBlockMap<T>) {
      RequireMap(node, place);
      for (const Node::Entry& entry : node.entries) {
        const bool is_new = out.find(entry.key) == out.end();
        const Place inner{Join(place.key, entry.key), {}, place.help};
        BlockOf(entry.value, inner, out[entry.key], is_new);
      }
    } else if constexpr (kIsVector<T>) {
      List(node, place, out);
    } else {
      Scalar(node, place, out);
    }
  }

  /// `whole`: every required key must be written; else only those that are there are read.
  template <Block S>
  void BlockOf(const Node& node, const Place& place, S& out, bool whole = true) const {
    RequireMap(node, place);
    KnownKeys known{{}, all_keys_};
    VisitFields(out, [&](const FieldInfo& field, auto&) { known.here.emplace_back(field.key); });
    for (const Node::Entry& entry : node.entries) {
      const bool is_known =
          std::find(known.here.begin(), known.here.end(), entry.key) != known.here.end();
      if (!is_known) FailUnknown(entry, place.key, known);
    }
    if constexpr (requires { S::kRequired; }) {
      for (const std::string_view key : S::kRequired) {
        if (whole) RequireKey(node, place.key, key);
      }
    }
    VisitFields(out, [&](const FieldInfo& field, auto& member) {
      const Node::Entry* entry = node.Find(field.key);
      if (entry != nullptr) Value(entry->value, PlaceOf(field, place.key), member);
    });
    CheckRules(out, node, place.key);
  }

 private:
  template <class T>
  void ByHand(const Node& node, const Place& place, T& out) const {
    try {
      out = Hook<T>::FromNode(node);
    } catch (const std::invalid_argument& broken) {
      Fail(node, place.key, broken.what());
    }
  }

  template <class T>
  void List(const Node& node, const Place& place, std::vector<T>& out) const {
    RequireList(node, place);
    std::vector<T> items(node.items.size());
    for (std::size_t i = 0; i < items.size(); ++i) {
      const Place inner{fmt::format("{}[{}]", place.key, i), place.range, place.help};
      Value(node.items[i], inner, items[i]);
    }
    out = std::move(items);
  }

  static void Scalar(const Node& node, const Place& at, double& out) { out = ReadDouble(node, at); }
  static void Scalar(const Node& node, const Place& at, int& out) { out = ReadInt(node, at); }
  static void Scalar(const Node& node, const Place& at, bool& out) { out = ReadBool(node, at); }
  static void Scalar(const Node& node, const Place& at, std::uint64_t& out) {
    out = ReadUint64(node, at);
  }
  static void Scalar(const Node& node, const Place& at, std::string& out) {
    out = ReadText(node, at);
  }
  static void Scalar(const Node& node, const Place& at, std::optional<double>& out) {
    if (node.IsNull()) {
      out.reset();
    } else {
      out = ReadDouble(node, at);
    }
  }
  template <Enumerated E>
  static void Scalar(const Node& node, const Place& at, E& out) {
    const auto names = EnumNames(E{});
    out = static_cast<E>(ReadName(node, at, names));
  }

  std::vector<std::string> all_keys_;
};

template <Block S>
void Bind(const Node& node, S& out) {
  S bound = out;
  Node root = node;
  if (root.IsNull()) root.kind = Node::Kind::kMap;
  Binder(ListKeys(out)).BlockOf(root, {}, bound);
  out = std::move(bound);
}

}  // namespace rift::yaml
