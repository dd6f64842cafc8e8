// What makes two logs doubtful beside each other, on either side of each rule.
#include "rift/gap/doubts.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

namespace rift::gap {
namespace {

using trajectory::StampedPose;
using trajectory::Trajectory;

/// A way with a bend that no mirror image and no turn of it is like, one metre and a half long.
Trajectory Bend() {
  Trajectory path;
  for (int i = 0; i <= 100; ++i) {
    const double x_m = 0.01 * i;
    path.poses.push_back({.t_s = 0.05 * i, .x_m = 0.3 + x_m, .y_m = 0.2 + 0.5 * x_m * x_m});
  }
  return path;
}

Trajectory Changed(Trajectory path, const std::function<void(StampedPose&)>& change) {
  for (StampedPose& pose : path.poses) change(pose);
  return path;
}

/// The only doubt; "" for none, and "several" for more.
std::string Doubt(const Trajectory& sim, const Trajectory& real, const GapOptions& options = {}) {
  const std::vector<std::string> doubts = Doubts(sim, real, options);
  if (doubts.size() > 1) return "several";
  return doubts.empty() ? "" : doubts.front();
}

/// A simulated path beside it that strays by two centimetres at its end.
Trajectory Beside(const Trajectory& path) {
  return Changed(path, [](StampedPose& pose) { pose.y_m += 0.02 * (pose.x_m - 0.3); });
}

TEST_CASE("Sound logs that stray from each other are not doubted") {
  CHECK(Doubt(Bend(), Beside(Bend())) == "");
  CHECK(Doubt(Beside(Bend()), Bend()) == "");
}

TEST_CASE("The same log twice is told, and one that differs in a time or a place is another") {
  const std::string same = "SIM and REAL are the same log: name the robot's own";
  CHECK(Doubt(Bend(), Bend()) == same);
  Trajectory later = Bend(), moved = Bend(), longer = Bend();
  later.poses.back().t_s += 1e-6;
  moved.poses.back().y_m += 1e-6;
  longer.poses.push_back(longer.poses.back());
  longer.poses.back().t_s += 1.0;
  CHECK(Doubt(Bend(), later) == "");
  CHECK(Doubt(Bend(), moved) == "");
  CHECK(Doubt(Bend(), longer) == "");
}

TEST_CASE("The same log on another clock is the same") {
  const std::string same = "SIM and REAL are the same log: name the robot's own";
  for (const double shift_s : {1.0, -3.3, 1.7e9}) {
    INFO(shift_s);
    const Trajectory shifted =
        Changed(Bend(), [&](StampedPose& pose) { pose.t_s = pose.t_s + shift_s; });
    CHECK(Doubt(Bend(), shifted) == same);
    CHECK(Doubt(shifted, Bend()) == same);
  }
}

TEST_CASE("A path in another unit is told with its factor and the side that is to be mended") {
  struct Unit {
    double factor;
    const char* name;
    std::string unit;
  };
  for (const Unit& unit : {Unit{1000.0, "mm for m", "mm"}, Unit{100.0, "cm for m", "cm"},
                           Unit{39.37, "inches for m", "in"}, Unit{10.0, "mm for cm", "mm"},
                           Unit{3.281, "feet for m", "ft"}}) {
    INFO(unit.name);
    const Trajectory large = Changed(Beside(Bend()), [&](StampedPose& pose) {
      pose.x_m *= unit.factor;
      pose.y_m *= unit.factor;
    });
    const std::string of_real = Doubt(Bend(), large), of_sim = Doubt(large, Bend());
    CHECK(of_real.starts_with("the path of REAL is "));
    CHECK(of_real.find(std::string("times as large as that of SIM: ") + unit.name) !=
          std::string::npos);
    CHECK(of_real.find("--real-units " + unit.unit + ", or") != std::string::npos);
    CHECK(of_sim.find("--sim-units " + unit.unit + ", or") != std::string::npos);
    CHECK(of_sim.starts_with("the path of SIM is "));
    CHECK(of_sim.find(std::string("times as large as that of REAL: ") + unit.name) !=
          std::string::npos);
  }
  for (const double factor : {2.0, 5.0, 20.0}) {  // of no unit
    const Trajectory other = Changed(Bend(), [&](StampedPose& pose) {
      pose.x_m *= factor;
      pose.y_m *= factor;
    });
    CHECK(Doubt(Bend(), other).find("times as large") == std::string::npos);
  }
}

TEST_CASE("A wrong sign or order of axes is told with what mends it") {
  struct Mistake {
    std::function<void(StampedPose&)> made;
    const char* words;
  };
  const Mistake mistakes[] = {
      {[](StampedPose& p) { p.y_m = -p.y_m; }, "mirrored y: turn its sign, as in y=-COLUMN"},
      {[](StampedPose& p) { p.x_m = -p.x_m; }, "mirrored x: turn its sign, as in x=-COLUMN"},
      {[](StampedPose& p) { std::swap(p.x_m, p.y_m); },
       "swapped axes: exchange the columns of x and y"},
      {[](StampedPose& p) { p.x_m = -p.x_m, p.y_m = -p.y_m; },
       "a frame turned by half a turn: x=-COLUMN,y=-COLUMN"}};
  for (const Mistake& mistake : mistakes) {
    INFO(mistake.words);
    const Trajectory real = Changed(Beside(Bend()), mistake.made);
    CHECK(Doubt(Bend(), real).ends_with(std::string("once it is mended: ") + mistake.words));
    CHECK(Doubt(real, Bend()).ends_with(std::string("once it is mended: ") + mistake.words));
  }
}

/// Straight from the origin in this direction, in rows of a hundredth of its length. Two of one
/// length are sin(half of the angle between them) of it apart on average.
Trajectory Ray(double angle_rad, double length_m = 1.0) {
  Trajectory path;
  for (int i = 0; i <= 100; ++i) {
    const double way_m = 0.01 * i * length_m;
    path.poses.push_back(
        {.t_s = 0.05 * i, .x_m = way_m * std::cos(angle_rad), .y_m = way_m * std::sin(angle_rad)});
  }
  return path;
}

TEST_CASE("A unit explains a size within 15 percent of its factor and a shape within a tenth") {
  const auto is_told = [](double angle_rad, double length_m) {
    const auto tells = [](const std::string& doubt, const std::string& side) {
      return doubt.ends_with("name the unit, as in --" + side + "-units mm, or, where the header " +
                             "names one, --" + side + "-columns 't=...,x=...:mm,y=...:mm'");
    };
    const bool of_real = tells(Doubt(Ray(0.1), Ray(0.1 + angle_rad, length_m)), "real");
    CHECK(tells(Doubt(Ray(0.1 + angle_rad, length_m), Ray(0.1)), "sim") == of_real);
    return of_real;
  };
  CHECK(is_told(0.0, 1140.0));
  CHECK_FALSE(is_told(0.0, 1160.0));
  CHECK(is_told(0.0, 860.0));
  CHECK_FALSE(is_told(0.0, 840.0));
  for (const double sign : {1.0, -1.0}) {
    CHECK(is_told(sign * 2.0 * std::asin(0.099), 1000.0));
    CHECK_FALSE(is_told(sign * 2.0 * std::asin(0.101), 1000.0));
  }
}

TEST_CASE("Axes are doubted from a tenth of the path's extent on, when 0.3 of it is left mended") {
  const std::string mirrored = "mirrored y: turn its sign, as in y=-COLUMN";
  CHECK(Doubt(Ray(std::asin(0.099)), Ray(-std::asin(0.099))) == "");
  CHECK(Doubt(Ray(std::asin(0.101)), Ray(-std::asin(0.101))).ends_with(mirrored));
  // 0.6 rad less `off` apart, and `off` once it is mended: sin(off / 2) = left sin(0.3 - off / 2).
  const auto doubt = [](double left) {
    const double off_rad = 2.0 * std::atan(left * std::sin(0.3) / (1.0 + left * std::cos(0.3)));
    return Doubt(Ray(0.3), Ray(-0.3 + off_rad));
  };
  CHECK(doubt(0.29).ends_with(mirrored));
  CHECK(doubt(0.31) == "");
}

TEST_CASE("Where a straight path begins tells its sign, unless starts are laid together") {
  const auto line = [](double y_m) {
    Trajectory path;
    for (int i = 0; i <= 40; ++i)
      path.poses.push_back({.t_s = 0.1 * i, .x_m = 0.02 * i, .y_m = y_m});
    return path;
  };
  CHECK(Doubt(line(0.3), line(-0.3)).ends_with("mirrored y: turn its sign, as in y=-COLUMN"));
  CHECK(Doubt(line(0.3), line(-0.3), {.align = Align::kStart}) == "");
  // Nearer than a tenth of the way, which is 0.8 m long.
  CHECK(Doubt(line(0.039), line(-0.039)) == "");
  CHECK(Doubt(line(0.041), line(-0.041)).ends_with("mirrored y: turn its sign, as in y=-COLUMN"));
  CHECK(Doubt(line(0.3), line(0.9)) == "");  // nothing mends that
}

/// Rows [from, to) of the path.
Trajectory Part(const Trajectory& path, size_t from, size_t to) {
  Trajectory part;
  part.poses.assign(path.poses.begin() + static_cast<std::ptrdiff_t>(from),
                    path.poses.begin() + static_cast<std::ptrdiff_t>(to));
  return part;
}

TEST_CASE("A log that was cut in motion is told with what it covers, whichever it is") {
  const Trajectory whole = Bend(), real = Beside(Bend());
  const std::string end = Doubt(whole, Part(real, 0, 71));
  CHECK(end.starts_with("REAL covers only u = 0.00 to 0.6"));
  CHECK(end.find("of the path of SIM and ends in motion: a log that was cut") != std::string::npos);
  const std::string begin = Doubt(Part(whole, 40, 101), real);
  CHECK(begin.starts_with("SIM covers only u = 0.3"));
  CHECK(begin.find(" of the path of REAL and begins in motion") != std::string::npos);
  const std::string both = Doubt(whole, Part(real, 25, 76));
  CHECK(both.find("and begins and ends in motion") != std::string::npos);
  CHECK(Doubt(whole, Part(real, 0, 95)) == "");  // nearly all of it
  Trajectory stopped = Part(real, 0, 71);        // a robot that stopped there
  for (int i = 1; i <= 10; ++i) {
    stopped.poses.push_back(stopped.poses.back());
    stopped.poses.back().t_s += 0.05;
  }
  CHECK(Doubt(whole, stopped) == "");
}

/// Along x from `from_m` to `to_m` in rows of a centimetre and 0.05 s, its last steps so much
/// slower.
Trajectory Piece(double from_m, double to_m, double y_m = 0.0, double slower = 1.0) {
  Trajectory path;
  double t_s = 0.0;
  const auto rows = std::lround(100.0 * (to_m - from_m));
  for (int i = 0; i <= rows; ++i) {
    path.poses.push_back({.t_s = t_s, .x_m = from_m + 0.01 * i, .y_m = y_m});
    t_s += 0.05 / (i + 4 >= rows ? slower : 1.0);
  }
  return path;
}

/// The same driven from its end to its start, and seen from there.
Trajectory Backward(Trajectory path) {
  const double end_s = path.poses.back().t_s;
  std::reverse(path.poses.begin(), path.poses.end());
  for (StampedPose& pose : path.poses) {
    pose.t_s = end_s - pose.t_s;
    pose.x_m = 1.0 - pose.x_m;
  }
  return path;
}

TEST_CASE("A part is cut off a whole up to 85 percent of it, at more than half its mean speed") {
  const Trajectory whole = Piece(0.0, 1.0);
  const auto is_told = [&](const Trajectory& part) {
    const std::string end = Doubt(whole, part), begin = Doubt(whole, Backward(part));
    CHECK((end.empty() || end.find(" and ends in motion") != std::string::npos));
    CHECK((begin.empty() || begin.find(" and begins in motion") != std::string::npos));
    CHECK(end.empty() == begin.empty());
    return !end.empty();
  };
  CHECK(is_told(Piece(0.0, 0.84)));
  CHECK_FALSE(is_told(Piece(0.0, 0.86)));
  // The last 0.04 m of 0.6 m at this share of the speed have (0.56 share + 0.04) / 0.6 of the mean
  // of all, which is a half at 0.464.
  CHECK(is_told(Piece(0.0, 0.6, 0.0, 0.48)));
  CHECK_FALSE(is_told(Piece(0.0, 0.6, 0.0, 0.45)));
  // Beside the whole by 6 % of its length on average is another path.
  CHECK(is_told(Piece(0.0, 0.6, 0.058)));
  CHECK_FALSE(is_told(Piece(0.0, 0.6, 0.062)));
  // And so is one whose end is 10 % off, however near the rest of it lies.
  for (const double off_m : {0.09, 0.11}) {
    Trajectory part = Piece(0.0, 0.6);
    for (int i = 0; i < 10; ++i) part.poses[static_cast<size_t>(i)].y_m = off_m * (1.0 - 0.1 * i);
    INFO(off_m);
    CHECK(is_told(part) == (off_m < 0.1));
  }
  // Nine rows tell of no speed.
  for (const size_t rows : {9, 10}) {
    Trajectory part;
    for (size_t i = 0; i < rows; ++i) {
      const double share = static_cast<double>(i);
      part.poses.push_back({.t_s = 0.3 * share, .x_m = 0.06 * share});
    }
    CHECK(is_told(part) == (rows == 10));
  }
}

TEST_CASE("Clocks differ from ten times as long on, or when one begins a million seconds later") {
  const auto timed = [](double factor, double begin_s) {
    return Changed(Beside(Bend()),
                   [=](StampedPose& pose) { pose.t_s = begin_s + factor * pose.t_s; });
  };
  CHECK(Doubt(Bend(), timed(9.9, 0.0)) == "");
  CHECK(Doubt(Bend(), timed(1.0 / 9.9, 0.0)) == "");
  CHECK(
      Doubt(Bend(), timed(10.1, 0.0)) ==
      "their clocks differ: SIM lasts 5 s and REAL 50.5 s: are the times of one in another unit?");
  CHECK(Doubt(timed(10.1, 0.0), Bend()).starts_with("their clocks differ: SIM lasts 50.5 s"));
  CHECK(Doubt(Bend(), timed(1.0, 0.99e6)) == "");
  CHECK(Doubt(Bend(), timed(1.0, 1.01e6))
            .starts_with("their clocks differ: SIM begins at 0 s and REAL at 1010000 s"));
  CHECK(Doubt(timed(1.0, 1.01e6), Bend())
            .starts_with("their clocks differ: SIM begins at 1010000 s and REAL at 0 s"));
  // A robot that stood for long before it drove, and whose standstill is trimmed.
  Trajectory waits = Beside(Bend());
  for (StampedPose& pose : waits.poses) pose.t_s += 100.0;
  waits.poses.insert(waits.poses.begin(), waits.poses.front());
  waits.poses.front().t_s = 0.0;
  CHECK(Doubt(Bend(), waits).starts_with("their clocks differ"));
  CHECK(Doubt(Bend(), waits, {.trim_standstill = true}) == "");
}

/// A straight log at 20 Hz with this unevenness of its steps and this noise of its places.
Trajectory Texture(double uneven, double noise_m, int rows = 60) {
  Trajectory log;
  for (int i = 0; i < rows; ++i) {
    log.poses.push_back({.t_s = 0.05 * (i + (i % 7 == 3 ? uneven : 0.0)),
                         .x_m = 0.01 * i,
                         .y_m = i % 2 == 0 ? noise_m : -noise_m});
  }
  return log;
}

TEST_CASE("Sides look swapped when the real one is even and smooth and the simulated one is not") {
  const Trajectory computed = Texture(0.0, 0.0), recorded = Texture(0.2, 0.001);
  CHECK(LookSwapped(recorded, computed));
  CHECK_FALSE(LookSwapped(computed, recorded));
  CHECK_FALSE(LookSwapped(recorded, recorded));
  CHECK_FALSE(LookSwapped(computed, computed));
  CHECK_FALSE(LookSwapped(Texture(0.0, 0.001), computed));  // even steps
  CHECK_FALSE(LookSwapped(Texture(0.2, 0.0), computed));    // no noise
  CHECK_FALSE(LookSwapped(recorded, Texture(0.2, 0.0)));
  CHECK_FALSE(LookSwapped(recorded, Texture(0.0, 0.001)));
  CHECK_FALSE(LookSwapped(Texture(0.2, 0.001, 9), computed));  // too few rows to tell
  CHECK_FALSE(LookSwapped(recorded, Texture(0.0, 0.0, 9)));
  CHECK(LookSwapped(Texture(0.2, 0.001, 10), Texture(0.0, 0.0, 10)));
  // Third differences of places that alternate are eight times as large: 0.4 mm are 0.05 mm of
  // noise.
  CHECK(LookSwapped(Texture(0.2, 0.4e-3 / 8.0 * 1.05), computed));
  CHECK_FALSE(LookSwapped(Texture(0.2, 0.4e-3 / 8.0 * 0.95), computed));
  CHECK(LookSwapped(recorded, Texture(0.0, 0.1e-3 / 8.0 * 0.95)));
  CHECK_FALSE(LookSwapped(recorded, Texture(0.0, 0.1e-3 / 8.0 * 1.05)));
  CHECK(LookSwapped(Texture(0.0505, 0.001), computed));
  CHECK_FALSE(LookSwapped(Texture(0.0495, 0.001), computed));
  CHECK(LookSwapped(recorded, Texture(0.00095, 0.0)));
  CHECK_FALSE(LookSwapped(recorded, Texture(0.00105, 0.0)));
}

TEST_CASE("A log stands whose every place is within the radius of its first, heights in space") {
  const auto log = [](double x_m, double y_m, double z_m) {
    Trajectory path;
    path.poses = {{.t_s = 0.0, .x_m = 1.0, .y_m = 2.0, .z_m = 3.0},
                  {.t_s = 1.0, .x_m = 1.0 + x_m, .y_m = 2.0 + y_m, .z_m = 3.0 + z_m},
                  {.t_s = 2.0, .x_m = 1.0, .y_m = 2.0, .z_m = 3.0}};
    return path;
  };
  GapOptions plane, space;
  plane.standstill_radius_m = space.standstill_radius_m = 0.04;
  space.dimension = Dimension::kXyz;
  for (const GapOptions& options : {plane, space}) {
    CHECK(IsStanding(log(0.0, 0.0, 0.0), options));
    CHECK(IsStanding(log(0.023, -0.032, 0.0), options));
    CHECK_FALSE(IsStanding(log(0.025, -0.032, 0.0), options));
    CHECK_FALSE(IsStanding(log(0.0, 0.041, 0.0), options));
    CHECK(IsStanding(log(0.0, 0.0, 0.039), options));
    CHECK(IsStanding(log(0.0, 0.0, -0.041), options) == !options.IsInSpace());
  }
  Trajectory last_moves = log(0.0, 0.0, 0.0), one = last_moves;
  last_moves.poses.back().x_m += 0.05;
  CHECK_FALSE(IsStanding(last_moves, plane));
  one.poses.resize(1);
  CHECK_FALSE(IsStanding(one, plane));
}

TEST_CASE("A path that was driven the other way is told, and one that comes back is not") {
  Trajectory back = Beside(Bend());
  std::reverse(back.poses.begin(), back.poses.end());
  for (size_t i = 0; i < back.poses.size(); ++i) back.poses[i].t_s = 0.05 * static_cast<double>(i);
  CHECK(Doubt(Bend(), back)
            .find("when it is taken from its end to its start: was one of them "
                  "driven the other way?") != std::string::npos);
  CHECK(Doubt(back, Bend()) == Doubt(Bend(), back));
  // Straight on, the way back is a mirror image as well.
  const auto straight = [](StampedPose& pose) { pose.y_m = 0.2; };
  CHECK(Doubt(Changed(Bend(), straight), Changed(back, straight)).find("once it is mended") !=
        std::string::npos);
  // From where it ended a robot may well drive on, or another way back.
  const Trajectory other = Changed(back, [](StampedPose& pose) { pose.y_m = 0.2; });
  CHECK(Doubt(Bend(), other).find("driven the other way") == std::string::npos);
  GapOptions aligned;
  aligned.align = Align::kStart;
  CHECK(Doubt(Bend(), back, aligned).find("driven the other way") == std::string::npos);
}

}  // namespace
}  // namespace rift::gap
