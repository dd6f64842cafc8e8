// What is said of logs in no dialect or in a wrong one, whole lines with their numbers.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "rift/trajectory/log.hpp"
#include "rift/trajectory/read_options.hpp"
#include "trajectory/columns.hpp"

namespace rift::trajectory {
namespace {

std::string Refusal(const std::string& text, const ReadOptions& options = {}) {
  try {
    ReadLog(text, "a.csv", options);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST_CASE("A log for evo has eight columns") {
  const ReadOptions tum{.format = Format::kTum};
  CHECK(Refusal("0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n", tum) == "accepted");
  CHECK(Refusal("0 0 0 0 0 0 1\n1 1 0 0 0 0 1\n", tum) ==
        "a.csv:1: 7 columns, and tum has 8: t tx ty tz qx qy qz qw");
  CHECK(Refusal("# c\n0 0 0 0 0 0 0 1 9\n", tum) ==
        "a.csv:2: 9 columns, and tum has 8: t tx ty tz qx qy qz qw");
  // Of nine columns or of words none is taken for one.
  CHECK_THAT(Refusal("0 0 0 0 0 0 0 1 9\n1 1 0 0 0 0 0 1 9\n"),
             Catch::Contains("belongs to no dialect"));
  const Log log = ReadLog("0\t1  2 3\t0 0 1 0\n1 4 5 6 0 0 0 1\n", "a.csv");
  CHECK(log.format == Format::kTum);
  CHECK(log.trajectory.poses[0].y_m == 2.0);
  CHECK(log.trajectory.poses[0].z_m == 3.0);
  CHECK(std::abs(log.trajectory.poses[0].yaw_rad) == Approx(std::numbers::pi));
}

TEST_CASE("A header of no dialect is told with what each one needs and how columns are named") {
  CHECK(Refusal("p,q,r\n1,x,3\n2,y,4\n", {.columns_flag = "--real-columns "}) ==
        "a.csv:1: the header 'p,q,r' belongs to no dialect: it needs t_s,x_m,y_m (rift), t,x,y "
        "(tracker, webots) or eight columns without header (tum); name its columns: "
        "--real-columns 't=...,x=...,y=...,yaw=...:deg'");
  CHECK(Refusal("\ntime,posx,posy\n1,0,3\n2,1,4\n") ==
        "a.csv:2: the header 'time,posx,posy' belongs to no dialect: it needs t_s,x_m,y_m (rift), "
        "t,x,y (tracker, webots) or eight columns without header (tum); is it this? --columns "
        "'t=time,x=posx,y=posy'");
  // Each of three columns makes a dialect; two of them make none.
  for (const char* header : {"t_s,x_m", "x_m,y_m", "t_s,y_m", "t,x", "x,y", "t,y"}) {
    INFO(header);
    CHECK_THAT(Refusal(std::string(header) + "\n1,2\n2,4\n"),
               Catch::Contains("belongs to no dialect"));
  }
}

TEST_CASE("A pose without a height is told with its time and what would give it one") {
  CHECK(
      Refusal("t_s,x_m,y_m\n0.5,0,0\n1,1,0\n",
              {.columns_flag = "--sim-columns ", .in_space = true}) ==
      "a.csv: the pose at 0.5 s has no height z, and a gap in space (dimension xyz) needs it: log "
      "z_m, or name its column: --sim-columns t=...,x=...,y=...,z=..., or leave dimension at xy");
  CHECK(Refusal("t,x,y,z\n0.5,0,0,1\n1,1,0,1\n", {.in_space = true}) ==
        "a.csv: the pose at 0.5 s has no height z, and a gap in space (dimension xyz) needs it: "
        "name its format, tracker or webots, since its header does not tell which way z points, "
        "or leave dimension at xy");
}

TEST_CASE("Columns or units beside a format are refused, whichever of them is given") {
  const std::string says =
      "columns and units are of a log in no dialect, and a format is one: leave out either";
  const std::string log = "t_s,x_m,y_m\n0,0,0\n1,1,0\n";
  CHECK(Refusal(log, {.format = Format::kRift, .columns = "t=t_s,x=x_m,y=y_m"}) == says);
  CHECK(Refusal(log, {.format = Format::kRift, .units = "mm"}) == says);
  CHECK(Refusal(log, {.format = Format::kRift}) == "accepted");
}

TEST_CASE("Poses seconds apart are told with the flag that names the unit of their times") {
  const auto doubts = [](const std::string& header, const ReadOptions& options) {
    std::string text = header + "\n";
    for (int i = 0; i < 40; ++i) text += fmt::format("{},{},{}\n", 5 * i, 0.3 * i, 0.01 * i * i);
    return ReadLog(text, "a.csv", options).doubts;
  };
  using Lines = std::vector<std::string>;
  const std::string says =
      "its poses are 5 s apart: are its times in ms, us or ns? name the unit, as in ";
  CHECK(doubts("t_s,x_m,y_m", {.columns_flag = "--sim-columns "}) ==
        Lines{says + "--sim-columns 't=...:ms,x=...,y=...'"});
  CHECK(doubts("t,x,y", {.columns_flag = "--sim-columns "}) == Lines{says + "--sim-units ms"});
  CHECK(doubts("t,x,y", {.columns_flag = "--columns ", .own_columns_flag = "--real-columns "}) ==
        Lines{says + "--real-units ms"});
}

TEST_CASE("A column of text far down a log is not looked at, and up to there it is no number") {
  // Two thousand rows tell what columns hold.
  const auto guess = [](int text_row) {
    std::string text = "time,x,y,z\n";
    for (int i = 1; i <= 2002; ++i) {
      text += fmt::format("{:.3f},{:.4f},{:.5f},{}\n", 0.05 * i, 0.001 * i, 1e-7 * i * i,
                          i == text_row ? "low" : "0.5");
    }
    return GuessColumns(text, "a.csv", "").columns;
  };
  CHECK(guess(2000) == "t=time,x=x,y=y");
  CHECK(guess(2001) == "t=time,x=x,y=y,z=z");
}

TEST_CASE("Of many columns that may be the place six are named") {
  std::string header = "time", row;
  for (int i = 1; i <= 8; ++i) header += fmt::format(",x_{0}a,y_{0}a", i);
  for (int i = 0; i < 16; ++i) row += fmt::format(",{}", i + 0.5);
  const ColumnGuess guess = GuessColumns(header + "\n1" + row + "\n2" + row + "\n", "a.csv", "");
  CHECK(guess.columns.empty());
  CHECK(guess.unclear ==
        "; x may be x_1a or x_2a or x_3a or x_4a or x_5a or x_6a, y may be y_1a or y_2a or y_3a or "
        "y_4a or y_5a or y_6a");
}

}  // namespace
}  // namespace rift::trajectory
