#include "start_gate.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace rift::sessions {
namespace {

constexpr double kShowPeriod_s = 0.1;
constexpr double kUnseen_s = 10.0;  // as hardware::Drive waits for the first pose

}  // namespace

Placement PlacementOf(const geometry::Pose2& world_from_robot, const geometry::Pose2& start) {
  const double turn_rad = geometry::WrapToPi(world_from_robot.yaw_rad - start.yaw_rad);
  return {(world_from_robot.Position() - start.Position()).norm(),
          geometry::DegFromRad(std::abs(turn_rad))};
}

std::string PlacementText(const Placement& placement) {
  return fmt::format("{:.1f} cm, {:.0f} deg off", 100.0 * placement.off_m, placement.off_deg);
}

std::optional<std::string> StartGate::WhyNot(const geometry::Pose2& seen) const {
  const Placement placement = PlacementOf(seen, start_);
  if (placement.off_m <= options_.within_m && placement.off_deg <= options_.within_deg) {
    return std::nullopt;
  }
  return fmt::format(
      "the robot stands {:.3f} m and {:.1f} deg off its start, and {:g} m and {:g} deg are allowed "
      "(hardware.start): put it on x {:.3f} m, y {:.3f} m, heading {:.0f} deg, or give --any-start",
      placement.off_m, placement.off_deg, options_.within_m, options_.within_deg, start_.x_m,
      start_.y_m, geometry::DegFromRad(start_.yaw_rad));
}

bool StartGate::MayStart(double now_s, const std::optional<geometry::Pose2>& seen) {
  if (!person_.has_agreed()) {
    ShowPlacement(now_s, seen);
    return false;
  }
  if (!IsSeen(now_s, seen) || !MayGoOn(*seen)) {
    agreed_s_.reset();
    return false;
  }
  if (!agreed_s_) {
    agreed_s_ = now_s;
    seconds_shown_ = 0;
    if (options_.countdown_s > 0.0) {
      person_.say(fmt::format("starts in {:g} s; any key or Ctrl-C cancels", options_.countdown_s));
    }
  }
  if (now_s - *agreed_s_ >= options_.countdown_s) {
    if (person_.show) person_.show("the robot drives: any key or Ctrl-C stops it");
    return true;
  }
  CountDown(now_s);
  return false;
}

bool StartGate::IsSeen(double now_s, const std::optional<geometry::Pose2>& seen) {
  if (seen) {
    unseen_since_s_.reset();
    return true;
  }
  ShowPlacement(now_s, seen);
  if (!unseen_since_s_) unseen_since_s_ = now_s;
  if (now_s - *unseen_since_s_ > kUnseen_s) {
    unseen_since_s_.reset();
    Refuse(
        fmt::format("the robot has not been seen for {:g} s: see to it that its tag is in the "
                    "picture, flat and well lit",
                    kUnseen_s));
  }
  return false;
}

bool StartGate::MayGoOn(const geometry::Pose2& seen) {
  const std::optional<std::string> why_not = WhyNot(seen);
  if (!why_not) return true;
  if (any_place_) {
    if (!is_warned_) person_.say("warning: " + *why_not);
    is_warned_ = true;
    return true;
  }
  Refuse(*why_not);
  return false;
}

void StartGate::Refuse(const std::string& why) {
  if (!person_.ask_again) throw std::runtime_error("not started: " + why);
  person_.say("not started: " + why + "; then Enter");
  person_.ask_again();
}

void StartGate::ShowPlacement(double now_s, const std::optional<geometry::Pose2>& seen) {
  if (!person_.show || now_s - shown_s_ < kShowPeriod_s) return;
  shown_s_ = now_s;
  person_.show(seen ? fmt::format("put the robot at the start: {}; Enter",
                                  PlacementText(PlacementOf(*seen, start_)))
                    : "put the robot at the start: it is not seen");
}

void StartGate::CountDown(double now_s) {
  const int left_s = static_cast<int>(std::ceil(options_.countdown_s - (now_s - *agreed_s_)));
  if (!person_.show || left_s == seconds_shown_) return;
  seconds_shown_ = left_s;
  person_.show(fmt::format("{} ...", left_s));
}

}  // namespace rift::sessions
