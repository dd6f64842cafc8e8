#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <vector>

#include "rift/control/diff_drive.hpp"
#include "rift/trial/robot.hpp"

namespace rift::test {

struct FakeRobotOptions {
  geometry::Pose2 world_from_start;
  control::DiffDriveOptions drive;
  double command_delay_s = 0.0;
  double sensing_delay_s = 0.0;
  double frame_period_s = 0.02;
};

/// A robot whose motion is known in closed form: no slip, no inertia, fixed delays. Every reading
/// may be spoiled by `spoil` before the trial sees it.
class FakeRobot : public trial::Robot {
 public:
  explicit FakeRobot(const FakeRobotOptions& options)
      : options_(options), drive_(options.drive), pose_(options.world_from_start) {
    TakePicture();
  }

  std::function<void(trial::Sensed&)> spoil = [](trial::Sensed&) {};
  std::vector<control::WheelPower> commands;
  int stops = 0;

  trial::Sensed Sense() override {
    trial::Sensed sensed;
    sensed.now_s = now_s_;
    while (pictures_.size() > 1 &&
           pictures_[1].captured_s + options_.sensing_delay_s <= now_s_ + kTick_s) {
      pictures_.pop_front();
    }
    if (pictures_[0].captured_s + options_.sensing_delay_s <= now_s_ + kTick_s) {
      sensed.pose = pictures_[0];
    }
    spoil(sensed);
    return sensed;
  }

  void Command(const control::WheelPower& power) override {
    commands.push_back(power);
    queue_.push_back({now_s_ + options_.command_delay_s, power});
  }

  void Advance(double dt_s) override {
    const double end_s = now_s_ + dt_s;
    while (now_s_ < end_s - kTick_s) {
      while (!queue_.empty() && queue_.front().acts_s <= now_s_ + kTick_s) {
        power_ = queue_.front().power;
        queue_.pop_front();
      }
      double next_s = std::min(end_s, next_picture_s_);
      if (!queue_.empty()) next_s = std::min(next_s, queue_.front().acts_s);
      pose_ = drive_.Drive(pose_, power_, next_s - now_s_);
      now_s_ = next_s;
      if (now_s_ >= next_picture_s_ - kTick_s) TakePicture();
    }
    now_s_ = end_s;
  }

  void Stop() noexcept override {
    ++stops;
    power_ = {};
    queue_.clear();
  }

  const geometry::Pose2& world_from_robot() const { return pose_; }
  const control::WheelPower& power() const { return power_; }

 private:
  static constexpr double kTick_s = 1e-9;
  struct Queued {
    double acts_s;
    control::WheelPower power;
  };

  void TakePicture() {
    pictures_.push_back({now_s_, pose_, 0.0, 0.0, 0.0});
    next_picture_s_ = now_s_ + options_.frame_period_s;
  }

  FakeRobotOptions options_;
  control::DiffDrive drive_;
  geometry::Pose2 pose_;
  control::WheelPower power_;
  double now_s_ = 0.0;
  double next_picture_s_ = 0.0;
  std::deque<Queued> queue_;
  std::deque<trial::PoseMeasurement> pictures_;
};

}  // namespace rift::test
