#include "rift/hardware/wire.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace rift::hardware {
namespace {

void Flip(CommandBytes& bytes, size_t bit) {
  bytes[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
}

constexpr size_t kBits = 8 * CommandFrame::kSize;

TEST_CASE("A plain line is what the authors' format string prints of the hundredth towards zero") {
  const auto hundredth = [](int milli) {
    return std::copysign(std::abs(milli) / 10 / 100.0, static_cast<double>(milli));
  };
  for (int left = -1000; left <= 1000; left += 7) {
    for (int right = -1000; right <= 1000; right += 61) {
      char expected[32];
      std::snprintf(expected, sizeof expected, "%.2f %.2f\n", hundredth(left), hundredth(right));
      REQUIRE(PlainLine({left / 1000.0, right / 1000.0}) == expected);
    }
  }
}

TEST_CASE("A power outside of its range is refused and never made to fit") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {1.0000001, -1.01, 85.0, nan, HUGE_VAL, -HUGE_VAL}) {
    CHECK_THROWS_AS(PlainLine({bad, 0.0}), std::invalid_argument);
    CHECK_THROWS_AS(PlainLine({0.0, bad}), std::invalid_argument);
    CHECK_THROWS_AS(MilliOf({0.0, bad}), std::invalid_argument);
  }
}

TEST_CASE("A plain line that lost one byte is understood only where it lost its sign") {
  for (const std::string line : {"0.85 0.90", "-0.85 0.90", "1.00 -1.00", "0.00 0.00"}) {
    REQUIRE(ParsePlainLine(line));
    for (size_t lost = 0; lost < line.size(); ++lost) {
      std::string cut = line;
      cut.erase(lost, 1);
      INFO(cut);
      CHECK(ParsePlainLine(cut).has_value() == (line[lost] == '-'));
    }
  }
}

TEST_CASE("What is not exactly two numbers of two decimals in range is no plain line") {
  for (const char* bad : {"",
                          " ",
                          "85 0.90",
                          "0.8 0.90",
                          "0.850.90",
                          "1.01 0.00",
                          "9.99 0.00",
                          "nan nan",
                          "inf 0.00",
                          "0.85  0.90",
                          "0.85 0.90 ",
                          " 0.85 0.90",
                          "0.85 0.90\r",
                          "+0.85 0.90",
                          "0.85,0.90",
                          "--0.85 0.90",
                          "0.85 0.900",
                          "1e-1 0.00",
                          "0.85",
                          "0.85 ",
                          "OK+LOST",
                          "0.85 0.900.80 0.9"}) {
    INFO(bad);
    CHECK_FALSE(ParsePlainLine(bad));
  }
  CHECK(ParsePlainLine("-0.85 1.00") == MilliPower{-850, 1000});
}

TEST_CASE("Each character of a plain line must be the one that belongs there") {
  const std::string line = "-0.85 1.00";
  REQUIRE(ParsePlainLine(line) == MilliPower{-850, 1000});
  for (size_t at = 1; at < line.size(); ++at) {
    for (const char other :
         {'/', ':', ',', 'x', ' ', '.', '-'}) {  // around the digits, and between
      if (other == line[at]) continue;
      std::string wrong = line;
      wrong[at] = other;
      INFO(wrong);
      CHECK_FALSE(ParsePlainLine(wrong));
    }
  }
}

TEST_CASE("A frame and an answer have their own start, length and every byte of their CRC") {
  const CommandBytes command = Encode(CommandFrame{7, {300, -200}});
  REQUIRE(DecodeCommand(command));
  const AnswerBytes answer = Encode(Answer{9, 3, -123456, 2147483647, 5021, 255});
  REQUIRE(DecodeAnswer(answer));
  const auto check_lengths = [](const auto& bytes, const auto& decode) {
    std::vector<std::uint8_t> longer(bytes.begin(), bytes.end());
    longer.push_back(Crc8(Bytes(longer)));  // the last byte is right
    CHECK_FALSE(decode(Bytes(longer)));
    for (size_t length = 0; length < bytes.size(); ++length) {
      std::vector<std::uint8_t> cut(bytes.begin(), bytes.begin() + static_cast<long>(length));
      if (length > 1) cut.back() = Crc8(Bytes(cut).first(length - 1));
      CHECK_FALSE(decode(Bytes(cut)));
    }
  };
  check_lengths(command, [](Bytes bytes) { return DecodeCommand(bytes).has_value(); });
  check_lengths(answer, [](Bytes bytes) { return DecodeAnswer(bytes).has_value(); });
  for (size_t at = 0; at < answer.size(); ++at) {
    for (int bit = 0; bit < 8; ++bit) {
      AnswerBytes wrong = answer;
      wrong[at] ^= static_cast<std::uint8_t>(1 << bit);
      CHECK_FALSE(DecodeAnswer(wrong));
      if (at > 0) continue;
      wrong.back() = Crc8(Bytes(wrong).first(wrong.size() - 1));  // another start, rightly sealed
      CHECK_FALSE(DecodeAnswer(wrong));
    }
  }
}

