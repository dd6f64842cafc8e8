#include "rift/sweep/calibrate/report_bytes.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "support/inputs/paths.hpp"

namespace rift::sweep {
namespace {

CalibrationReport Report() {
  CalibrationReport report;
  report.calibration.parameters = {
      {.parameter = {.key = "simulation.motor.mismatch"}, .value = 0.1}};
  report.calibration.correlation = Eigen::MatrixXd::Constant(1, 1, std::nan(""));
  report.agreement = {{.values = {0.1, 0.2}, .difference = 0.5, .agrees = false}};
  report.values = {0.1};
  report.trials = {{.level = "ground", .trial = "1", .source = "a.csv", .is_held_out = true}};
  report.missing = {"b.csv: no such file"};
  report.judged = {{.level = "all", .side = "fitted"}};
  report.judged[0].after.told_apart.features.resize(3);
  report.judged[0].after.told_apart.all.features = {{.feature = 2, .weight = -1.5}};
  report.errors = {{.side = "fitted"}};
  report.errors[0].after.lag_s = 0.25;
  report.shown_real = test::StraightPath(0.7, 5);
  report.shown_real.channels = {{"power_left", {0.1, 0.2, 0.3, 0.4, 0.5}}};
  report.shown_after = {test::StraightPath(0.6, 4), test::StraightPath(0.5, 3)};
  return report;
}

TEST_CASE("A calibration comes back from its bytes with every list and every number") {
  const std::string bytes = EncodeReport(Report());
  const CalibrationReport back = DecodeReport(bytes);
  CHECK(EncodeReport(back) == bytes);
  CHECK(back.calibration.parameters[0].parameter.key == "simulation.motor.mismatch");
  CHECK(std::isnan(back.calibration.correlation(0, 0)));
  CHECK_FALSE(back.agreement[0].agrees);
  CHECK(back.trials[0].is_held_out);
  CHECK(back.missing == Report().missing);
  CHECK(back.judged[0].after.told_apart.features.size() == 3);
  CHECK(back.judged[0].after.told_apart.all.features[0].weight == -1.5);
  CHECK(back.errors[0].after.lag_s == 0.25);
  CHECK(back.shown_real.channels[0].values[4] == 0.5);
  CHECK(back.shown_after[1].poses.size() == 3);
}

TEST_CASE("Bytes of a calibration that are cut short, or followed by more, are refused") {
  const std::string bytes = EncodeReport(Report());
  for (size_t length = 0; length < bytes.size(); length += 7) {
    CHECK_THROWS_AS(DecodeReport(bytes.substr(0, length)), std::runtime_error);
  }
  CHECK_THROWS_WITH(DecodeReport(bytes + "x"), Catch::Contains("behind its end"));
}

}  // namespace
}  // namespace rift::sweep
