#include "rift/control/program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace rift::control {
namespace {

std::string NameOf(const Segment& segment) {
  if (segment.straight_m) return fmt::format("straight {:g} m", *segment.straight_m);
  if (segment.hold_s) return fmt::format("hold {:g} s", *segment.hold_s);
  if (segment.radius_m) {
    return fmt::format("arc {:g} deg, {:g} m", *segment.turn_deg, *segment.radius_m);
  }
  return fmt::format("turn {:g} deg", *segment.turn_deg);
}

}  // namespace

void Segment::Check() const {
  const int kinds = straight_m.has_value() + turn_deg.has_value() + hold_s.has_value();
  if (kinds != 1) {
    throw std::invalid_argument(fmt::format(
        "a segment is one of straight_m, turn_deg and hold_s, and {} of them are set", kinds));
  }
  if (radius_m && !turn_deg) {
    throw std::invalid_argument(
        fmt::format("radius_m is {:g} without turn_deg: an arc needs both", *radius_m));
  }
  if (power && hold_s) {
    throw std::invalid_argument(
        fmt::format("power is {:g} beside hold_s: a robot that holds has none", *power));
  }
}

Program::Program(const ProgramOptions& options, const DiffDriveOptions& drive,
                 const geometry::Pose2& world_from_start)
    : rest_s_(options.rest_s) {
  if (options.segments.empty()) {
    throw std::invalid_argument("program.segments is empty: name segments such as {straight_m: 1}");
  }
  const double full_speed_mps =
      DiffDrive(drive).options().full_power_speed_rad_s * drive.wheel_radius_m;
  waypoints_.push_back({.name = "start",
                        .x_m = world_from_start.x_m,
                        .y_m = world_from_start.y_m,
                        .heading_deg = geometry::DegFromRad(world_from_start.yaw_rad)});
  pieces_.push_back({.world_from_start = world_from_start});  // of no length, taken away below
  for (int lap = 0; lap < options.laps; ++lap) {
    for (const Segment& segment : options.segments) {
      Add(segment, full_speed_mps, options, drive.track_m);
    }
  }
  pieces_.erase(pieces_.begin());
  const auto moves = [](const Piece& piece) {
    return piece.length_m != 0.0 || piece.turn_rad != 0.0;
  };
  if (std::none_of(pieces_.begin(), pieces_.end(), moves)) {
    throw std::invalid_argument("program.segments: none of them moves the robot");
  }
}

void Program::Add(const Segment& segment, double full_speed_mps, const ProgramOptions& options,
                  double track_m) {
  segment.Check();
  double power = segment.power.value_or(options.power);
  if (!segment.power && options.speed_mps) power = *options.speed_mps / full_speed_mps;
  if (power > 1.0) {
    throw std::invalid_argument(
        fmt::format("program.speed_mps is {:g}, and the robot's wheels make {:.3f} m/s at full "
                    "power (hardware.odometry.drive)",
                    *options.speed_mps, full_speed_mps));
  }
  const Piece& before = pieces_.back();
  Piece piece{.start_s = before.end_s, .world_from_start = PoseAt(before.end_s)};
  double outer_m = 0.0;  // what the faster wheel rolls
  if (segment.straight_m) {
    piece.length_m = *segment.straight_m;
    outer_m = std::abs(piece.length_m);
    piece.power = {std::copysign(power, piece.length_m), std::copysign(power, piece.length_m)};
  } else if (segment.turn_deg) {
    piece.turn_rad = geometry::RadFromDeg(*segment.turn_deg);
    const double radius_m = segment.radius_m.value_or(0.0);
    piece.length_m = std::abs(piece.turn_rad) * radius_m;
    outer_m = std::abs(piece.turn_rad) * (radius_m + 0.5 * track_m);
    const double inner = power * (radius_m - 0.5 * track_m) / (radius_m + 0.5 * track_m);
    piece.power = piece.turn_rad >= 0.0 ? WheelPower{inner, power} : WheelPower{power, inner};
  }
  piece.end_s = piece.start_s + segment.hold_s.value_or(outer_m / (power * full_speed_mps));
  length_m_ += std::abs(piece.length_m);
  pieces_.push_back(piece);
  const geometry::Pose2 end = PoseAt(piece.end_s);
  waypoints_.push_back({.name = NameOf(segment), .x_m = end.x_m, .y_m = end.y_m});
}

size_t Program::PieceAt(double t_s) const {
  const auto after = std::upper_bound(pieces_.begin(), pieces_.end(), t_s,
                                      [](double t, const Piece& piece) { return t < piece.end_s; });
  const size_t index = static_cast<size_t>(after - pieces_.begin());
  return std::min(index, pieces_.size() - 1);
}

WheelPower Program::MeanPower(double from_s, double to_s) const {
  WheelPower mean;
  if (!(to_s > from_s)) return mean;
  for (size_t i = PieceAt(from_s); i < pieces_.size() && pieces_[i].start_s < to_s; ++i) {
    const double inside_s = std::min(to_s, pieces_[i].end_s) - std::max(from_s, pieces_[i].start_s);
    const double share = std::max(0.0, inside_s) / (to_s - from_s);
    mean.left += share * pieces_[i].power.left;
    mean.right += share * pieces_[i].power.right;
  }
  return mean;
}

double Program::MostPower() const {
  double most = 0.0;
  for (const Piece& piece : pieces_) {
    most = std::max({most, std::abs(piece.power.left), std::abs(piece.power.right)});
  }
  return most;
}

geometry::Pose2 Program::PoseAt(double t_s) const {
  const Piece& piece = pieces_[PieceAt(t_s)];
  const double length_s = piece.end_s - piece.start_s;
  const double share =
      length_s > 0.0 ? std::clamp((t_s - piece.start_s) / length_s, 0.0, 1.0) : 1.0;
  return piece.world_from_start * ArcMotion(share * piece.length_m, share * piece.turn_rad);
}

std::vector<double> Program::Times(double step_s) const {
  std::vector<double> times{0.0};
  for (const Piece& piece : pieces_) {
    const double length_s = piece.end_s - piece.start_s;
    const int steps = std::max(1, static_cast<int>(std::ceil(length_s / step_s)));
    for (int i = 1; i <= steps; ++i) {
      times.push_back(i == steps ? piece.end_s : piece.start_s + length_s * i / steps);
    }
  }
  return times;
}

}  // namespace rift::control
