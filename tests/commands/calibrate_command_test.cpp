#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "support/documented.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"
#include "support/processes/quick_gnuplot.hpp"
#include "support/processes/running_rift.hpp"

namespace rift {
namespace {

using nlohmann::json;
using test::ProcessResult;
using test::ReadFile;
using test::RunRift;
using test::WriteText;

const std::string kTask = R"(waypoints: [{x: 0, y: 0, heading: 0}, {x: 0.4, y: 0.05, stop: true}]
simulation: {step_s: 0.008, motor: {dead_band: 0.05}}
trial: {pace: new_pose}
)";
const std::string kCalibrate = kTask + R"(goal: calibrate
reference: {kind: logs, path: "log{trial}.csv", trials: [1, 2, 3, 4]}
calibrate:
  holdout: [4]
  fit: {motor.mismatch: {min: -0.1, max: 0.1}, surfaces.bump.mu: {min: 0.5, max: 1.2}}
  judge_runs: 2
  method: {runs: 1, iterations: 2, horizon: {phases: 2}, simulated_logs: 6, resamples: 100}
likeness: {shuffles: 19}
)";

/// A folder with the logs of a robot whose left wheel is 5 % faster.
struct Bench {
  Bench() {
    WriteText(task, kTask);
    for (int i = 1; i <= 4; ++i) {
      const std::string n = std::to_string(i);
      REQUIRE(RunRift({"simulate", task, "--set", "simulation.motor.mismatch=0.05", "--seed", n,
                       "--out", folder / ("log" + n + ".csv")})
                  .exit_code == 0);
    }
  }
  ProcessResult Run(const std::string& experiment, const std::vector<std::string>& more = {}) {
    WriteText(file, experiment);
    std::vector<std::string> words{"sweep", file, "--out", folder / "out"};
    words.insert(words.end(), more.begin(), more.end());
    return RunRift(words);
  }

  test::QuickGnuplot gnuplot;
  test::TemporaryFolder folder;
  std::string task = folder / "task.yaml";
  std::string file = folder / "calibrate.yaml";
};

/// Where it does not matter how well the fit is.
const std::vector<std::string> kRough{"--set", "calibrate.method.horizon.phases=1",
                                      "--set", "calibrate.method.corrections=1",
                                      "--set", "calibrate.method.simulated_logs=2"};

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST_CASE("A calibration finds the mismatch and its robot file is used as an include") {
  Bench bench;
  const std::string robot = bench.folder / "robot.yaml";
  const ProcessResult run = bench.Run(kCalibrate, {"--write-robot", robot, "--jobs", "2"});
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  const json found = json::parse(ReadFile(bench.folder / "out/calibration.json"));
  CHECK(test::KeysOf(found) == test::DocumentedKeys("calibration.json"));
  const json& fitted = found["fit"]["parameters"];
  const json& mismatch = fitted["simulation.motor.mismatch"];
  CHECK(mismatch["value"].get<double>() == Approx(0.05).margin(0.03));
  CHECK(mismatch["low"].get<double>() < 0.05);
  CHECK(mismatch["high"].get<double>() > 0.05);
  CHECK(fitted["simulation.terrain.surfaces.bump.mu"]["has_effect"] == false);
  CHECK(run.out.find("no effect") != std::string::npos);
  CHECK(found["judged"]["all"].contains("held out"));
  CHECK(std::filesystem::exists(bench.folder / "out/figures/calibration.png"));

  const std::string text = ReadFile(robot);
  CHECK(text.find("interval") != std::string::npos);
  CHECK(text.find("log1.csv") != std::string::npos);
  WriteText(bench.task,
            "include: robot.yaml\n" +
                Replaced(kTask, "simulation: {step_s: 0.008, motor: {dead_band: 0.05}}\n", ""));
  const ProcessResult drive =
      RunRift({"simulate", bench.task, "--out", bench.folder / "again.csv", "--json"});
  INFO(drive.err);
  CHECK(drive.exit_code == 0);
  CHECK(ReadFile(bench.folder / "again.experiment.yaml").find("mismatch: 0.0") !=
        std::string::npos);

  const std::string first = ReadFile(bench.folder / "out/calibration.json");
  REQUIRE(bench.Run(kCalibrate, {"--jobs", "1"}).exit_code == 0);
  CHECK(ReadFile(bench.folder / "out/calibration.json") == first);
}

