// How a comparison is asked for: which logs are read in which columns, and what is refused.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "rift/sessions/gap/measure.hpp"
#include "rift/trajectory/log.hpp"
#include "support/processes/process.hpp"

namespace rift::sessions {
namespace {

using Catch::Matchers::Contains;
using trajectory::Format;
using trajectory::ReadOptions;

/// One side of a job, so that both are held to the same rules.
struct Side {
  Format LogSides::*format;
  std::string LogSides::*columns;
  std::string LogSides::*units;
  ReadOptions (LogSides::*read)(bool) const;
  std::string flag;
};
const std::vector<Side>& BothSides() {
  static const std::vector<Side> sides{{&LogSides::sim_format, &LogSides::sim_columns,
                                        &LogSides::sim_units, &LogSides::Sim, "--sim-columns "},
                                       {&LogSides::real_format, &LogSides::real_columns,
                                        &LogSides::real_units, &LogSides::Real, "--real-columns "}};
  return sides;
}

TEST_CASE("Columns of both sides are those of a side that says nothing of its own") {
  const size_t i = GENERATE(0, 1);
  const Side &own = BothSides()[i], &other = BothSides()[1 - i];
  LogSides sides;
  const auto read = [&](const Side& side) { return (sides.*side.read)(false); };
  SECTION("nothing was said") {
    CHECK(read(own).format == Format::kAuto);
    CHECK(read(own).columns.empty());
    CHECK(read(own).units.empty());
    CHECK(read(own).columns_flag == own.flag);
  }
  SECTION("of both") {
    sides.columns = "t=a,x=b,y=c";
    sides.units = "mm";
    CHECK(read(own).columns == "t=a,x=b,y=c");
    CHECK(read(own).units == "mm");
    CHECK(read(own).columns_flag == "--columns ");
  }
  SECTION("units of both alone") {
    sides.units = "cm";
    CHECK(read(own).units == "cm");
    CHECK(read(own).columns_flag == "--columns ");
  }
  SECTION("of its own in their place") {
    sides.columns = "t=a,x=b,y=c";
    sides.units = "mm";
    sides.*own.columns = "t=d,x=e,y=f";
    CHECK(read(own).columns == "t=d,x=e,y=f");
    CHECK(read(own).units == "mm");
    CHECK(read(own).columns_flag == own.flag);
    CHECK(read(other).columns == "t=a,x=b,y=c");
    CHECK(read(other).columns_flag == "--columns ");
  }
  SECTION("units of its own alone") {
    sides.columns = "t=a,x=b,y=c";
    sides.units = "mm";
    sides.*own.units = "cm";
    CHECK(read(own).columns == "t=a,x=b,y=c");
    CHECK(read(own).units == "cm");
    CHECK(read(own).columns_flag == own.flag);
    CHECK(read(other).units == "mm");
  }
  SECTION("a format is read without those of both, and with its own") {
    sides.columns = "t=a,x=b,y=c";
    sides.units = "mm";
    sides.*own.format = Format::kTum;
    CHECK(read(own).format == Format::kTum);
    CHECK(read(own).columns.empty());
    CHECK(read(own).units.empty());
    CHECK(read(own).columns_flag == own.flag);
    CHECK(read(other).format == Format::kAuto);
    sides.*own.columns = "t=d,x=e,y=f";
    CHECK(read(own).columns == "t=d,x=e,y=f");
  }
}

TEST_CASE("What is told of one log offers the flags of its side, whatever was said of both") {
  for (const Side& side : BothSides()) {
    const std::string units = side.flag.substr(0, side.flag.find("columns")) + "units ";
    LogSides sides;
    for (const std::string columns : {"", "t=a,x=b,y=c"}) {
      sides.columns = columns;
      CHECK((sides.*side.read)(false).OwnColumnsFlag() == side.flag);
      CHECK((sides.*side.read)(false).OwnUnitsFlag() == units);
    }
  }
}

TEST_CASE("Columns and units of both sides that hold for neither are refused") {
  GapJob job{.sim = "a.csv", .reals = {"b.csv"}};
  job.sides.units = "mm";
  job.sides.sim_format = Format::kRift;
  CHECK_NOTHROW(job.Check());
  job.sides.real_format = Format::kRift;
  CHECK_THROWS_WITH(job.Check(),
                    "--units 'mm' is of each side without a format or units of its own, and both "
                    "have one: leave it out");
  job.sides = {};
  job.sides.columns = job.sides.sim_columns = "t=a,x=b,y=c";
  CHECK_NOTHROW(job.Check());
  job.sides.units = "mm";
  job.sides.real_columns = "t=a,x=d,y=e";
  CHECK_THROWS_WITH(job.Check(), Catch::StartsWith("--columns 't=a,x=b,y=c' is of each side"));
  job.sides.columns.clear();
  CHECK_NOTHROW(job.Check());  // the units are those of both
  job.sides.sim_units = job.sides.real_units = "cm";
  CHECK_THROWS_WITH(job.Check(), Catch::StartsWith("--units 'mm' is of each side"));
}

TEST_CASE("Logs of a comparison in space are read in space, on both sides") {
  GapJob job;
  CHECK_FALSE(job.SimLogs().in_space);
  CHECK_FALSE(job.RealLogs().in_space);
  job.options.dimension = gap::Dimension::kXyz;
  CHECK(job.SimLogs().in_space);
  CHECK(job.RealLogs().in_space);
  job.sides.sim_columns = "t=a,x=b,y=c,z=d";
  CHECK(job.SimLogs().columns == "t=a,x=b,y=c,z=d");
  CHECK(job.RealLogs().columns.empty());
}

TEST_CASE("What is measured in the plane alone is refused in space") {
  GapJob job{.sim = "a.csv", .reals = {"b.csv"}};
  job.tag_offset_m = 0.03;
  job.sim_repeats = {"c.csv"};
  CHECK_NOTHROW(job.Check());
  job.options.dimension = gap::Dimension::kXyz;
  CHECK_THROWS_WITH(job.Check(), Contains("--tag-offset is 0.03") && Contains("xyz"));
  job.tag_offset_m = 0.0;
  CHECK_THROWS_WITH(job.Check(), Contains("--sim-repeats measures likeness"));
  job.sim_repeats.clear();
  CHECK_NOTHROW(job.Check());
  job.options.align = gap::Align::kSe2;  // a motion in the plane
  CHECK_THROWS_AS(job.Check(), std::invalid_argument);
}

TEST_CASE("Columns that break a rule are refused for each side before a log is read") {
  for (const Side& side : BothSides()) {
    GapJob job{.sim = "a.csv", .reals = {"b.csv"}};
    job.sides.*side.columns = "t=a,x=b";
    const std::string flag = side.flag.substr(0, side.flag.size() - 1);
    CHECK_THROWS_WITH(job.Check(), flag + ": y is missing in 't=a,x=b'");
    job.sides.*side.columns = "t=a,x=b,y=c";
    CHECK_NOTHROW(job.Check());
  }
}

TEST_CASE("A log is named once among the repeats of each side, and may stand on both") {
  const test::TemporaryFolder folder;
  for (const char* name : {"a.csv", "b.csv", "c.csv"}) test::WriteText(folder / name, "t\n");
  const std::string a = folder / "a.csv", b = folder / "b.csv", c = folder / "c.csv";
  const auto job = [](const std::string& sim, std::vector<std::string> reals,
                      std::vector<std::string> more) {
    return GapJob{.sim = sim, .reals = std::move(reals), .sim_repeats = std::move(more)};
  };
  CHECK_NOTHROW(job(a, {b, c}, {}).Check());
  CHECK_NOTHROW(job(a, {a, b}, {c}).Check());
  CHECK_THROWS_WITH(
      job(a, {b, c, b}, {}).Check(),
      b + " and " + b + " are one log, and each repeat is a run of its own: name it once");
  CHECK_THROWS_WITH(job(a, {b}, {c, a}).Check(), Contains(a + " and " + a));
  CHECK_THROWS_WITH(job(a, {b}, {c, c}).Check(), Contains(c + " and " + c));
}

/// A straight metre along x in a hundred steps, beside the x axis by `off_m`.
std::string Straight(double off_m) {
  trajectory::Trajectory path;
  for (int i = 0; i <= 100; ++i) {
    path.poses.push_back({.t_s = 0.05 * i, .x_m = 0.01 * i, .y_m = off_m, .yaw_rad = 0.0});
  }
  return trajectory::WriteRift(path);
}

TEST_CASE("A comparison keeps what it was asked, and moves the real paths forward alone") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "a.csv", Straight(0.0));
  test::WriteText(folder / "b.csv", Straight(0.04));
  test::WriteText(folder / "c.csv", Straight(-0.08));
  GapJob job{.sim = folder / "a.csv", .reals = {folder / "b.csv", folder / "c.csv"}};
  job.tag_offset_m = 0.03;
  job.options.threshold_m = 0.07;
  job.verdict.share = 0.2;
  const gap::GapResult result = MeasureGap(job, [](const std::string&) {});
  CHECK(result.sim_path == folder / "a.csv");
  CHECK(result.tag_offset_m == 0.03);
  CHECK(result.options.threshold_m == 0.07);
  CHECK(result.judged_by.share == 0.2);
  CHECK(result.sim.poses.front().x_m == 0.0);
  REQUIRE(result.reals.size() == 2);
  CHECK(result.reals[0].poses.front().x_m == Approx(0.03));
  CHECK(result.reals[1].poses.front().x_m == Approx(0.03));
  REQUIRE(result.trials.size() == 2);
  CHECK(result.trials[0].path == folder / "b.csv");
  CHECK(result.trials[1].path == folder / "c.csv");
  // Parallel lines, 3 cm further on.
  CHECK(result.trials[0].comparison.gap_m == Approx(0.05).margin(1e-6));
  CHECK(result.trials[1].comparison.gap_m == Approx(std::hypot(0.08, 0.03)).margin(1e-6));
  CHECK(result.mean_gap_m == Approx((0.05 + std::hypot(0.08, 0.03)) / 2.0).margin(1e-6));
  CHECK(result.noise_floor_m == Approx(0.12).margin(1e-6));
  CHECK(result.verdict.repeats == 2);
  CHECK(result.verdict.above == 1);
}

