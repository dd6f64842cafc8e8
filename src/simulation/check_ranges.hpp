#pragma once

#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace rift::simulation {

/// Holds every member of an options struct to the range its Fields states, and calls the struct's
/// own Check() when there is one. Throws std::invalid_argument with the path of the member, its
/// value and the range: an experiment built in code is refused like one read from a file.
template <class Options>
void CheckRanges(const Options& options, const std::string& path = "");

namespace check_ranges_detail {

template <class Number>
void CheckNumber(const std::string& key, Number value, double min, double max) {
  const double number = static_cast<double>(value);
  if (number >= min && number <= max) return;  // false for NaN too
  std::ostringstream message;
  message << key << " is " << value << ", but it must lie in [" << min << ", " << max << "]";
  throw std::invalid_argument(message.str());
}

struct Visitor {
  const std::string& path;

  template <class Number, class Min, class Max>
  void operator()(const char* key, const Number& value, Min min, Max max, const char*) const {
    CheckNumber(path + key, value, static_cast<double>(min), static_cast<double>(max));
  }
  template <class Min, class Max>
  void operator()(const char* key, const std::optional<double>& value, Min min, Max max,
                  const char*) const {
    if (value) CheckNumber(path + key, *value, static_cast<double>(min), static_cast<double>(max));
  }
  template <class Member>
  void operator()(const char* key, const Member& member, const char*) const {
    if constexpr (std::is_class_v<Member>) Nested(path + key, member);
  }

  template <class Member>
  static void Nested(const std::string& key, const Member& member) {
    CheckRanges(member, key + ".");
  }
  static void Nested(const std::string&, const std::string&) {}
  template <class Item>
  static void Nested(const std::string& key, const std::vector<Item>& items) {
    for (size_t i = 0; i < items.size(); ++i) Nested(key + "[" + std::to_string(i) + "]", items[i]);
  }
  template <class Item>
  static void Nested(const std::string& key, const std::map<std::string, Item>& items) {
    for (const auto& [name, item] : items) Nested(key + "." + name, item);
  }
};

}  // namespace check_ranges_detail

template <class Options>
void CheckRanges(const Options& options, const std::string& path) {
  Options::Fields(options, check_ranges_detail::Visitor{path});
  if constexpr (requires { options.Check(); }) options.Check();
}

}  // namespace rift::simulation
