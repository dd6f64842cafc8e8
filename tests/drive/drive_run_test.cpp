#include "commands/drive_run.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "commands/drive_files.hpp"
#include "commands/drive_output.hpp"
#include "commands/files.hpp"
#include "hardware/bench.hpp"
#include "rift/trajectory/log.hpp"
#include "rift/vision/camera/camera_file.hpp"
#include "support/documented.hpp"
#include "support/paper_camera.hpp"
#include "support/paper_waypoints.hpp"
#include "support/process.hpp"

namespace rift::commands {
namespace {

using hardware::Bench;
using hardware::StopReason;

experiment::Experiment PaperExperiment() {
  experiment::Experiment experiment;
  experiment.name = "bench";
  experiment.waypoints = test::PaperWaypoints();
  experiment.trial.pace = trial::Pace::kNewPose;
  return experiment;
}

struct Operator {
  std::vector<std::string> told;
  std::optional<std::pair<StopReason, std::string>> stop;
  bool says_yes = true;

  DriveParts PartsOf(Bench& bench) {
    return {.line = bench,
            .poses = bench,
            .clock = bench,
            .stoppers = {[this] { return stop; }},
            .say = [this](const std::string& line) { told.push_back(line); },
            .may_arm = [this] { return says_yes; },
            .threads = false};
  }
};

TEST_CASE("A drive reaches the end and leaves a folder that tells all of it") {
  Bench bench;
  bench.line_delay_s = 0.005;
  Operator person;
  const experiment::Experiment experiment = PaperExperiment();
  const DriveRun run = Drive(person.PartsOf(bench), experiment);
  CHECK(run.trial.outcome == trial::Outcome::kReached);
  CHECK(run.evidence.stop_acknowledged == true);
  CHECK(run.ping.protocol == hardware::Protocol::kFramed);
  REQUIRE(person.told.size() == 3);
  CHECK_THAT(person.told[1], Catch::StartsWith("worst stopping distance 0.2"));

  const test::TemporaryFolder folder;
  BeginDriveFolder(folder.Path(), experiment, test::PaperCamera());
  SaveDrive(folder.Path(), experiment, run);
  const auto summary = nlohmann::json::parse(ReadFile(folder / "summary.json"));
  CHECK(summary["outcome"] == "reached");
  CHECK(summary["stop"]["acknowledged"] == true);
  CHECK(summary["stop"]["reason"] == "finished");
  CHECK(summary["latency"]["capture_to_command"]["p50_s"] < 0.03);
  CHECK(summary["latency"]["capture_to_command"]["n"] > 30);
  CHECK(test::KeysOf(summary) == test::DocumentedKeys("summary.json of rift drive"));
  CHECK(test::KeysOf(summary["ping"]) == test::DocumentedKeys("rift drive --ping --json"));
  const std::string stages = ReadFile(folder / "stages.csv");
  CHECK(test::Columns(stages) == test::Documented("files.md", "Columns of stages.csv"));
  const auto rows = std::count(stages.begin(), stages.end(), '\n');
  CHECK(rows == 1 + static_cast<long>(run.evidence.poses.size()));
  const std::string encoders = ReadFile(folder / "encoders.csv");
  CHECK(test::Columns(encoders) == test::Documented("files.md", "Columns of encoders.csv"));
  CHECK(std::count(encoders.begin(), encoders.end(), '\n') > rows - 5);
  CHECK(vision::ReadCamera(ReadFile(folder / "camera.yaml"), "camera").world);
  const trajectory::Log log = trajectory::ReadLog(ReadFile(folder / "trajectory.csv"), "trajectory",
                                                  trajectory::Format::kAuto);
  CHECK(log.trajectory.poses.size() == run.trial.trajectory.poses.size());
}

TEST_CASE("A link over its budget is not armed and the line says what to change") {
  Bench bench;
  bench.line_delay_s = 0.2;
  Operator person;
  CHECK_THROWS_WITH(Drive(person.PartsOf(bench), PaperExperiment()),
                    Catch::Contains("not armed, the link breaks its budget: 99 %") &&
                        Catch::Contains("baud rate"));
  CHECK(bench.obeyed == std::set<std::pair<int, int>>{{0, 0}});
}

TEST_CASE("Nothing moves until the operator says yes") {
  Bench bench;
  Operator person;
  person.says_yes = false;
  DriveParts parts = person.PartsOf(bench);
  int asked = 0;
  parts.may_arm = [&] {
    if (++asked == 50) person.stop = {StopReason::kOperator, "q was pressed"};
    return false;
  };
  const DriveRun run = Drive(parts, PaperExperiment());
  CHECK_FALSE(run.has_begun);
  CHECK(run.trial.reason == "stopped before the start: q was pressed");
  CHECK(bench.obeyed == std::set<std::pair<int, int>>{{0, 0}});
}

TEST_CASE("A robot that no camera sees is not driven") {
  Bench bench;
  bench.tag_is_hidden = true;
  Operator person;
  CHECK_THROWS_WITH(Drive(person.PartsOf(bench), PaperExperiment()),
                    Catch::Contains("was not seen within 10 s"));
}

TEST_CASE("A stop in the middle of a drive is told with its reason") {
  Bench bench;
  Operator person;
  DriveParts parts = person.PartsOf(bench);
  const double begun_s = bench.Now_s();
  parts.stoppers.push_back([&]() -> std::optional<std::pair<StopReason, std::string>> {
    if (bench.Now_s() < begun_s + 5.0) return std::nullopt;
    return std::pair(StopReason::kSignal, "SIGTERM came");
  });
  const DriveRun run = Drive(parts, PaperExperiment());
  CHECK(run.trial.outcome == trial::Outcome::kFault);
  CHECK(run.trial.reason == "SIGTERM came");
  CHECK(run.evidence.stop->reason == StopReason::kSignal);
  CHECK_THAT(DriveText(run), Catch::Contains("acknowledged the stop"));
}

}  // namespace
}  // namespace rift::commands
