#include <catch2/catch.hpp>

#include "rift/report/text/text.hpp"

namespace rift::report {
namespace {

TEST_CASE("A fit that is worse than its start is not written, and both losses say so") {
  sweep::Calibration fit;
  fit.loss_before = 1.25;
  fit.loss_after = 1.5;
  const std::string why = WhyNotWritten(fit, "robot.yaml");
  CHECK(why.find("robot.yaml is not written") == 0);
  CHECK(why.find("1.5000 after 1.2500") != std::string::npos);
  CHECK(why.find('\n') == std::string::npos);
  // By more than what drives scatter by.
  fit.loss_noise = 0.13;
  CHECK(WhyNotWritten(fit, "robot.yaml").empty());
  fit.loss_noise = 0.12;
  CHECK_FALSE(WhyNotWritten(fit, "robot.yaml").empty());
  fit.loss_noise = 0.0;
  fit.loss_after = fit.loss_before;
  CHECK(WhyNotWritten(fit, "robot.yaml").empty());
}

sweep::Calibration FitOf(double value, double low, double high) {
  return {.parameters = {{.parameter = {.key = "simulation.link.delay_s"},
                          .value = value,
                          .low = low,
                          .high = high}}};
}

TEST_CASE("Starts agree when they differ by at most 0.3 of half the interval") {
  const auto of = [](double other) {
    return sweep::AgreementOf({FitOf(0.10, 0.08, 0.12), FitOf(other, 0.0, 1.0)}).front();
  };
  CHECK(of(0.105).difference == Approx(0.25));
  CHECK(of(0.105).agrees);
  CHECK(of(0.09).difference == Approx(0.5));
  CHECK_FALSE(of(0.09).agrees);
  CHECK(of(0.10).agrees);
  CHECK(sweep::AgreementOf({FitOf(0.1, 0.1, 0.1)}).empty());
  CHECK_FALSE(sweep::AgreementOf({FitOf(0.1, 0.1, 0.1), FitOf(0.2, 0.1, 0.1)}).front().agrees);
}

TEST_CASE("Values of several starts stand apart, however long they are") {
  sweep::CalibrationReport report{.calibration = FitOf(-0.0007646, -0.002, 0.001)};
  report.calibration.correlation.setIdentity(1, 1);
  report.agreement = sweep::AgreementOf({report.calibration, FitOf(-0.0008748, -0.002, 0.001)});
  CHECK(CalibrationText(report).find(
            "simulation.link.delay_s  -0.0007646  -0.0008748  difference 0.07\n") !=
        std::string::npos);
}

TEST_CASE("The flag of a parameter says when the prior and not the logs tell it") {
  sweep::CalibratedParameter parameter;
  CHECK(FlagOf(parameter).empty());
  parameter.is_from_prior = true;
  CHECK(FlagOf(parameter) == "from the prior, not the logs");
}

TEST_CASE("The table of a fit is as wide as its words where the keys are short") {
  sweep::CalibrationReport report{.calibration = FitOf(0.25, 0.125, 0.5)};
  report.calibration.parameters[0].parameter.key = "mu";
  report.calibration.parameters[0].parameter.start = 0.75;
  report.calibration.correlation.setIdentity(1, 1);
  const std::string text = CalibrationText(report);
  INFO(text);
  CHECK(text.find("\nparameter      start      value  interval                flag\n"
                  "mu              0.75       0.25  [0.125, 0.5]            ") !=
        std::string::npos);
}

}  // namespace
}  // namespace rift::report
