// Where a guess of units turns from one to the next, and how names of columns are parted.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "trajectory/columns.hpp"

namespace rift::trajectory {
namespace {

struct Made {
  std::string header = "clock,px,py";
  double step = 0.05;  ///< of the clock from row to row
  double speed = 0.3;  ///< of x, over the clock
  double yaw = 0.0;    ///< largest, where the header has one more column
};

std::string GuessOf(const Made& made) {
  std::string text = made.header + "\n";
  const bool has_yaw = std::count(made.header.begin(), made.header.end(), ',') == 3;
  for (int i = 0; i < 60; ++i) {
    const double t = made.step * i, x = made.speed * t;
    text += fmt::format("{:.9f},{:.9f},{:.9f}", 1.0 + t, x, 0.001 * x);
    if (has_yaw) text += fmt::format(",{:.9f}", made.yaw * i / 59.0);
    text += "\n";
  }
  return GuessColumns(text, "log", "").columns;
}

TEST_CASE("The unit of a clock follows from its steps") {
  const auto unit_at = [](double step) {
    // So slow that the length stays in metres whatever the unit of the time.
    const std::string guess = GuessOf({.step = step, .speed = 0.3 / step * 1e-3});
    return guess.substr(0, guess.find(','));
  };
  CHECK(unit_at(0.05) == "t=clock");
  CHECK(unit_at(1.5) == "t=clock");
  CHECK(unit_at(1.6) == "t=clock:ms");
  CHECK(unit_at(900.0) == "t=clock:ms");
  CHECK(unit_at(901.0) == "t=clock:us");
  CHECK(unit_at(5e5) == "t=clock:us");
  CHECK(unit_at(5.1e5) == "t=clock:ns");
}

TEST_CASE("A column that steps back a little is no time") {
  std::string text = "time,px,py\n";
  for (int i = 0; i < 60; ++i) {
    text += fmt::format("{:.3f},{:.4f},{:.4f}\n", 0.05 * i - (i == 30 ? 0.1 : 0.0), 0.015 * i,
                        0.01 * (i % 7));
  }
  CHECK(GuessColumns(text, "log", "").columns.find("t=time") == std::string::npos);
}

TEST_CASE("A path faster than ten metres a second is in millimetres") {
  CHECK(GuessOf({.speed = 9.9}) == "t=clock,x=px,y=py");
  CHECK(GuessOf({.speed = 10.1}) == "t=clock,x=px:mm,y=py:mm");
}

TEST_CASE("An angle beyond one turn and a quarter is in degrees") {
  // Along x with a yaw that sweeps: neither unit agrees with the path.
  const auto unit_of = [](double largest) {
    const std::string guess = GuessOf({.header = "clock,px,py,yaw", .yaw = largest});
    return guess.substr(guess.rfind("yaw="));
  };
  CHECK(unit_of(0.1) == "yaw=yaw");
  CHECK(unit_of(7.9) == "yaw=yaw:deg");
  CHECK(unit_of(-7.9) == "yaw=yaw:deg");
}

TEST_CASE("Names are parted at humps, dots, blanks and brackets, and end in their units") {
  CHECK(GuessOf({.header = "timeStamp [s],robotPosX [mm],robotPosY [mm]"}) ==
        "t=timeStamp [s],x=robotPosX [mm]:mm,y=robotPosY [mm]:mm");
  CHECK(GuessOf({.header = "elapsed,pose.position.x,pose.position.y"}) ==
        "t=elapsed,x=pose.position.x,y=pose.position.y");
  CHECK(GuessOf({.header = "secs,east_cm,north_cm"}) == "t=secs,x=east_cm:cm,y=north_cm:cm");
  CHECK(GuessOf({.header = "millis,x_ft,y_ft"}).substr(0, 11) == "t=millis:ms");
  CHECK(GuessOf({.header = "micros,x,y"}).substr(0, 11) == "t=micros:us");
  CHECK(GuessOf({.header = "nanos,x,y"}).substr(0, 10) == "t=nanos:ns");
  CHECK(GuessOf({.header = "t,x,y,heading_degrees", .yaw = 1.0})
            .ends_with("yaw=heading_degrees:deg"));
  CHECK(GuessOf({.header = "t,x,y,heading_radians", .yaw = 1.0}).ends_with("yaw=heading_radians"));
}

/// The guess for rows of a slow arc with further columns between clock and path.
std::string GuessWith(const std::vector<std::string>& names,
                      const std::vector<std::function<double(int)>>& columns) {
  std::string text = fmt::format("{}\n", fmt::join(names, ","));
  for (int i = 0; i < 60; ++i) {
    std::vector<std::string> cells;
    for (const auto& column : columns) cells.push_back(fmt::format("{:.9f}", column(i)));
    text += fmt::format("{}\n", fmt::join(cells, ","));
  }
  return GuessColumns(text, "log", "").columns;
}

double Clock(int i) { return 0.05 * i; }
double X(int i) { return 0.015 * i; }
double Y(int i) { return 1e-4 * i * i; }

TEST_CASE("Of columns of one quantity a pose's is taken, then the one of fewest words") {
  CHECK(GuessWith({"t", "robot.arm.x", "robot.y", "robot.x"}, {Clock, X, Y, X}) ==
        "t=t,x=robot.x,y=robot.y");
  CHECK(GuessWith({"t", "robot.x", "robot.y", "robot.arm.x"}, {Clock, X, Y, X}) ==
        "t=t,x=robot.x,y=robot.y");
  CHECK(GuessWith({"t", "x", "y", "msg.pose.pose.position.x"}, {Clock, X, Y, X}) ==
        "t=t,x=msg.pose.pose.position.x,y=y");
  CHECK(GuessWith({"t", "a.x", "y", "b.x"}, {Clock, X, Y, X}) == "");
  // A time that does not rise is none, and what comes behind it is looked at.
  CHECK(GuessWith({"time", "clock", "x", "y"}, {[](int) { return 1.0; }, Clock, X, Y}) ==
        "t=clock,x=x,y=y");
}

TEST_CASE("A robot that stands most of the time has the unit of its way while it moves") {
  CHECK(GuessWith({"t", "x", "y"}, {Clock, [](int i) { return 1e3 * X(std::min(i, 20)); },
                                    [](int i) { return 1e3 * Y(std::min(i, 20)); }}) ==
        "t=t,x=x:mm,y=y:mm");
}

TEST_CASE("A height has the unit of the path, and a tilt that of the yaw") {
  const auto degrees = [](double rad) { return 57.29577951 * rad; };
  const auto yaw = [&](int i) { return degrees(std::atan2(2e-4 * i, 0.015)); };
  CHECK(GuessWith({"t", "x", "y", "z", "roll", "pitch", "yaw"},
                  {Clock, [](int i) { return 1e3 * X(i); }, [](int i) { return 1e3 * Y(i); },
                   [](int) { return 30.0; }, [](int) { return 2.0; }, [](int) { return 3.0; },
                   yaw}) == "t=t,x=x:mm,y=y:mm,z=z:mm,roll=roll:deg,pitch=pitch:deg,yaw=yaw:deg");
  CHECK(GuessWith({"t", "x", "y", "z", "roll", "pitch", "yaw"},
                  {Clock, X, Y, [](int) { return 0.03; }, [](int) { return 0.02; },
                   [](int) { return 0.03; }, [&](int i) { return yaw(i) / 57.29577951; }}) ==
        "t=t,x=x,y=y,z=z,roll=roll,pitch=pitch,yaw=yaw");
}

TEST_CASE("A time that no name tells is the first nameless column that rises and is nothing else") {
  CHECK(GuessWith({"x", "y", "3"}, {X, Y, Clock}) == "t=3,x=x,y=y");
  CHECK(GuessWith({"1", "2", "x", "y"}, {[](int) { return 1.0; }, Clock, X, Y}) == "t=2,x=x,y=y");
  CHECK(GuessWith({"1", "2", "x", "y"}, {[](int i) { return -Clock(i); }, Clock, X, Y}) ==
        "t=2,x=x,y=y");
  CHECK(GuessWith({"x", "y", "n"}, {X, Y, Clock}) == "");
  // A place of which one coordinate has a name is none without the other.
  CHECK(GuessWith({"t", "x", "b"}, {Clock, X, Y}) == "");
  CHECK(GuessWith({"t", "a", "y"}, {Clock, X, Y}) == "");
  CHECK(GuessWith({"t", "2", "3", "4"}, {Clock, [](int) { return 1.0; }, X, Y}) == "t=t,x=3,y=4");
  CHECK(GuessWith({"1", "2", "t"}, {X, Y, Clock}) == "t=t,x=1,y=2");
  CHECK(GuessWith({"t", "still", "a", "b"}, {Clock, [](int) { return 1.0; }, X, Y}) == "");
}

TEST_CASE("An angle of 7.8 may be radians beyond a turn, one of 7.9 is in degrees") {
  // A circle that the yaw goes along, in radians.
  const auto unit_of = [](double largest) {
    const auto turn = [largest](int i) { return largest * i / 59.0; };
    const std::string guess =
        GuessWith({"t", "x", "y", "yaw"}, {Clock, [&](int i) { return std::sin(turn(i)); },
                                           [&](int i) { return 1.0 - std::cos(turn(i)); }, turn});
    return guess.substr(guess.rfind("yaw="));
  };
  CHECK(unit_of(7.8) == "yaw=yaw");
  CHECK(unit_of(-7.8) == "yaw=yaw");
  CHECK(unit_of(7.9) == "yaw=yaw:deg");
  CHECK(unit_of(-7.9) == "yaw=yaw:deg");
}

TEST_CASE("An angle is in degrees where these agree with the way better by more than 0.2") {
  // Along x: twice the angle's cosine in radians, and nearly one in degrees.
  const auto unit_of = [](double angle) {
    const std::string guess = GuessWith({"t", "x", "y", "yaw"}, {Clock, X, [](int) { return 0.5; },
                                                                 [angle](int) { return angle; }});
    return guess.substr(guess.rfind("yaw="));
  };
  for (const double sign : {1.0, -1.0}) {
    CHECK(unit_of(sign * 0.318) == "yaw=yaw");  // cos 0.636 = 0.804
    CHECK(unit_of(sign * 0.326) == "yaw=yaw:deg");
  }
}

TEST_CASE("A column without a name is a yaw where it agrees with the way to 0.85") {
  // A circle in steps of 0.06 rad, of which two make a piece, its yaw off by so much. The first row
  // stands where a header would.
  const auto guess = [](double off_rad, double unit) {
    const auto turn = [](int i) { return 0.06 * (i + 1); };
    return GuessWith(
        {"0.05", "0.0", "-0.4", fmt::format("{}", unit * off_rad)},
        {[](int i) { return 0.1 + Clock(i); }, [&](int i) { return 0.4 * std::sin(turn(i)); },
         [&](int i) { return -0.4 * std::cos(turn(i)); },
         [&](int i) { return unit * (turn(i) + off_rad); }});
  };
  for (const double sign : {1.0, -1.0}) {
    CHECK(guess(sign * 0.26, 1.0) == "t=1,x=2,y=3,yaw=4");  // cos 0.52 = 0.868
    CHECK(guess(sign * 0.29, 1.0) == "t=1,x=2,y=3");        // cos 0.58 = 0.836
    CHECK(guess(sign * 0.26, 57.29577951) == "t=1,x=2,y=3,yaw=4:deg");
    CHECK(guess(sign * 0.29, 57.29577951) == "t=1,x=2,y=3");
  }
}

}  // namespace
}  // namespace rift::trajectory
