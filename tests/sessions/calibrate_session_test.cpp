// A fit of the simulator to logs: made here, kept in a journal, brought back from a cluster's job.
#include "rift/sessions/sweep/calibrate.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "rift/report/json/json.hpp"
#include "rift/sessions/sweep/journal.hpp"
#include "rift/sessions/sweep/shard.hpp"
#include "rift/sweep/calibrate/report_bytes.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"
#include "rift/trajectory/log.hpp"
#include "sessions/idle_slurm.hpp"
#include "sessions/sweep/kept_calibration.hpp"
#include "sessions/sweep_folder.hpp"
#include "support/inputs/png_bytes.hpp"
#include "support/processes/process.hpp"
#include "support/processes/quick_gnuplot.hpp"

namespace rift::sessions {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

const std::string kDrive =
    "waypoints: [{x: 0, y: 0, heading: 0}, {x: 0.4, y: 0.05, stop: true}]\n"
    "trial: {pace: new_pose}\n";

/// Logs of three drives of a robot whose wheels differ by 0.05, and the fit to them.
struct Fitted {
  Fitted() {
    for (int trial = 1; trial <= 3; ++trial) WriteLog(trial, 0.05);
  }
  void WriteLog(int trial, double mismatch) const {
    const experiment::Experiment robot =
        LoadText(kDrive, {"simulation.motor.mismatch=" + std::to_string(mismatch)});
    const sweep::SimulatedRun run = sweep::Simulate(
        sweep::SimulatedTrialOf(robot, experiment::TaskOf(robot).Start(),
                                static_cast<std::uint64_t>(trial), "robot.yaml", FileInputs()));
    test::WriteText(folder / ("log" + std::to_string(trial) + ".csv"),
                    trajectory::WriteRift(run.result.trajectory));
  }
  experiment::Experiment Load() const {
    return LoadText(kDrive + "goal: calibrate\nreference: {kind: logs, path: \"" +
                    (folder / "log{trial}.csv") +
                    "\", trials: [1, 2, 3]}\ncalibrate:\n"
                    "  holdout: [3]\n"
                    "  fit: {motor.mismatch: {min: -0.1, max: 0.1}}\n"
                    "  starts: 1\n  judge_runs: 2\n"
                    "  method: {runs: 0, iterations: 1, horizon: {phases: 1}, simulated_logs: 4, "
                    "resamples: 20}\nlikeness: {shuffles: 19}\n");
  }

