#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <fstream>

#include "rift/files/files.hpp"
#include "support/processes/process.hpp"
#include "support/processes/quick_gnuplot.hpp"
#include "support/processes/running_rift.hpp"
#include "support/processes/until_done.hpp"
#include "support/tree.hpp"
#include "support/until.hpp"

namespace rift {
namespace {

namespace fs = std::filesystem;

// A short way, pictures that cost little, and limits that a loaded machine keeps as well.
constexpr const char* kTask = R"(
name: table
waypoints:
  - {name: start, x: 0.0, y: 0.0, heading: 0.0}
  - {name: end, x: 0.15, y: 0.0}
space: {simulation.terrain.surface: [ground, cardboard]}
reference: {trials: 2}
twin: {fps: 10, still_s: 60, camera: {grain_grey: 0, jpeg_colour: false}}
track: {tag: {acquire_decimate: 2, lost_after_s: 5}, capture: {silent_s: 20, same_s: 20, open_timeout_s: 60}}
trial: {pose_stale_s: 5, lost_after_s: 20, timeout_s: 60}
hardware:
  line: {hello_s: 20}
  guard: {pose_stale_s: 2, control_stale_s: 2, link_lag_s: 2, host_stall_s: 2}
  ping: {duration_s: 0.5, max_p99_s: 10, max_loss: 1, max_burst: 1000}
  start: {countdown_s: 0}
  turn: {enabled: false}
  evidence: {max_latency_s: 2}
)";

/// The command that drives, on twins of its own, everything that is not driven yet.
struct Bench {
  Bench() {
    test::WriteText(folder / "task.yaml",
                    "include: " + test::SourceDir() + "/configs/twin.yaml\n" + std::string(kTask));
  }
  std::vector<std::string> Command(const std::vector<std::string>& more,
                                   const std::string& twin) const {
    std::vector<std::string> words{"drive",
                                   folder / "task.yaml",
                                   "--yes",
                                   "--out",
                                   folder / "run",
                                   "--before-each",
                                   test::BuildDir() + "/rift simulate " + (folder / "task.yaml") +
                                       " --twin --force --seed {trial} " + twin};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  bool Has(const std::string& name) const { return fs::exists(folder / ("run/" + name)); }
  std::string Read(const std::string& name) const {
    return files::ReadFile(folder / ("run/" + name));
  }

  test::TemporaryFolder folder;
};

/// True while a process has the text among its arguments.
bool IsAtWork(const std::string& text) {
  std::error_code gone;
  for (const fs::directory_entry& process : fs::directory_iterator("/proc", gone)) {
    std::ifstream arguments(process.path() / "cmdline");
    std::string line;
    while (std::getline(arguments, line, '\0')) {
      if (line.starts_with(text)) return true;
    }
  }
  return false;
}

/// False when a busy machine interrupted one of the first drives.
bool GridGoesOnAfterKill() {
  const Bench bench;
  const std::vector<std::string> command =
      bench.Command({"--grid"}, "--set simulation.terrain.surface={surface} --out " +
                                    (bench.folder / "twins/{surface}_{trial}"));
  {
    test::RunningRift rift(command);
    bool has_begun = false;
    rift.WaitUntil("the second drive has begun or a busy machine ended the series before", [&] {
      const bool is_running = rift.IsRunning();
      has_begun = bench.Has("ground_2.unfinished/experiment.yaml");
      return has_begun || !is_running;
    });
    if (!has_begun) return false;
    rift.Signal(SIGKILL);
    CHECK(rift.Wait().exit_code == 128 + SIGKILL);
  }
  test::WaitUntil("the twin of the killed drive ends",
                  [&] { return !IsAtWork(bench.folder / "twins/"); });
  if (!bench.Has("ground_1")) return false;
  CHECK_FALSE(bench.Has("cardboard_1.unfinished"));
  const std::string first = bench.Read("ground_1/trajectory.csv");

  const test::ProcessResult result = test::RunUntilDone(command);
  INFO(result.out << result.err);
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.err, Catch::Contains("lay the cardboard"));
  CHECK(bench.Read("ground_1/trajectory.csv") == first);
  CHECK(bench.Has("ground_2.unfinished1"));
  const std::string table = bench.Read("sweep/table.csv");
  INFO(table);
  CHECK(std::count(table.begin(), table.end(), '\n') == 1 + 4);
  std::size_t compared = 0;
  for (std::size_t at = 0; (at = table.find(",ok,", at)) != table.npos; ++at) ++compared;
  CHECK(compared == 4);
  CHECK(bench.Has("sweep/report.html"));

