#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "rift/yaml/bind.hpp"

namespace rift::yaml {

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

}  // namespace rift::yaml
