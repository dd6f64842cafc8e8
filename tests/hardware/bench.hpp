#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <memory>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "rift/control/diff_drive.hpp"
#include "rift/hardware/listener.hpp"
#include "rift/hardware/real_robot.hpp"

namespace rift::hardware {

/// A world of one robot on a fake clock: the host's RealRobot, a line of bytes that can be spoiled,
/// the listener's model, wheels that follow with a lag, and a camera at 30 fps.
class Bench : public ByteLine, public Clock, public PoseSource {
 public:
  // The radio.
  double line_delay_s = 0.02;
  bool line_is_gone = false;
  bool line_is_blocked = false;
  bool to_robot_is_cut = false;
  bool from_robot_is_cut = false;
  std::function<std::vector<std::uint8_t>(std::uint8_t)> spoil = [](std::uint8_t byte) {
    return std::vector<std::uint8_t>{byte};
  };
  std::function<bool()> lose_command = [] { return false; };
  std::function<double()> extra_delay_s = [] { return 0.0; };
  // The camera.
  bool camera_is_frozen = false;
  bool tag_is_hidden = false;
  std::optional<std::string> camera_fault;
  double camera_late_s = 0.0;  ///< older than its pictures' stamps say
  /// It shows the same picture again and again, with stamps that are fresh, since then.
  std::optional<double> repeats_since_s;
  std::function<void(trial::PoseMeasurement&)> bend = [](trial::PoseMeasurement&) {};
  // The robot.
  double slip_left = 1.0, slip_right = 1.0;  ///< what a wheel turns over what it moves the robot
  bool counts_are_stuck = false;             ///< at zero
  std::uint16_t battery_mv = 5000;
  bool robot_is_on = true;
  bool motors_are_stuck = false;  ///< at what they last were
  std::unique_ptr<Listener> listener = std::make_unique<Listener>();
  std::set<std::pair<int, int>> obeyed;
  size_t zeros_heard = 0;
  std::set<std::pair<int, int>> written;  // powers, as the host meant them

  double Now_s() override { return now_s_; }
  void Wait(double dt_s) override {
    const double end_s = now_s_ + dt_s;
    while (now_s_ < end_s - 1e-9) Step(std::min(1e-3, end_s - now_s_));
  }

  bool Write(Bytes bytes) override {
    RequireLine();
    if (const auto frame = DecodeCommand(bytes))
      written.insert({frame->power.left, frame->power.right});
    if (to_robot_is_cut || lose_command()) return true;
    Carry(bytes, to_robot_, to_robot_free_s_);
    return true;
  }
  std::vector<std::uint8_t> Read() override {
    RequireLine();
    return Arrived(to_host_);
  }
  size_t Unsent() override { return line_is_blocked ? 1 : 0; }

  PoseNews Newest() override {
    news_.fault = camera_fault;
    news_.repeats_since_s = repeats_since_s;
    return news_;
  }

  const geometry::Pose2& Pose() const { return pose_; }
  /// Where a robot that stood there would be a little later, as the wheels turn now.
  geometry::Pose2 PoseAfter(const geometry::Pose2& pose, double dt_s) const {
    return dt_s < 0.0 ? drive_.Drive(pose, {-left_, -right_}, -dt_s)
                      : drive_.Drive(pose, {left_, right_}, dt_s);
  }
  double SpeedOfWheels() const { return std::abs(left_) + std::abs(right_); }
  double LastMoving_s() const { return moving_s_; }
  double Travelled_m() const { return travelled_m_; }
  /// As a robot that was switched off and on does.
  void BeginCountsAnew() { rolled_left_m_ = rolled_right_m_ = 0.0; }
  /// Both at once, by a hand, where the camera sees no motion of the robot.
  void PushWheels(double rolled_m) {
    rolled_left_m_ += rolled_m;
    rolled_right_m_ += rolled_m;
  }
  void Chatter(const std::string& text) {
    for (const char c : text) to_robot_.push_back({now_s_, static_cast<std::uint8_t>(c)});
  }

 private:
  struct Byte {
    double at_s;
    std::uint8_t value;
  };

  void RequireLine() const {
    if (line_is_gone) throw LineGone("the serial port went away: the test pulled it");
  }