  test::TemporaryFolder folder;
};

TEST_CASE("A fit made here finds what the logs were made with, and is saved with what it read") {
  const test::QuickGnuplot quick;
  const Fitted fitted;
  const experiment::Experiment experiment = fitted.Load();
  sweep::Evaluator evaluator(experiment, "fit.yaml", FileInputs());
  SweepTold told;
  const fs::path out = fitted.folder / "out";
  std::vector<std::string> said;
  const auto found = Fit(evaluator, {.out = out}, ObserverOf(told),
                         [&](const std::string& line) { said.push_back(line); });
  REQUIRE(found);
  REQUIRE(found->calibration.parameters.size() == 1);
  CHECK(found->calibration.parameters[0].value == Approx(0.05).margin(0.03));
  CHECK_FALSE(said.empty());
  SaveCalibration(out, evaluator, *found);
  CHECK(files::ReadFile(out / "experiment.yaml") == experiment::WriteExperiment(experiment));
  CHECK(files::ReadFile(out / "inputs.txt") == evaluator.InputsText());
  CHECK(files::ReadFile(out / "calibration.json") == report::CalibrationJson(experiment, *found));
  CHECK(SaveCalibrationFigure(out, "fit", *found));
  CHECK_FALSE(fs::is_empty(out / "figures"));
  sweep::CalibrationReport nothing = *found;
  nothing.judged.clear();
  nothing.trials.clear();
  nothing.shown_real = {};
  nothing.shown_before.clear();
  nothing.shown_after.clear();
  CHECK_FALSE(SaveCalibrationFigure(fitted.folder / "none", "fit", nothing));
  CHECK_FALSE(fs::exists(fitted.folder / "none"));
}

TEST_CASE("A fit tells of logs that do not fit their task, apart from its progress") {
  const Fitted fitted;
  fitted.WriteLog(1, 0.05);
  const std::string log = fitted.folder / "log1.csv";
  test::WriteText(fitted.folder / "log3.csv", files::ReadFile(log));
  experiment::Experiment experiment = fitted.Load();
  experiment.waypoints[1].y_m = -0.2;
  sweep::Evaluator evaluator(experiment, "fit.yaml", FileInputs());
  SweepTold told;
  std::vector<std::string> notes;
  Fit(evaluator, {.out = fitted.folder / "out"}, ObserverOf(told), [&](const std::string& line) {
    if (IsNote(line)) notes.push_back(line);
  });
  REQUIRE(notes.size() == 2);
  CHECK_THAT(notes[0], Catch::StartsWith("warning: " + log + " (and 2 more logs): it comes no ") &&
                           Contains("x 0.4 m, y -0.2 m"));
  CHECK_THAT(notes[1], Contains("log3.csv: it has the rows of " + log));
}

TEST_CASE("A fit comes back from the journal that keeps it, with its notes but not its progress") {
  const Fitted fitted;
  const experiment::Experiment experiment = fitted.Load();
  sweep::Evaluator evaluator(experiment, "fit.yaml", FileInputs());
  KeptCalibration kept(evaluator);
  CHECK_THAT(kept.key(), Catch::StartsWith("beside the table: calibration to "));
  const fs::path file = fitted.folder / "journal.sqlite";
  sweep::Journal journal(file, FactsOf(experiment));
  std::vector<std::string> said, again;
  const auto none = [](const std::string&) {};
  CHECK_FALSE(kept.Find(journal, none));
  const sweep::JournalEntry entry =
      kept.Fit(1, [&](const std::string& line) { said.push_back(line); });
  CHECK(entry.status == "ok");
  CHECK(std::isnan(entry.gap_m));
  journal.Add(kept.key(), entry);
  const auto found = kept.Find(journal, [&](const std::string& line) { again.push_back(line); });
  REQUIRE(found);
  CHECK(found->calibration.parameters[0].value == Approx(0.05).margin(0.03));
  std::vector<std::string> notes;
  for (const std::string& line : said) {
    if (line.starts_with("note: ") || line.starts_with("warning: ")) notes.push_back(line);
  }
  CHECK(again == notes);
  CHECK(said.size() > notes.size());
  // Other logs are another key, the same ones the same.
  sweep::Evaluator same(experiment, "fit.yaml", FileInputs());
  CHECK(KeptCalibration(same).key() == kept.key());
  fitted.WriteLog(2, 0.06);
  sweep::Evaluator changed(experiment, "fit.yaml", FileInputs());
  CHECK(KeptCalibration(changed).key() != kept.key());
}

TEST_CASE("A fit is another one when a picture that it drives on has changed") {
  const Fitted fitted;
  experiment::Experiment experiment = fitted.Load();
  const std::string picture = fitted.folder / "hill.png";
  experiment.simulation.terrain.surface = "hill";
  experiment.simulation.terrain.surfaces["hill"] = {};
  experiment.simulation.terrain.surfaces["hill"].shape = simulation::Shape::kHeightfield;
  experiment.simulation.terrain.surfaces["hill"].image = picture;
  const auto key = [&] {
    sweep::Evaluator evaluator(experiment, "fit.yaml", FileInputs());
    const std::string text = KeptCalibration(evaluator).key();
    CHECK_THAT(evaluator.InputsText(), Catch::EndsWith("  " + picture + "\n"));
    return text;
  };
  test::WriteText(picture, test::RampPng(100));
  const std::string before = key();
  CHECK(key() == before);
  test::WriteText(picture, test::RampPng(101));
  CHECK(key() != before);
}

TEST_CASE("A fit to drives of powers is another one when their trials began at another time") {
  const Fitted fitted;
  experiment::Experiment experiment = fitted.Load();
  const auto key = [&](const std::string& commands) {
    test::WriteText(fitted.folder / "commands.csv", commands);
    sweep::Evaluator evaluator(experiment, "fit.yaml", FileInputs());
    return KeptCalibration(evaluator).key();
  };
  const std::string first = "t_s,power_left,power_right\n0.1,0,0\n";
  const std::string later = "t_s,power_left,power_right\n0.2,0,0\n";
  CHECK(key(first) == key(later));  // of waypoints nobody asks
  experiment.waypoints.resize(1);
  experiment.program.segments = {{.straight_m = 0.3}};
  experiment.program.power = 0.3;
  CHECK(key(first) == key(first));
  CHECK(key(first) != key(later));
}

TEST_CASE("A fit on a cluster is one job with the bytes of one made here, and is kept") {
  const IdleSlurm slurm;
  const Fitted fitted;
  const experiment::Experiment experiment = fitted.Load();
  const fs::path out = fitted.folder / "out";
  fs::create_directories(out);
  Nodes nodes{out, experiment};
  sweep::SlurmOptions options;
  options.poll_s = 0.05;
  options.max_array_size = 100;
  SweepTold told;
  SweepObserver observer = ObserverOf(told);
  observer.watch_for_stop = [&nodes] { return [&nodes] { return nodes.Compute(); }; };
  const auto none = [](const std::string&) {};
  sweep::Evaluator evaluator(experiment, "fit.yaml", FileInputs());
  const FitRequest request{.out = out, .cluster = &options};
  const auto there = Fit(evaluator, request, observer, none);
  REQUIRE(there);
  CHECK(nodes.kinds == std::vector<sweep::ShardKind>{sweep::ShardKind::kCalibration});
  sweep::Evaluator fresh(experiment, "fit.yaml", FileInputs());
  const auto here = Fit(fresh, {.out = out}, observer, none);
  CHECK(sweep::EncodeReport(*there) == sweep::EncodeReport(*here));
  CHECK(ReadStatus(out).state == "done");
  CHECK(ReadStatus(out).summary.notes.at("name") == experiment.name);
  // Asked again, nothing is submitted; afresh it is.
  nodes.kinds.clear();
  CHECK(Fit(evaluator, request, observer, none));
  CHECK(nodes.kinds.empty());
  nodes.computed.clear();
  CHECK(Fit(evaluator, {.out = out, .fresh = true, .cluster = &options}, observer, none));
  CHECK(nodes.kinds.size() == 1);
}

TEST_CASE("A fit on a cluster that is told to stop finds nothing, and its shard is for its logs") {
  const IdleSlurm slurm;
  const Fitted fitted;
  const experiment::Experiment experiment = fitted.Load();
  const fs::path out = fitted.folder / "out";
  fs::create_directories(out);
  sweep::SlurmOptions options;
  options.poll_s = 0.05;
  options.max_array_size = 100;
  SweepTold told;
  SweepObserver observer = ObserverOf(told);
  observer.watch_for_stop = [] { return [] { return false; }; };
  sweep::Evaluator evaluator(experiment, "fit.yaml", FileInputs());
  CHECK_FALSE(
      Fit(evaluator, {.out = out, .cluster = &options}, observer, [](const std::string&) {}));
  fitted.WriteLog(1, 0.02);
  const ShardFile shard = ReadShard(out / "slurm/1/0.shard", experiment);
  CHECK_THROWS_WITH(
      RunShard(shard, experiment, "fit.yaml", FileInputs(), {.out = out}, ObserverOf(told)),
      Contains("its trials read logs or programs that are others on this machine"));
}

}  // namespace
}  // namespace rift::sessions
