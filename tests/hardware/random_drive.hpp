#pragma once

#include <cmath>
#include <deque>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "bench.hpp"
#include "rift/hardware/real_robot.hpp"

namespace rift::hardware {

/// A bench whose camera, wheels and radio are as noisy as those of the authors' trials: a standing
/// tag jitters by 0.1 to 0.6 mm and up to 0.3 deg, a driving one by 3 mm along its path (second
/// differences of 59 logs), as stamps that are 8 ms off give; a command in 1700 is lost, here one
/// in 1000; each wheel slips by some per cent.
struct NoisyDrive {
  explicit NoisyDrive(std::uint64_t seed, const HardwareOptions& hardware = {})
      : random(seed), robot(bench, bench, bench, {hardware, Protocol::kFramed, false}) {
    bench.bend = [this](trial::PoseMeasurement& pose) {
      pose.world_from_robot = bench.PoseAfter(pose.world_from_robot, 0.008 * normal(random));
      pose.world_from_robot.x_m += 0.0006 * normal(random);
      pose.world_from_robot.y_m += 0.0006 * normal(random);
      pose.world_from_robot.yaw_rad += 0.005 * normal(random);
      fault(pose);
    };
    bench.lose_command = [this] { return uniform(random) < 0.001; };
    bench.extra_delay_s = [this] { return 0.01 * uniform(random); };
    bench.slip_left = 1.0 + 0.04 * normal(random);
    bench.slip_right = 1.0 + 0.04 * normal(random);
  }

  /// As arming does, zeros first: the robot's listener takes no power before it has heard one.
  void Begin() {
    Drive({}, 0.6);
    robot.Arm();
    robot.SetCameraLatency(0.0);
  }

  /// A control loop that wants `power` for that long.
  void Drive(const control::WheelPower& power, double duration_s) {
    for (const double end_s = bench.Now_s() + duration_s; bench.Now_s() < end_s - 1e-6;) {
      robot.Sense();
      robot.Command(power);
      robot.Advance(0.02);
    }
  }

  double Uniform(double low, double high) { return low + (high - low) * uniform(random); }

