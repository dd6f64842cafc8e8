#include "rift/hardware/latency.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <utility>
#include <vector>

#include "rift/geometry/pose2.hpp"
#include "rift/statistics/descriptive.hpp"

namespace rift::hardware {
namespace {

constexpr double kTurn_s = 0.02;  // of the loop
constexpr double kTick_s = 1e-4;  // less is no time
constexpr double kLagStep_s = 0.005;
constexpr double kLeastLag_s = -0.1;  // clocks that do not agree show up here
constexpr double kMostLag_s = 1.2;
constexpr size_t kLeastSamples = 8;
constexpr double kRest_s = 0.5;  // after a pulse, for wheels and link to come to rest
// On top of it, pulse by pulse: no pair of pulses is like the one before, or a picture that is one
// pair late would fit as well as one of now.
constexpr std::array<double, 6> kMoreRest_s{0.0, 0.05, 0.15, 0.0, 0.05, 0.2};
constexpr int kMostPulses = 14;
constexpr double kHarder = 1.25;

double Range(std::span<const Angle> angles) {
  if (angles.empty()) return 0.0;
  const auto [low, high] = std::minmax_element(
      angles.begin(), angles.end(), [](const Angle& a, const Angle& b) { return a.rad < b.rad; });
  return high->rad - low->rad;
}

/// Mean time between two.
double Spacing_s(std::span<const Angle> angles) {
  if (angles.size() < 2) return 0.0;
  return (angles.back().t_s - angles.front().t_s) / static_cast<double>(angles.size() - 1);
}

/// Nine in ten are read no further apart: a busy machine reads them unevenly.
double WidestSpacing_s(std::span<const Angle> angles) {
  if (angles.size() < 2) return 0.0;
  std::vector<double> spacings_s;
  for (size_t i = 1; i < angles.size(); ++i) {
    spacings_s.push_back(angles[i].t_s - angles[i - 1].t_s);
  }
  return statistics::Quantile(std::move(spacings_s), 0.9);
}

/// It stands before its first time and after its last: all of the follower counts at every lag.
double At(std::span<const Angle> angles, double t_s) {
  const auto after = std::lower_bound(angles.begin(), angles.end(), t_s,
                                      [](const Angle& a, double t) { return a.t_s < t; });
  if (after == angles.begin()) return after->rad;
  if (after == angles.end()) return angles.back().rad;
  const Angle& before = *(after - 1);
  const double share = (t_s - before.t_s) / (after->t_s - before.t_s);
  return before.rad + share * (after->rad - before.rad);
}

/// The line through follower over leader at one lag.
std::optional<Lag> FitAt(std::span<const Angle> follower, std::span<const Angle> leader,
                         double lag_s) {
  std::vector<double> x, y;
  for (const Angle& angle : follower) {
    x.push_back(At(leader, angle.t_s - lag_s));
    y.push_back(angle.rad);
  }
  const double mean_x = statistics::Mean(x), mean_y = statistics::Mean(y);
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
    yy += (y[i] - mean_y) * (y[i] - mean_y);
  }
  if (xx <= 0.0) return std::nullopt;
  const double scale = xy / xx;
  const double squares = std::max(0.0, yy - scale * xy);
  return Lag{lag_s, scale, std::sqrt(squares / static_cast<double>(x.size()))};
}

}  // namespace

void AddAngle(std::vector<Angle>& angles, double t_s, double rad) {
  const double before_rad = angles.empty() ? rad : angles.back().rad;
  angles.push_back({t_s, before_rad + geometry::WrapToPi(rad - before_rad)});
}

