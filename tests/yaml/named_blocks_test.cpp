// Blocks by name whose entries have keys that must be written.
#include <array>
#include <catch2/catch.hpp>
#include <map>
#include <string>
#include <vector>

#include "rift/yaml/bind.hpp"
#include "rift/yaml/load.hpp"
#include "robot_schema.hpp"

namespace rift::yaml::test {
namespace {

struct Room {
  std::map<std::string, Waypoint> doors{{"north", {"n", 1.0, 2.0, true}}};
  std::vector<Waypoint> seats{{"s", 3.0, 4.0, true}};
  double width_m = 5.0;
  std::optional<double> height_m;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("doors", self.doors, "ways out");
    field("seats", self.seats, "places");
    field("width_m", self.width_m, 1.0, 9.0, "from wall to wall");
    field("height_m", self.height_m, 2.0, 4.0, "to the ceiling");
  }
  void Check() const {
    if (height_m && *height_m > width_m) throw std::invalid_argument("height_m exceeds width_m");
  }
};

std::string BindInto(Room& room, const std::string& text) {
  return ErrorOf([&] { Bind(Parse(text, "f"), room); });
}

TEST_CASE("An entry that is there may be changed in part, and a new one needs its keys") {
  Room room;
  CHECK(BindInto(room, "doors: {north: {y_m: 7}}") == "no error");
  CHECK(room.doors.at("north").x_m == 1.0);
  CHECK(room.doors.at("north").y_m == 7.0);
  CHECK(BindInto(room, "doors: {south: {y_m: 7}}") ==
        "f:1:16: key 'doors.south.x_m' is missing: must be given");
  CHECK(room.doors.size() == 1);
  CHECK(BindInto(room, "doors: {south: {x_m: 8, y_m: -9}}") == "no error");
  CHECK(room.doors.at("south").x_m == 8.0);
  CHECK(room.doors.at("south").y_m == -9.0);
  CHECK(BindInto(room, "seats: [{x_m: 5}]") ==
        "f:1:9: key 'seats[0].y_m' is missing: must be given");
  CHECK(BindInto(room, "seats: [{x_m: 5, y_m: 6}, {x_m: 7, y_m: 8}]") == "no error");
  REQUIRE(room.seats.size() == 2);
  CHECK(room.seats[1].x_m == 7.0);
  CHECK(room.seats[1].y_m == 8.0);
}

TEST_CASE("A value with a full key is set in its own entry, and the rules around it hold") {
  Room room;
  room.doors["north_west"] = {"nw", 5.0, 6.0, true};
  room.seats.resize(12);
  SetValue(room, "doors.north_west.x_m", Parse("9", "f"));
  CHECK(room.doors.at("north_west").x_m == 9.0);
  CHECK(room.doors.at("north").x_m == 1.0);
  SetValue(room, "seats[11].y_m", Parse("-3", "f"));
  CHECK(room.seats[11].y_m == -3.0);
  CHECK(room.seats[1].y_m == 0.0);
  SetValue(room, "seats[1].y_m", Parse("-4", "f"));
  CHECK(room.seats[1].y_m == -4.0);
  CHECK(room.seats[11].y_m == -3.0);
  CHECK(ErrorOf([&] { SetValue(room, "doors.north.x_m", Parse("10.5", "f")); }) ==
        "f:1:1: key 'doors.north.x_m' is 10.5: must be in [-10, 10]; meaning: world frame");
  CHECK(ErrorOf([&] { SetValue(room, "width_m", Parse("9.5", "f")); }) ==
        "f:1:1: key 'width_m' is 9.5: must be in [1, 9]; meaning: from wall to wall");
  SetValue(room, "height_m", Parse("4", "f"));
  CHECK(ErrorOf([&] { SetValue(room, "width_m", Parse("3", "f")); }) ==
        "f:1:1: height_m exceeds width_m");
  CHECK(room.width_m == 5.0);
  SetValue(room, "height_m", Node());
  CHECK_FALSE(room.height_m);
  SetValue(room, "width_m", Parse("3", "f"));
  CHECK(room.width_m == 3.0);
}

}  // namespace
}  // namespace rift::yaml::test
