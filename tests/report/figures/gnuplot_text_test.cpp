#include "rift/report/figures/gnuplot_text.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <set>

namespace rift::report {
namespace {

TEST_CASE("A text of more letters than its limit keeps its begin and its end, letters whole") {
  CHECK(Shortened("abcdefgh", 8) == "abcdefgh");
  CHECK(Shortened("abcdefghi", 8) == "abcd…ghi");
  CHECK(Shortened("abcdefghi", 7) == "abc…ghi");
  CHECK(Shortened("Straße über", 11) == "Straße über");
  CHECK(Shortened("äöüäöüäöü", 5) == "äö…öü");
  CHECK(LetterCount("äöü€a") == 5);
  CHECK(LetterCount("") == 0);
}

TEST_CASE("Labels that are alike when cut are cut where they differ, or else numbered") {
  using Texts = std::vector<std::string>;
  CHECK(ShortenedApart({"abcdefghi", "ab", "abcdefghi"}, 7) == Texts{"abc…ghi", "ab", "abc…ghi"});
  const std::string path = "floors_2026/run_", file = "_monday/heightfield.png";
  CHECK(ShortenedApart({path + "A" + file, "flat", path + "B" + file}, 32) ==
        Texts{"…026/run_A_monda…heightfield.png", "flat", "…026/run_B_monda…heightfield.png"});
  const std::string begin(40, 'a'), end(40, 'z');
  const Texts ends = ShortenedApart({begin + "ä" + end, begin + "ö" + end}, 16);
  CHECK(ends == Texts{"…aaaäzzz…zzzzzzz", "…aaaözzz…zzzzzzz"});
  CHECK(ShortenedApart({"a\tb", "a b"}, 32) == Texts{"a b", "a b (2)"});
}

TEST_CASE("Control characters are blanks and bytes that are no text are replaced") {
  CHECK(PlainText("a\x1f\tb\x7f~ c") == "a  b ~ c");
  CHECK(PlainText("x\xffy") == "x\xEF\xBF\xBDy");
  CHECK(PlainText("a\uFFFE\uFFFFb") == "a\uFFFD\uFFFDb");  // which no SVG file may hold
  CHECK(PlainText("a\uFFFD\U0001FFFEb") == "a\uFFFD\U0001FFFEb");
  CHECK(Quoted("it's 5 %") == "'it''s 5 %'");
  CHECK(TicLabel({"5 %", "it's"}) == "'5 %%'.\"\\n\".'it''s'");
}

TEST_CASE("An axis ends at the next of eleven round numbers of its decade") {
  CHECK(AxisEnd(0.0) == 1.0);
  CHECK(AxisEnd(-1.0) == 1.0);
  CHECK(AxisEnd(NAN) == 1.0);
  const std::vector<double> rounds{1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0};
  for (const double decade : {0.001, 0.1, 1.0, 1000.0}) {
    for (size_t i = 0; i < rounds.size(); ++i) {
      INFO(rounds[i] << " x " << decade);
      CHECK(AxisEnd(rounds[i] * decade) == Approx(rounds[i] * decade));
      if (i > 0) CHECK(AxisEnd(1.001 * rounds[i - 1] * decade) == Approx(rounds[i] * decade));
    }
  }
}

TEST_CASE("Up to eight series have colours of their own, more take even steps of viridis") {
  std::set<std::string> eight;
  for (int i = 0; i < 8; ++i) eight.insert(SeriesColour(i, 8));
  CHECK(eight.size() == 8);
  CHECK(SeriesColour(0, 8) == "#0072B2");
  CHECK(SeriesColour(1, 8) == "#E69F00");
  CHECK(SeriesColour(7, 8) == "#999999");
  CHECK(SeriesColour(0, 9) == "#440154");
  CHECK(SeriesColour(8, 9) == "#FDE725");
  CHECK(SeriesColour(4, 9) == "#21918C");
  CHECK(SeriesColour(8, 18) == "#21918C");
  CHECK(SeriesColour(17, 18) == "#FDE725");
  const std::string palette = ViridisPalette();
  CHECK(palette.find("(0 '#440154', 1 '#472D7B', 2 '#3B528B'") != palette.npos);
  CHECK(palette.find(", 8 '#FDE725')\n") != palette.npos);
}

TEST_CASE(
    "The left margin widens as far as a slanted label reaches, to half of the figure at most") {
  const auto margin = [](size_t labels, size_t letters, double first) {
    return SlantedMargin(std::vector<size_t>(labels, letters),
                         {.first = first, .width_px = 490, .left_px = 55.0, .right_px = 15.0});
  };
  CHECK(margin(4, 17, 0.6).empty());
  // 5.4 px a letter, 31 of them, of which 0.15 of the plot (475 px less the margin) take some.
  CHECK(margin(4, 30, 0.6) == "set lmargin at screen 0.2309\n");
  CHECK(margin(4, 30, 0.5) == "set lmargin at screen 0.2520\n");
  CHECK(margin(20, 80, 0.6) == "set lmargin at screen 0.5000\n");
  CHECK(SlantedMargin({30, 1, 1, 1}, {0.6, 490, 55.0, 15.0}) == margin(4, 30, 0.6));
  CHECK(SlantedMargin({1, 1, 1, 30}, {0.6, 490, 55.0, 15.0}).empty());
}

TEST_CASE("Rows of a data block are numbers of seven digits, and what is none is NaN") {
  DataBlock block("name");
  CHECK(block.IsEmpty());
  block.Add({1.0 / 3.0, 12345678.0, NAN});
  block.Add({-HUGE_VAL, 0.0});
  CHECK_FALSE(block.IsEmpty());
  CHECK(block.Text() == "$name << EOD\n0.3333333 1.234568e+07 NaN \nNaN 0 \nEOD\n");
  CHECK(Number(0.0600000001) == "0.06");
  CHECK(Number(1234567.0) == "1.23457e+06");
  CHECK(ThresholdLine(0.06) ==
        "0.06 with lines lw 1.2 dt 2 lc rgb '#000000' title 'threshold 0.06 m'");
}

TEST_CASE("Near the end of an axis a label takes ten times what it lacks and no more") {
  // The last of twenty tics is at 0.98 of 475 px: 465.5 px. 88 letters of 5.4 px have 480.6.
  std::vector<size_t> letters(20, 1);
  letters.back() = 88;
  CHECK(SlantedMargin(letters, {0.6, 490, 55.0, 15.0}) == "set lmargin at screen 0.3082\n");
  letters.back() = 86;
  CHECK(SlantedMargin(letters, {0.6, 490, 55.0, 15.0}).empty());
}

}  // namespace
}  // namespace rift::report
