#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "rift/geometry/pose2.hpp"
#include "rift/trajectory/log.hpp"
#include "support/inputs/trials.hpp"

namespace rift::trajectory {
namespace {

using geometry::kPi;

/// Three turns of a circle in the authors' columns, or a straight drive.
std::string Drive(bool turning, double yaw_unit, double pitch) {
  std::string text = "t,x,y,z,roll,pitch,yaw\n";
  for (int i = 0; i < 90; ++i) {
    const double yaw_rad = turning ? 0.2 * i : 0.01;
    const double x_m = turning ? std::sin(yaw_rad) : 0.02 * i;
    text += fmt::format("{},{},{},0.8,0,{},{}\n", 0.05 * i, x_m, turning ? std::cos(yaw_rad) : 0.0,
                        pitch, geometry::WrapToPi(yaw_rad) * yaw_unit);
  }
  return text;
}

std::vector<std::string> Notes(const std::string& text, Format format) {
  return ReadLog(text, "log.csv", format).notes;
}

TEST_CASE("Degrees in a log of radians are noted") {
  const std::vector<std::string> of_pitch = Notes(Drive(false, 1.0, -33.7), Format::kWebots);
  REQUIRE(of_pitch.size() == 1);
  CHECK(of_pitch[0] == "a pitch of 33.7 rad looks like degrees: is it a tracker log?");
  const std::vector<std::string> of_yaw = Notes(Drive(true, 180.0 / kPi, 0.0), Format::kWebots);
  REQUIRE(of_yaw.size() == 1);
  CHECK(of_yaw[0].starts_with("a yaw of 17"));
  const std::string rift = "t_s,x_m,y_m,roll_rad\n0,0,0,6\n1,1,0,";
  CHECK(Notes(rift + "7\n", Format::kAuto).size() == 1);
  CHECK(Notes(rift + "6.2\n", Format::kAuto).empty());
}

TEST_CASE("An unwrapped yaw in radians is not taken for degrees") {
  std::string text = "t_s,x_m,y_m,yaw_rad\n";
  for (int i = 0; i < 200; ++i) text += fmt::format("{},{},0,{}\n", i, i, 0.5 * i);
  CHECK(Notes(text, Format::kRift).empty());
  CHECK(Notes(Drive(true, 1.0, 0.0), Format::kWebots).empty());
}

TEST_CASE("Radians in a log of degrees are noted when the path turns") {
  const std::vector<std::string> notes = Notes(Drive(true, 1.0, 0.1), Format::kTracker);
  REQUIRE(notes.size() == 1);
  CHECK(notes[0].ends_with("looks like radians: is it a webots log?"));
  CHECK(Notes(Drive(true, 180.0 / kPi, 0.1), Format::kTracker).empty());
  CHECK(Notes(Drive(false, 180.0 / kPi, 0.1), Format::kTracker).empty());
}

TEST_CASE("Every published log is noted in the wrong dialect and not in its own") {
  RIFT_SKIP_WITHOUT_TRIALS();
  for (const test::TrialPair& pair : test::PublishedPairs()) {
    INFO(pair.real.string());
    const std::string real = test::ReadFile(pair.real), webots = test::ReadFile(pair.webots);
    CHECK(Notes(real, Format::kTracker).empty());
    CHECK(Notes(webots, Format::kWebots).empty());
    CHECK(Notes(real, Format::kWebots).size() == 1);
    CHECK(Notes(webots, Format::kTracker).size() == 1);
  }
}

TEST_CASE("A yaw beyond a turn is in degrees where it steps by more than half a turn") {
  const auto notes = [](double step_rad, double last_rad) {
    std::string text = "t_s,x_m,y_m,yaw_rad\n";
    for (int i = 0; step_rad * i <= last_rad; ++i) {
      text += fmt::format("{},{},0,{}\n", i, i, step_rad * i);
    }
    return Notes(text, Format::kRift);
  };
  CHECK(notes(3.1, 60.0).empty());
  CHECK(notes(3.2, 60.0).size() == 1);
  CHECK(notes(3.2, 6.5).size() == 1);
  CHECK(notes(3.2, 6.2).empty());
  CHECK(notes(3.0, 990.0).empty());
  REQUIRE(notes(3.0, 1010.0).size() == 1);  // no robot turns 159 times
  CHECK(notes(3.0, 1010.0)[0] == "a yaw of 1008.0 rad looks like degrees: is it a tracker log?");
}

TEST_CASE("Roll and pitch are each held against a turn") {
  for (const char* angle : {"roll", "pitch"}) {
    const auto notes = [&](double largest) {
      return Notes(fmt::format("t_s,x_m,y_m,{}_rad\n0,0,0,0\n1,1,0,{}\n", angle, largest),
                   Format::kRift);
    };
    CHECK(notes(6.25).empty());
    CHECK(notes(-6.25).empty());
    REQUIRE(notes(-6.3).size() == 1);
    CHECK(notes(6.3)[0] ==
          fmt::format("a {} of 6.3 rad looks like degrees: is it a tracker log?", angle));
  }
}

/// Legs of the authors' columns at these directions, in steps of 1 cm.
std::vector<std::string> NotesOfLegs(const std::vector<double>& directions_rad, int rows,
                                     double angle) {
  std::string text = "t,x,y,z,roll,pitch,yaw\n";
  double x_m = 0.0, y_m = 0.0;
  for (int i = 0; i < rows; ++i) {
    const auto leg = static_cast<size_t>(i) * directions_rad.size() / static_cast<size_t>(rows);
    text += fmt::format("{},{:.9f},{:.9f},0.8,0,0,{}\n", 0.05 * i, x_m, y_m, angle);
    x_m += 0.01 * std::cos(directions_rad[leg]);
    y_m += 0.01 * std::sin(directions_rad[leg]);
  }
  return Notes(text, Format::kTracker);
}

TEST_CASE(
    "A path that turns by more than 0.15 rad, both ways together, has no yaw within 3 degrees") {
  for (const double side : {1.0, -1.0}) {
    CHECK(NotesOfLegs({0.0, side * 0.14}, 60, 2.0).empty());
    REQUIRE(NotesOfLegs({0.0, side * 0.16}, 60, 2.0).size() == 1);
    CHECK(NotesOfLegs({0.0, side * 0.16}, 60, 2.0)[0] ==
          "the path turns and no angle exceeds 2.00 degrees, which looks like radians: is it a "
          "webots log?");
    CHECK(NotesOfLegs({0.0, side * 0.08, -side * 0.08}, 90, 2.0).size() == 1);
    CHECK(NotesOfLegs({0.0, side * 0.07, -side * 0.07}, 90, 2.0).empty());
  }
  CHECK(NotesOfLegs({3.1, -3.1}, 60, 2.0).empty());  // across half a turn
  CHECK(NotesOfLegs({0.0, 1.0}, 60, 3.2).empty());
  CHECK(NotesOfLegs({0.0, 1.0}, 60, 3.1).size() == 1);
  CHECK(NotesOfLegs({0.0, 1.0}, 60, 0.0).empty());  // it has no angles at all
  CHECK(NotesOfLegs({0.0, 1.0}, 21, 2.0).size() == 1);
  CHECK(NotesOfLegs({0.0, 1.0}, 20, 2.0).empty());
}

TEST_CASE("A robot that jitters within five centimetres of its place makes no turn of the path") {
  const auto notes = [](double to_m, bool is_x) {
    std::string text = "t,x,y,z,roll,pitch,yaw\n";
    for (int i = 0; i < 40; ++i) {
      const double off_m = i % 2 == 0 ? 0.0 : to_m;
      text += fmt::format("{},{},{},0.8,0,0,2\n", 0.05 * i, is_x ? off_m : 0.0, is_x ? 0.0 : off_m);
    }
    return Notes(text, Format::kTracker).size();
  };
  for (const bool is_x : {true, false}) {
    for (const double side : {1.0, -1.0}) {
      CHECK(notes(side * 0.049, is_x) == 0);
      CHECK(notes(side * 0.051, is_x) == 1);
    }
  }
}

}  // namespace
}  // namespace rift::trajectory
