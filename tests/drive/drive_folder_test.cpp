#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "hardware/bench.hpp"
#include "rift/files/files.hpp"
#include "rift/report/json/json.hpp"
#include "rift/sessions/drive/session.hpp"
#include "rift/trajectory/log.hpp"
#include "rift/vision/camera/camera_file.hpp"
#include "sessions/drive/folder.hpp"
#include "support/documented.hpp"
#include "support/inputs/paper_camera.hpp"
#include "support/inputs/paper_experiment.hpp"
#include "support/processes/process.hpp"

namespace rift::sessions {
namespace {

TEST_CASE("A drive reaches the end and leaves a folder that tells all of it") {
  hardware::Bench bench;
  bench.line_delay_s = 0.005;
  std::vector<std::string> told;
  const experiment::Experiment experiment = test::PaperExperiment();
  const test::TemporaryFolder folder;
  BegunFolder begun(folder.Path());
  begun.Write(experiment, test::PaperCamera());
  DriveLog log(WriterInto(folder.Path(), experiment));
  const hardware::DriveRun run =
      hardware::Drive({.line = bench,
                       .poses = bench,
                       .clock = bench,
                       .say = [&](const auto& line) { told.push_back(line); },
                       .may_arm = [] { return true; },
                       .observer = &log,
                       .threads = false},
                      DriveTaskOf(experiment));
  CHECK(run.trial.outcome == trial::Outcome::kReached);
  CHECK(run.evidence.stop_acknowledged == true);
  CHECK(run.ping.protocol == hardware::Protocol::kFramed);
  REQUIRE(told.size() == 5);
  CHECK_THAT(told[1], Catch::StartsWith("worst stopping distance 0.2"));
  CHECK_THAT(report::DriveText(experiment, run), Catch::Contains("acknowledged the stop"));

  CHECK(CloseDrive(folder.Path(), experiment, run, log).empty());
  const auto summary = nlohmann::json::parse(files::ReadFile(folder / "summary.json"));
  CHECK(summary["state"] == "finished");
  CHECK(summary["outcome"] == "reached");
  CHECK(summary["stop"]["acknowledged"] == true);
  CHECK(summary["stop"]["reason"] == "finished");
  CHECK(summary["latency"]["capture_to_command"]["p50_s"] < 0.03);
  CHECK(summary["latency"]["capture_to_command"]["n"] > 30);
  CHECK(test::KeysOf(summary) == test::DocumentedKeys("summary.json of rift drive"));
  CHECK(test::KeysOf(summary["ping"]) == test::DocumentedKeys("rift drive --ping --json"));
  const std::string stages = files::ReadFile(folder / "stages.csv");
  CHECK(test::Columns(stages) == test::Documented("files.md", "Columns of stages.csv"));
  const auto rows = std::count(stages.begin(), stages.end(), '\n');
  CHECK(rows == 1 + static_cast<long>(run.evidence.poses.size()));
  const std::string encoders = files::ReadFile(folder / "encoders.csv");
  CHECK(test::Columns(encoders) == test::Documented("files.md", "Columns of encoders.csv"));
  CHECK(std::count(encoders.begin(), encoders.end(), '\n') > rows - 5);
  CHECK(vision::ReadCamera(files::ReadFile(folder / "camera.yaml"), "camera").world);
  const trajectory::Log read = trajectory::ReadLog(files::ReadFile(folder / "trajectory.csv"),
                                                   "trajectory", trajectory::Format::kAuto);
  CHECK(read.trajectory.poses.size() == run.trial.trajectory.poses.size());
}

}  // namespace
}  // namespace rift::sessions
