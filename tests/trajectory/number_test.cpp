#include <bit>
#include <catch2/catch.hpp>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

#include "trajectory/number.hpp"

namespace rift::trajectory::csv {
namespace {

void CheckOnce(const std::string& text) {
  INFO('\'' << text << '\'');
  double value = 7.0, expected = 7.0;
  const char *const begin = text.data(), *const end = begin + text.size();
  const auto [stop, error] = FromChars(begin, end, value);
  const auto [expected_stop, expected_error] = std::from_chars(begin, end, expected);
  REQUIRE(error == expected_error);
  REQUIRE(stop - begin == expected_stop - begin);
  REQUIRE(std::bit_cast<std::uint64_t>(value) == std::bit_cast<std::uint64_t>(expected));
}

/// At the end of a text and in the midst of one, which takes another way.
void CheckLikeTheStandard(const std::string& text) {
  CheckOnce(text);
  CheckOnce(text + ",0.25\n0.3832,0.1,2,-0.0757,12345678901234567890");
}

TEST_CASE("A number is read as the standard library reads it to the bit") {
  for (const char* text : {"",
                           "-",
                           ".",
                           "-.",
                           "0",
                           "-0",
                           "0.0",
                           "5.",
                           ".5",
                           "-.5,",
                           "+1",
                           "1e5",
                           "1e",
                           "1e-999",
                           "1e999",
                           "0x10",
                           "nan",
                           "-inf",
                           "12a",
                           "1.5.2",
                           "1,2",
                           "1\n",
                           "1\r\n",
                           "1 2",
                           "0.1",
                           "0.3832,",
                           "1234567",
                           "12345678",
                           "1.23456789012345678",
                           "9007199254740993",
                           "1e-05",
                           "0.000000000000000000000001",
                           "00000000000000000000000.5",
                           "9999999999999999999",
                           "18446744073709551616",
                           "0.9999999999999999999",
                           "0.18446744073709551616",
                           "123456789.1234567890",
                           "123456789.12345678901",
                           "1234567890.5",
                           "-0.0000000000000000001",
                           "0.1234567e3",
                           "0.12345678E-3",
                           "0.123456789012345678901234567890",
                           "0.12345678/",
                           "0.1234567:",
                           "-.",
                           "1..2",
                           "99999999999999999999",
                           "0.30000000000000004,0.1"}) {
    CheckLikeTheStandard(text);
  }
}

TEST_CASE("Random numbers in many forms are read as the standard library reads them to the bit") {
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> exponent(-8.0, 8.0), mantissa(-10.0, 10.0);
  for (int i = 0; i < 100'000; ++i) {
    const double number = mantissa(generator) * std::pow(10.0, exponent(generator));
    char buffer[64];
    const auto format = i % 2 == 0 ? std::chars_format::general : std::chars_format::fixed;
    const auto end = i % 3 == 0 ? std::to_chars(buffer, buffer + 64, number)
                                : std::to_chars(buffer, buffer + 64, number, format, i % 18);
    CheckLikeTheStandard(std::string(buffer, end.ptr) + ",\n x"[i % 4]);
  }
}

TEST_CASE("Random bytes of numbers are read as the standard library reads them to the bit") {
  constexpr std::string_view kBytes = "0123456789012345678901234567890123456789.-e,\n x";
  std::mt19937_64 generator(2);
  for (int i = 0; i < 100'000; ++i) {
    std::string text(generator() % 24, ' ');
    for (char& byte : text) byte = kBytes[generator() % kBytes.size()];
    CheckLikeTheStandard(text);
  }
}

}  // namespace
}  // namespace rift::trajectory::csv
