#include "rift/trial/loop_delay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "rift/control/navigator.hpp"
#include "rift/geometry/pose2.hpp"

namespace rift::trial {
namespace {

constexpr size_t kFewestIntervals = 10;

// A power that holds from one pose to the next; its integral makes means over any span exact.
class HeldSteering {
 public:
  void Append(double t_s, double steering) {
    if (!times_s_.empty()) {
      integrals_.push_back(integrals_.back() + values_.back() * (t_s - times_s_.back()));
    } else {
      integrals_.push_back(0.0);
    }
    times_s_.push_back(t_s);
    values_.push_back(steering);
  }

  double Mean(double from_s, double to_s) const {
    return (IntegralTo(to_s) - IntegralTo(from_s)) / (to_s - from_s);
  }

 private:
  double IntegralTo(double t_s) const {
    const auto after = std::upper_bound(times_s_.begin(), times_s_.end(), t_s);
    if (after == times_s_.begin()) return 0.0;  // nothing was sent before the log
    const size_t i = static_cast<size_t>(after - times_s_.begin()) - 1;
    return integrals_[i] + values_[i] * (t_s - times_s_[i]);
  }

  std::vector<double> times_s_, values_, integrals_;
};

struct Answer {
  double from_s, to_s;
  double yaw_rate_rad_s;
};

HeldSteering RebuildSteering(const trajectory::Trajectory& log,
                             const std::vector<control::Waypoint>& waypoints,
                             const control::NavigatorOptions& options, double* finished_s) {
  control::Navigator navigator(options, waypoints);
  HeldSteering steering;
  *finished_s = log.poses.back().t_s;
  double last_s = log.poses.front().t_s - (log.poses[1].t_s - log.poses[0].t_s);
  for (const trajectory::StampedPose& pose : log.poses) {
    const control::Decision decision =
        navigator.Step({pose.t_s, pose.t_s - last_s, pose.t_s, pose.Planar()});
    navigator.NoteSent(pose.t_s, decision.power);
    steering.Append(pose.t_s, decision.power.right - decision.power.left);
    if (decision.finished) *finished_s = std::min(*finished_s, pose.t_s);
    last_s = pose.t_s;
  }
  return steering;
}

std::vector<Answer> MovingAnswers(const trajectory::Trajectory& log, double moved_m,
                                  double finished_s) {
  std::vector<Answer> answers;
  bool has_moved = false;
  for (size_t i = 0; i + 1 < log.poses.size(); ++i) {
    const trajectory::StampedPose &from = log.poses[i], &to = log.poses[i + 1];
    has_moved = has_moved || (from.Position() - log.poses[0].Position()).norm() >= moved_m;
    if (!has_moved || to.t_s > finished_s) continue;
    const double turned_rad = geometry::WrapToPi(to.yaw_rad - from.yaw_rad);
    answers.push_back({from.t_s, to.t_s, turned_rad / (to.t_s - from.t_s)});
  }
  return answers;
}

struct Line {
  double gain = 0.0;
  double bias = 0.0;
  double r2 = 0.0;
};

// Least squares of the yaw rate over the steering `lag_s` before.
Line FitAtLag(const std::vector<Answer>& answers, const HeldSteering& steering, double lag_s) {
  double sum_x = 0.0, sum_y = 0.0, sum_xx = 0.0, sum_xy = 0.0, sum_yy = 0.0;
  for (const Answer& answer : answers) {
    const double x = steering.Mean(answer.from_s - lag_s, answer.to_s - lag_s);
    const double y = answer.yaw_rate_rad_s;
    sum_x += x, sum_y += y, sum_xx += x * x, sum_xy += x * y, sum_yy += y * y;
  }
  const double n = static_cast<double>(answers.size());
  const double var_x = sum_xx - sum_x * sum_x / n, var_y = sum_yy - sum_y * sum_y / n;
  const double cov = sum_xy - sum_x * sum_y / n;
  if (!(var_x > 0.0 && var_y > 0.0 && cov > 0.0)) return {};
  const double gain = cov / var_x;
  return {gain, (sum_y - gain * sum_x) / n, cov * cov / (var_x * var_y)};
}

void CheckLog(const trajectory::Trajectory& log, const LoopDelayOptions& options) {
  if (!(options.lag_step_s > 0.0 && options.max_lag_s >= 0.0)) {
    throw std::invalid_argument(
        fmt::format("lag_step_s is {} and max_lag_s {}, and they must be above zero and not below",
                    options.lag_step_s, options.max_lag_s));
  }
  if (log.poses.size() <= kFewestIntervals || !log.HasYaw()) {
    throw std::invalid_argument(
        fmt::format("the loop delay needs yaw and more than {} poses, and the log has {}{}",
                    kFewestIntervals, log.poses.size(), log.HasYaw() ? "" : " without yaw"));
  }
}

// Between the lags tried, R2 is taken for a parabola through its highest point and its neighbours.
double RefinedPeak_s(const LoopDelay& delay, size_t best, double lag_step_s) {
  if (best == 0 || best + 1 == delay.r2_at_lag.size()) return delay.lags_s[best];
  const double before = delay.r2_at_lag[best - 1], peak = delay.r2_at_lag[best],
               after = delay.r2_at_lag[best + 1];
  const double bend = before - 2.0 * peak + after;
  if (!(bend < 0.0)) return delay.lags_s[best];
  return delay.lags_s[best] + 0.5 * lag_step_s * (before - after) / bend;
}

LoopDelay DelayBetween(const HeldSteering& steering, const std::vector<Answer>& answers,
                       const LoopDelayOptions& options) {
  if (answers.size() < kFewestIntervals) {
    throw std::invalid_argument(
        fmt::format("the loop delay needs {} intervals in motion, and the log has {}",
                    kFewestIntervals, answers.size()));
  }
  LoopDelay delay;
  delay.intervals = answers.size();
  const int lags = static_cast<int>(std::floor(options.max_lag_s / options.lag_step_s + 1e-9));
  for (int i = 0; i <= lags; ++i) {
    delay.lags_s.push_back(i * options.lag_step_s);
    delay.r2_at_lag.push_back(FitAtLag(answers, steering, delay.lags_s.back()).r2);
  }
  const auto highest = std::max_element(delay.r2_at_lag.begin(), delay.r2_at_lag.end());
  if (*highest <= 0.0) return delay;
  delay.lag_s = RefinedPeak_s(delay, static_cast<size_t>(highest - delay.r2_at_lag.begin()),
                              options.lag_step_s);
  const Line line = FitAtLag(answers, steering, delay.lag_s);
  delay.r2 = line.r2;
  delay.gain_rad_s = line.gain;
  delay.bias_rad_s = line.bias;
  return delay;
}

}  // namespace

LoopDelay EstimateLoopDelay(const trajectory::Trajectory& log,
                            const std::vector<control::Waypoint>& waypoints,
                            const control::NavigatorOptions& navigator,
                            const LoopDelayOptions& options) {
  CheckLog(log, options);
  double finished_s = 0.0;
  const HeldSteering steering = RebuildSteering(log, waypoints, navigator, &finished_s);
  return DelayBetween(steering, MovingAnswers(log, options.moved_m, finished_s), options);
}

LoopDelay EstimateCommandDelay(const trajectory::Trajectory& log, std::span<const SentCommand> sent,
                               const LoopDelayOptions& options) {
  CheckLog(log, options);
  HeldSteering steering;
  for (const SentCommand& command : sent) {
    steering.Append(command.t_s, command.power.right - command.power.left);
  }
  if (sent.empty()) throw std::invalid_argument("the loop delay needs commands, and none was sent");
  return DelayBetween(steering, MovingAnswers(log, options.moved_m, log.poses.back().t_s), options);
}

}  // namespace rift::trial
