#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "rift/hardware/options.hpp"
#include "rift/yaml/fields.hpp"

namespace rift::test {

/// Text that YAML readers like to misread, or a few random characters, some beyond ASCII.
inline std::string RandomText(std::mt19937_64& random) {
  static const std::array<std::string, 34> kNasty{
      "",      "true",        "1.0",  "a: b", "#x",    " lead", "trail ", "two\nlines",
      "null",  "~",           "0x10", "1e3",  "-",     "- a",   "[a",     "{v_min:.2f}.csv",
      "größe", "路径",        "\t",   "\\n",  "\"q\"", "'",     "a #b",   "../data/x.csv",
      "no",    "1:30",        "a,b",  "*a",   "&a",    "!t",    "%d",     "2024-01-01",
      "\r\n",  "\xE2\x80\xA8"};
  static const std::array<std::string, 12> kLetters{"a", "B", "_", "7", ".",  " ",
                                                    ":", "-", "ü", "#", "\"", "\xF0\x9F\xA4\x96"};
  if (random() % 2 == 0) return kNasty[random() % kNasty.size()];
  std::string text;
  for (std::size_t left = random() % 9; left > 0; --left) {
    text += kLetters[random() % kLetters.size()];
  }
  return text;
}

/// A number of the range, often an end of it, of any size when the range is open.
inline double RandomNumber(const yaml::Range& range, std::mt19937_64& random) {
  constexpr double kWide = 1e300;
  const double min = std::max(range.min, -kWide);
  const double max = std::min(range.max, kWide);
  const std::uint64_t choice = random() % 8;
  if (choice == 0) return min;
  if (choice == 1) return max;
  const double share = std::uniform_real_distribution<double>(0.0, 1.0)(random);
  if (max - min > 1e6) {  // spread over the orders of magnitude
    const double size = std::pow(10.0, std::uniform_real_distribution<double>(-9.0, 9.0)(random));
    return std::clamp(share < 0.5 ? size : -size, min, max);
  }
  return std::clamp(min + share * (max - min), min, max);
}

template <class S>
void RandomFill(S& block, std::mt19937_64& random);

/// A random value of a member. Hooked types stay as they are.
template <class T>
void RandomValue(T& value, const std::optional<yaml::Range>& range, std::mt19937_64& random) {
  using yaml::Range;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if constexpr (yaml::Hooked<T>) {
    return;
  } else if constexpr (yaml::Block<T>) {
    RandomFill(value, random);
  } else if constexpr (yaml::kIsBlockMap<T>) {
    // An entry of the defaults cannot be taken away by a file, so none is taken away here.
    for (std::size_t more = random() % 3; more > 0; --more) value[RandomText(random)];
    for (auto& [name, entry] : value) RandomFill(entry, random);
  } else if constexpr (yaml::kIsVector<T>) {
    const std::size_t most = random() % 8 == 0 ? 60 : 5;
    value.assign(random() % most, typename T::value_type{});
    for (auto& item : value) RandomValue(item, range, random);
  } else if constexpr (std::is_same_v<T, std::optional<double>>) {
    value.reset();
    if (random() % 3 != 0) RandomValue(value.emplace(), range, random);
  } else if constexpr (std::is_same_v<T, double>) {
    value = RandomNumber(range.value_or(Range{-kInfinity, kInfinity}), random);
  } else if constexpr (std::is_same_v<T, int>) {
    using Limits = std::numeric_limits<int>;
    const Range ends = range.value_or(Range{Limits::min(), Limits::max()});
    const double whole = std::floor(RandomNumber(ends, random));
    value = static_cast<int>(std::clamp(whole, std::ceil(ends.min), std::floor(ends.max)));
  } else if constexpr (std::is_same_v<T, bool>) {
    value = random() % 2 == 0;
  } else if constexpr (yaml::Enumerated<T>) {
    value = static_cast<T>(random() % EnumNames(value).size());
  } else if constexpr (std::is_same_v<T, std::string>) {
    value = RandomText(random);
  } else {
    static_assert(std::is_same_v<T, std::uint64_t>);
    value = random() >> (random() % 64);
  }
}

template <class S>
bool KeepsItsRules(const S& block) {
  if constexpr (yaml::Checked<S>) {
    try {
      block.Check();
    } catch (const std::invalid_argument&) {
      return false;
    }
  }
  return true;
}

/// What chance never meets: a line format of a robot with both powers in it.
inline void KeepFormat(hardware::PlainOptions& plain, std::mt19937_64& random) {
  constexpr std::array kFormats{"{left:.2f} {right:.2f}\n", "M {left:d},{right:d}\r\n",
                                "<{right:+.1f}|{left:+.1f}>\r"};
  plain.format = kFormats[random() % kFormats.size()];
  // A middle that whole numbers can write, and steps of 0.05 of full power and less.
  const double middle = std::floor(RandomNumber({-5e5, 5e5}, random));
  const double half = std::floor(RandomNumber({20.0, 5e5}, random));
  plain.range = {middle - half, middle + half};
}

/// Gives every member of a struct of fields a random value that its schema allows: within its
/// range, and such that Check() of each struct holds. Throws std::runtime_error when the rules are
/// too narrow to be met by chance.
template <class S>
void RandomFill(S& block, std::mt19937_64& random) {
  const S untouched = block;
  for (int attempt = 0; attempt < 10'000; ++attempt) {
    block = untouched;
    yaml::VisitFields(block, [&](const yaml::FieldInfo& field, auto& member) {
      RandomValue(member, field.range, random);
    });
    if constexpr (std::is_same_v<S, hardware::PlainOptions>) KeepFormat(block, random);
    if (KeepsItsRules(block)) return;
  }
  throw std::runtime_error("no random struct keeps the rules of its Check()");
}

}  // namespace rift::test
