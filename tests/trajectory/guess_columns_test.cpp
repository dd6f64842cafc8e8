// The columns that are offered for a log of a program that rift does not know.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "trajectory/columns.hpp"

namespace rift::trajectory {
namespace {

/// A turn of a circle of 1 m around (20 m, -70 m) at 0.3 m/s, 20 rows a second.
struct Moment {
  double t_s, x_m, y_m, yaw_rad;
};

std::vector<Moment> Circle() {
  std::vector<Moment> moments;
  for (int i = 0; i < 200; ++i) {
    const double t_s = 0.05 * i, turn_rad = 0.3 * t_s;
    moments.push_back({t_s, 20.0 + std::sin(turn_rad), -70.0 - std::cos(turn_rad), turn_rad});
  }
  return moments;
}

std::string GuessFor(const std::string& header,
                     const std::function<std::string(const Moment&)>& row,
                     const std::string& units = "") {
  std::string text = header + "\n";
  for (const Moment& moment : Circle()) text += row(moment) + "\n";
  return GuessColumns(text, "log.csv", units).columns;
}

/// Time, x, y and yaw in units of that many to a second, a metre and a radian.
std::string GuessIn(double per_s, double per_m, double per_rad, const std::string& units = "") {
  return GuessFor(
      "clock,px,py,heading",
      [&](const Moment& m) {
        return fmt::format("{:.9f},{:.9f},{:.9f},{:.9f}", per_s * m.t_s, per_m * m.x_m,
                           per_m * m.y_m, per_rad * m.yaw_rad);
      },
      units);
}

constexpr double kDegrees = 57.29577951308232;

TEST_CASE("Units of a guess follow from rate, speed and direction of travel") {
  CHECK(GuessIn(1.0, 1.0, 1.0) == "t=clock,x=px,y=py,yaw=heading");
  CHECK(GuessIn(1e3, 1.0, 1.0) == "t=clock:ms,x=px,y=py,yaw=heading");
  CHECK(GuessIn(1e6, 1.0, 1.0) == "t=clock:us,x=px,y=py,yaw=heading");
  CHECK(GuessIn(1e9, 1.0, 1.0) == "t=clock:ns,x=px,y=py,yaw=heading");
  CHECK(GuessIn(1.0, 1e3, 1.0) == "t=clock,x=px:mm,y=py:mm,yaw=heading");
  CHECK(GuessIn(1e3, 1e3, 1.0) == "t=clock:ms,x=px:mm,y=py:mm,yaw=heading");
  CHECK(GuessIn(1.0, 1.0, kDegrees) == "t=clock,x=px,y=py,yaw=heading:deg");
}

TEST_CASE("Units that are given are not guessed") {
  CHECK(GuessIn(1e3, 1e3, kDegrees, "ms,mm,deg") == "t=clock,x=px,y=py,yaw=heading");
  CHECK(GuessIn(1.0, 1e3, 1.0, "mm") == "t=clock,x=px,y=py,yaw=heading");
  CHECK(GuessIn(1e3, 1.0, 1.0, "m") == "t=clock:ms,x=px,y=py,yaw=heading");
}

TEST_CASE("Units at the end of a name are believed") {
  const std::string guess = GuessFor("time_ms,x_cm,y_cm,yaw_deg", [](const Moment& m) {
    return fmt::format("{},{},{},{}", m.t_s, m.x_m, m.y_m, m.yaw_rad);
  });
  CHECK(guess == "t=time_ms:ms,x=x_cm:cm,y=y_cm:cm,yaw=yaw_deg:deg");
}

TEST_CASE("A column whose name holds a comma or is empty is offered by its number") {
  const auto row = [](const Moment& m) {
    return fmt::format("{};7;{};{};{}", m.t_s, m.x_m, m.y_m, m.yaw_rad);
  };
  CHECK(GuessFor("t, s;a;x, cm;y;yaw, deg", row) == "t=1,x=3:cm,y=y,yaw=5:deg");
  CHECK(GuessFor(";a;x;y;yaw", row) == "t=1,x=x,y=y,yaw=yaw");
  const std::string guess = GuessFor("sec;nsec, ns;x;y;yaw", [](const Moment& m) {
    return fmt::format("{};{};{};{};{}", std::floor(m.t_s),
                       std::lround(1e9 * m.t_s) % 1'000'000'000, m.x_m, m.y_m, m.yaw_rad);
  });
  CHECK(guess == "t=sec+2:ns,x=x,y=y,yaw=yaw");
}

TEST_CASE("Columns without names are told apart by rising, varying and following the path") {
  const std::string header = "5,0.0,20.0,-71.0,7,0.0";
  const auto row = [](double per_rad) {
    return [per_rad](const Moment& m) {
      return fmt::format("5,{},{},{},7,{}", m.t_s + 0.01, m.x_m, m.y_m, per_rad * m.yaw_rad);
    };
  };
  CHECK(GuessFor(header, row(1.0)) == "t=2,x=3,y=4,yaw=6");
  CHECK(GuessFor(header, row(kDegrees)) == "t=2,x=3,y=4,yaw=6:deg");
}

TEST_CASE("A pose is preferred to what is named like it, and a quaternion to a yaw") {
  const std::string header =
      "header.stamp.sec,header.stamp.nanosec,goal.x,odom.x,odom.y,"
      "pose.position.x,pose.position.y,"
      "pose.orientation.x,pose.orientation.y,pose.orientation.z,pose.orientation.w,theta";
  const std::string guess = GuessFor(header, [](const Moment& m) {
    const long ns = std::lround(1e9 * m.t_s);
    return fmt::format("{},{},9,{},{},{},{},0,0,{},{},{}", ns / 1'000'000'000, ns % 1'000'000'000,
                       m.x_m + 1.0, m.y_m, m.x_m, m.y_m, std::sin(m.yaw_rad / 2.0),
                       std::cos(m.yaw_rad / 2.0), m.yaw_rad);
  });
  CHECK(guess ==
        "t=header.stamp.sec+header.stamp.nanosec:ns,x=pose.position.x,y=pose.position.y,"
        "qx=pose.orientation.x,qy=pose.orientation.y,qz=pose.orientation.z,qw=pose.orientation.w");
}

/// What a message says where no columns are found.
std::string UnclearIn(const std::string& header, const std::string& row_format = "{},{},{},{},{}") {
  std::string text = header + "\n";
  for (const Moment& m : Circle()) {
    text += fmt::format(fmt::runtime(row_format), m.t_s, m.x_m, m.y_m, m.x_m, m.y_m) + "\n";
  }
  const ColumnGuess guess = GuessColumns(text, "log.csv", "");
  CHECK(guess.columns.empty());
  return guess.unclear;
}

TEST_CASE("Columns whose names say something else than a place are not taken for one") {
  CHECK(UnclearIn("time,enc_l,enc_r,a,b") == "");
  CHECK(UnclearIn("time,x_ref,y_ref,x_meas,y_meas") ==
        "; x may be x_ref or x_meas, y may be y_ref or y_meas");
  CHECK(UnclearIn("time,vel_x,vel_y,q_x,q_y") == "");
  CHECK(UnclearIn("time,vel_x,vel_y,x_ref,y_ref") == "; x may be x_ref, y may be y_ref");
  // A time that no name tells is none either.
  CHECK(UnclearIn("frames,x,y,a,b") == "");
}

TEST_CASE("Of two places that are named alike none is taken, and both are named") {
  CHECK(UnclearIn("time,gps.x,gps.y,odom.x,odom.y") ==
        "; x may be gps.x or odom.x, y may be gps.y or odom.y");
  CHECK(GuessFor("time,x,y,odom.x,odom.y", [](const Moment& m) {
          return fmt::format("{},{},{},{},{}", m.t_s, m.x_m, m.y_m, m.x_m, m.y_m);
        }) == "t=time,x=x,y=y");
}

TEST_CASE("A cell without a finite number is an empty one to a guess") {
  for (const char* word : {"nan", "NaN", "inf", "-inf", "+inf", ""}) {
    INFO(word);
    const std::string guess = GuessFor("time,pos_x,pos_y,1,2", [&](const Moment& m) {
      const bool is_lost = m.t_s > 1.0 && m.t_s < 1.2;
      return is_lost ? fmt::format("{},{},{},{},{}", m.t_s, word, word, m.t_s, m.x_m)
                     : fmt::format("{},{},{},{},{}", m.t_s, m.x_m, m.y_m, m.t_s, m.x_m);
    });
    CHECK(guess == "t=time,x=pos_x,y=pos_y");
  }
  // A column that holds nothing else is no place.
  CHECK(GuessFor("time,x,y,pose.x,pose.y", [](const Moment& m) {
          return fmt::format("{},{},{},nan,nan", m.t_s, m.x_m, m.y_m);
        }) == "t=time,x=x,y=y");
}

TEST_CASE("A unit in a name comes before those that are given, whatever it is") {
  const auto row = [](const Moment& m) { return fmt::format("{},{},{}", m.t_s, m.x_m, m.y_m); };
  CHECK(GuessFor("time (s),X (m),Y (m)", row, "mm,ms") == "t=time (s):s,x=X (m):m,y=Y (m):m");
  CHECK(GuessFor("time (s),X (cm),Y (cm)", row, "mm") == "t=time (s),x=X (cm):cm,y=Y (cm):cm");
  CHECK(GuessFor("time,X (mm),Y", row, "mm") == "t=time,x=X (mm),y=Y");
  CHECK(GuessFor("secs,x,y", row, "ms") == "t=secs:s,x=x,y=y");
}

TEST_CASE("Nothing is offered where time or position cannot be told") {
  const auto still = [](const Moment& m) { return fmt::format("{},1.5,2.5", m.t_s); };
  CHECK(GuessFor("a,b,c", still) == "");
  const auto words = [](const Moment& m) { return fmt::format("now,{},{}", m.x_m, m.y_m); };
  CHECK(GuessFor("time,x,y", words) == "");
  CHECK(GuessFor("a,b", [](const Moment& m) { return fmt::format("{},{}", m.t_s, m.x_m); }) == "");
}

}  // namespace
}  // namespace rift::trajectory
