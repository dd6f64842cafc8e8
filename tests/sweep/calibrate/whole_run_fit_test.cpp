// Whole runs of somebody else's simulator beside a log, at equal shares of their paths.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "rift/trajectory/log.hpp"
#include "sweep/calibrate/fitted_simulator.hpp"

namespace rift::sweep {
namespace {

using trajectory::Trajectory;

/// A straight way in equal steps.
Trajectory Way(double to_x_m, double to_y_m, double duration_s) {
  constexpr int kSteps = 50;
  Trajectory path;
  for (int i = 0; i <= kSteps; ++i) {
    const double share = static_cast<double>(i) / kSteps;
    path.poses.push_back({share * duration_s, share * to_x_m, share * to_y_m, 0.0});
  }
  return path;
}

TEST_CASE("A whole run is beside its log in place and time at each share of the way, the end too") {
  experiment::Experiment experiment;
  experiment.candidate.kind = experiment::CandidateKind::kLogs;
  experiment.candidate.path.text = "run.csv";
  experiment.reference.kind = experiment::ReferenceKind::kLogs;
  experiment.reference.path.text = "log.csv";
  experiment.reference.trials.names = {"1"};
  const std::string run = trajectory::WriteRift(Way(1.2, 0.4, 4.0));
  Evaluator evaluator(experiment, "fit.yaml",
                      {[&](const std::string& path) {
                         return path == "run.csv" ? std::optional(run) : std::nullopt;
                       },
                       [](const std::string&) {}});
  CandidateRuns runs(evaluator, 1);
  ProgramTwins twins(runs, {{.theta = {}, .trial = "1", .seed = 1}}, experiment, "fit.yaml",
                     [](const std::string&) {});
  const std::vector<CalibrationLog> logs{{.name = "log.csv", .log = Way(1.0, 0.1, 3.0)}};
  CalibrationOptions options = OfWholeRuns({});
  options.runs = 2;
  const std::vector<LogPrediction> predictions = twins.Predict(logs, {}, options);
  REQUIRE(predictions.size() == 1);
  CHECK(predictions[0].runs.size() == 2);
  REQUIRE(predictions[0].mean_traits);
  CHECK((*predictions[0].mean_traits)[kLogWeave] == Approx(std::log(1e-6)));  // none at all
  CHECK((*predictions[0].mean_traits)[kLogSpeed] == Approx(std::log(std::hypot(1.2, 0.4) / 4.0)));
  CHECK((*predictions[0].mean_traits)[kLoopDelay_s] == 0.0);
  CHECK((*predictions[0].mean_traits)[kSteeringGain] == 0.0);
  const Eigen::VectorXd& errors = predictions[0].motions;
  REQUIRE(errors.size() == 3 * 16);
  for (int k = 0; k < 16; ++k) {
    const double share = (k + 1) / 16.0;
    INFO("at " << share);
    CHECK(errors[3 * k] == Approx(0.2 * share).margin(1e-9));
    CHECK(errors[3 * k + 1] == Approx(0.3 * share).margin(1e-9));
    CHECK(errors[3 * k + 2] == Approx(share - 1.0 / 16.0).margin(1e-9));
  }
}

TEST_CASE("A log that no run gives a path for is beside a robot that stays, doubts are said once") {
  experiment::Experiment experiment;
  experiment.candidate.kind = experiment::CandidateKind::kLogs;
  experiment.candidate.path.text = "run_{trial}.csv";
  experiment.reference.kind = experiment::ReferenceKind::kLogs;
  experiment.reference.path.text = "{trial}.csv";
  experiment.reference.trials.names = {"1", "2"};
  const std::string run = trajectory::WriteRift(Way(1000.0, 100.0, 3.0));  // in mm
  Evaluator evaluator(experiment, "fit.yaml",
                      {[&](const std::string& path) {
                         return path == "run_2.csv" ? std::optional(run) : std::nullopt;
                       },
                       [](const std::string&) {}});
  CandidateRuns runs(evaluator, 1);
  std::vector<std::string> said;
  ProgramTwins twins(
      runs, {{.theta = {}, .trial = "1", .seed = 1}, {.theta = {}, .trial = "2", .seed = 9}},
      experiment, "fit.yaml", [&](const std::string& line) { said.push_back(line); });
  std::vector<CalibrationLog> logs{{.name = "1.csv", .log = Way(0.8, -0.4, 2.0)},
                                   {.name = "2.csv", .log = Way(1.0, 0.1, 3.0)}};
  for (auto& pose : logs[0].log.poses) pose.x_m += 3.0, pose.y_m += 5.0, pose.t_s += 70.0;
  CalibrationOptions options = OfWholeRuns({});
  options.runs = 2;
  const std::vector<LogPrediction> predictions = twins.Predict(logs, {}, options);
  twins.Predict(logs, {}, options);
  REQUIRE_FALSE(said.empty());
  for (size_t i = 0; i < said.size(); ++i) {
    CHECK(said[i].starts_with("warning: SIM run_2.csv and REAL 2.csv: "));
    CHECK(std::count(said.begin(), said.end(), said[i]) == 1);
  }
  REQUIRE(predictions.size() == 2);
  CHECK(predictions[0].runs.empty());
  CHECK_FALSE(predictions[0].mean_traits);
  const Eigen::VectorXd& errors = predictions[0].motions;
  REQUIRE(errors.size() == 3 * 16);
  for (int k = 0; k < 16; ++k) {
    const double share = (k + 1) / 16.0;
    CHECK(errors[3 * k] == Approx(-0.8 * share).margin(1e-9));
    CHECK(errors[3 * k + 1] == Approx(0.4 * share).margin(1e-9));
    CHECK(errors[3 * k + 2] == Approx(2.0 * (1.0 / 16.0 - share)).margin(1e-9));
  }
  CHECK(predictions[1].runs.size() == 2);
  REQUIRE(predictions[1].mean_traits);
  // A way that does not weave at all counts as one of a micrometre.
  CHECK((*predictions[1].mean_traits)[kLogWeave] >= std::log(1e-6));
}

}  // namespace
}  // namespace rift::sweep
