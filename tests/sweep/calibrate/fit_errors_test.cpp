// What a fit makes of repeats of one setting: how far apart they are, in the logs and simulated.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "support/inputs/paths.hpp"
#include "sweep/calibrate/errors.hpp"
#include "sweep/calibrate/fitted_simulator.hpp"
#include "sweep/calibrate/model.hpp"

namespace rift::sweep {
namespace {

using trajectory::Trajectory;

/// One metre ahead along x, `aside_m` beside it: the gap of two is how far they are apart.
Trajectory Lane(double aside_m) {
  return test::Moved(test::StraightPath(1.0, 21), {0.0, aside_m, 0.0});
}

/// Predicts the same runs whatever it is asked.
class Told : public FittedSimulator {
 public:
  explicit Told(std::vector<LogPrediction> predictions) : predictions_(std::move(predictions)) {}

  std::vector<LogPrediction> Predict(const std::vector<CalibrationLog>& logs,
                                     const std::vector<double>&,
                                     const CalibrationOptions&) override {
    grids_fps.clear();
    for (const CalibrationLog& log : logs) grids_fps.push_back(log.drives_grid_fps);
    return predictions_;
  }
  std::vector<Trajectory> LogsAt(const std::vector<CalibrationLog>&, const std::vector<double>&,
                                 int) override {
    return made;
  }
  /// Where a path lies, for a speed.
  Traits TraitsOf(const Trajectory& path, size_t, const std::vector<double>&) const override {
    if (!has_traits) return {};
    return Eigen::Vector4d(0.0, path.poses.front().y_m, 0.0, 0.0);
  }
  bool HasWholeRunsOnly() const override { return true; }

  std::vector<Trajectory> made;
  std::vector<double> grids_fps;  ///< of the drives of the logs that it was asked of last
  bool has_traits = false;

