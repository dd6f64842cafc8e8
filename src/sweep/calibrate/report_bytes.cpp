#include "rift/sweep/calibrate/report_bytes.hpp"

#include <stdexcept>
#include <type_traits>

#include "rift/sweep/falsify/trajectory_bytes.hpp"
#include "rift/sweep/run/byte_codec.hpp"

namespace rift::sweep {

template <class C, Is<Eigen::MatrixXd> T>
void Members(C& codec, T& square) {
  const size_t rows = codec.Count(static_cast<size_t>(square.rows()), 1);
  if constexpr (!std::is_const_v<T>) {
    square.resize(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(rows));
  }
  for (auto& number : square.reshaped()) codec(number);
}

template <class C, Is<CalibratedParameter> T>
void Members(C& codec, T& p) {
  codec(p.parameter.key);
  codec(p.parameter.min);
  codec(p.parameter.max);
  codec(p.parameter.start);
  codec(p.parameter.prior_mean);
  codec(p.parameter.prior_sd);
  codec(p.value);
  codec(p.low);
  codec(p.high);
  codec(p.has_effect);
  codec(p.is_at_bound);
  codec(p.is_identified);
  codec(p.is_from_prior);
}

template <class C, Is<Calibration> T>
void Members(C& codec, T& fit) {
  codec(fit.parameters);
  codec(fit.correlation);
  codec(fit.loss_before);
  codec(fit.loss_after);
  codec(fit.loss_noise);
  codec(fit.steps);
  codec(fit.has_converged);
  codec(fit.trials_simulated);
}

template <class C, Is<StartAgreement> T>
void Members(C& codec, T& agreement) {
  codec(agreement.values);
  codec(agreement.difference);
  codec(agreement.agrees);
}

template <class C, Is<CalibrationTrial> T>
void Members(C& codec, T& trial) {
  codec(trial.level);
  codec(trial.trial);
  codec(trial.source);
  codec(trial.is_held_out);
  codec(trial.gap_before_m);
  codec(trial.gap_after_m);
}

template <class C, Is<statistics::TwoSampleTest> T>
void Members(C& codec, T& test) {
  codec(test.first);
  codec(test.second);
  codec(test.groups);
  codec(test.accuracy);
  codec(test.accuracy_interval);
  codec(test.p);
  codec(test.features);
}

template <class C, Is<DriveLikeness> T>
void Members(C& codec, T& likeness) {
  codec(likeness.path);
  codec(likeness.loop_delay_s);
  codec(likeness.loop_r2);
  codec(likeness.steering_gain_rad_s);
  codec(likeness.runs);
  codec(likeness.circled_runs);
  codec(likeness.prediction);
  codec(likeness.ranks);
  codec(likeness.told_apart.all);
  codec(likeness.told_apart.without_timing);
  codec(likeness.told_apart.features);
  codec(likeness.failed_runs);
}

template <class C, Is<JudgedGroup> T>
void Members(C& codec, T& group) {
  codec(group.level);
  codec(group.side);
  codec(group.before);
  codec(group.after);
}

template <class C, Is<CalibrationReport::Errors> T>
void Members(C& codec, T& errors) {
  codec(errors.side);
  codec(errors.before);
  codec(errors.after);
}

template <class C, Is<CalibrationReport> T>
void Members(C& codec, T& report) {
  codec(report.calibration);
  codec(report.agreement);
  codec(report.values);
  codec(report.trials);
  codec(report.missing);
  codec(report.judged);
  codec(report.errors);
  codec(report.shown);
  codec(report.shown_real);
  codec(report.shown_before);
  codec(report.shown_after);
}

std::string EncodeReport(const CalibrationReport& report) {
  ByteWriter write;
  write(report);
  return write.Take();
}

CalibrationReport DecodeReport(std::string_view bytes) {
  ByteReader read(bytes);
  CalibrationReport report;
  read(report);
  if (!read.IsAtEnd()) throw std::runtime_error("a calibration has more behind its end");
  return report;
}

}  // namespace rift::sweep