  const test::ProcessResult other = test::RunRift(
      bench.Command({"--grid", "--set", "control.v_min=0.17"}, "--out " + (bench.folder / "t")));
  CHECK(other.exit_code == 2);
  CHECK_THAT(other.err, Catch::Contains("control.v_min was") && Catch::Contains("another --out"));
  return true;
}

TEST_CASE("A grid driven on twins and killed in the middle goes on and ends with its report") {
  const test::QuickGnuplot gnuplot;
  test::WaitUntil("a grid that was killed has gone on to its end", GridGoesOnAfterKill);
}

TEST_CASE("Repeats are driven into numbered folders and a sweep reads them") {
  const test::QuickGnuplot gnuplot;
  const Bench bench;
  const test::ProcessResult result = test::RunUntilDone(
      bench.Command({"--repeat", "2"}, "--out " + (bench.folder / "twins/{trial}")));
  INFO(result.out << result.err);
  REQUIRE(result.exit_code == 0);
  CHECK(bench.Has("1/trajectory.csv"));
  const test::ProcessResult swept = test::RunRift(
      {"sweep", bench.folder / "run/sweep.yaml", "--out", bench.folder / "run/sweep", "--quiet"});
  INFO(swept.out << swept.err);
  CHECK(swept.exit_code == 0);
  const std::string table = bench.Read("sweep/table.csv");
  CHECK(std::count(table.begin(), table.end(), '\n') == 1 + 2);
  CHECK(table.find("run/2/trajectory.csv") != table.npos);

  const test::ProcessResult more = test::RunUntilDone(
      bench.Command({"--repeat", "3"}, "--out " + (bench.folder / "twins/{trial}")));
  INFO(more.err);
  CHECK(more.exit_code == 0);
  CHECK_THAT(more.err, Catch::Contains("2 of them done"));
  CHECK(bench.Has("3/trajectory.csv"));
}

TEST_CASE("Suggested experiments are driven on twins and the sweep says what they confirmed") {
  const test::QuickGnuplot gnuplot;
  // The twin's left motor is weaker than the simulator of the sweep believes: it leaves its way.
  const Bench bench;
  const std::string sweep = bench.folder / "sweep";
  test::WriteText(bench.folder / "falsify.yaml",
                  "include: task.yaml\n"
                  "goal: falsify\n"
                  "space: {simulation.terrain.surface: {values: [ground, cardboard], settable: "
                  "false}, control.v_min: {min: 0.12, max: 0.16, step: 0.02}, "
                  "simulation.motor.mismatch: {min: -0.3, max: 0.3}}\n"
                  "gap: {threshold_m: 0.004}\n"
                  "reference: {kind: path, trials: 1}\n"
                  "search: {budget: 16}\n"
                  "falsify: {until: budget, most_repeats: 3}\n");
  const std::vector<std::string> command{
      "sweep", bench.folder / "falsify.yaml", "--out", sweep, "--suggest", "1", "--quiet"};
  const test::ProcessResult first = test::RunRift(command);
  INFO(first.out << first.err);
  REQUIRE(first.exit_code == 0);
  REQUIRE(fs::exists(sweep + "/suggested.yaml"));
  const test::ProcessResult driven =
      test::RunUntilDone({"drive", "--suggested", sweep, "--yes", "--before-each",
                          test::BuildDir() + "/rift simulate " + (bench.folder / "task.yaml") +
                              " --twin --force --seed {trial} --set control.v_min={v_min} --set "
                              "simulation.motor.mismatch=-0.5 --out " +
                              (bench.folder / "twins/{v_min}_{trial}")});
  INFO(driven.out << driven.err);
  REQUIRE(driven.exit_code == 0);
  CHECK(fs::exists(sweep + "/suggested/1_1/trajectory.csv"));
  CHECK_THAT(driven.err, Catch::Contains("what they confirm: rift sweep"));
  const test::ProcessResult again = test::RunRift(command);
  INFO(again.out << again.err);
  CHECK(again.exit_code == 0);
  CHECK_THAT(again.out, Catch::Contains("1 of 1 predicted failures confirmed by the robot"));
}

TEST_CASE("A robot that is put down far off its start is not driven, with what to do") {
  const Bench bench;
  const test::ProcessResult result = test::RunRift(
      bench.Command({"--repeat", "2"}, "--start 0.08,0.0,0 --out " + (bench.folder / "twin")));
  INFO(result.out << result.err);
  CHECK(result.exit_code == 3);
  CHECK_THAT(result.err, Catch::Contains("0.08") && Catch::Contains("hardware.start"));
  CHECK_FALSE(bench.Has("1"));
}

}  // namespace
}  // namespace rift
