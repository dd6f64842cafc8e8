// Whole runs of somebody else's simulator beside a log, at equal shares of their paths.
#include <catch2/catch.hpp>
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

}  // namespace
}  // namespace rift::sweep
