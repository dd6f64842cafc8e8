#include "rift/sweep/calibrate/report_bytes.hpp"

#include <concepts>
#include <stdexcept>
#include <type_traits>

#include "rift/sweep/run/byte_codec.hpp"

namespace rift::sweep {
namespace {

template <class T>
inline constexpr bool kIsVector = false;
template <class T>
inline constexpr bool kIsVector<std::vector<T>> = true;

/// T is U or const U: one list of members for both directions.
template <class T, class U>
concept Is = std::same_as<std::remove_const_t<T>, U>;

/// ByteWriter or ByteReader, for structs with lists in them.
template <class Bytes>
class Codec {
 public:
  explicit Codec(Bytes bytes) : bytes_(std::move(bytes)) {}

  template <class T>
  void operator()(T& value) {
    using Value = std::remove_const_t<T>;
    if constexpr (kIsVector<Value>) {
      const size_t count = Count(value.size());
      if constexpr (kReads) value.resize(count);
      for (auto& item : value) (*this)(item);
    } else if constexpr (std::same_as<Value, Eigen::MatrixXd>) {
      const size_t rows = Count(static_cast<size_t>(value.rows()));
      if constexpr (kReads) {
        value.resize(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(rows));
      }
      for (auto& number : value.reshaped()) bytes_(number);
    } else if constexpr (Plain<Value> || std::same_as<Value, std::string>) {
      bytes_(value);
    } else {
      Members(*this, value);
    }
  }
  Bytes& bytes() { return bytes_; }

 private:
  static constexpr bool kReads = std::same_as<Bytes, ByteReader>;

  size_t Count(size_t written) {
    if constexpr (kReads) return bytes_.Count(1);
    bytes_(written);
    return written;
  }

  Bytes bytes_;
};

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

template <class C, Is<trajectory::Channel> T>
void Members(C& codec, T& channel) {
  codec(channel.name);
  codec(channel.values);
}

template <class C, Is<trajectory::Trajectory> T>
void Members(C& codec, T& path) {
  codec(path.poses);
  codec(path.channels);
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

}  // namespace

std::string EncodeReport(const CalibrationReport& report) {
  Codec<ByteWriter> codec{ByteWriter()};
  codec(report);
  return codec.bytes().Take();
}

CalibrationReport DecodeReport(std::string_view bytes) {
  Codec<ByteReader> codec{ByteReader(bytes)};
  CalibrationReport report;
  codec(report);
  if (!codec.bytes().IsAtEnd()) throw std::runtime_error("a calibration has more behind its end");
  return report;
}

}  // namespace rift::sweep
