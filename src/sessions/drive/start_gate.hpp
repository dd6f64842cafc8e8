#pragma once

#include <functional>
#include <optional>
#include <string>

#include "rift/geometry/pose2.hpp"
#include "rift/hardware/options.hpp"

namespace rift::sessions {

/// How far a robot is from where it has to start.
struct Placement {
  double off_m = 0.0;
  double off_deg = 0.0;  ///< without sign
};
Placement PlacementOf(const geometry::Pose2& world_from_robot, const geometry::Pose2& start);

/// "3.1 cm, 2 deg off"
std::string PlacementText(const Placement& placement);

/// Between a person's Enter and the first power: waits for a robot that is not seen, refuses one
/// that stands too far off its start, and counts down. Knows no clock and no terminal.
class StartGate {
 public:
  struct Person {
    /// Asked again and again: may the robot start?
    std::function<bool()> has_agreed;
    /// Takes the agreement back, until the person gives it again; empty where nobody can be asked.
    std::function<void()> ask_again;
    std::function<void(const std::string&)> say;
    /// A line in place of the one shown before; may be empty.
    std::function<void(const std::string&)> show;
  };

  /// `any_place`: a robot that is far off is warned of and not refused.
  StartGate(const hardware::StartOptions& options, const geometry::Pose2& start, bool any_place,
            Person person)
      : options_(options), start_(start), any_place_(any_place), person_(std::move(person)) {}

  /// To be called many times a second until it is true; `seen`: where the robot stands now, none
  /// while it is not seen. Throws std::runtime_error, with the distance and what to do, when the
  /// robot is too far off, or was not seen for 10 s, and nobody can be asked.
  bool MayStart(double now_s, const std::optional<geometry::Pose2>& seen);

 private:
  std::optional<std::string> WhyNot(const geometry::Pose2& seen) const;
  bool IsSeen(double now_s, const std::optional<geometry::Pose2>& seen);
  bool MayGoOn(const geometry::Pose2& seen);
  void Refuse(const std::string& why);
  void ShowPlacement(double now_s, const std::optional<geometry::Pose2>& seen);
  void CountDown(double now_s);

  hardware::StartOptions options_;
  geometry::Pose2 start_;
  bool any_place_;
  Person person_;
  bool is_warned_ = false;
  double shown_s_ = -1e9;
  std::optional<double> agreed_s_;
  std::optional<double> unseen_since_s_;
  int seconds_shown_ = 0;
};

}  // namespace rift::sessions