namespace {

enum class Side { kAny, kSame };

std::optional<Lag> BestLag(std::span<const Angle> follower, std::span<const Angle> leader,
                           double least_s, double most_s, Side side) {
  constexpr double kLeastTurn_rad = 1e-3;
  if (follower.size() < kLeastSamples) return std::nullopt;
  if (Range(follower) < kLeastTurn_rad || Range(leader) < kLeastTurn_rad) return std::nullopt;
  std::vector<Lag> fits;
  const auto steps = static_cast<int>(std::floor((most_s - least_s) / kLagStep_s + 1e-6));
  for (int step = 0; step <= steps; ++step) {
    const std::optional<Lag> fit = FitAt(follower, leader, least_s + step * kLagStep_s);
    if (fit && (side == Side::kAny || fit->scale > 0.0)) fits.push_back(*fit);
  }
  if (fits.empty()) return std::nullopt;
  const auto best = std::min_element(fits.begin(), fits.end(), [](const Lag& a, const Lag& b) {
    return a.residual_rad < b.residual_rad;
  });
  Lag found = *best;
  if (best == fits.begin() || best + 1 == fits.end()) return found;
  // The parabola through the squares of the residuals around the least.
  const double before = std::pow((best - 1)->residual_rad, 2);
  const double here = std::pow(best->residual_rad, 2);
  const double after = std::pow((best + 1)->residual_rad, 2);
  const double curvature = before - 2.0 * here + after;
  if (curvature > 0.0) found.lag_s += 0.5 * kLagStep_s * (before - after) / curvature;
  return found;
}

}  // namespace

std::optional<Lag> EstimateLag(std::span<const Angle> follower, std::span<const Angle> leader,
                               double least_s, double most_s) {
  return BestLag(follower, leader, least_s, most_s, Side::kAny);
}

std::vector<Angle> WheelTurns(std::span<const EncoderReading> readings, double rad_per_count) {
  std::vector<Angle> angles;
  for (const EncoderReading& reading : readings) {
    const auto difference = static_cast<double>(reading.counts.right - reading.counts.left);
    if (angles.empty() || reading.t_s > angles.back().t_s) {
      angles.push_back({reading.t_s, rad_per_count * difference});
    }
  }
  return angles;
}

bool AreTimed(std::span<const Angle> wheels) {
  constexpr double kMostSpacing_s = 0.1;
  return wheels.size() >= kLeastSamples && Spacing_s(wheels) < kMostSpacing_s;
}

namespace {

/// Collects what the turn shows.
class Turn {
 public:
  Turn(RealRobot& robot, const odometry::OdometryOptions& odometry) : robot_(robot) {
    yaw_per_count_rad_ = odometry::YawPerCount_rad(odometry);
  }

  /// False when the drive was stopped.
  bool Run(const control::WheelPower& power, double duration_s) {
    double now_s = Look();
    began_s_ = now_s;
    const double end_s = now_s + duration_s;
    while (now_s < end_s - kTick_s) {
      if (robot_.state() == DriveState::kStopped) return false;
      if (commanded_.empty() || commanded_.back().t_s < now_s) {
        const double before_rad = commanded_.empty() ? 0.0 : commanded_.back().rad;
        const double since_s = commanded_.empty() ? 0.0 : now_s - commanded_.back().t_s;
        commanded_.push_back({now_s, before_rad + (last_.right - last_.left) * since_s});
      }
      robot_.Command(power);
      last_ = power;
      robot_.Advance(std::min(kTurn_s, end_s - now_s));
      now_s = Look();
    }
    return true;
  }

  std::vector<Angle> Wheels() const {
    return WheelTurns(robot_.Record().encoders, yaw_per_count_rad_);
  }
  const std::vector<Angle>& Seen() const { return seen_; }
  const std::vector<Angle>& Commanded() const { return commanded_; }
  /// When the last Run() did.
  double Began_s() const { return began_s_; }

 private:
  double Look() {
    const trial::Sensed sensed = robot_.Sense();
    if (sensed.pose && (seen_.empty() || sensed.pose->captured_s > seen_.back().t_s)) {
      AddAngle(seen_, sensed.pose->captured_s, sensed.pose->world_from_robot.yaw_rad);
    }
    return sensed.now_s;
  }

