#pragma once

#include <concepts>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "rift/yaml/node.hpp"
#include "rift/yaml/scalar.hpp"

/// What a struct must have to be a schema. The engine knows a struct by its `Fields` alone:
///
///   struct GapOptions {
///     int samples = 2000;
///     template <class Self, class Visitor>
///     static void Fields(Self& self, Visitor&& field) {
///       field("samples", self.samples, 2, 10'000'000, "evenly spaced values of u");
///     }
///     // Optional, rules between fields; throws std::invalid_argument:
///     void Check() const;
///     // Optional, keys that a written block must have:
///     static constexpr std::array<std::string_view, 1> kRequired{"samples"};
///   };
///
/// Members: double, int, std::optional<double> and std::vector<double> with (min, max, help);
/// std::uint64_t, bool, std::string, enums with EnumNames, std::vector<std::string>, nested
/// structs, std::vector<struct>, std::map<std::string, struct> and hooked types with (help).
namespace rift::yaml {

struct FieldInfo {
  std::string_view key;
  std::optional<Range> range;
  std::string_view help;
};

/// How a type that is no struct of fields is read and written by hand. Either give the type
/// `static T FromNode(const Node&)` and `Node ToNode() const`, or, where its room may not include
/// config, specialize Hook<T> with the same two as static functions of the specialization. What
/// FromNode throws as std::invalid_argument gets file:line:column, key and value in front; with
/// Fail() it can point at a part. `static constexpr std::string_view kTypeText` describes the
/// values in the list of keys (else "see the documentation"). A written value replaces the default.
template <class T>
struct Hook {};

template <class T>
requires requires(const Node& node, const T& value) {
  { T::FromNode(node) } -> std::same_as<T>;
  { value.ToNode() } -> std::same_as<Node>;
}
struct Hook<T> {
  static T FromNode(const Node& node) { return T::FromNode(node); }
  static Node ToNode(const T& value) { return value.ToNode(); }
  static constexpr std::string_view kTypeText = [] {
    if constexpr (requires { T::kTypeText; }) return std::string_view(T::kTypeText);
    return std::string_view("see the documentation");
  }();
};

/// A member of type Node keeps its tree as written.
template <>
struct Hook<Node> {
  static Node FromNode(const Node& node) { return node; }
  static Node ToNode(const Node& value) { return value; }
};

template <class T>
concept Hooked = requires(const Node& node, const T& value) {
  { Hook<T>::FromNode(node) } -> std::same_as<T>;
  { Hook<T>::ToNode(value) } -> std::same_as<Node>;
};

template <class T>
concept Block = std::is_class_v<T> && !Hooked<T> && requires(T & value) {
  T::Fields(value, [](auto&&...) {});
};

template <class T>
concept Enumerated = std::is_enum_v<T> && requires(T value) {
  EnumNames(value);
};

template <class T>
concept Checked = requires(const T& value) {
  value.Check();
};

template <class T>
inline constexpr bool kIsVector = false;
template <class T>
inline constexpr bool kIsVector<std::vector<T>> = true;

template <class T>
inline constexpr bool kIsBlockMap = false;
template <Block T>
inline constexpr bool kIsBlockMap<std::map<std::string, T>> = true;

/// Calls visit(FieldInfo, member) for every member of a block, in order.
template <class S, class Visit>
requires Block<std::remove_const_t<S>>
void VisitFields(S& block, Visit&& visit) {
  std::remove_const_t<S>::Fields(
      block, [&visit](std::string_view key, auto& member, const auto&... about) {
        static_assert(sizeof...(about) == 1 || sizeof...(about) == 3,
                      "field(key, member, help) or field(key, member, min, max, help)");
        if constexpr (sizeof...(about) == 1) {
          visit(FieldInfo{key, std::nullopt, about...}, member);
        } else {
          const auto ranged = [&](auto min, auto max, std::string_view help) {
            const Range range{static_cast<double>(min), static_cast<double>(max)};
            visit(FieldInfo{key, range, help}, member);
          };
          ranged(about...);
        }
      });
}

/// The place of a field below `path`.
inline Place PlaceOf(const FieldInfo& field, std::string_view path) {
  return {Join(path, field.key), field.range, std::string(field.help)};
}

}  // namespace rift::yaml
