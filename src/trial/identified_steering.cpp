#include "identified_steering.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <vector>

#include "progress.hpp"
#include "rift/geometry/pose2.hpp"
#include "rift/trial/loop_delay.hpp"

namespace rift::trial {
namespace {

using std::numbers::pi;

constexpr double kLeastR2 = 0.3;
constexpr double kTurnedAway = 0.25;
constexpr double kLeastWay_m = 0.02;

double Turned_rad(const trajectory::Trajectory& log) {
  double turned_rad = 0.0;
  for (size_t i = 1; i < log.poses.size(); ++i) {
    turned_rad += geometry::WrapToPi(log.poses[i].yaw_rad - log.poses[i - 1].yaw_rad);
  }
  return turned_rad;
}

/// Integrals over time of v and w as they were sent.
class SentIntegrals {
 public:
  explicit SentIntegrals(const std::vector<SentCommand>& commands) : commands_(commands) {
    SteeringCommand sum{0.0, 0.0};
    for (size_t i = 0; i < commands.size(); ++i) {
      sums_.push_back(sum);
      if (i + 1 == commands.size()) break;
      const SteeringCommand held = Of(i);
      const double dt_s = commands[i + 1].t_s - commands[i].t_s;
      sum = {sum.v + dt_s * held.v, sum.w + dt_s * held.w};
    }
  }

  SteeringCommand Until(double t_s) const {
    if (commands_.empty()) return {0.0, 0.0};
    t_s = std::min(t_s, commands_.back().t_s);  // how long that one held is not known
    const auto after =
        std::upper_bound(commands_.begin(), commands_.end(), t_s,
                         [](double t, const SentCommand& sent) { return t < sent.t_s; });
    if (after == commands_.begin()) return {0.0, 0.0};
    const auto i = static_cast<size_t>(after - commands_.begin()) - 1;
    const SteeringCommand held = Of(i);
    const double dt_s = t_s - commands_[i].t_s;
    return {sums_[i].v + dt_s * held.v, sums_[i].w + dt_s * held.w};
  }

 private:
  SteeringCommand Of(size_t i) const {
    const control::WheelPower& power = commands_[i].power;
    return {0.5 * (power.left + power.right), 0.5 * (power.right - power.left)};
  }

  const std::vector<SentCommand>& commands_;
  std::vector<SteeringCommand> sums_;
};

/// Sums of squares and products of the turn of a stride and of what was sent for it.
struct TurnSums {
  double ww = 0.0, wv = 0.0, vv = 0.0, wy = 0.0, vy = 0.0, yy = 0.0;

