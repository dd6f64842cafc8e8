// goal: calibrate with candidate.kind: program, end to end: somebody else's simulator fitted to
// logs.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/documented.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"
#include "support/processes/quick_gnuplot.hpp"
#include "support/processes/shell.hpp"
#include "support/tree.hpp"

namespace rift {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::ProcessResult;
using test::ReadFile;
using test::RunRift;
using test::TemporaryFolder;
using test::WriteText;

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  REQUIRE(text.find(from) != std::string::npos);
  return text.replace(text.find(from), from.size(), to);
}

constexpr double kMu = 0.31, kMismatch = -0.09;

/// The thirty-line simulator and logs that it wrote with those values.
struct Bench {
  Bench() {
    const std::string script = ReadFile(test::SourceDir() + "/configs/programs/diff_drive.py");
    // A parameter that nothing depends on.
    WriteText(folder / "sim.py",
              Replaced(script, "trial = json.loads(line)",
                       "trial = json.loads(line); trial['theta'].pop('idle', 0)"));
    for (int i = 1; i <= 6; ++i) {
      const std::string command =
          fmt::format("python3 '{}' --mu {} --mismatch {} --seed {} --out '{}'", folder / "sim.py",
                      kMu, kMismatch, 300 + i, folder / fmt::format("robot_{}.csv", i));
      REQUIRE(test::RunShell(command) == 0);
    }
  }
  ProcessResult Run(const std::string& experiment, const std::vector<std::string>& more = {}) {
    WriteText(folder / "fit.yaml", experiment);
    std::vector<std::string> words{"sweep", folder / "fit.yaml", "--out", folder / "out"};
    words.insert(words.end(), more.begin(), more.end());
    return RunRift(words);
  }

  test::QuickGnuplot gnuplot;
  TemporaryFolder folder;
};

const std::string kFit = R"(goal: calibrate
candidate:
  kind: program
  run: [python3, sim.py, --serve]
  persistent: true
  columns: t=time,x=pose_x,y=pose_y,yaw=theta
  units: mm
reference: {kind: logs, path: 'robot_{trial}.csv', trials: 6, units: mm,
            columns: 't=time,x=pose_x,y=pose_y,yaw=theta'}
calibrate:
  fit:
    mu: {min: 0.05, max: 1.0}
    mismatch: {min: -0.3, max: 0.3}
    idle: {min: 0, max: 1}
  holdout: [6]
  judge_runs: 4
  method: {runs: 2, simulated_logs: 10, resamples: 200}
likeness: {shuffles: 19}
)";

TEST_CASE("The hidden parameters of a program are found again in logs that it wrote itself") {
  Bench bench;
  const ProcessResult run = bench.Run(kFit, {"--jobs", "2"});
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  const std::string text = ReadFile(bench.folder / "out/calibration.json");
  const json found = json::parse(text);
  CHECK(test::KeysOf(found) == test::DocumentedKeys("calibration.json"));
  const auto has_found = [&](const std::string& name, double truth, double within) {
    const json& parameter = found["fit"]["parameters"][name];
    INFO(name << ": " << parameter.dump());
    CHECK(parameter["low"].get<double>() <= truth);
    CHECK(parameter["high"].get<double>() >= truth);
    CHECK(parameter["high"].get<double>() - parameter["low"].get<double>() < within);
    CHECK(parameter["is_identified"] == true);
  };
  has_found("mu", kMu, 0.15);
  has_found("mismatch", kMismatch, 0.06);
  CHECK(found["fit"]["parameters"]["idle"]["has_effect"] == false);
  CHECK(found["fit"]["loss_after"].get<double>() < found["fit"]["loss_before"].get<double>());
  const json& held_out = found["judged"]["all"]["held out"];
  CHECK(held_out["after"]["mean_path_gap_m"].get<double>() <
        held_out["before"]["mean_path_gap_m"].get<double>());
  CHECK(found["errors"].empty());
  CHECK(run.err.find("whole runs") != std::string::npos);
  CHECK(fs::exists(bench.folder / "out/figures/calibration.png"));
  REQUIRE(bench.Run(kFit, {"--jobs", "1", "--force"}).exit_code == 0);
  CHECK(ReadFile(bench.folder / "out/calibration.json") == text);
}