TEST_CASE(
    "What is known beside the logs holds what they cannot tell, and a wrong prior holds all") {
  Bench bench;
  const std::string known = Replaced(kCalibrate, "surfaces.bump.mu: {min: 0.5, max: 1.2}",
                                     "surfaces.bump.mu: {min: 0.5, max: 1.2, mean: 0.9, sd: 0.05}");
  const auto fitted = [&](const std::string& experiment) {
    const ProcessResult run = bench.Run(experiment);
    INFO(run.err);
    REQUIRE(run.exit_code == 0);
    return json::parse(ReadFile(bench.folder / "out/calibration.json"))["fit"]["parameters"];
  };
  const json loose = fitted(known);
  const json& mu = loose["simulation.terrain.surfaces.bump.mu"];
  CHECK(mu["value"].get<double>() == Approx(0.9).margin(0.005));
  CHECK(mu["is_from_prior"] == true);
  CHECK(mu["prior_sd"] == 0.05);
  // 1.96 standard deviations to either side, wider for three logs.
  CHECK(mu["high"].get<double>() - mu["low"].get<double>() > 2.0 * 1.5 * 0.05);
  CHECK(loose["simulation.motor.mismatch"]["is_from_prior"] == false);
  CHECK(loose["simulation.motor.mismatch"]["prior_mean"].is_null());
  CHECK(loose["simulation.motor.mismatch"]["value"].get<double>() == Approx(0.05).margin(0.03));
  std::filesystem::remove_all(bench.folder / "out");
  const json tight = fitted(
      Replaced(known, "min: -0.1, max: 0.1", "min: -0.1, max: 0.1, mean: -0.02, sd: 0.0001"));
  const json& mismatch = tight["simulation.motor.mismatch"];
  CHECK(mismatch["value"].get<double>() == Approx(-0.02).margin(0.002));
  CHECK(mismatch["is_from_prior"] == true);
}

TEST_CASE("A fit that is told to stop says that it starts over, and leaves nothing behind") {
  Bench bench;
  WriteText(bench.file, Replaced(kCalibrate, "phases: 2", "phases: 1000"));
  test::RunningRift running({"sweep", bench.file, "--out", bench.folder / "out"});
  running.WaitUntil("the fit",
                    [&] { return running.Err().find("fitting 2") != std::string::npos; });
  running.Signal(SIGTERM);
  const ProcessResult stopped = running.Wait();
  CHECK(stopped.exit_code == 130);
  CHECK(stopped.out.empty());
  CHECK_THAT(stopped.err, Catch::EndsWith("stopped; the same command starts over\n"));
  CHECK(std::filesystem::is_empty(bench.folder / "out"));
}

TEST_CASE("Flags of a sweep are refused by a fit, which would do nothing with them") {
  Bench bench;
  for (const std::vector<std::string>& flags :
       std::vector<std::vector<std::string>>{{"--budget", "5"},
                                             {"--seconds", "5"},
                                             {"--suggest", "2"},
                                             {"--shrink", "worst"},
                                             {"--rare-event"},
                                             {"--brief"},
                                             {"--exit-code"},
                                             {"--serve"}}) {
    const ProcessResult run = bench.Run(kCalibrate, flags);
    INFO(flags[0]);
    CHECK(run.exit_code == 2);
    CHECK(run.err.find("goal is calibrate, a fit, and " + flags[0] + " is of a sweep") !=
          std::string::npos);
    CHECK_FALSE(std::filesystem::exists(bench.folder / "out"));
  }
}

TEST_CASE("Fits from several starts stand beside each other, and the first one counts") {
  Bench bench;
  const std::string one = Replaced(kCalibrate, ", surfaces.bump.mu: {min: 0.5, max: 1.2}", "");
  REQUIRE(bench.Run(one, kRough).exit_code == 0);
  const json alone = json::parse(ReadFile(bench.folder / "out/calibration.json"));
  CHECK(alone["agreement"].empty());
  std::vector<std::string> more = kRough;
  more.insert(more.end(), {"--set", "calibrate.starts=2", "--force"});
  const ProcessResult run = bench.Run(one, more);
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  const json twice = json::parse(ReadFile(bench.folder / "out/calibration.json"));
  CHECK(twice["fit"]["parameters"] == alone["fit"]["parameters"]);
  const json& mismatch = twice["agreement"]["simulation.motor.mismatch"];
  REQUIRE(mismatch["values"].size() == 2);
  CHECK(mismatch["values"][0] == alone["fit"]["parameters"]["simulation.motor.mismatch"]["value"]);
  // Two steps from elsewhere need not arrive at the same place; that is what is told here.
  CHECK(std::abs(mismatch["values"][1].get<double>()) <= 0.1);
  CHECK(mismatch["values"][0] != mismatch["values"][1]);
  CHECK((mismatch["difference"].get<double>() <= 0.3) == mismatch["agrees"].get<bool>());
  CHECK(run.out.find("fits from 2 starts") != std::string::npos);
}