  RealRobot& robot_;
  double yaw_per_count_rad_ = 0.0;
  std::vector<Angle> seen_, commanded_;
  control::WheelPower last_;
  double began_s_ = 0.0;
};

std::optional<double> HostTime_s(const std::vector<PoseStages>& poses) {
  std::vector<double> times_s;
  for (const PoseStages& pose : poses) {
    if (pose.written_s >= 0.0) times_s.push_back(pose.written_s - pose.arrived_s);
  }
  if (times_s.empty()) return std::nullopt;
  return statistics::Median(times_s);
}

/// From the middle of a pulse to the middle of what the wheels made of it; NaN when they hardly
/// moved.
double Response_s(const std::vector<Angle>& wheels, double began_s, double pulse_s) {
  constexpr double kLeast_rad = 0.01;
  const double from_rad = At(wheels, began_s), to_rad = At(wheels, began_s + kRest_s);
  if (std::abs(to_rad - from_rad) < kLeast_rad) return std::nan("");
  const double middle_rad = 0.5 * (from_rad + to_rad);
  for (size_t i = 1; i < wheels.size(); ++i) {
    const Angle &before = wheels[i - 1], &after = wheels[i];
    const bool crosses = (before.rad < middle_rad) != (after.rad < middle_rad);
    if (after.t_s < began_s || !crosses) continue;
    const double share = (middle_rad - before.rad) / (after.rad - before.rad);
    return before.t_s + share * (after.t_s - before.t_s) - (began_s + 0.5 * pulse_s);
  }
  return std::nan("");
}

/// The parts of the loop delay, from what the turn showed. `pulses_s`: when each pulse began.
LoopDelay DelayOf(const std::vector<Angle>& wheels, const std::vector<double>& pulses_s,
                  double pulse_s, const Lag& camera, double one_way_s,
                  const std::vector<PoseStages>& poses) {
  LoopDelay delay{.camera_s = camera.lag_s, .host_s = HostTime_s(poses), .link_s = one_way_s};
  std::vector<double> responses_s;
  for (const double began_s : pulses_s) {
    const double response_s = Response_s(wheels, began_s, pulse_s);
    if (!std::isnan(response_s)) responses_s.push_back(response_s);
  }
  if (!responses_s.empty()) {
    delay.robot_s = std::max(0.0, statistics::Median(responses_s) - one_way_s);
  }
  delay.total_s =
      *delay.camera_s + delay.host_s.value_or(0.0) + *delay.link_s + delay.robot_s.value_or(0.0);
  return delay;
}

/// A lag at the end of the search is where the search ended, not where the fit is best.
bool IsBelowMost(const Lag& lag) { return lag.lag_s < kMostLag_s - 0.5 * kLagStep_s; }

std::vector<Angle> From(const std::vector<Angle>& angles, double t_s) {
  std::vector<Angle> later;
  std::copy_if(angles.begin(), angles.end(), std::back_inserter(later),
               [t_s](const Angle& angle) { return angle.t_s >= t_s; });
  return later;
}

constexpr double kMostNoise = 0.25;  // of a fit, as a share of the turn

constexpr const char* kTooBusy =
    "this machine is too busy for pictures and encoders to come evenly, or it is another robot's "
    "tag; end what else it does and start again (hardware.turn.enabled=false leaves this check "
    "out)";

/// Steering to the left must turn wheels and picture to the left. Pulses to and fro look alike half
/// a period later to the other side, but for where they begin and end: of pictures that came
/// unevenly the other side may fit a little better, so it is named only where it fits better by
/// far.
void RequireSides(std::span<const Angle> seen, std::span<const Angle> wheels,
                  std::span<const Angle> commanded) {
  constexpr double kByFar = 0.5;
  const auto fit = [&](std::span<const Angle> angles) {
    const std::optional<Lag> lag = EstimateLag(angles, commanded, 0.0, kMostLag_s);
    const bool is_clear = lag && lag->residual_rad < kMostNoise * Range(angles);
    return is_clear ? *lag : Lag{};
  };
  const Lag other = fit(seen);
  if (!(other.scale < 0.0)) return;
  const std::optional<Lag> same = BestLag(seen, commanded, 0.0, kMostLag_s, Side::kSame);
  if (same && other.residual_rad > kByFar * same->residual_rad) {
    throw std::runtime_error(
        fmt::format("the picture shows a turn of {:.1f} deg, and not clearly to which side: {}",
                    geometry::DegFromRad(Range(seen)), kTooBusy));
  }
  if (fit(wheels).scale > 0.0) {
    throw std::runtime_error(
        "steered to the left, the wheels turned the robot to the left by their encoders and the "
        "picture shows it turning to the right: the picture is mirrored, or left and right are "
        "swapped at both the motors and the encoders");
  }
  throw std::runtime_error(
      "steered to the left, the robot turned to the right: swap {left} and {right} in "
      "hardware.plain.format, or the plugs of its motors (motors that both run backwards and a "
      "mirrored picture show the same)");
}

/// The picture's turn over the wheels'.
bool IsAsFar(double seen_rad, double turned_rad) {
  constexpr double kLeastScale = 0.4, kMostScale = 2.5;
  return seen_rad > kLeastScale * turned_rad && seen_rad < kMostScale * turned_rad;
}

void RequireSeen(bool is_seen, double turned_rad, double seen_rad) {
  if (is_seen) return;
  throw std::runtime_error(
      fmt::format("the wheels turned the robot by {:.1f} deg and the picture shows {:.1f} deg "
                  "within {:g} s: do "
                  "the wheels touch the floor, is it this robot's tag, and are the pictures of now "
                  "(hardware.turn.enabled=false leaves this check out)",
                  geometry::DegFromRad(turned_rad), geometry::DegFromRad(seen_rad), kMostLag_s));
}

/// The lag of the picture behind the wheels; no picture shows a turn before the wheels made it.
Lag RequireBehindWheels(const std::optional<Lag>& lag, const std::vector<Angle>& wheels,
                        double seen_rad) {
  constexpr double kLeast_s = 0.02;
  const double turned_rad = Range(wheels);
  RequireSeen(lag && IsAsFar(seen_rad, turned_rad), turned_rad, seen_rad);
  const bool is_clear = IsBelowMost(*lag) && lag->residual_rad <= kMostNoise * seen_rad;
  if (!IsAsFar(lag->scale, 1.0) || !is_clear) {
    throw std::runtime_error(fmt::format(
        "the picture shows a turn of {:.1f} deg as the wheels made one of {:.1f} deg, but not when "
        "they did: {}",
        geometry::DegFromRad(seen_rad), geometry::DegFromRad(turned_rad), kTooBusy));
  }
  const double spacing_s = WidestSpacing_s(wheels);
  if (lag->lag_s >= -std::max(kLeast_s, spacing_s)) return *lag;
  throw std::runtime_error(fmt::format(
      "the picture shows the turn {:.0f} ms before the encoders do, which cannot be (nine in ten "
      "are read within {:.0f} ms): the stamps of pictures and encoders are not of one clock, or "
      "the encoders "
      "answer late",
      -1e3 * lag->lag_s, 1e3 * spacing_s));
}

/// Without timed encoders: the lag of the picture behind the commands. Of the last pair of pulses
/// alone, which began at `pair_s` and was strong enough: weaker ones before it may have moved
/// nothing, and no line through them fits both.
Lag RequireBehindCommands(const Turn& turn, const std::vector<Angle>& wheels, double pair_s,
                          double first_power) {
  const std::vector<Angle> seen = From(turn.Seen(), pair_s);
  const std::optional<Lag> lag = EstimateLag(seen, turn.Commanded(), 0.0, kMostLag_s);
  const double turned_rad = Range(wheels), seen_rad = Range(turn.Seen());
  const bool is_as_far = wheels.empty() || IsAsFar(seen_rad, turned_rad);
  RequireSeen(lag && is_as_far, turned_rad, seen_rad);
  const bool is_inside = lag->lag_s > 0.5 * kLagStep_s && IsBelowMost(*lag);
  if (lag->scale > 0.0 && is_inside && lag->residual_rad <= kMostNoise * Range(seen)) return *lag;
  throw std::runtime_error(fmt::format(
      "the picture shows a turn of {:.1f} deg, and not how long after the commands within {:g} s "
      "(the best fit is {:.3f} s late and {:.1f} deg off): start again, with a stronger turn "
      "(hardware.turn.power is {:g}), more light, or less else to do for this machine "
      "(hardware.turn.enabled=false leaves this check out)",
      geometry::DegFromRad(Range(seen)), kMostLag_s, lag->lag_s,
      geometry::DegFromRad(lag->residual_rad), first_power));
}

/// What stopped the turn by itself, such as a picture that does not follow the wheels, may be a
/// turn to the other side.
void RequireNoOtherSide(RealRobot& robot, const Turn& turn) {
  const std::optional<DriveStop> stop = robot.Record().stop;
  const bool is_asked =
      stop && (stop->reason == StopReason::kOperator || stop->reason == StopReason::kSignal);
  if (!is_asked) RequireSides(turn.Seen(), turn.Wheels(), turn.Commanded());
}

}  // namespace