TEST_CASE("The likeness of repeats takes the first simulated run as one of them, with the seed") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "a.csv", Straight(0.0));
  test::WriteText(folder / "b.csv", Straight(0.02));
  test::WriteText(folder / "c.csv", Straight(0.05));
  test::WriteText(folder / "d.csv", Straight(0.11));
  GapJob job{.sim = folder / "a.csv",
             .reals = {folder / "c.csv", folder / "d.csv"},
             .sim_repeats = {folder / "b.csv"}};
  const gap::GapResult result = MeasureGap(job, [](const std::string&) {});
  REQUIRE(result.likeness);
  CHECK(result.likeness->sims == 2);
  CHECK(result.likeness->reals == 2);
  CHECK(result.likeness->spread_m.sim == Approx(0.02).margin(1e-6));
  CHECK(result.likeness->spread_m.real == Approx(0.06).margin(1e-6));
}

TEST_CASE("A further simulated run is read as the simulator's side says") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "a.csv", Straight(0.0));
  test::WriteText(folder / "b.csv", Straight(0.02));
  // The authors' header: without a format its angles are unknown, and the note says what to set.
  test::WriteText(folder / "c.csv",
                  "t,x,y,z,roll,pitch,yaw\n0,0,0,0,0,0,0\n1,0.5,0.02,0,0,0,0\n2,1,0.06,0,0,0,0\n");
  std::vector<std::string> lines;
  MeasureGap(
      {.sim = folder / "a.csv", .reals = {folder / "b.csv"}, .sim_repeats = {folder / "c.csv"}},
      [&lines](const std::string& line) { lines.push_back(line); });
  REQUIRE(lines.size() == 1);
  CHECK_THAT(lines[0], Contains("note: " + (folder / "c.csv")) && Contains("set --sim-format"));
}

}  // namespace
}  // namespace rift::sessions