  /// Share of w that v does not tell: without it gain and pull cannot be told apart.
  double Excitation() const { return ww * vv > 0.0 ? 1.0 - wv * wv / (ww * vv) : 0.0; }
};

TurnSums TurnsOf(const TrialResult& result, const SentIntegrals& sent, double delay_s) {
  constexpr double kStride_s = 0.3;
  TurnSums sums;
  const std::vector<trajectory::StampedPose>& poses = result.trajectory.poses;
  double turned_rad = 0.0;
  for (size_t i = 1, from = 0; i < poses.size(); ++i) {
    turned_rad += geometry::WrapToPi(poses[i].yaw_rad - poses[i - 1].yaw_rad);
    if (poses[i].t_s - poses[from].t_s < kStride_s) continue;
    const SteeringCommand to = sent.Until(poses[i].t_s - delay_s),
                          at = sent.Until(poses[from].t_s - delay_s);
    const double v = to.v - at.v, w = to.w - at.w;
    sums.ww += w * w, sums.wv += w * v, sums.vv += v * v;
    sums.wy += w * turned_rad, sums.vy += v * turned_rad, sums.yy += turned_rad * turned_rad;
    from = i;
    turned_rad = 0.0;
  }
  return sums;
}

/// Yaw rate for each unit of w and of v that explain the turns best, where the run tells both.
void FitPull(const TurnSums& sums, IdentifiedSteering& found) {
  constexpr double kLeastExcitation = 0.02, kLeastShare = 0.5, kMostRest = 0.5;
  if (sums.Excitation() < kLeastExcitation) return;
  const double det = sums.ww * sums.vv - sums.wv * sums.wv;
  const double gain = (sums.wy * sums.vv - sums.vy * sums.wv) / det;
  const double pull = (sums.vy * sums.ww - sums.wy * sums.wv) / det;
  const double explained = (gain * sums.wy + pull * sums.vy) / sums.yy;
  const double without = sums.wy * sums.wy / (sums.ww * sums.yy);
  // A pull has to explain what the steering alone does not.
  if (!(gain > 0.0) || explained < kLeastShare || 1.0 - explained > kMostRest * (1.0 - without))
    return;
  found.model.yaw_rate_rad_s = gain;
  found.model.pull_rad_s = pull;
  found.r2 = explained;
  found.is_identified = found.is_pull_told = true;
}

std::optional<LoopDelay> TryDelay(const TrialResult& result, double sign) {
  std::vector<SentCommand> sent = result.commands;
  for (SentCommand& command : sent) {
    if (sign < 0.0) std::swap(command.power.left, command.power.right);
  }
  try {
    return EstimateCommandDelay(result.trajectory, sent, {.max_lag_s = 1.0, .lag_step_s = 0.02});
  } catch (const std::invalid_argument&) {  // too short, or it never moved
    return std::nullopt;
  }
}

/// Steering to the left turned it to the right.
bool IsReversed(const LoopDelay& delay, const TrialResult& result) {
  const std::optional<LoopDelay> reversed = TryDelay(result, -1.0);
  if (!reversed || reversed->r2 < kLeastR2) return false;
  // Steering that swings fits half a period late too, with the wrong sign.
  return delay.lag_s < 0.0 || (reversed->r2 > delay.r2 && reversed->lag_s < delay.lag_s);
}

}  // namespace

IdentifiedSteering IdentifySteering(const TrialResult& result, const SteeringPrior& prior,
                                    double turns) {
  IdentifiedSteering found{.model = prior.model};
  found.model.pose_age_s =
      std::max(0.0, result.pose_age_s >= 0.0 ? result.pose_age_s : result.arrival_age_s);
  const double way_m = Way_m(result.trajectory);
  const std::optional<LoopDelay> delay = TryDelay(result, 1.0);
  if (way_m < kLeastWay_m || !delay) return found;
  // It turns its back on the waypoint; less of a turn may be noise.
  const bool may_be_reversed = result.outcome != Outcome::kReached && turns > kTurnedAway;
  if (may_be_reversed && IsReversed(*delay, result)) {
    found.is_reversed = true;
    return found;
  }
  found.r2 = delay->r2;
  found.is_identified = delay->r2 >= kLeastR2 && delay->gain_rad_s > 0.0;
  if (found.is_identified) {
    found.model.yaw_rate_rad_s = 2.0 * delay->gain_rad_s;
    found.model.command_delay_s = delay->lag_s;
  }
  const SentIntegrals integrals(result.commands);
  const SteeringCommand sent =
      integrals.Until(result.trajectory.poses.back().t_s - found.model.command_delay_s);
  FitPull(TurnsOf(result, integrals, found.model.command_delay_s), found);
  if (sent.v > 0.1 * way_m / prior.model.speed_mps) found.model.speed_mps = way_m / sent.v;
  // On a steady circle nothing tells the delay, and the turn itself tells the gain.
  const double turned_rad = Turned_rad(result.trajectory);
  if (!found.is_identified && std::abs(turned_rad) > pi && turned_rad * sent.w > 0.0) {
    // A gain far from the robot's own is a pull.
    constexpr double kLeastShare = 0.6;
    const double gain = turned_rad / sent.w, own = prior.model.yaw_rate_rad_s;
    if (gain > kLeastShare * own && gain < own / kLeastShare) {
      found.model.yaw_rate_rad_s = gain;
    } else {
      found.model.pull_rad_s = (turned_rad - own * sent.w) / sent.v;
    }
    found.is_identified = true;
  }
  return found;
}

}  // namespace rift::trial