 private:
  std::vector<LogPrediction> predictions_;
};

CalibrationLog Log(const std::string& setting, double aside_m) {
  return {.name = setting, .setting = setting, .log = Lane(aside_m)};
}

LogPrediction Runs(const std::vector<double>& asides_m) {
  LogPrediction prediction;
  for (const double aside_m : asides_m) prediction.runs.push_back(Lane(aside_m));
  return prediction;
}

TEST_CASE("A repeat is held against the repeat of its own setting before it") {
  const std::vector<CalibrationLog> logs{Log("a", 0.0),  Log("b", 0.5), Log("a", 0.04),
                                         Log("b", 0.52), Log("c", 0.9), Log("a", 0.07)};
  Told simulator(std::vector<LogPrediction>(logs.size()));
  const LoggedTraits traits = TraitsOfLogs(logs, simulator, {});
  CHECK(traits.partner == std::vector<int>{-1, -1, 0, 1, -1, 2});
  CHECK(std::isnan(traits.log_spread[1]));
  CHECK(traits.log_spread[2] == Approx(std::log(0.04)));
  CHECK(traits.log_spread[3] == Approx(std::log(0.02)));
  CHECK(traits.log_spread[5] == Approx(std::log(0.03)));
}

TEST_CASE("Simulated repeats that are further apart than the logs are an error of the spread") {
  const std::vector<CalibrationLog> logs{Log("a", 0.0), Log("b", 0.5), Log("a", 0.04),
                                         Log("b", 0.52)};
  // Those of "a" are twice and half as far apart as the logs, those of "b" four times.
  Told simulator({Runs({0.0, 1.0}), Runs({0.3}), Runs({0.08, 1.02}), Runs({0.38})});
  const LoggedTraits traits = TraitsOfLogs(logs, simulator, {});
  const double scatter = std::log(2.0) / std::sqrt(2.0);  // of log 0.04 and log 0.02
  CHECK(traits.spread_scatter == Approx(scatter));
  const std::vector<LogErrors> errors = ErrorsAt(logs, traits, simulator, {}, {});
  REQUIRE(errors.size() == 4);
  const auto spread = [&](int log) { return errors[static_cast<size_t>(log)].traits[kTraits]; };
  CHECK(spread(0) == 0.0);
  CHECK(spread(1) == 0.0);
  CHECK(spread(2) == Approx(0.0).margin(1e-9));
  CHECK(spread(3) == Approx(std::log(4.0) / scatter));
}

TEST_CASE("Repeats with unequally many runs are compared as long as both have one") {
  const std::vector<CalibrationLog> logs{Log("a", 0.0), Log("a", 0.04)};
  const auto spread = [&logs](const std::vector<double>& first, const std::vector<double>& second) {
    Told simulator({Runs(first), Runs(second)});
    const LoggedTraits traits = TraitsOfLogs(logs, simulator, {});
    return ErrorsAt(logs, traits, simulator, {}, {})[1].traits[kTraits];
  };
  CHECK(spread({0.0, 1.0, 7.0}, {0.08}) == Approx(std::log(2.0)));
  CHECK(spread({0.0}, {0.08, 1.0, 7.0}) == Approx(std::log(2.0)));
  // No run that arrives is as far off as one log is from the next, and no error of 0.
  CHECK(spread({}, {0.08}) == 1.0);
  CHECK(spread({0.0}, {}) == 1.0);
}

TEST_CASE(
    "A trait that the log does not tell is no error, one that no run tells is as logs differ") {
  const std::vector<CalibrationLog> logs{Log("a", 0.0), Log("b", 0.04)};
  const auto errors = [&logs](bool of_logs, bool of_runs, int runs = 4) {
    std::vector<LogPrediction> predictions(2);
    if (of_runs) {
      for (LogPrediction& one : predictions) one.mean_traits = Eigen::Vector4d(3.0, 0.1, 3.0, 3.0);
    }
    Told simulator(predictions);
    simulator.has_traits = of_logs;
    const LoggedTraits traits = TraitsOfLogs(logs, simulator, {});
    CalibrationOptions options;
    options.runs = runs;
    return ErrorsAt(logs, traits, simulator, {}, options)[0].traits;
  };
  CHECK(errors(true, false).head<kTraits>().isOnes(0.0));
  CHECK(errors(true, false)[kTraits] == 0.0);  // no repeat
  CHECK(errors(true, false, 0).isZero(0.0));   // no runs were asked for
  CHECK(errors(false, false).isZero(0.0));
  CHECK(errors(false, true).isZero(0.0));
  // In scatters of 0.04 / sqrt(2); those that do not scatter count in their units.
  CHECK(errors(true, true)[kLogSpeed] == Approx(0.1 / 0.04 * std::sqrt(2.0)));
  CHECK(errors(true, true)[kLogWeave] == 3.0);
}

TEST_CASE(
    "Logs that are alike but for rounding tell no scatter, and their traits outweigh nothing") {
  Told simulator(std::vector<LogPrediction>(3));
  simulator.has_traits = true;
  // What is far less than a drive differs from the next: of sums, of a micrometre in a log.
  for (const double rounding : {1e-16, 1e-12, 1e-6}) {
    CAPTURE(rounding);
    const std::vector<CalibrationLog> logs{Log("a", 0.4), Log("b", 0.4 + rounding),
                                           Log("c", 0.4 - rounding)};
    CHECK(TraitsOfLogs(logs, simulator, {}).scatter[kLogSpeed] == 1.0);
  }
  // As three drives of a robot that is as even as any do differ.
  const std::vector<CalibrationLog> even{Log("a", 0.4), Log("b", 0.401), Log("c", 0.399)};
  CHECK(TraitsOfLogs(even, simulator, {}).scatter[kLogSpeed] == Approx(0.001));

  for (const double off : {7e-5, 1.5e-4}) {
    const std::vector<CalibrationLog> near{Log("a", 0.4), Log("b", 0.4 + off), Log("c", 0.4 - off)};
    CHECK(TraitsOfLogs(near, simulator, {}).scatter[kLogSpeed] == Approx(off > 1e-4 ? off : 1.0));
  }

  // Repeats that are copies: each pair a tenth of a millimetre apart.
  std::vector<CalibrationLog> copies;
  for (const std::string setting : {"a", "b", "c", "d", "e", "f"}) {
    copies.push_back(Log(setting, 0.4));
    copies.push_back(Log(setting, 0.4));
  }
  CHECK(TraitsOfLogs(copies, simulator, {}).spread_scatter == 1.0);
}

TEST_CASE("Simulated logs are told in the scatter of the real ones, each beside its own repeat") {
  const std::vector<CalibrationLog> logs{Log("a", 0.0), Log("b", 0.5), Log("a", 0.04),
                                         Log("b", 0.52)};
  std::vector<LogPrediction> predictions{Runs({0.0}), Runs({0.3}), Runs({0.08}), Runs({0.38})};
  for (LogPrediction& one : predictions) one.mean_traits = Eigen::Vector4d(0.0, 1.0, 0.0, 0.0);
  Told simulator(predictions);
  simulator.has_traits = true;
  // Made ones scatter by other amounts: 0.01 and 0.32 apart.
  simulator.made = {Lane(0.2), Lane(0.9), Lane(0.21), Lane(1.22)};
  const std::vector<experiment::FreeParameter> parameters{{.key = "p", .max = 1.0}};
  const CalibrationOptions options;
  const Eigen::VectorXd shares = Eigen::VectorXd::Constant(1, 0.5);
  const ErrorModel real(parameters, logs, simulator, options, shares);
  const std::vector<LogErrors> errors = real.OfSimulatedLogs(shares, 0).RawErrorsAt(shares);
  REQUIRE(errors.size() == 4);
  const double spread_scatter = std::log(2.0) / std::sqrt(2.0);
  CHECK(errors[0].traits[kTraits] == 0.0);
  CHECK(errors[2].traits[kTraits] == Approx(std::log(0.08 / 0.01) / spread_scatter));
  CHECK(errors[3].traits[kTraits] == Approx(std::log(0.08 / 0.32) / spread_scatter));
  const double scatter = TraitsOfLogs(logs, simulator, {}).scatter[kLogSpeed];  // of 0 to 0.52
  CHECK(errors[0].traits[kLogSpeed] == Approx((1.0 - 0.2) / scatter));
  CHECK(errors[3].traits[kLogSpeed] == Approx((1.0 - 1.22) / scatter));
}

TEST_CASE("What is driven in the place of a simulated log stands on the frames of the real one's") {
  std::vector<CalibrationLog> logs{Log("a", 0.0), Log("b", 0.5)};
  logs[1].drives_grid_fps = 30.0;
  Told simulator(std::vector<LogPrediction>(2));
  simulator.made = {Lane(0.2), Lane(0.9)};
  const std::vector<experiment::FreeParameter> parameters{{.key = "p", .max = 1.0}};
  const CalibrationOptions options;
  const Eigen::VectorXd shares = Eigen::VectorXd::Constant(1, 0.5);
  const ErrorModel real(parameters, logs, simulator, options, shares);
  real.OfSimulatedLogs(shares, 0).RawErrorsAt(shares);
  CHECK(simulator.grids_fps == std::vector<double>{0.0, 30.0});
}

TEST_CASE("How far repeats are apart leaves the first tenth of their paths out") {
  Trajectory jump = Lane(0.03);
  for (size_t i = 0; i < 2; ++i) jump.poses[i].y_m += 0.02;  // the first twentieth of the way
  CalibrationLog second = Log("a", 0.0);
  second.log = jump;
  Told simulator(std::vector<LogPrediction>(2));
  CHECK(TraitsOfLogs({Log("a", 0.0), second}, simulator, {}).log_spread[1] ==
        Approx(std::log(0.03)).margin(0.1));  // not log 0.05
  // The same path twice is a tenth of a millimetre apart.
  CHECK(TraitsOfLogs({Log("a", 0.0), Log("a", 0.0)}, simulator, {}).log_spread[1] ==
        Approx(std::log(1e-4)));
}

TEST_CASE("How far repeats are apart counts what they do behind the first tenth of their paths") {
  CalibrationLog second = Log("a", 0.03);
  second.log.poses[3].y_m += 0.005;  // at 0.15 of the way
  Told simulator(std::vector<LogPrediction>(2));
  CHECK(TraitsOfLogs({Log("a", 0.0), second}, simulator, {}).log_spread[1] ==
        Approx(std::log(0.035)).margin(0.02));  // and not log 0.03
}

}  // namespace
}  // namespace rift::sweep
