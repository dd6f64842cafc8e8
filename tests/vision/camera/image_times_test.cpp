#include "vision/camera/image_times.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

namespace rift::vision {
namespace {

using Catch::Matchers::Contains;

TEST_CASE("Pictures come in natural order and the numbers in their names are their time") {
  std::vector<std::string> files{"run/frame10.jpg", "run/frame2.jpg", "run/frame1.jpg"};
  std::sort(files.begin(), files.end(), IsBefore);
  CHECK(files == std::vector<std::string>{"run/frame1.jpg", "run/frame2.jpg", "run/frame10.jpg"});
  CHECK(IsBefore("aa", "b"));
  CHECK_FALSE(IsBefore("b", "aa"));
  CHECK(IsBefore("a", "aa"));
  CHECK(IsBefore("a9b", "a10"));
  CHECK_FALSE(IsBefore("a10", "a10"));
  // 3 to 9 are missing: at 10 a second the last one is 0.9 s after the first.
  CHECK(TimesByNames(files, 10.0).back() == Approx(0.9));
  // Every tenth picture was kept: the usual step is one period.
  CHECK(TimesByNames({"a0010.png", "a0020.png", "a0040.png", "a0050.png"}, 5.0).back() ==
        Approx(0.8));
  CHECK(TimesByNames({"a.png", "b.png", "c.png"}, 4.0) == std::vector<double>{0.0, 0.25, 0.5});
}

TEST_CASE("A file of times is read by order or by name and is held to its rules") {
  const std::vector<std::string> files{"run/a.jpg", "run/b.jpg"};
  CHECK(TimesFromText("# s\n0.5\n0.75\n", "t.txt", files) == std::vector<double>{0.5, 0.75});
  CHECK(TimesFromText("b.jpg, 2\na.jpg 1\n", "t.txt", files) == std::vector<double>{1.0, 2.0});
  CHECK_THROWS_WITH(TimesFromText("0.5\nsoon\n", "t.txt", files), Contains("t.txt:2"));
  CHECK_THROWS_WITH(TimesFromText("0.5\n", "t.txt", files), Contains("no time for the picture"));
  CHECK_THROWS_WITH(TimesFromText("2\n1\n", "t.txt", files), Contains("not later"));
  for (const char* none : {"nan", "-nan", "inf", "-inf", "1e999"}) {
    INFO(none);
    CHECK_THROWS_WITH(TimesFromText("0.5\n" + std::string(none) + "\n", "t.txt", files),
                      Contains("t.txt:2") && Contains("is no time"));
  }
  CHECK(TimesFromText("\xEF\xBB\xBF"
                      "1\n2\n",
                      "t", files) == std::vector<double>{1.0, 2.0});
  CHECK_THROWS_WITH(TimesFromText("1\n2\n3\n", "t", files),
                    "t: 3 times for 2 pictures: name the pictures, as in `a.jpg 0.5`");
  CHECK_THROWS_WITH(TimesFromText("a.jpg 1\nb.jpg 2\nrun/a.jpg 1\n", "t", files),
                    "t:3: a second time for the picture run/a.jpg");
  CHECK_THROWS_WITH(TimesFromText("1\nb.jpg 2\n", "t", files),
                    Contains("t:2: times with and without a picture's name"));
  CHECK(TimesFromText("c.jpg 0\na.jpg 1\nb.jpg 2\n", "t", files) == std::vector<double>{1.0, 2.0});
}

/// Runs of digits without their leading zeros, every other character by itself.
std::vector<std::string> Words(const std::string& text) {
  std::vector<std::string> words;
  bool goes_on = false;
  for (const char c : text) {
    const bool is_digit = c >= '0' && c <= '9';
    if (!is_digit || !goes_on) words.emplace_back();
    if (words.back() == "0") words.back().clear();
    words.back() += c;
    goes_on = is_digit;
  }
  return words;
}

bool IsNumber(const std::string& word) { return word[0] >= '0' && word[0] <= '9'; }

/// Natural order by words: numbers by their size, what is left by its length.
bool ComesFirst(const std::string& a, const std::string& b) {
  const std::vector<std::string> x = Words(a), y = Words(b);
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    if (x[i] == y[i]) continue;
    if (!IsNumber(x[i]) || !IsNumber(y[i])) return x[i][0] < y[i][0];
    return std::stol(x[i]) < std::stol(y[i]);
  }
  return x.size() != y.size() ? x.size() < y.size() : a < b;
}

TEST_CASE("Natural order is that of words and numbers, and one order of all names") {
  std::mt19937 random(3);
  std::vector<std::string> names;
  for (int i = 0; i < 120; ++i) {
    std::string& name = names.emplace_back();
    for (unsigned k = 0; k < random() % 6; ++k) name += "0011289ab-"[random() % 10];
  }
  int wrong = 0;
  for (const std::string& a : names) {
    for (const std::string& b : names) {
      // Where words end within a number, its digits left count, not its words.
      if (Words(a).size() == Words(b).size()) wrong += IsBefore(a, b) != ComesFirst(a, b);
      if (a != b) wrong += IsBefore(a, b) == IsBefore(b, a);
    }
    wrong += IsBefore(a, a);
  }
  CHECK(wrong == 0);
  CHECK(IsBefore("a01", "a1"));
  CHECK(IsBefore("a01b", "a2"));
  CHECK(IsBefore("a0", "a00"));
  CHECK(IsBefore("a1-", "a1b"));
}

TEST_CASE("The last number in a name is its time, folder and ending left out") {
  const auto times_s = [](const std::vector<std::string>& files) {
    return TimesByNames(files, 10.0);
  };
  using Times = std::vector<double>;
  CHECK(times_s({"run9/a.jp2"}) == Times{0.0});
  CHECK(times_s({"run1/a.jp2", "run5/b.jp2"}) == Times{0.0, 0.1});
  CHECK(times_s({"cam2_7x.png", "cam1_9x.png", "cam1_10x.png"}) ==
        Times{0.0, 2.0 / 10.0, 3.0 / 10.0});
  CHECK(times_s({"7.png", "9.png", "9.jpg"}) == Times{0.0, 0.1, 0.2});  // they do not rise
  CHECK(times_s({"7.png", "9.png", "a.png"}) == Times{0.0, 0.1, 0.2});  // one has none
  CHECK(times_s({"12.png", "15.png", "18.png", "24.png"}) == Times{0.0, 0.1, 0.2, 0.4});
  // Clock times scatter: the median of 100, 101, 99 and 300 is one picture's.
  const Times clock = times_s({"1000.png", "1100.png", "1201.png", "1300.png", "1600.png"});
  CHECK(clock[1] == Approx(100.0 / 100.5 / 10.0));
  CHECK(clock[4] == Approx(600.0 / 100.5 / 10.0));
}

TEST_CASE("What is wrong with a file of times is said with its line, picture and numbers") {
  const std::vector<std::string> files{"run/a.jpg", "run/b.jpg"};
  using Times = std::vector<double>;
  CHECK(TimesFromText("\n  \t\r\n1 # one\n#2\n\n3\n", "t", files) == Times{1.0, 3.0});
  CHECK(TimesFromText("other/b.jpg,,2.5\r\na.jpg 1e0", "t", files) == Times{1.0, 2.5});
  const std::string rule = " is no time: seconds up to 1e+12, or a picture's name and seconds";
  CHECK_THROWS_WITH(TimesFromText("\n#\n1.5x\n", "t.txt", files), "t.txt:3: '1.5x'" + rule);
  CHECK_THROWS_WITH(TimesFromText("a.jpg b.jpg 1\n", "t", files), "t:1: 'a.jpg b.jpg 1'" + rule);
  CHECK_THROWS_WITH(TimesFromText("a.jpg one\n", "t", files), "t:1: 'a.jpg one'" + rule);
  CHECK_THROWS_WITH(TimesFromText(",\n", "t", files), "t:1: ' '" + rule);
  CHECK_THROWS_WITH(TimesFromText("1\n-1.1e12\n", "t", files), "t:2: '-1.1e12'" + rule);
  CHECK(TimesFromText("-1e12\n1e12\n", "t", files) == Times{-1e12, 1e12});
  CHECK_THROWS_WITH(TimesFromText(std::string("1\n2\0\n", 5), "t", files),
                    "t:2: a byte 0 is in the line: a list of times is a text");
  CHECK_THROWS_WITH(TimesFromText("1\n", "t", files), "t: no time for the picture run/b.jpg");
  CHECK_THROWS_WITH(TimesFromText("b.jpg 2\n", "t", files), "t: no time for the picture run/a.jpg");
  CHECK_THROWS_WITH(TimesFromText("2\n1.25\n", "t", files),
                    "t: 1.25 s of run/b.jpg is not later than 2 s of the picture before");
  CHECK_THROWS_WITH(TimesFromText("2\n2\n", "t", files), Contains("2 s of run/b.jpg is not later"));
}

TEST_CASE("The numbers that count pictures may stand before others, and may be Unix seconds") {
  const auto times_s = [](const std::vector<std::string>& files) {
    return TimesByNames(files, 10.0);
  };
  using Times = std::vector<double>;
  // Of the fourth no picture is there, whatever stands behind its number.
  const Times with_gap{0.0, 0.1, 0.3};
  CHECK(times_s({"a1_960x720.jpg", "a2_960x720.jpg", "a4_960x720.jpg"}) == with_gap);
  CHECK(times_s({"1_cam2.jpg", "2_cam2.jpg", "4_cam2.jpg"}) == with_gap);
  const Times unix_s = times_s(
      {"1700000000.900.png", "1700000001.000.png", "1700000001.300.png", "1700000001.400.png"});
  REQUIRE(unix_s.size() == 4);
  CHECK(unix_s[1] == Approx(0.1));
  CHECK(unix_s[2] == Approx(0.4));
  CHECK(AreCounted({"a1_960x720.jpg", "a2_960x720.jpg"}));
  CHECK(AreCounted({"1700000000.9.png", "1700000001.1.png"}));
  CHECK_FALSE(AreCounted({"a.png", "b.png"}));
  CHECK_FALSE(AreCounted({"10-59-59.900.png", "11-00-00.000.png", "11-00-00.100.png"}));
  CHECK_FALSE(AreCounted({"1.9.png", "2.1.png", "2.0.png"}));
  CHECK_FALSE(AreCounted({"a1_1.png", "a1.png"}));
}

TEST_CASE("A date and time in the names counts in seconds, over the end of a minute and a day") {
  const auto are = [](const std::vector<std::string>& files, double fps,
                      const std::vector<double>& expected_s) {
    const std::vector<double> times_s = TimesByNames(files, fps);
    REQUIRE(times_s.size() == expected_s.size());
    for (std::size_t i = 0; i < times_s.size(); ++i) {
      INFO(files[i]);
      CHECK(times_s[i] == Approx(expected_s[i]).margin(1e-5));
    }
  };
  are({"IMG_20261127_101558.jpg", "IMG_20261127_101559.jpg", "IMG_20261127_101600.jpg",
       "IMG_20261127_101602.jpg"},
      1.0, {0.0, 1.0, 2.0, 4.0});
  are({"20261231-235959_cam2.png", "20270101-000001_cam2.png", "20270101-000003_cam2.png"}, 4.0,
      {0.0, 0.25, 0.5});
  are({"20261127101558.jpg", "20261127101559.jpg", "20261127101600.jpg", "20261127101602.jpg"}, 1.0,
      {0.0, 1.0, 2.0, 4.0});
  are({"20261127101559800000.png", "20261127101559900000.png", "20261127101600000000.png",
       "20261127101600200000.png"},
      10.0, {0.0, 0.1, 0.2, 0.4});
  are({"PXL_20261127_101559800.jpg", "PXL_20261127_101559900.jpg", "PXL_20261127_101600000.jpg",
       "PXL_20261127_101600200.jpg"},
      10.0, {0.0, 0.1, 0.2, 0.4});
  // What is no date, and a number of nanoseconds, are counts.
  are({"20261127_000059.png", "20261127_000060.png", "20261127_000061.png", "20261127_000063.png"},
      1.0, {0.0, 1.0, 2.0, 4.0});
  are({"20261327_101558.jpg", "20261327_101559.jpg", "20261327_101600.jpg"}, 1.0, {0.0, 1.0, 42.0});
  are({"1764238559900000000.png", "1764238560000000000.png", "1764238560100000000.png"}, 10.0,
      {0.0, 0.1, 0.2});
}

TEST_CASE("Behind the point of Unix seconds digits are a fraction, however many there are") {
  const std::vector<std::string> in_order{
      "c_1699999999.9.jpg",  "c_1700000000.jpg",   "c_1700000000.05.jpg", "c_1700000000.1.jpg",
      "c_1700000000.25.jpg", "c_1700000000.5.jpg", "c_1700000000.75.jpg", "c_1700000001.0.jpg"};
  std::vector<std::string> files(in_order.rbegin(), in_order.rend());
  std::sort(files.begin(), files.end(), IsBefore);
  CHECK(files == in_order);
  CHECK(AreCounted(files));
  CHECK(IsBefore("1700000000.5a.jpg", "1700000000.50b.jpg"));
  CHECK(IsBefore("1700000000.50.jpg", "1700000000.5.jpg") !=
        IsBefore("1700000000.5.jpg", "1700000000.50.jpg"));
  // Numbers of other lengths are counts.
  CHECK(IsBefore("170000000.5.jpg", "170000000.25.jpg"));
  CHECK(IsBefore("17000000000.5.jpg", "17000000000.25.jpg"));
}

}  // namespace
}  // namespace rift::vision
