#include "number.hpp"

#include <fast_float/fast_float.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace rift::trajectory::csv {
namespace {

/// The digits that eight bytes begin with, as a number.
struct Digits {
  std::uint64_t value;
  int count;
};

/// All eight bytes in one go: a branch for each digit is what a long number costs most.
Digits DigitsAt(const char* at) {
  constexpr std::uint64_t kZeros = 0x3030303030303030, kTops = 0x8080808080808080;
  const std::uint64_t text = fast_float::read_u64(at);
  // The top bit of a byte that is no digit is set, as in is_made_of_eight_digits_fast. Carries run
  // away from the first of these bytes.
  const std::uint64_t others = ((text + 0x4646464646464646) | (text - kZeros)) & kTops;
  const int count = std::countr_zero(others) / 8;
  const int half_bits = 4 * (8 - count);  // twice, since a shift by 64 is not defined
  const std::uint64_t padded = ((text - kZeros) << half_bits << half_bits) + kZeros;
  return {fast_float::parse_eight_digits_unrolled(padded), count};
}

bool IsDigit(char c) { return '0' <= c && c <= '9'; }

/// A decimal of up to 19 digits without exponent, as nearly every cell of a log is; fast_float
/// rounds it. Nothing for any other, and near the end of the text.
const char* ReadPlain(const char* begin, const char* end, double& value) {
  constexpr std::ptrdiff_t kLongest = 40, kMostWhole = 9;
  constexpr std::array<std::uint64_t, 9> kPowers{1,       10,        100,        1'000,      10'000,
                                                 100'000, 1'000'000, 10'000'000, 100'000'000};
  if (end - begin < kLongest) return nullptr;
  const bool is_negative = *begin == '-';
  const char *const whole = begin + is_negative, *at = whole;
  std::uint64_t digits = 0;
  while (IsDigit(*at) && at - whole < kMostWhole) digits = 10 * digits + (*at++ - '0');
  if (at == whole) return nullptr;
  const std::ptrdiff_t leading = digits == 0 ? 0 : at - whole;
  int decimals = 0;
  if (*at == '.') {
    for (int block = 0; block < 3 && decimals == 8 * block; ++block) {
      const Digits next = DigitsAt(at + 1 + decimals);
      digits = digits * kPowers[next.count] + next.value;
      decimals += next.count;
    }
    at += 1 + decimals;
  }
  const bool goes_on = IsDigit(*at) || *at == 'e' || *at == 'E';
  if (goes_on || leading + decimals > 19) return nullptr;
  using Double = fast_float::binary_format<double>;
  const auto rounded = fast_float::compute_float<Double>(-decimals, digits);
  if (rounded.power2 < 0) return nullptr;
  const auto sign = static_cast<std::uint64_t>(is_negative);
  const auto exponent = static_cast<std::uint64_t>(rounded.power2);
  value = std::bit_cast<double>(sign << 63 | exponent << 52 | rounded.mantissa);
  return at;
}

}  // namespace

std::from_chars_result FromChars(const char* begin, const char* end, double& value) {
  if (const char* const stop = ReadPlain(begin, end, value)) return {stop, std::errc{}};
  double read = 0.0;
  const auto [stop, error] = fast_float::from_chars(begin, end, read);
  // The edges of the range are told in another way: the standard has the last word there.
  const bool is_plain = error == std::errc{} && std::isfinite(read) && read != 0.0;
  if (!is_plain) return std::from_chars(begin, end, value);
  value = read;
  return {stop, error};
}

}  // namespace rift::trajectory::csv