TEST_CASE("What held-out logs hold changes nothing that is fitted") {
  Bench bench;
  REQUIRE(bench.Run(kCalibrate, kRough).exit_code == 0);
  const json before = json::parse(ReadFile(bench.folder / "out/calibration.json"));
  std::filesystem::copy_file(bench.folder / "log1.csv", bench.folder / "log4.csv",
                             std::filesystem::copy_options::overwrite_existing);
  REQUIRE(bench.Run(kCalibrate, kRough).exit_code == 0);
  const json after = json::parse(ReadFile(bench.folder / "out/calibration.json"));
  CHECK(before["fit"] == after["fit"]);
  CHECK(before["judged"]["all"]["held out"] != after["judged"]["all"]["held out"]);
}

TEST_CASE("A calibration that cannot be is refused with one line that says why") {
  test::TemporaryFolder folder;
  const auto refused = [&](const std::string& from, const std::string& to) {
    WriteText(folder / "bad.yaml", Replaced(kCalibrate, from, to));
    const ProcessResult run = RunRift({"sweep", folder / "bad.yaml", "--out", folder / "out"});
    CHECK(run.exit_code == 2);
    CHECK(std::count(run.err.begin(), run.err.end(), '\n') == 1);
    return run.err;
  };
  using Catch::Contains;
  CHECK_THAT(refused("motor.mismatch", "motor.mismtach"), Contains("is unknown"));
  CHECK_THAT(refused("min: -0.1, max: 0.1", "min: -0.1"), Contains("max is missing"));
  CHECK_THAT(refused("min: -0.1, max: 0.1", "min: -0.1, max: 7"), Contains("7"));
  CHECK_THAT(refused("max: 0.1", "max: 0.1, mean: 0"), Contains("mean: m, sd: s"));
  CHECK_THAT(refused("max: 0.1", "max: 0.1, mean: 0, sd: 0"), Contains("must be above 0"));
  CHECK_THAT(refused("max: 0.1", "max: 0.1, mean: 1, sd: 1"), Contains("must lie in the range"));
  CHECK_THAT(refused("max: 0.1", "max: 0.1, mean: 0, width: 1"), Contains("mean: m, sd: s"));
  CHECK_THAT(refused("min: -0.1, max: 0.1", "min: 0.01, max: 0.1"), Contains("starts at 0"));
  CHECK_THAT(refused("motor.mismatch", "motor.model"), Contains("only a number can be fitted"));
  CHECK_THAT(refused("motor.mismatch", "\"surfaces.{surface}.mu\""),
             Contains("'surface' of space"));
  CHECK_THAT(refused("holdout: [4]", "holdout: [5]"), Contains("calibrate.holdout names trial 5"));
  CHECK_THAT(refused("holdout: [4]", "holdout: [1, 2, 3, 4]"), Contains("none is left to fit"));
  CHECK_THAT(refused("kind: logs, path: \"log{trial}.csv\"", "kind: nominal"),
             Contains("reference.kind is not logs"));
  CHECK_THAT(refused("log{trial}.csv", "none{trial}.csv"), Contains("at least 2 logs"));
}

TEST_CASE("Writing a robot without a calibration is refused") {
  test::TemporaryFolder folder;
  WriteText(folder / "task.yaml", kTask);
  const ProcessResult run = RunRift({"sweep", folder / "task.yaml", "--out", folder / "out",
                                     "--write-robot", folder / "robot.yaml"});
  CHECK(run.exit_code == 2);
  CHECK(run.err.find("goal: calibrate") != std::string::npos);
}

}  // namespace
}  // namespace rift
