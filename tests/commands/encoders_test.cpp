#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "support/documented.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"
#include "support/processes/quick_gnuplot.hpp"
#include "support/tree.hpp"

namespace rift {
namespace {

using nlohmann::json;
using test::RunRift;

const std::string kEncoders = test::SourceDir() + "/configs/encoders.yaml";

std::string Lap(const test::TemporaryFolder& folder, const std::string& name,
                const std::vector<std::string>& more) {
  std::vector<std::string> words{"simulate", kEncoders, "--out", folder / name};
  words.insert(words.end(), more.begin(), more.end());
  const test::ProcessResult result = RunRift(words);
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  return folder / name;
}

TEST_CASE("The tables of figure 14 come from one command and respond to surface and speed") {
  const test::QuickGnuplot gnuplot;
  const test::TemporaryFolder folder;
  const test::ProcessResult swept =
      RunRift({"sweep", kEncoders, "--out", folder / "out", "--quiet"});
  INFO(swept.out << swept.err);
  REQUIRE(swept.exit_code == 0);
  CHECK_THAT(swept.out, Catch::Contains("mean distance from the programmed path (m)") &&
                            Catch::Contains("spread of the repeats (m)") &&
                            Catch::Contains("sqrt(sx^2 + sy^2)"));
  const json programs = json::parse(test::ReadFile(folder / "out/programs.json"));
  REQUIRE(programs["cells"].size() == 9);
  CHECK(test::KeysOf(programs["cells"][0]) == test::DocumentedKeys("programs.json"));
  const auto cell = [&](const std::string& surface, double power) {
    for (const json& each : programs["cells"]) {
      if (each["theta"]["surface"] == surface && each["theta"]["power"] == power) return each;
    }
    FAIL("no cell of " << surface);
    return json();
  };
  for (const json& each : programs["cells"]) {
    CHECK(each["runs"] == 5);
    CHECK(each["trials"].size() == 5);
  }
  // Parchment is dry or wet: faster spreads and drifts more, wet slips more than dry, and more the
  // faster.
  for (const char* surface : {"parchment", "wet_parchment"}) {
    CHECK(cell(surface, 0.75)["spread_m"] > cell(surface, 0.25)["spread_m"]);
    CHECK(cell(surface, 0.75)["drift_per_m"] > cell(surface, 0.25)["drift_per_m"]);
  }
  CHECK(cell("wet_parchment", 0.75)["slip_left"] > cell("wet_parchment", 0.25)["slip_left"]);
  for (const double power : {0.25, 0.5, 0.75}) {
    CHECK(cell("wet_parchment", power)["slip_right"] > cell("parchment", power)["slip_right"]);
    CHECK(cell("bump", power)["spread_m"] > cell("wet_parchment", power)["spread_m"]);
  }
  for (const double power : {0.5, 0.75}) {  // at 0.25 both drift by 0.07 m per m (40 runs of each)
    CHECK(cell("bump", power)["drift_per_m"] > cell("wet_parchment", power)["drift_per_m"]);
  }
  const std::string page = test::ReadFile(folder / "out/report.html");
  CHECK_THAT(page, Catch::Contains("Distance from the programmed path") &&
                       Catch::Contains("Slip of the left wheel along the program"));
}

TEST_CASE("Runs both ways round tell a planted asymmetry of the wheels") {
  const test::TemporaryFolder folder;
  const std::vector<std::string> robot{"--set", "simulation.body.right_over_left=1.01",
                                       "--set", "simulation.body.track_m=0.085",
                                       "--set", "simulation.terrain.surface=ground"};
  std::vector<std::string> words{"gap"};
  for (const std::string name : {"ccw1", "ccw2", "cw1", "cw2"}) {
    std::vector<std::string> more = robot;
    if (name.starts_with("cw")) {
      more.insert(more.end(), {"--set",
                               "program.segments=[{straight_m: 0.5}, {turn_deg: -90, "
                               "radius_m: 0.25}]"});
    }
    more.insert(more.end(), {"--seed", std::to_string(words.size())});
    words.push_back(Lap(folder, name, more));
  }
  words.insert(words.end(), {"--calibrate-odometry", "--json", "-"});
  const test::ProcessResult result = RunRift(words);
  INFO(result.out << result.err);
  REQUIRE(result.exit_code == 0);
  const json found = json::parse(result.out);
  CHECK(test::KeysOf(found) == test::DocumentedKeys("rift gap --odometry --json"));
  CHECK(found["umbmark"]["ccw_runs"] == 2);
  CHECK(found["umbmark"]["cw_runs"] == 2);
  CHECK(found["umbmark"]["largest_m"] > 0.1);
  CHECK(found["cell"].is_null());  // left and right squares are two programs
  const json& calibration = found["calibration"];
  CHECK(calibration["right_over_left"]["value"] == Approx(1.01).margin(0.001));
  CHECK(calibration["track_m"]["value"] == Approx(0.085).epsilon(0.01));  // the ground is uneven
  CHECK(calibration["wheel_radius_m"]["value"] == Approx(0.016).epsilon(0.005));
  CHECK(calibration["right_over_left"]["interval"][0] > 1.0);
}

TEST_CASE("Most of what the odometry turns too far in a lap is the track of the data sheet") {
  const test::TemporaryFolder folder;
  const std::string sheet = Lap(folder, "sheet", {}),
                    body = Lap(folder, "body", {"--set", "hardware.odometry.drive.track_m=0.084"});
  const test::ProcessResult result = RunRift({"gap", sheet, body, "--odometry", "--json", "-"});
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  const json runs = json::parse(result.out)["runs"];
  const double sheet_rad = runs[0]["yaw_drift_rad"], body_rad = runs[1]["yaw_drift_rad"];
  // 360 deg x (0.084 / 0.083 - 1) are 4.3 deg, beside what slips on the two ways.
  CHECK(sheet_rad - body_rad == Approx(0.076).margin(0.03));
  CHECK(std::abs(body_rad) < 0.06);
}

TEST_CASE("Repeats of a program are a cell and its words say what was measured") {
  const test::TemporaryFolder folder;
  const std::string a = Lap(folder, "a", {"--seed", "1"}), b = Lap(folder, "b", {"--seed", "2"});
  const test::ProcessResult result = RunRift({"gap", a, b, "--odometry"});
  CHECK(result.exit_code == 0);
  CHECK_THAT(result.out, Catch::Contains("2 of 2 runs of one program moved") &&
                             Catch::Contains("odometry from camera") &&
                             Catch::Contains("slip of the wheels"));
  const test::ProcessResult bare =
      RunRift({"gap", a + "/trajectory.csv", "--program", kEncoders, "--json", "-"});
  CHECK(bare.exit_code == 0);
  CHECK(json::parse(bare.out)["runs"][0]["deviation_m"] > 0.0);
}

TEST_CASE("What cannot be held together is refused with what to do") {
  const test::TemporaryFolder folder;
  const auto refused = [](const std::vector<std::string>& words, const std::string& says) {
    const test::ProcessResult result = RunRift(words);
    INFO(result.err);
    CHECK(result.exit_code == 2);
    CHECK_THAT(result.err, Catch::Contains(says));
  };
  const std::string task = test::SourceDir() + "/configs/waypoints/paper.yaml";
  const std::string lap = Lap(folder, "lap", {});
  refused({"gap", lap}, "REAL is required");
  refused({"gap", lap, lap, "--odometry"}, "are one log");
  refused({"gap", lap, "--program", task}, "has no program");
  refused({"gap", lap, "--odometry", "--figure", "f.svg"}, "leave them out with --odometry");
  for (const std::string flag : {"--threshold", "--tag-offset", "--skip-start"}) {
    refused({"gap", lap, "--odometry", flag, "0.05"}, flag + " is for the gap of two logs");
  }
  refused({"gap", lap, "--program", kEncoders, "--exit-code"}, "--exit-code is for the gap");
  const std::string program = folder / "program.yaml";
  test::WriteText(program, test::ReadFile(lap + "/experiment.yaml"));
  refused({"gap", lap, "--program", program, "--json", program, "--force"}, "is an input");
  refused({"gap", lap, "--calibrate-odometry", "--window", "1000"}, "smaller window_s");
  test::WriteText(folder / "bare/trajectory.csv", test::ReadFile(lap + "/trajectory.csv"));
  refused({"gap", folder / "bare", "--odometry"}, "neither encoders");
  refused({"simulate", kEncoders, "--set", "program.segments=[{straight_m: 1, hold_s: 1}]"},
          "one of straight_m, turn_deg and hold_s");
  refused({"simulate", task, "--set", "program.segments=[{straight_m: 1}]"}, "beside a program");
  refused({"sweep", kEncoders, "--set", "program.power=2", "--out", folder / "s"}, "program.power");
}

TEST_CASE("A search for where dead reckoning fails is judged by odometry") {
  const test::QuickGnuplot gnuplot;
  const test::TemporaryFolder folder;
  test::WriteText(folder / "slip.yaml", "include: " + kEncoders + R"(
name: slip
goal: falsify
objective: odometry
space: {program.power: {min: 0.2, max: 0.8}}
simulation: {terrain: {surface: wet_parchment}}
gap: {threshold_m: 0.15}
search: {budget: 8}
)");
  const test::ProcessResult result =
      RunRift({"sweep", folder / "slip.yaml", "--out", folder / "out", "--quiet", "--json"});
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  const json summary = json::parse(result.out);
  CHECK(summary["falsification"]["verdict"] == "falsified");
}

}  // namespace
}  // namespace rift
