#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <concepts>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rift/yaml/describe.hpp"
#include "rift/yaml/fields.hpp"
#include "rift/yaml/node.hpp"
#include "rift/yaml/scalar.hpp"
#include "rift/yaml/suggest.hpp"

namespace rift::yaml {

/// Lets a tree's values into a struct of fields (see fields.hpp), over what it holds already:
/// keys that are not written keep their value, maps of blocks are merged entry by entry, lists are
/// replaced. Throws Error, and then leaves the struct alone, for: an unknown key, a wrong type, a
/// number that is not finite or out of range, an unknown enum value, a missing required key, and
/// what the struct's own Check() refuses.
template <Block S>
void Bind(const Node& node, S& out);

/// Sets the one value with this full key (as ListKeys lists them; a nested struct's key works
/// too), with the checks of Bind; the rules of every struct around it are checked again. Throws
/// Error and then leaves `out` alone; an unknown key is named with its nearest. ResolveKey makes
/// full keys of short ones.
template <Block S>
void SetValue(S& out, std::string_view key, const Node& value);

struct KeyValue {
  std::string key;
  Node value;
};

/// Sets several values before any rule between fields is checked, so that v_min and v_max can move
/// together past each other's old value.
template <Block S>
void SetValues(S& out, const std::vector<KeyValue>& values);

/// The keys that a block knows, and where to look for one that was written in the wrong block.
struct KnownKeys {
  std::vector<std::string> here;
  const std::vector<std::string>& anywhere;  ///< full dotted keys
};

/// Throw Error unless the node is of that kind.
void RequireMap(const Node& node, const Place& place);
void RequireList(const Node& node, const Place& place);

/// Throws Error for an unknown key: names the nearest known one, here or elsewhere, or all here.
[[noreturn]] void FailUnknown(const Node::Entry& entry, std::string_view path,
                              const KnownKeys& known);
/// Throws Error when a key that must be written is not.
void RequireKey(const Node& block, std::string_view path, std::string_view key);

/// Throws Error for a rule between fields: where the key stands that the rule names, of several the
/// one written last (--set over files over the block's first file); the block where it names none.
/// With the block's key, what is proposed, and the other sources of these values.
[[noreturn]] void FailRule(const Node& block, std::string_view path,
                           const std::invalid_argument& broken, const std::string& proposal = "");

/// A block with a name, Choice(), that has to be one of Choices(), which the file may extend.
template <class S>
concept Choosing = requires(const S& block) {
  { block.Choice() } -> std::convertible_to<std::string>;
  { block.Choices() } -> std::convertible_to<std::vector<std::string>>;
};

/// The choice nearest to one that is none; empty for one of them, and where none is near.
template <class S>
std::string Proposal(const S& block) {
  if constexpr (Choosing<S>) {
    const std::string nearest = Nearest(block.Choice(), block.Choices());
    return nearest == block.Choice() ? "" : nearest;
  }
  return "";
}

/// Runs the block's own rules, if it has any. `node` is where the block was written.
template <class S>
void CheckRules(const S& block, const Node& node, std::string_view path) {
  if constexpr (Checked<S>) {
    try {
      block.Check();
    } catch (const std::invalid_argument& broken) {
      FailRule(node, path, broken, Proposal(block));
    }
  }
}

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

/// Looks for the member with a full key and binds it.
class Setter {
 public:
  Setter(const Binder& binder, std::string_view key, const Node& value, bool check_rules)
      : binder_(binder), key_(key), value_(value), check_rules_(check_rules) {}

  /// True when the key named something in this block, which is at `path`.
  template <Block S>
  bool IntoBlock(S& block, std::string_view path) const {
    bool is_set = false;
    VisitFields(block, [&](const FieldInfo& field, auto& member) {
      is_set = is_set || Into(member, PlaceOf(field, path));
    });
    if (is_set && check_rules_) CheckRules(block, value_, path);
    return is_set;
  }

 private:
  template <class T>
  bool Into(T& member, const Place& place) const {
    if (place.key == key_) {
      binder_.Value(value_, place, member);
      return true;
    }
    if (!key_.starts_with(place.key)) return false;
    if constexpr (Block<T>) {
      return IntoBlock(member, place.key);
    } else if constexpr (kIsBlockMap<T>) {
      for (auto& [name, entry] : member) {
        if (Into(entry, {Join(place.key, name), {}, place.help})) return true;
      }
    } else if constexpr (kIsVector<T>) {
      for (std::size_t i = 0; i < member.size(); ++i) {
        if (Into(member[i], {fmt::format("{}[{}]", place.key, i), place.range, place.help})) {
          return true;
        }
      }
    }
    return false;
  }

  const Binder& binder_;
  std::string_view key_;
  const Node& value_;
  bool check_rules_;
};

template <Block S>
void Bind(const Node& node, S& out) {
  S bound = out;
  Node root = node;
  if (root.IsNull()) root.kind = Node::Kind::kMap;
  Binder(ListKeys(out)).BlockOf(root, {}, bound);
  out = std::move(bound);
}

template <Block S>
void SetValues(S& out, const std::vector<KeyValue>& values) {
  S changed = out;
  const std::vector<std::string> keys = ListKeys(out);
  const Binder binder(keys);
  for (const bool check_rules : {false, true}) {
    for (const auto& [key, value] : values) {
      const bool is_set = Setter(binder, key, value, check_rules).IntoBlock(changed, "");
      if (!is_set) Fail(value, key, "no such key; " + KeyHint(key, keys));
    }
  }
  out = std::move(changed);
}

template <Block S>
void SetValue(S& out, std::string_view key, const Node& value) {
  SetValues(out, {{std::string(key), value}});
}

/// `a.b.c` -> a, b, c; nothing when a part is empty (then the key is no path).
std::vector<std::string> SplitPath(std::string_view key);

/// True when `key` is `<something>.<end>`.
bool EndsAtPart(std::string_view key, std::string_view end);

/// Adds an entry to a map; dots in its key open nested maps, which join those already there.
/// `path` is that of the map, for messages. Throws Error when a value is already there.
void AddAtPath(Node& map, Node::Entry entry, const std::string& path);

/// The same for a key taken as it is, dots and all.
void AddLiteral(Node& map, Node::Entry entry, const std::string& path);

[[noreturn]] void FailDuplicate(std::string_view key, const Origin& first, const Origin& second);

}  // namespace rift::yaml
