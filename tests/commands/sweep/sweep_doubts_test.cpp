// Mistakes in logs, and in what a program writes, that a sweep warns of once.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"
#include "support/processes/quick_gnuplot.hpp"
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

/// A path that turns left and right, 1.25 m in 5 s, `error_m` off; every value times its factor.
std::string Log(double error_m, double length_factor = 1.0, double time_factor = 1.0,
                size_t rows = 100) {
  std::string text = "t,x,y\n";
  double x = 0.0, y = 0.0;
  for (size_t i = 0; i < rows; ++i) {
    const auto at = static_cast<double>(i);
    text += fmt::format("{:.6f},{:.9f},{:.9f}\n", 0.05 * at * time_factor, x * length_factor,
                        (y + error_m * std::sin(0.03 * at)) * length_factor);
    x += 0.0125 * std::cos(0.4 + std::sin(0.06 * at));
    y += 0.0125 * std::sin(0.4 + std::sin(0.06 * at));
  }
  return text;
}

size_t Count(const std::string& text, const std::string& part) {
  size_t count = 0;
  for (size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// A program that copies a log, chosen by {mode}; four logs of the robot.
struct Bench {
  Bench() {
    WriteText(folder / "copy.py", "import shutil, sys; shutil.copy(sys.argv[1], sys.argv[2])\n");
    for (const double k : {1.0, 2.0, 3.0, 4.0}) {
      WriteText(folder / fmt::format("robot_{}.csv", k), Log(0.01 * k));
    }
  }
  ProcessResult Sweep(const std::string& mode_list, const std::string& jobs = "2") {
    WriteText(folder / "sweep.yaml",
              "candidate: {kind: program, columns: 't=t,x=x,y=y',\n"
              "  run: [python3, copy.py, '{folder}/../" +
                  folder.Path().filename().string() + "/sim_{mode}.csv', '{out}']}\n" +
                  "reference: {kind: logs, path: 'robot_{trial}.csv', trials: 4,\n"
                  "            columns: 't=t,x=x,y=y'}\n"
                  "likeness: {shuffles: 19}\nspace: {mode: [" +
                  mode_list + "]}\n");
    ProcessResult result = RunRift(
        {"sweep", folder / "sweep.yaml", "--out", folder / "out", "--jobs", jobs, "--force"});
    INFO(result.err);
    REQUIRE(result.exit_code == 0);
    return result;
  }
  json Doubts() const {
    return json::parse(ReadFile(fs::path(folder / "out") / "summary.json")).at("doubts");
  }

  test::QuickGnuplot gnuplot;
  TemporaryFolder folder;
};

TEST_CASE("A sweep warns once of a program that writes millimetres, and keeps it") {
  Bench bench;
  WriteText(bench.folder / "sim_a.csv", Log(0.0, 1000.0));
  WriteText(bench.folder / "sim_b.csv", Log(0.02, 1000.0));
  const ProcessResult run = bench.Sweep("a, b");
  INFO(run.err);
  CHECK(Count(run.err, "warning: ") == 2);
  CHECK(Count(run.err,
              "are its positions in mm or cm? name the unit, as in --set candidate.units=mm") == 1);
  CHECK(Count(run.err, "mm for m?") == 1);
  const json doubts = bench.Doubts();
  REQUIRE(doubts.size() == 2);
  CHECK(doubts[0]["about"] == "candidate");
  CHECK(doubts[0]["trials"] == 8);
  CHECK(doubts[0]["row"] == 1);
  CHECK(doubts[1]["about"] == "pair");
  const std::string summary = ReadFile(fs::path(bench.folder / "out") / "summary.json");
  bench.Sweep("a, b", "1");
  CHECK(ReadFile(fs::path(bench.folder / "out") / "summary.json") == summary);
}

TEST_CASE("A sweep warns of a program's milliseconds and of its mirrored axis") {
  Bench bench;
  WriteText(bench.folder / "sim_late.csv", Log(0.0, 1.0, 1000.0));
  CHECK(bench.Sweep("late").err.find("are its times in ms") != std::string::npos);
  std::string mirrored = "t,x,y\n";
  const std::string log = Log(0.0);
  for (size_t at = log.find('\n') + 1; at < log.size(); at = log.find('\n', at) + 1) {
    const size_t last = log.rfind(',', log.find('\n', at));
    const std::string y = log.substr(last + 1, log.find('\n', at) - last - 1);
    mirrored += log.substr(at, last + 1 - at) + (y[0] == '-' ? y.substr(1) : "-" + y) + "\n";
  }
  WriteText(bench.folder / "sim_mirror.csv", mirrored);
  CHECK(bench.Sweep("mirror").err.find("mirrored y") != std::string::npos);
}

TEST_CASE("What few runs of a program show is no doubt of the sweep, but one cut log is") {
  Bench bench;
  WriteText(bench.folder / "sim_a.csv", Log(0.0));
  WriteText(bench.folder / "sim_b.csv", Log(0.02));
  WriteText(bench.folder / "sim_c.csv", Log(0.0, 1000.0));
  const ProcessResult run = bench.Sweep("a, b, c");
  CHECK(run.err.find("warning") == std::string::npos);
  CHECK(bench.Doubts().empty());
  WriteText(bench.folder / "robot_3.csv", Log(0.01, 1.0, 1.0, 55));
  WriteText(bench.folder / "logs.yaml",
            "candidate: {kind: logs, path: sim_a.csv, columns: 't=t,x=x,y=y'}\n"
            "reference: {kind: logs, path: 'robot_{trial}.csv', trials: 4,\n"
            "            columns: 't=t,x=x,y=y'}\nlikeness: {shuffles: 19}\n");
  const ProcessResult logs =
      RunRift({"sweep", bench.folder / "logs.yaml", "--out", bench.folder / "out", "--force"});
  INFO(logs.err);
  CHECK(Count(logs.err, "warning: ") == 1);
  CHECK(logs.err.find("robot_3.csv: REAL covers only u = 0.00") != std::string::npos);
  CHECK(bench.Doubts()[0]["row"] == 3);
}

TEST_CASE("Logs in the wrong unit are doubted once in a sweep of rift's own simulator") {
  const test::QuickGnuplot gnuplot;
  const TemporaryFolder folder;
  const std::string task = "waypoints: [{x: 0, y: 0, heading: 0}, {x: 0.4, y: 0.05, stop: true}]\n";
  WriteText(folder / "task.yaml", task);
  for (const std::string n : {"1", "2", "3"}) {
    REQUIRE(RunRift({"simulate", folder / "task.yaml", "--seed", "1" + n, "--out",
                     folder / ("log" + n + ".csv")})
                .exit_code == 0);
  }
  const std::string sweep = task + "reference: {kind: logs, path: 'log{trial}.csv', trials: 3}\n" +
                            "space: {control.v_min: [0.1, 0.15]}\nlikeness: {shuffles: 19}\n";
  WriteText(folder / "sound.yaml", sweep);
  const ProcessResult sound =
      RunRift({"sweep", folder / "sound.yaml", "--out", folder / "sound", "--jobs", "2"});
  INFO(sound.err);
  CHECK(sound.exit_code == 0);
  CHECK(sound.err.find("warning") == std::string::npos);
  const ProcessResult wrong =
      RunRift({"sweep", folder / "sound.yaml", "--out", folder / "wrong", "--jobs", "2", "--set",
               "reference.columns='t=t_s:ms,x=x_m:cm,y=y_m:cm'"});
  INFO(wrong.err);
  CHECK(wrong.exit_code == 0);
  CHECK(Count(wrong.err, "times as large as that of REAL: cm for m?") == 1);
  CHECK(Count(wrong.err, "are its times in another unit") <= 1);
}

}  // namespace
}  // namespace rift