TEST_CASE("A fit of a program starts at what is known of it, and a prior holds what no log tells") {
  Bench bench;
  const std::string known =
      Replaced(kFit, "idle: {min: 0, max: 1}", "idle: {min: 0, max: 1, mean: 0.7, sd: 0.02}");
  REQUIRE(bench.Run(known, {"--set", "calibrate.method.iterations=2"}).exit_code == 0);
  const json found = json::parse(ReadFile(bench.folder / "out/calibration.json"));
  const json& idle = found["fit"]["parameters"]["idle"];
  CHECK(idle["start"].get<double>() == 0.7);
  CHECK(idle["value"].get<double>() == Approx(0.7).margin(0.01));
  CHECK(idle["is_from_prior"] == true);
  CHECK(found["fit"]["parameters"]["mu"]["start"].get<double>() == Approx(0.525));
}

TEST_CASE("What does not apply to a program that is fitted is refused in one line") {
  Bench bench;
  const auto refusal = [&](const std::string& from, const std::string& to,
                           const std::vector<std::string>& more = {}) {
    const ProcessResult result = bench.Run(Replaced(kFit, from, to), more);
    CHECK(result.exit_code == 2);
    CHECK_FALSE(fs::exists(bench.folder / "out/calibration.json"));
    return result.err;
  };
  const auto has = [](const std::string& text, const std::string& part) {
    INFO(text);
    CHECK(text.find(part) != std::string::npos);
  };
  has(refusal("{runs: 2", "{horizon: {phases: 2}"), "rift cannot ask of a program");
  has(refusal("runs: 2", "runs: 0"), "fitted by its whole runs");
  has(refusal("idle: {", "out: {"), "calls something else (seed, trial, out");
  has(refusal("idle: {", "wheel.mu: {"), "shares its name 'mu'");
  has(refusal("kind: logs, path: 'robot_{trial}.csv', trials: 6", "kind: nominal"),
      "reference.kind is not logs");
  has(refusal("mu: {", "mu: {", {"--write-robot", bench.folder / "r.yaml"}),
      "--write-robot writes the robot of rift's own simulator");
  has(refusal("--serve]", "--server]"), "not one of 10 runs of the program where the fit starts");
  has(refusal("kind: program", "kind: logs\n  path: a.csv"), "only a simulator can be fitted");
}

TEST_CASE("A program that hangs does not hold up the likeness of a sweep over repeated logs") {
  Bench bench;
  WriteText(bench.folder / "sometimes.py",
            "import sys, time, shutil\n"
            "time.sleep(7357 if sys.argv[1] == 'hang' else 0)\n"
            "shutil.copy(sys.argv[2], sys.argv[3])\n");
  const ProcessResult run = bench.Run(
      "candidate: {kind: program, columns: 't=time,x=pose_x,y=pose_y', units: mm,\n"
      "  run: [python3, sometimes.py, '{mode}', robot_6.csv, '{out}']}\n"
      "reference: {kind: logs, path: 'robot_{trial}.csv', trials: 2, units: mm,\n"
      "            columns: 't=time,x=pose_x,y=pose_y'}\n"
      "space: {mode: [good, hang]}\n"
      "run: {timeout_s: 10, retries: 0}\n"
      "likeness: {shuffles: 19}\n",
      {"--jobs", "2"});
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  const json likeness = json::parse(ReadFile(bench.folder / "out/likeness.json"));
  CHECK(likeness.dump().find("\"all\"") != std::string::npos);
}

}  // namespace
}  // namespace rift
