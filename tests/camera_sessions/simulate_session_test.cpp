#include <catch2/catch.hpp>
#include <filesystem>

#include "rift/sessions/simulate/run.hpp"
#include "support/inputs/paper_task.hpp"
#include "support/processes/process.hpp"

namespace rift::sessions {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

TEST_CASE("A run goes into a folder, or beside the log that was named") {
  CHECK(RunFiles("out/run").summary == "out/run/summary.json");
  CHECK(RunFiles("out/run").trajectory == "out/run/trajectory.csv");
  CHECK(RunFiles("out/sim.csv").trajectory == "out/sim.csv");
  CHECK(RunFiles("out/sim.csv").encoders == "out/sim.encoders.csv");
}

TEST_CASE("A run is replaced by the run of the same experiment and by no other") {
  const test::TemporaryFolder folder;
  const fs::path out = folder / "run";
  const experiment::Experiment experiment = test::PaperTask();
  const auto check = [&](const experiment::Experiment& next, bool force) {
    CheckRunNames(out, next, {}, {}, force);
  };
  CHECK_NOTHROW(check(experiment, false));
  fs::create_directories(out);
  test::WriteText(RunFiles(out).experiment.string(), experiment::WriteExperiment(experiment));
  test::WriteText(RunFiles(out).trajectory.string(), "t_s\n");
  CHECK_NOTHROW(check(experiment, false));
  experiment::Experiment other = experiment;
  other.seed = 2;
  CHECK_THROWS_WITH(check(other, false), Contains("is there already"));
  CHECK_NOTHROW(check(other, true));
}

TEST_CASE("What is written beside a run is no file of it, and a run for a pipe has none") {
  const test::TemporaryFolder folder;
  const fs::path truth = folder / "sim.truth.csv";
  CHECK_THROWS_WITH(CheckRunNames(folder / "sim.csv", test::PaperTask(), {}, {truth}, false),
                    Contains("another output"));
  CHECK_NOTHROW(CheckRunNames("-", test::PaperTask(), {}, {truth, "-/truth.csv"}, false));
  CHECK_THROWS_WITH(CheckRunNames("-", test::PaperTask(), {truth}, {truth}, false),
                    Contains("is an input"));
}

TEST_CASE("A run alone begins with its tag on the first waypoint, wherever its draw has the tag") {
  experiment::Experiment experiment = test::PaperTask();
  experiment.simulation.mocap.tag_ahead_m = 0.0;
  experiment.ensemble.keys = {"simulation.mocap.tag_ahead_m"};
  experiment.ensemble.draws = {{0.08}};
  const sweep::SimulatedTrial trial =
      TrialAlone(experiment, "e.yaml", {[](const std::string&) { return std::nullopt; }, {}});
  const geometry::Pose2 tag = trial.start * geometry::Pose2{0.08, 0.0, 0.0};
  CHECK((tag.Position() - experiment.waypoints[0].Position()).norm() < 1e-12);
}

}  // namespace
}  // namespace rift::sessions