TEST_CASE("Every command comes out of its frame as it went in") {
  for (int left = -1000; left <= 1000; left += 13) {
    for (int right = -1000; right <= 1000; right += 17) {
      const CommandFrame frame{static_cast<std::uint8_t>(left * right), {left, right}};
      const auto decoded = DecodeCommand(Encode(frame));
      REQUIRE(decoded);
      REQUIRE(decoded->power == frame.power);
      REQUIRE(decoded->sequence == frame.sequence);
    }
  }
}

TEST_CASE("Frames and answers are these bytes: numbers from their low byte on, then the CRC") {
  const auto hex = [](const auto& bytes) {
    std::string text;
    for (const std::uint8_t byte : bytes) text += fmt::format("{:02x}", byte);
    return text;
  };
  // Worked out by struct.pack of Python.
  CHECK(hex(Encode(CommandFrame{7, {300, -200}})) == "a5072c0138ffd3fec7008f");
  CHECK(hex(Encode(Answer{9, 3, -2, 66051, 5021, 255})) == "5a0903feffffff030201009d13ff7a");
  CHECK(AnswerLine(Answer{{}, 4, -2, 66051, 5021, 6}) == "rift1 -2 66051 5021*60\n");
}

TEST_CASE("Powers are rounded to the nearest thousandth, and one beyond full is told by its side") {
  CHECK(MilliOf({0.1234, -0.5678}) == MilliPower{123, -568});
  CHECK(MilliOf({-0.0006, 0.0004}) == MilliPower{-1, 0});
  CHECK_THROWS_WITH(MilliOf({1.25, -0.5}), "the left power is 1.25, but it must lie in [-1, 1]");
  CHECK_THROWS_WITH(MilliOf({0.5, -1.5}), "the right power is -1.5, but it must lie in [-1, 1]");
  CHECK_THROWS_WITH(PlainLine({-1.125, 0.0}),
                    "the left power is -1.125, but it must lie in [-1, 1]");
  CHECK_THROWS_WITH(PlainLine({0.25, 1.0625}),
                    "the right power is 1.0625, but it must lie in [-1, 1]");
}

TEST_CASE("CRC-8 gives the check value of its catalogue entry") {
  const std::string digits = "123456789";
  CHECK(Crc8(Bytes(reinterpret_cast<const std::uint8_t*>(digits.data()), digits.size())) == 0xF4);
}

TEST_CASE("No command frame with up to three wrong bits is taken") {
  const CommandBytes good = Encode(CommandFrame{77, {123, -456}});
  for (size_t a = 0; a < kBits; ++a) {
    CommandBytes one = good;
    Flip(one, a);
    REQUIRE_FALSE(DecodeCommand(one));
    for (size_t b = a + 1; b < kBits; ++b) {
      CommandBytes two = one;
      Flip(two, b);
      REQUIRE_FALSE(DecodeCommand(two));
      for (size_t c = b + 1; c < kBits; ++c) {
        CommandBytes three = two;
        Flip(three, c);
        REQUIRE_FALSE(DecodeCommand(three));
      }
    }
  }
}

TEST_CASE("Of all frames with four wrong bits hardly any changes a power unseen") {
  const CommandBytes good = Encode(CommandFrame{77, {123, -456}});
  size_t changed = 0, patterns = 0;
  for (size_t a = 0; a < kBits; ++a)
    for (size_t b = a + 1; b < kBits; ++b)
      for (size_t c = b + 1; c < kBits; ++c)
        for (size_t d = c + 1; d < kBits; ++d) {
          CommandBytes bytes = good;
          for (const size_t bit : {a, b, c, d}) Flip(bytes, bit);
          ++patterns;
          const auto taken = DecodeCommand(bytes);
          changed += taken && !(taken->power == MilliPower{123, -456});
        }
  CHECK(patterns == 2'331'890);
  CHECK(changed * 50'000 < patterns);
}

TEST_CASE("No frame of random bytes is taken as a command") {
  std::mt19937_64 random(11);
  for (int i = 0; i < 1'000'000; ++i) {
    CommandBytes bytes;
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    bytes[0] = CommandFrame::kStart;
    REQUIRE_FALSE(DecodeCommand(bytes));
  }
}

TEST_CASE("An answer comes back as it was said in both languages") {
  const Answer answer{9, 3, -123456, 2147483647, 5021, 255};
  CHECK(DecodeAnswer(Encode(answer)) == answer);
  const std::string line = AnswerLine(answer);
  const auto said = ParseAnswerLine(std::string_view(line).substr(0, line.size() - 1));
  REQUIRE(said);
  CHECK(said->left == answer.left);
  CHECK(said->right == answer.right);
  CHECK(said->battery_mv == answer.battery_mv);
}

TEST_CASE("An answer with one wrong character is not believed") {
  const std::string line = AnswerLine(Answer{{}, 0, 12, -7, 5021, 0});
  for (size_t i = 0; i + 1 < line.size(); ++i) {
    std::string wrong = line.substr(0, line.size() - 1);
    wrong[i] ^= 1;
    INFO(wrong);
    CHECK_FALSE(ParseAnswerLine(wrong));
    CHECK_FALSE(ParseAnswerLine(line.substr(0, i)));
  }
}

}  // namespace
}  // namespace rift::hardware
