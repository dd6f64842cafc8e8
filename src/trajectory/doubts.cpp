#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <set>

#include "plausibility.hpp"
#include "rift/geometry/pose2.hpp"
#include "rift/statistics/descriptive.hpp"
#include "rift/trajectory/log.hpp"

namespace rift::trajectory {
namespace {

using geometry::kPi;
using geometry::WrapToPi;

/// A piece of the path: where it leads, and the yaw in its middle.
struct Piece {
  Eigen::Vector2d along_m;
  double yaw_rad;
};

/// Pieces so long that measurement noise turns them little.
std::vector<Piece> PiecesOf(const Trajectory& trajectory) {
  constexpr double kShare = 1.0 / 30.0;
  const auto& poses = trajectory.poses;
  std::vector<Piece> pieces;
  if (poses.empty()) return pieces;
  Eigen::Vector2d low = poses.front().Position(), high = low;
  for (const StampedPose& pose : poses) {
    low = low.cwiseMin(pose.Position());
    high = high.cwiseMax(pose.Position());
  }
  const double piece_m = kShare * (high - low).norm();
  size_t begin = 0;
  for (size_t i = 1; i < poses.size(); ++i) {
    const Eigen::Vector2d along_m = poses[i].Position() - poses[begin].Position();
    if (!(along_m.norm() > piece_m)) continue;
    pieces.push_back({along_m, poses[(begin + i) / 2].yaw_rad});
    begin = i;
  }
  return pieces;
}

using Change = std::function<Piece(const Piece&)>;

double Agreement(const std::vector<Piece>& pieces, const Change& change) {
  double sum = 0.0;
  for (const Piece& piece : pieces) {
    const Piece changed = change(piece);
    const double travel_rad = std::atan2(changed.along_m.y(), changed.along_m.x());
    sum += std::cos(2.0 * (changed.yaw_rad - travel_rad));
  }
  return pieces.empty() ? StampedPose::kNotLogged : sum / static_cast<double>(pieces.size());
}

/// How sure the yaw must contradict the path, and the mistake must mend it.
constexpr double kContradicts = 0.4, kMends = 0.85;
constexpr size_t kFewestPieces = 10;

void DoubtYaw(const Trajectory& trajectory, std::vector<std::string>& doubts) {
  const std::vector<Piece> pieces = PiecesOf(trajectory);
  if (!trajectory.HasYaw() || pieces.size() < kFewestPieces) return;
  const double agreement = Agreement(pieces, [](const Piece& piece) { return piece; });
  if (agreement > kContradicts) return;
  struct Mistake {
    const char* what;
    Change mended;
  };
  const std::array<Mistake, 5> mistakes{{
      {"degrees read as radians? name the unit as in yaw=COLUMN:deg",
       [](const Piece& piece) {
         return Piece{piece.along_m, piece.yaw_rad * kPi / 180.0};
       }},
      {"radians read as degrees?",
       [](const Piece& piece) {
         return Piece{piece.along_m, piece.yaw_rad * 180.0 / kPi};
       }},
      {"x and y swapped, or a yaw from north, clockwise?",
       [](const Piece& piece) {
         return Piece{{piece.along_m.y(), piece.along_m.x()}, piece.yaw_rad};
       }},
      {"y mirrored, or a yaw that counts clockwise? turn one of them as in y=-COLUMN",
       [](const Piece& piece) {
         return Piece{{piece.along_m.x(), -piece.along_m.y()}, piece.yaw_rad};
       }},
      {"a yaw of another zero, a quarter turn off?",
       [](const Piece& piece) {
         return Piece{piece.along_m, piece.yaw_rad + kPi / 2.0};
       }},
  }};
  const Mistake* best = nullptr;
  double best_agreement = kMends;
  for (const Mistake& mistake : mistakes) {
    const double mended = Agreement(pieces, mistake.mended);
    if (!(mended > best_agreement)) continue;
    best = &mistake;
    best_agreement = mended;
  }
  doubts.push_back(fmt::format("the yaw disagrees with the direction of travel: {}",
                               best ? best->what : "is it another column?"));
}

double Distance_m(const StampedPose& a, const StampedPose& b, bool in_space) {
  return in_space ? (b.PositionInSpace() - a.PositionInSpace()).norm()
                  : (b.Position() - a.Position()).norm();
}

/// Speeds from row to row while it moves.
std::vector<double> SpeedsOf(const Trajectory& trajectory, bool in_space) {
  const auto& poses = trajectory.poses;
  std::vector<double> speeds;
  for (size_t i = 1; i < poses.size(); ++i) {
    const double step_m = Distance_m(poses[i - 1], poses[i], in_space);
    const double time_s = poses[i].t_s - poses[i - 1].t_s;
    if (step_m > 0.0 && time_s > 0.0) speeds.push_back(step_m / time_s);
  }
  return speeds;
}

void DoubtUnits(const Trajectory& trajectory, bool in_space, const UnitAdvice& advice,
                std::vector<std::string>& doubts) {
  const auto& poses = trajectory.poses;
  constexpr double kShortest_m = 0.003, kSlowest_step_s = 2.0, kFastest_step_s = 1e-4;
  const std::vector<double> speeds_m_s = SpeedsOf(trajectory, in_space);
  std::vector<double> steps_s;
  for (size_t i = 1; i < poses.size(); ++i) steps_s.push_back(poses[i].t_s - poses[i - 1].t_s);
  const double step_s = steps_s.empty() ? 0.1 : statistics::Median(steps_s);
  if (step_s > kSlowest_step_s) {
    doubts.push_back(fmt::format(
        "its poses are {:.3g} s apart: are its times in ms, us or ns? name the unit, as in {}",
        step_s, advice.time));
  } else if (step_s < kFastest_step_s) {
    doubts.push_back(fmt::format(
        "its poses are {:.3g} s apart: are its times in another unit than they are read in?",
        step_s));
  }
  const double speed_m_s = speeds_m_s.empty() ? 0.0 : statistics::Median(speeds_m_s);
  if (speed_m_s > kFastest_m_s && step_s >= kFastest_step_s) {
    doubts.push_back(
        fmt::format("it moves at {:.4g} m/s, and no robot here drives faster than {:g}: are its "
                    "positions in mm or cm? name the unit, as in {}",
                    speed_m_s, kFastest_m_s, advice.length));
  }
  double extent_m = 0.0;
  for (const StampedPose& pose : poses) {
    extent_m = std::max(extent_m, Distance_m(poses.front(), pose, in_space));
  }
  if (extent_m < kShortest_m && poses.size() >= kFewestPieces) {
    doubts.push_back(fmt::format(
        "the whole path lies within {:.3g} m: metres read as a smaller unit, or another column?",
        extent_m));
  }
}

/// Rows in motion, and how many of them only repeat the position of the row before.
void DoubtRepeats(const Trajectory& trajectory, bool in_space, std::vector<std::string>& doubts) {
  constexpr double kMost = 0.8;
  const auto& poses = trajectory.poses;
  int pairs = 0, others = 0;  // runs of two rows with one position; of any other number
  for (size_t i = 0; i < poses.size();) {
    size_t end = i + 1;
    while (end < poses.size() && Distance_m(poses[i], poses[end], in_space) == 0.0) ++end;
    ++(end - i == 2 ? pairs : others);
    i = end;
  }
  if (pairs < 10 || pairs < kMost * (pairs + others)) return;
  doubts.push_back(fmt::format("{} of {} positions are there twice in a row: are its rows doubled?",
                               pairs, pairs + others));
}

/// A piece of the way, so long that noise alone makes none.
struct Stride {
  double way_m;  ///< along the positions
  double net_m;  ///< from its first to its last
  double time_s;
};

/// From where the robot left its place to where it came to rest.
std::vector<Stride> StridesOf(const Trajectory& trajectory, double stride_m, bool in_space) {
  const auto& poses = trajectory.poses;
  size_t last = poses.size() - 1;
  while (last > 0 && Distance_m(poses[last - 1], poses.back(), in_space) <= stride_m) --last;
  std::vector<Stride> strides;
  double way_m = 0.0;
  for (size_t begin = 0, i = 1; i <= last; ++i) {
    way_m += Distance_m(poses[i - 1], poses[i], in_space);
    const double net_m = Distance_m(poses[begin], poses[i], in_space);
    if (net_m <= stride_m) continue;
    strides.push_back({way_m, net_m, poses[i].t_s - poses[begin].t_s});
    begin = i;
    way_m = 0.0;
  }
  if (!strides.empty()) strides.erase(strides.begin());  // it may have stood before
  return strides;
}

/// Where a robot stands the noise of its positions is no way, but a path over its arc length takes
/// it for one and lays what comes later beside other points of the other path.
void DoubtStanding(const Trajectory& trajectory, bool in_space, std::vector<std::string>& doubts) {
  constexpr double kStride_m = 0.01, kLeast_s = 1.0, kSlow = 0.2, kLeastShare = 0.05;
  if (trajectory.poses.size() < kFewestPieces) return;
  const std::vector<Stride> strides = StridesOf(trajectory, kStride_m, in_space);
  if (strides.size() < kFewestPieces) return;
  std::vector<double> speeds_m_s;
  double length_m = 0.0;
  for (const Stride& stride : strides) {
    speeds_m_s.push_back(stride.net_m / stride.time_s);
    length_m += stride.way_m;
  }
  const double slow_m_s = kSlow * statistics::Median(speeds_m_s);
  double noise_m = 0.0, stood_s = 0.0;
  for (const Stride& stride : strides) {
    if (stride.time_s < kLeast_s || stride.net_m > slow_m_s * stride.time_s) continue;
    noise_m += stride.way_m - stride.net_m;
    stood_s += stride.time_s;
  }
  if (noise_m < kLeastShare * length_m) return;
  doubts.push_back(fmt::format(
      "it stands on its way for {:.3g} s, and the noise of its positions there makes {:.0f} % of "
      "its arc length, so that the gap compares other points: leave those rows out",
      stood_s, 100.0 * noise_m / length_m));
}

/// A coordinate that stands still and jumps while the other one moves is no robot's.
void DoubtTarget(const Trajectory& trajectory, std::vector<std::string>& doubts) {
  constexpr size_t kMost = 12, kRowsForEach = 5;
  constexpr double kJump_m = 0.02;
  struct Axis {
    const char* name;
    std::set<double> values;  // no more of them than decide
    double largest_step_m = 0.0;
  };
  std::array<Axis, 2> axes{{{"x", {}}, {"y", {}}}};
  const auto& poses = trajectory.poses;
  for (size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Vector2d p_m = poses[i].Position();
    const Eigen::Vector2d step_m =
        i > 0 ? (p_m - poses[i - 1].Position()).eval() : Eigen::Vector2d::Zero();
    for (int k = 0; k < 2; ++k) {
      if (axes[k].values.size() <= kRowsForEach * kMost) axes[k].values.insert(p_m[k]);
      axes[k].largest_step_m = std::max(axes[k].largest_step_m, std::abs(step_m[k]));
    }
  }
  for (int k = 0; k < 2; ++k) {
    const Axis &axis = axes[k], &other = axes[1 - k];
    const size_t values = axis.values.size();
    if (values < 2 || values > kMost || other.values.size() < kRowsForEach * values) continue;
    if (axis.largest_step_m < kJump_m || axis.largest_step_m < other.largest_step_m) continue;
    doubts.push_back(fmt::format(
        "its {} has {} values only and jumps between them, by up to {:.3g} m: is it the column of "
        "a target or waypoint?",
        axis.name, values, axis.largest_step_m));
  }
}

void DoubtTilt(const Trajectory& trajectory, std::vector<std::string>& doubts) {
  constexpr double kLying_rad = 0.8;
  std::vector<double> tilts_rad;
  for (const StampedPose& pose : trajectory.poses) {
    const double tilt_rad = std::max(std::abs(WrapToPi(pose.roll_rad)), std::abs(pose.pitch_rad));
    if (std::isfinite(tilt_rad)) tilts_rad.push_back(tilt_rad);
  }
  if (tilts_rad.empty() || statistics::Median(tilts_rad) < kLying_rad) return;
  doubts.push_back(
      fmt::format("the robot lies on its side, {:.2g} rad of roll or pitch: degrees read as "
                  "radians, or a quaternion in another order (w first)?",
                  statistics::Median(tilts_rad)));
}

}  // namespace

double TravelAgreement(const Trajectory& trajectory) {
  const std::vector<Piece> pieces = PiecesOf(trajectory);
  if (pieces.size() < 3) return StampedPose::kNotLogged;
  return Agreement(pieces, [](const Piece& piece) { return piece; });
}

std::vector<std::string> Doubts(const Trajectory& trajectory, bool in_space,
                                const UnitAdvice& advice) {
  std::vector<std::string> doubts;
  DoubtUnits(trajectory, in_space, advice, doubts);
  if (!in_space) DoubtYaw(trajectory, doubts);
  DoubtRepeats(trajectory, in_space, doubts);
  DoubtStanding(trajectory, in_space, doubts);
  DoubtTarget(trajectory, doubts);
  if (!in_space) DoubtTilt(trajectory, doubts);
  return doubts;
}

}  // namespace rift::trajectory
