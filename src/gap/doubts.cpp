#include "rift/gap/doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "arc_path.hpp"
#include "rift/statistics/descriptive.hpp"

namespace rift::gap {
namespace {

using trajectory::StampedPose;
using trajectory::Trajectory;

constexpr int kPoints = 160;
constexpr size_t kFewestRows = 10;

/// The first of the points becomes the origin.
template <int N>
PointsIn<N> FromStart(PointsIn<N> points) {
  const Point<N> start_m = points.front();
  for (Point<N>& point : points) point -= start_m;
  return points;
}

template <int N>
double Extent_m(const std::vector<Point<N>>& points) {
  double extent_m = 0.0;
  for (const Point<N>& point : points) extent_m = std::max(extent_m, point.norm());
  return extent_m;
}

template <int N>
using Matrix = Eigen::Matrix<double, N, N>;

template <int N>
double MeanDistance_m(const PointsIn<N>& a, const PointsIn<N>& b, const Matrix<N>& b_changed) {
  double sum_m = 0.0;
  for (size_t i = 0; i < a.size(); ++i) sum_m += (a[i] - b_changed * b[i]).norm();
  return sum_m / static_cast<double>(a.size());
}

template <int N>
void DoubtScale(const PointsIn<N>& sim, const PointsIn<N>& real, std::vector<std::string>& doubts) {
  struct Factor {
    double factor;
    const char* units;
    const char* of_larger;
  };
  constexpr std::array<Factor, 5> kFactors{{{1000.0, "mm for m", "mm"},
                                            {100.0, "cm for m", "cm"},
                                            {39.37, "inches for m", "in"},
                                            {10.0, "mm for cm", "mm"},
                                            {3.281, "feet for m", "ft"}}};
  constexpr double kSameFactor = 0.15, kSameShape = 0.1;
  const double sim_m = Extent_m<N>(sim), real_m = Extent_m<N>(real);
  if (!(sim_m > 0.0) || !(real_m > 0.0)) return;
  const double ratio = std::max(sim_m, real_m) / std::min(sim_m, real_m);
  for (const Factor& factor : kFactors) {
    if (std::abs(ratio / factor.factor - 1.0) > kSameFactor) continue;
    const double to_sim = sim_m > real_m ? factor.factor : 1.0 / factor.factor;
    const double rest_m = MeanDistance_m<N>(sim, real, Matrix<N>::Identity() * to_sim);
    if (rest_m > kSameShape * sim_m) continue;
    const bool is_sim = sim_m > real_m;
    doubts.push_back(fmt::format(
        "the path of {0} is {1:.4g} times as large as that of {2}: {3}? name the unit, as in "
        "--{4}-units {5}, or, where the header names one, --{4}-columns "
        "'t=...,x=...:{5},y=...:{5}'",
        is_sim ? "SIM" : "REAL", ratio, is_sim ? "REAL" : "SIM", factor.units,
        is_sim ? "sim" : "real", factor.of_larger));
    return;
  }
}

constexpr const char* kMirroredZ = "mirrored z: turn its sign, as in z=-COLUMN (rift's z is up)";

/// What was done to the axes of a log, and undoes it.
template <int N>
struct AxesMistake {
  Matrix<N> mended;
  const char* what;
};

template <int N>
std::vector<AxesMistake<N>> AxesMistakes() {
  const auto matrix = [](double a, double b, double c, double d) {
    Matrix<N> planar = Matrix<N>::Identity();
    planar.template topLeftCorner<2, 2>() << a, b, c, d;
    return planar;
  };
  std::vector<AxesMistake<N>> mistakes{
      {matrix(1, 0, 0, -1), "mirrored y: turn its sign, as in y=-COLUMN"},
      {matrix(-1, 0, 0, 1), "mirrored x: turn its sign, as in x=-COLUMN"},
      {matrix(0, 1, 1, 0), "swapped axes: exchange the columns of x and y"},
      {matrix(-1, 0, 0, -1), "a frame turned by half a turn: x=-COLUMN,y=-COLUMN"}};
  if constexpr (N == 3) {
    const Eigen::Vector3d mirrored_z(1, 1, -1);
    mistakes.push_back({mirrored_z.asDiagonal(), kMirroredZ});
  }
  return mistakes;
}

constexpr double kMends = 0.3;  // of the distance is left once it is mended

/// The mistake that tells best why the paths lie more than `far_m` apart.
template <int N>
void DoubtAxes(const PointsIn<N>& sim, const PointsIn<N>& real, double far_m,
               std::vector<std::string>& doubts) {
  const std::vector<AxesMistake<N>> mistakes = AxesMistakes<N>();
  const double distance_m = MeanDistance_m<N>(sim, real, Matrix<N>::Identity());
  if (distance_m < far_m) return;
  const AxesMistake<N>* best = nullptr;
  double best_m = kMends * distance_m;
  for (const AxesMistake<N>& mistake : mistakes) {
    const double mended_m = MeanDistance_m<N>(sim, real, mistake.mended);
    if (mended_m > best_m) continue;
    best = &mistake;
    best_m = mended_m;
  }
  if (best == nullptr) return;
  doubts.push_back(
      fmt::format("REAL lies {:.3g} m from SIM on average and {:.2g} m once it is mended: {}",
                  distance_m, best_m, best->what));
}

/// A straight path has the same shape with another sign; where it begins tells. The robot of sound
/// logs is put down at one place.
template <int N>
void DoubtPlace(const PointsIn<N>& sim, const PointsIn<N>& real, double far_m,
                std::vector<std::string>& doubts) {
  if ((sim.front() - real.front()).norm() < far_m) return;
  DoubtAxes<N>(sim, real, far_m, doubts);
}

/// A robot that was driven from the end of the other's path to its start. A straight way back is a
/// mirror image as well, and told as one. `sim`, `real`: where they lie.
template <int N>
void DoubtDirection(const PointsIn<N>& sim, const PointsIn<N>& real, double far_m,
                    std::vector<std::string>& doubts) {
  constexpr double kClearer = 0.5;  // than what mends the axes
  const double distance_m = MeanDistance_m<N>(sim, real, Matrix<N>::Identity());
  if (distance_m < far_m) return;
  const PointsIn<N> back(real.rbegin(), real.rend());
  const double back_m = MeanDistance_m<N>(sim, back, Matrix<N>::Identity());
  const PointsIn<N> sim_m = FromStart<N>(sim), real_m = FromStart<N>(real);
  double mended_m = distance_m;
  for (const AxesMistake<N>& mistake : AxesMistakes<N>()) {
    mended_m = std::min(mended_m, MeanDistance_m<N>(sim_m, real_m, mistake.mended));
  }
  if (back_m > kMends * distance_m || back_m > kClearer * mended_m) return;
  doubts.push_back(
      fmt::format("REAL lies {:.3g} m from SIM on average and {:.2g} m when it is taken from its "
                  "end to its start: was one of them driven the other way?",
                  distance_m, back_m));
}

/// Heights are small beside the way, and so is what a wrong sign of them does to the distance.
void DoubtHeights(const PointsIn<3>& sim, const PointsIn<3>& real, double far_m,
                  std::vector<std::string>& doubts) {
  double apart_m = 0.0, mended_m = 0.0;
  for (size_t i = 0; i < sim.size(); ++i) {
    apart_m += std::abs(sim[i].z() - real[i].z()) / kPoints;
    mended_m += std::abs(sim[i].z() + real[i].z()) / kPoints;
  }
  if (apart_m < far_m || mended_m > kMends * apart_m) return;
  doubts.push_back(fmt::format(
      "REAL lies {:.3g} m above or below SIM on average and {:.2g} m once it is mended: {}",
      apart_m, mended_m, kMirroredZ));
}

/// Speed over the rows [begin, end).
template <int N>
double Speed_m_s(const Trajectory& log, size_t begin, size_t end) {
  const StampedPose &first = log.poses[begin], &last = log.poses[end - 1];
  const double time_s = last.t_s - first.t_s;
  return time_s > 0.0 ? (PositionOf<N>(last) - PositionOf<N>(first)).norm() / time_s : 0.0;
}

/// Where a point stands on a path: the nearest of its points between two of them.
struct Place {
  double u;
  double distance_m;
};
template <int N>
Place PlaceOn(const PointsIn<N>& path, const Point<N>& point, double from_u, double to_u) {
  Place best{0.0, HUGE_VAL};
  for (size_t i = 0; i < path.size(); ++i) {
    const double u = static_cast<double>(i) / static_cast<double>(path.size() - 1);
    if (u < from_u || u > to_u || (path[i] - point).norm() >= best.distance_m) continue;
    best = {u, (path[i] - point).norm()};
  }
  return best;
}

/// One of the logs covers a part of the other's path, and moves where it is cut.
template <int N>
void DoubtPart(const Trajectory& log, const ArcPathIn<N>& part, const ArcPathIn<N>& whole,
               const char* name, const char* other, std::vector<std::string>& doubts) {
  constexpr double kWhole = 0.85, kNear = 0.1, kBeside = 0.06, kMoves = 0.5;
  const double share = part.length_m / whole.length_m;
  if (share > kWhole || log.poses.size() < kFewestRows) return;
  const PointsIn<N> path = Resample(whole, kPoints), piece = Resample(part, kPoints);
  const double near_m = kNear * whole.length_m;
  const Place begin = PlaceOn<N>(path, piece.front(), 0.0, 1.0 - 0.7 * share);
  const Place end =
      PlaceOn<N>(path, piece.back(), begin.u + 0.85 * share, begin.u + 1.15 * share + 0.01);
  if (begin.distance_m > near_m || end.distance_m > near_m || end.u - begin.u > kWhole) return;
  double beside_m = 0.0;  // a path of another shape comes by as well
  for (size_t i = 0; i < piece.size(); ++i) {
    const double u = begin.u + (end.u - begin.u) * static_cast<double>(i) / (kPoints - 1);
    beside_m += (piece[i] - path[static_cast<size_t>(u * (kPoints - 1))]).norm() / kPoints;
  }
  if (beside_m > kBeside * whole.length_m) return;
  constexpr size_t kRows = 5;
  const double mean_m_s = part.length_m / log.Duration_s();
  const size_t rows = log.poses.size();
  const bool lacks_begin =
      begin.u > 1.0 - kWhole && Speed_m_s<N>(log, 0, kRows) > kMoves * mean_m_s;
  const bool lacks_end =
      end.u < kWhole && Speed_m_s<N>(log, rows - kRows, rows) > kMoves * mean_m_s;
  if (!lacks_begin && !lacks_end) return;
  doubts.push_back(
      fmt::format("{} covers only u = {:.2f} to {:.2f} of the path of {} and {} in motion: a log "
                  "that was cut, so that its gap tells nothing of the robot?",
                  name, begin.u, end.u, other,
                  lacks_begin ? (lacks_end ? "begins and ends" : "begins") : "ends"));
}

/// Of what is compared: a robot may stand long before it drives.
template <int N>
double ComparedDuration_s(const Trajectory& log, const GapOptions& options) {
  const ArcPathIn<N> path = MakeArcPathIn<N>(log, options);
  return path.poses.back().t_s - path.poses.front().t_s;
}

template <int N>
void DoubtClocks(const Trajectory& sim, const Trajectory& real, const GapOptions& options,
                 std::vector<std::string>& doubts) {
  constexpr double kRatio = 10.0, kOffset_s = 1e6;
  const double sim_lasts_s = ComparedDuration_s<N>(sim, options);
  const double real_lasts_s = ComparedDuration_s<N>(real, options);
  const double ratio = sim_lasts_s / real_lasts_s;
  if (ratio > kRatio || ratio < 1.0 / kRatio) {
    doubts.push_back(
        fmt::format("their clocks differ: SIM lasts {:.3g} s and REAL {:.3g} s: are the times of "
                    "one in another "
                    "unit?",
                    sim_lasts_s, real_lasts_s));
  }
  const double sim_s = sim.poses.front().t_s, real_s = real.poses.front().t_s;
  if (std::abs(sim_s - real_s) < kOffset_s) return;
  doubts.push_back(fmt::format(
      "their clocks differ: SIM begins at {:.10g} s and REAL at {:.10g} s; the gap does "
      "not depend on time, and equal_time_m counts from the first row of each",
      sim_s, real_s));
}

/// On whatever clocks, whose stamps are rounded.
template <int N>
bool AreSame(const Trajectory& sim, const Trajectory& real) {
  const double sim_s = sim.poses.front().t_s, real_s = real.poses.front().t_s;
  const double rounding_s = 1e-7 + 1e-15 * std::max(std::abs(sim_s), std::abs(real_s));
  return std::equal(sim.poses.begin(), sim.poses.end(), real.poses.begin(), real.poses.end(),
                    [&](const StampedPose& a, const StampedPose& b) {
                      const double apart_s = (a.t_s - sim_s) - (b.t_s - real_s);
                      return PositionOf<N>(a) == PositionOf<N>(b) &&
                             std::abs(apart_s) <= rounding_s;
                    });
}

/// How a log was made: the scatter of its rows' distances in time, and of its positions.
struct Texture {
  double step_scatter;  ///< largest deviation from the median step, over that
  double noise_m;       ///< median size of the third differences
};

Texture TextureOf(const Trajectory& log) {
  const auto& poses = log.poses;
  std::vector<double> steps_s, noise_m;
  for (size_t i = 1; i < poses.size(); ++i) steps_s.push_back(poses[i].t_s - poses[i - 1].t_s);
  for (size_t i = 3; i < poses.size(); ++i) {
    noise_m.push_back((poses[i].Position() - 3.0 * poses[i - 1].Position() +
                       3.0 * poses[i - 2].Position() - poses[i - 3].Position())
                          .norm());
  }
  const double step_s = statistics::Median(steps_s);
  double scatter_s = 0.0;
  for (const double s : steps_s) scatter_s = std::max(scatter_s, std::abs(s - step_s));
  return {scatter_s / step_s, statistics::Median(noise_m)};
}

}  // namespace

bool IsStanding(const Trajectory& path, const GapOptions& options) {
  const double radius_m = options.standstill_radius_m;
  return path.poses.size() > 1 && (options.IsInSpace() ? StaysWithin<3>(path.poses, radius_m)
                                                       : StaysWithin<2>(path.poses, radius_m));
}

bool LookSwapped(const Trajectory& sim, const Trajectory& real) {
  constexpr double kEven = 1e-3, kUneven = 0.05, kSmooth_m = 1e-4, kNoisy_m = 4e-4;
  if (sim.poses.size() < kFewestRows || real.poses.size() < kFewestRows) return false;
  const Texture of_sim = TextureOf(sim), of_real = TextureOf(real);
  const bool real_is_computed = of_real.step_scatter < kEven && of_real.noise_m < kSmooth_m;
  return real_is_computed && of_sim.step_scatter > kUneven && of_sim.noise_m > kNoisy_m;
}

namespace {

template <int N>
std::vector<std::string> DoubtsIn(const Trajectory& sim, const Trajectory& real,
                                  const GapOptions& options) {
  std::vector<std::string> doubts;
  if (AreSame<N>(sim, real)) {
    doubts.emplace_back("SIM and REAL are the same log: name the robot's own");
    return doubts;
  }
  const ArcPathIn<N> sim_path = MakeArcPathIn<N>(sim, {}), real_path = MakeArcPathIn<N>(real, {});
  // At equal arc length: where they lie, and from their starts.
  const PointsIn<N> sim_at = Resample(sim_path, kPoints), real_at = Resample(real_path, kPoints);
  const PointsIn<N> sim_m = FromStart<N>(sim_at), real_m = FromStart<N>(real_at);
  DoubtScale<N>(sim_m, real_m, doubts);
  if (doubts.empty()) {
    constexpr double kFar = 0.1, kFarHeights = 0.03;  // of the path's extent
    const double extent_m = std::max(Extent_m<N>(sim_m), Extent_m<N>(real_m));
    const bool tells_places = options.align == Align::kNone;
    if (tells_places) DoubtDirection<N>(sim_at, real_at, kFar * extent_m, doubts);
    if (doubts.empty()) DoubtAxes<N>(sim_m, real_m, kFar * extent_m, doubts);
    if constexpr (N == 3) {
      if (doubts.empty()) DoubtHeights(sim_m, real_m, kFarHeights * extent_m, doubts);
    }
    if (doubts.empty() && tells_places) {
      DoubtPlace<N>(sim_at, real_at, kFar * extent_m, doubts);
    }
    DoubtPart(real, real_path, sim_path, "REAL", "SIM", doubts);
    DoubtPart(sim, sim_path, real_path, "SIM", "REAL", doubts);
  }
  DoubtClocks<N>(sim, real, options, doubts);
  return doubts;
}

}  // namespace

std::vector<std::string> Doubts(const Trajectory& sim, const Trajectory& real,
                                const GapOptions& options) {
  return options.IsInSpace() ? DoubtsIn<3>(sim, real, options) : DoubtsIn<2>(sim, real, options);
}

}  // namespace rift::gap