std::optional<LatencyResult> MeasureLatency(RealRobot& robot,
                                            const odometry::OdometryOptions& odometry,
                                            const TurnOptions& options, double one_way_s) {
  Turn turn(robot, odometry);
  if (!turn.Run({}, kTurn_s)) return std::nullopt;
  const double enough_rad = geometry::RadFromDeg(options.enough_deg);
  double power = options.power;
  std::vector<Angle> wheels;
  std::vector<double> pulses_s;
  for (int pulse = 0; pulse < kMostPulses; ++pulse) {
    const double side = pulse % 2 == 0 ? power : -power;
    const double rest_s = kRest_s + kMoreRest_s[static_cast<size_t>(pulse) % kMoreRest_s.size()];
    const bool has_pulsed = turn.Run({-side, side}, options.pulse_s);
    pulses_s.push_back(turn.Began_s());
    if (!has_pulsed || !turn.Run({}, rest_s)) {
      RequireNoOtherSide(robot, turn);
      return std::nullopt;
    }
    if (pulse % 2 == 0) continue;  // it must stand as it stood
    wheels = turn.Wheels();
    const double moved_rad = wheels.empty() ? Range(turn.Seen()) : Range(wheels);
    if (moved_rad >= enough_rad) break;
    power = std::min(options.most_power, power * kHarder);
  }
  if (!turn.Run({}, kMostLag_s - kRest_s)) {  // for the latest of pictures
    RequireNoOtherSide(robot, turn);
    return std::nullopt;
  }
  wheels = turn.Wheels();
  RequireSides(turn.Seen(), wheels, turn.Commanded());
  const double seen_rad = Range(turn.Seen());
  LatencyResult result{.turned_deg = geometry::DegFromRad(Range(wheels)),
                       .seen_deg = geometry::DegFromRad(seen_rad)};
  // Without timed encoders the commands lead, and only the sum of all parts is seen.
  if (!AreTimed(wheels)) {
    const double pair_s = pulses_s[pulses_s.size() - 2];
    result.delay.total_s = RequireBehindCommands(turn, wheels, pair_s, options.power).lag_s;
    return result;
  }
  const Lag lag = RequireBehindWheels(EstimateLag(turn.Seen(), wheels, kLeastLag_s, kMostLag_s),
                                      wheels, seen_rad);
  result.delay = DelayOf(wheels, pulses_s, options.pulse_s, lag, one_way_s, robot.Record().poses);
  return result;
}

}  // namespace rift::hardware
