#include "number.hpp"

#include <fast_float/fast_float.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

namespace rift::trajectory::csv {
namespace {

constexpr int kMostDigits = 19;  // more need not fit 64 bits
constexpr std::array<std::uint64_t, 9> kPowersOfTen{
    1, 10, 100, 1'000, 10'000, 100'000, 1'000'000, 10'000'000, 100'000'000};

/// Exact as doubles, as are whole numbers up to 2^53: one division rounds correctly (Clinger 1990).
constexpr std::array<double, kMostDigits + 1> kExactPowersOfTen{
    1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,
    1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19};
constexpr std::uint64_t kMostExact = std::uint64_t{1} << 53;

bool IsDigit(char c) { return static_cast<unsigned char>(c - '0') < 10; }

/// The highest bit of each byte that is no digit, exact up to the first of them.
std::uint64_t NoDigits(std::uint64_t eight) {
  return ((eight + 0x4646464646464646) | (eight - 0x3030303030303030)) & 0x8080808080808080;
}

/// The number that eight digits spell, the first in the lowest byte (Lemire 2018, "Quickly parsing
/// eight digits"): neighbours are joined to pairs, these to fours, these to eight.
std::uint64_t EightDigits(std::uint64_t eight) {
  eight -= 0x3030303030303030;
  eight = eight * 10 + (eight >> 8);
  const std::uint64_t even = (eight & 0x000000FF000000FF) * 0x000F424000000064;
  const std::uint64_t odd = ((eight >> 16) & 0x000000FF000000FF) * 0x0000271000000001;
  return (even + odd) >> 32;
}

/// Appends the digits from `at` on to `digits` and returns their end.
const char* TakeDigits(const char* at, const char* end, std::uint64_t& digits) {
  while (std::endian::native == std::endian::little && end - at >= 8) {
    std::uint64_t eight;
    std::memcpy(&eight, at, 8);
    const int count = std::countr_zero(NoDigits(eight)) / 8;
    if (count == 0) return at;
    // Zeros in front take the place of what is no digit.
    if (count < 8) eight = eight << (64 - 8 * count) | 0x3030303030303030 >> (8 * count);
    digits = digits * kPowersOfTen[count] + EightDigits(eight);
    at += count;
    if (count < 8) return at;
  }
  for (; at != end && IsDigit(*at); ++at) digits = digits * 10 + (*at - '0');
  return at;
}

}  // namespace

std::from_chars_result FromChars(const char* begin, const char* end, double& value) {
  const bool negative = begin != end && *begin == '-';
  const char* const first = begin + negative;
  std::uint64_t digits = 0;
  const char* at = first;
  for (; at != end && IsDigit(*at); ++at) digits = digits * 10 + (*at - '0');
  std::int64_t after_point = 0, count = at - first;
  if (at != end && *at == '.') {
    const char* const point = at;
    at = TakeDigits(point + 1, end, digits);
    after_point = at - point - 1;
    count += after_point;
  }
  const bool exponent = at != end && (*at == 'e' || *at == 'E');
  if (count == 0 || count > kMostDigits || exponent) return std::from_chars(begin, end, value);
  if (digits <= kMostExact) {
    const double number = static_cast<double>(digits) / kExactPowersOfTen[after_point];
    value = negative ? -number : number;
    return {at, std::errc{}};
  }
  using Double = fast_float::binary_format<double>;
  const auto binary = fast_float::compute_float<Double>(-after_point, digits);
  if (binary.power2 < 0) return std::from_chars(begin, end, value);  // too close to call
  const std::uint64_t sign = std::uint64_t{negative} << 63;
  const std::uint64_t exponent_bits = static_cast<std::uint64_t>(binary.power2)
                                      << Double::mantissa_explicit_bits();
  value = std::bit_cast<double>(sign | exponent_bits | binary.mantissa);
  return {at, std::errc{}};
}

}  // namespace rift::trajectory::csv