  void Carry(Bytes bytes, std::deque<Byte>& queue, double& free_s) {
    free_s = std::max(free_s, now_s_ + line_delay_s + extra_delay_s());
    for (const std::uint8_t byte : bytes) {
      free_s += 10.0 / 9600.0;
      for (const std::uint8_t value : spoil(byte)) queue.push_back({free_s, value});
    }
  }

  std::vector<std::uint8_t> Arrived(std::deque<Byte>& queue) const {
    std::vector<std::uint8_t> bytes;
    while (!queue.empty() && queue.front().at_s <= now_s_) {
      bytes.push_back(queue.front().value);
      queue.pop_front();
    }
    return bytes;
  }

  void Step(double dt_s) {
    constexpr double kMotorLag_s = 0.05;
    now_s_ += dt_s;
    const std::vector<std::uint8_t> received = Arrived(to_robot_);
    if (robot_is_on) PollListener(received);
    if (!motors_are_stuck) motors_ = robot_is_on ? listener->Motors() : MilliPower{};
    if (!motors_.IsZero()) moving_s_ = now_s_;
    left_ += (motors_.left / 1000.0 - left_) * dt_s / kMotorLag_s;
    right_ += (motors_.right / 1000.0 - right_) * dt_s / kMotorLag_s;
    pose_ = drive_.Drive(pose_, {left_, right_}, dt_s);
    travelled_m_ += 1.206 * 0.5 * std::abs(left_ + right_) * dt_s;
    rolled_left_m_ += 1.206 * slip_left * left_ * dt_s;
    rolled_right_m_ += 1.206 * slip_right * right_ * dt_s;
    TakePictures();
  }

  void PollListener(const std::vector<std::uint8_t>& received) {
    constexpr double kCountsPerMetre = 358.3 / (2.0 * std::numbers::pi * 0.016);
    const auto counts = [this](double rolled_m) {
      return counts_are_stuck ? 0
                              : static_cast<std::int32_t>(std::floor(rolled_m * kCountsPerMetre));
    };
    const Listener::Senses senses{counts(rolled_left_m_), counts(rolled_right_m_), battery_mv};
    const auto said = listener->Poll(static_cast<std::uint32_t>(now_s_ * 1000.0), received, senses);
    obeyed.insert({listener->Motors().left, listener->Motors().right});
    zeros_heard += !said.empty() && listener->Motors().IsZero();
    if (!from_robot_is_cut) Carry(said, to_host_, to_host_free_s_);
  }

  void TakePictures() {
    constexpr double kFrame_s = 1.0 / 30.0, kSight_s = 0.012;
    if (now_s_ >= next_frame_s_) {
      next_frame_s_ += kFrame_s;
      trial::PoseMeasurement seen{now_s_, pose_, 0.0, 0.0, 0.0};
      if (!camera_is_frozen) pictures_.push_back({seen, tag_is_hidden});
    }
    while (!pictures_.empty() &&
           pictures_.front().pose.captured_s + kSight_s + camera_late_s <= now_s_) {
      Picture picture = pictures_.front();
      pictures_.pop_front();
      picture.pose.captured_s += camera_late_s;
      news_.looked_s = picture.pose.captured_s;
      if (picture.is_empty) continue;
      bend(picture.pose);
      if (repeats_since_s) picture.pose.world_from_robot = news_.newest->measured.world_from_robot;
      news_.newest = PoseSample{picture.pose, picture.pose.captured_s + 0.01, now_s_};
    }
  }

  struct Picture {
    trial::PoseMeasurement pose;
    bool is_empty;
  };

  double now_s_ = 100.0;
  std::deque<Byte> to_robot_, to_host_;
  double to_robot_free_s_ = 0.0, to_host_free_s_ = 0.0;
  control::DiffDrive drive_;
  geometry::Pose2 pose_{-0.2822, -0.0655, 0.0};
  double left_ = 0.0, right_ = 0.0, travelled_m_ = 0.0;
  double rolled_left_m_ = 0.0, rolled_right_m_ = 0.0;
  double moving_s_ = 0.0;
  MilliPower motors_;
  double next_frame_s_ = 100.0;
  std::deque<Picture> pictures_;
  PoseNews news_;
};

/// Lets the bench run while nothing of the host does.
inline void RunAlone(Bench& bench, double dt_s) { bench.Wait(dt_s); }

}  // namespace rift::hardware
