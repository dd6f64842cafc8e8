// Where a guess of units turns from one to the next, and how names of columns are parted.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

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
  return GuessColumns(text, "log", "");
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
  CHECK(GuessColumns(text, "log", "").find("t=time") == std::string::npos);
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

}  // namespace
}  // namespace rift::trajectory
