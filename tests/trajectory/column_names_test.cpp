// What a column may hold by the words of its name, each word by itself.
#include "trajectory/column_names.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

namespace rift::trajectory {
namespace {

using Words = std::vector<std::string>;

std::string QuantityOf(const std::string& name) { return NamedColumnOf(name).quantity; }

TEST_CASE("A name falls into words at signs and humps, in small letters") {
  CHECK(WordsOf("pose.pose.position.x") == Words{"pose", "pose", "position", "x"});
  CHECK(WordsOf("posePositionX [mm]") == Words{"pose", "position", "x", "mm"});
  CHECK(WordsOf("__A__b-3C ") == Words{"a", "b", "3c"});  // a digit before it makes no hump
  CHECK(WordsOf("ABc") == Words{"abc"});                  // nor does a capital
  CHECK(WordsOf("").empty());
  CHECK(WordsOf("[]").empty());
}

TEST_CASE("Every word for a quantity is known as the last of a name") {
  const std::vector<std::pair<std::string, Words>> quantities{
      {"x", {"x", "posx", "px", "tx", "xpos", "east", "easting"}},
      {"y", {"y", "posy", "py", "ty", "ypos", "north", "northing"}},
      {"z", {"z", "posz", "pz", "tz", "zpos", "height", "up"}},
      {"yaw", {"yaw", "theta", "heading", "psi", "phi", "angle", "orientation", "th", "rz"}},
      {"roll", {"roll"}},
      {"pitch", {"pitch"}},
      {"t",
       {"t", "time", "timestamp", "stamp", "sec", "secs", "seconds", "elapsed", "clock", "millis",
        "micros", "nanos"}},
      {"nanosec", {"nanosec", "nsec", "nsecs", "nanoseconds"}}};
  for (const auto& [quantity, words] : quantities) {
    for (const std::string& word : words) {
      INFO(word);
      CHECK(QuantityOf(word) == quantity);
      CHECK(QuantityOf("robot_" + word) == quantity);
      CHECK(IsX(word) == (quantity == "x"));
      CHECK(IsY(word) == (quantity == "y"));
    }
  }
  for (const char* none : {"a", "x1", "power", "w", "state", "id", "speed"}) {
    CHECK(QuantityOf(none).empty());
  }
}

TEST_CASE("A rotation's x, y, z and w are parts of a quaternion, others are places") {
  for (const char* word : {"orientation", "rotation", "quaternion", "quat", "rot", "q"}) {
    for (const char* axis : {"x", "y", "z", "w"}) {
      INFO(word << "." << axis);
      CHECK(QuantityOf(std::string(word) + "." + axis) == std::string("q") + axis);
      CHECK(IsRotation({word, axis}));
    }
  }
  for (const char* part : {"qx", "qy", "qz", "qw"}) CHECK(QuantityOf(part) == part);
  CHECK_FALSE(IsRotation({"position", "x"}));
  CHECK(QuantityOf("position.x") == "x");
  CHECK(QuantityOf("q_a").empty());
}

TEST_CASE("A rate and a reference are no part of a pose, whichever word says so") {
  for (const char* rate : {"vel", "velocity", "speed", "twist", "linear", "angular", "acc", "accel",
                           "cmd", "rate", "v", "covariance", "error"}) {
    INFO(rate);
    CHECK(IsRate({"x", rate}));
    CHECK(QuantityOf(std::string(rate) + "_x").empty());
  }
  CHECK_FALSE(IsRate({"x", "pose"}));
  for (const char* reference : {"target", "desired", "goal", "ref", "setpoint", "waypoint"}) {
    INFO(reference);
    CHECK(QuantityOf(std::string(reference) + "_x").empty());
    CHECK(QuantityOf(std::string("x_") + reference).empty());
  }
}

TEST_CASE("The unit at the end of a name is its own, and one that does not fit makes it none") {
  struct Case {
    std::string name, quantity, unit;
  };
  for (const Case& one : {Case{"x [m]", "x", "m"},
                          {"x_cm", "x", "cm"},
                          {"posX (mm)", "x", "mm"},
                          {"x_km", "x", "km"},
                          {"x_in", "x", "in"},
                          {"x_ft", "x", "ft"},
                          {"time_s", "t", "s"},
                          {"time_ms", "t", "ms"},
                          {"time_us", "t", "us"},
                          {"time_ns", "t", "ns"},
                          {"time_min", "t", "min"},
                          {"yaw_deg", "yaw", "deg"},
                          {"yaw_rad", "yaw", "rad"},
                          {"yaw degrees", "yaw", "deg"},
                          {"yaw degree", "yaw", "deg"},
                          {"yaw radians", "yaw", "rad"},
                          {"yaw radian", "yaw", "rad"},
                          {"sec", "t", "s"},
                          {"stamp.secs", "t", "s"},
                          {"seconds", "t", "s"},
                          {"millis", "t", "ms"},
                          {"micros", "t", "us"},
                          {"nanos", "t", "ns"},
                          {"time", "t", ""},
                          {"stamp.nanosec", "nanosec", ""},
                          {"q.w [rad]", "qw", "rad"},
                          {"yaw_m", "", "m"},
                          {"x_rad", "", "rad"},
                          {"t_mm", "", "mm"},
                          {"x_s", "", "s"}}) {
    INFO(one.name);
    const NamedColumn column = NamedColumnOf(one.name);
    CHECK(column.name == one.name);
    CHECK(column.quantity == one.quantity);
    CHECK(column.unit == one.unit);
  }
  // No length and no time is without a unit.
  for (const char* name : {"x []", "y []", "z []", "t []"}) CHECK(QuantityOf(name).empty());
  CHECK(QuantityOf("yaw []") == "yaw");
}

TEST_CASE("A name of fewer words comes first, and one of a pose before ten more") {
  const auto rank = [](const std::string& name) { return NamedColumnOf(name).rank; };
  CHECK(rank("x") == 1);
  CHECK(rank("robot.x") == 2);
  CHECK(rank("robot.x_mm") == 2);  // the unit is no word
  for (const char* pose : {"pose", "position", "pos", "translation", "orientation", "p", "q"}) {
    INFO(pose);
    CHECK(rank(std::string(pose) + ".x") == -8);
  }
  CHECK(rank("a.b.pose.x") == -6);
}

}  // namespace
}  // namespace rift::trajectory