  std::mt19937_64 random;
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform{0.0, 1.0};
  std::function<void(trial::PoseMeasurement&)> fault = [](trial::PoseMeasurement&) {};
  Bench bench;
  RealRobot robot;
};

/// What can happen to a drive; each strikes at once and stays.
inline const std::vector<std::pair<std::string, std::function<void(NoisyDrive&)>>>& RandomFaults() {
  static const std::vector<std::pair<std::string, std::function<void(NoisyDrive&)>>> kFaults{
      {"no picture", [](NoisyDrive& d) { d.bench.camera_is_frozen = true; }},
      {"no tag", [](NoisyDrive& d) { d.bench.tag_is_hidden = true; }},
      {"repeats with noise",
       [](NoisyDrive& d) {
         d.fault = [&d, held = std::optional<geometry::Pose2>()](auto& pose) mutable {
           if (!held) held = pose.world_from_robot;
           pose.world_from_robot = *held;
           pose.world_from_robot.x_m += 0.0003 * d.normal(d.random);
           pose.world_from_robot.yaw_rad += 0.002 * d.normal(d.random);
         };
       }},
      {"slow repeats",
       [](NoisyDrive& d) {
         const double period_s = d.Uniform(0.4, 1.5);
         d.fault = [period_s, since_s = -1e9, held = geometry::Pose2()](auto& pose) mutable {
           if (pose.captured_s - since_s > period_s) {
             since_s = pose.captured_s;
             held = pose.world_from_robot;
           }
           pose.world_from_robot = held;
         };
       }},
      {"late", [](NoisyDrive& d) { d.bench.camera_late_s = d.Uniform(0.3, 1.2); }},
      {"out of order",
       [](NoisyDrive& d) {
         const size_t window = 3 + d.random() % 6;
         d.fault = [&d, window, held = std::deque<geometry::Pose2>()](auto& pose) mutable {
           held.push_back(pose.world_from_robot);
           if (held.size() < window) {
             pose.world_from_robot = held.front();
             return;
           }
           const size_t which = d.random() % held.size();
           pose.world_from_robot = held[which];
           held.erase(held.begin() + static_cast<long>(which));
         };
       }},
      {"another tag that lies still",
       [](NoisyDrive& d) {
         const double off_m = d.Uniform(0.0, 0.4), way_rad = d.Uniform(-3.14, 3.14);
         d.fault = [off_m, way_rad, other = std::optional<geometry::Pose2>()](auto& pose) mutable {
           if (!other) {
             other = pose.world_from_robot;
             other->x_m += off_m * std::cos(way_rad);
             other->y_m += off_m * std::sin(way_rad);
           }
           pose.world_from_robot = *other;
         };
       }},
      {"clock jumps forward",
       [](NoisyDrive& d) {
         const double by_s = d.Uniform(0.2, 5.0);
         d.fault = [by_s](auto& pose) { pose.captured_s += by_s; };
       }},
      {"clock jumps back",
       [](NoisyDrive& d) {
         const double by_s = d.Uniform(0.2, 5.0);
         d.fault = [by_s](auto& pose) { pose.captured_s -= by_s; };
       }},
      {"byte noise",
       [](NoisyDrive& d) {
         d.bench.spoil = [&d](std::uint8_t byte) {
           if (d.uniform(d.random) < 0.3) return std::vector<std::uint8_t>{};
           if (d.uniform(d.random) < 0.3) byte = static_cast<std::uint8_t>(d.random());
           return std::vector<std::uint8_t>{byte};
         };
       }},
      {"answers dead", [](NoisyDrive& d) { d.bench.from_robot_is_cut = true; }},
      {"commands dead", [](NoisyDrive& d) { d.bench.to_robot_is_cut = true; }},
  };
  return kFaults;
}

/// How far a robot went after one or two faults struck, and how far it may.
struct Struck {
  std::string faults;
  double speed_mps = 0.0;
  double travelled_m = 0.0;
  double allowed_m = 0.0;
  std::string reason;
};

inline Struck StrikeAtRandom(std::uint64_t seed) {
  NoisyDrive drive(seed);
  drive.Begin();
  const double forward = drive.Uniform(0.05, 0.4), turn = drive.Uniform(-0.3, 0.3) * forward;
  const control::WheelPower power{forward - turn, forward + turn};
  drive.Drive(power, drive.Uniform(0.4, 1.2));
  Struck struck{.speed_mps = 1.206 * forward};
  if (drive.robot.state() == DriveState::kStopped) {  // a false alarm, counted elsewhere
    struck.faults = "none";
    struck.reason = drive.robot.Record().stop->text;
    struck.allowed_m = 1e9;
    return struck;
  }
  const auto& faults = RandomFaults();
  const int how_many = 1 + static_cast<int>(drive.random() % 2);
  const double before_m = drive.bench.Travelled_m();
  for (int i = 0; i < how_many; ++i) {
    const auto& [name, strike] = faults[drive.random() % faults.size()];
    struck.faults += (i > 0 ? " and " : "") + name;
    strike(drive);
  }
  drive.Drive(power, 3.0);
  constexpr double kWatchdog_s = 0.3, kReaction_s = 0.4, kMotorLag_s = 0.05;
  const double link_s = drive.bench.line_delay_s + 0.01 + 0.034;
  struck.travelled_m = drive.bench.Travelled_m() - before_m;
  struck.allowed_m = struck.speed_mps * (kReaction_s + kWatchdog_s + link_s + kMotorLag_s);
  if (drive.robot.Record().stop) struck.reason = drive.robot.Record().stop->text;
  return struck;
}

/// Hours of healthy driving at random powers, and what stopped it.
struct HealthyHours {
  double hours = 0.0;
  std::vector<std::string> stops;
};

inline HealthyHours DriveHealthily(double hours, std::uint64_t seed) {
  HealthyHours result;
  for (; result.hours < hours; ++seed) {
    NoisyDrive drive(seed);
    drive.Begin();
    const double begun_s = drive.bench.Now_s();
    for (int leg = 0; leg < 60 && drive.robot.state() != DriveState::kStopped; ++leg) {
      const double forward = drive.Uniform(0.0, 1.0) < 0.2 ? 0.0 : drive.Uniform(0.05, 0.45);
      const double turn = drive.Uniform(-0.12, 0.12);
      drive.Drive({forward - turn, forward + turn}, drive.Uniform(0.2, 2.0));
      if (drive.Uniform(0.0, 1.0) < 0.3) drive.Drive({}, drive.Uniform(0.0, 1.0));
    }
    if (drive.robot.state() == DriveState::kStopped) {
      result.stops.push_back(drive.robot.Record().stop->text);
    }
    result.hours += (drive.bench.Now_s() - begun_s) / 3600.0;
  }
  return result;
}

}  // namespace rift::hardware
