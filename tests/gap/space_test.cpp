// The gap in space (dimension xyz): arms and drones.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>
#include <stdexcept>

#include "rift/gap/comparison.hpp"
#include "rift/gap/doubts.hpp"
#include "rift/gap/goal.hpp"
#include "rift/geometry/pose2.hpp"
#include "support/inputs/paths.hpp"

namespace rift::gap {
namespace {

using geometry::kPi;
using trajectory::StampedPose;
using trajectory::Trajectory;

GapOptions InSpace(Align align = Align::kNone) {
  return {.dimension = Dimension::kXyz, .align = align};
}

Trajectory PathOf(const std::function<Eigen::Vector3d(double)>& at, int rows) {
  Trajectory path;
  for (int i = 0; i < rows; ++i) {
    const double share = static_cast<double>(i) / (rows - 1);
    const Eigen::Vector3d p = at(share);
    path.poses.push_back({.t_s = 10.0 * share, .x_m = p.x(), .y_m = p.y(), .z_m = p.z()});
  }
  return path;
}

/// Three turns of radius 0.2 m that climb 0.5 m, `lifted_m` above the floor.
Trajectory Helix(double lifted_m = 0.0, int rows = 3001) {
  return PathOf(
      [=](double share) {
        const double angle = 6.0 * kPi * share;
        return Eigen::Vector3d(0.2 * std::cos(angle), 0.2 * std::sin(angle),
                               lifted_m + 0.5 * share);
      },
      rows);
}

Trajectory Changed(Trajectory path, const std::function<Eigen::Vector3d(Eigen::Vector3d)>& change) {
  for (StampedPose& pose : path.poses) {
    const Eigen::Vector3d p = change(pose.PositionInSpace());
    pose.x_m = p.x();
    pose.y_m = p.y();
    pose.z_m = p.z();
  }
  return path;
}

Trajectory RandomInSpace(std::mt19937_64& generator, int rows) {
  std::normal_distribution<double> step_m(0.0, 0.01);
  Trajectory path = test::RandomPath(generator, rows);
  double z_m = 0.0;
  for (StampedPose& pose : path.poses) pose.z_m = z_m += step_m(generator);
  return path;
}

void CheckEqual(const Comparison& a, const Comparison& b) {
  for (const auto member : {&Comparison::gap_m,
                            &Comparison::gap_u,
                            &Comparison::exact_gap_m,
                            &Comparison::exact_gap_u,
                            &Comparison::mean_error_m,
                            &Comparison::rms_error_m,
                            &Comparison::median_error_m,
                            &Comparison::p95_error_m,
                            &Comparison::sim_length_m,
                            &Comparison::real_length_m,
                            &Comparison::start_offset_m,
                            &Comparison::end_error_m,
                            &Comparison::start_aligned_gap_m,
                            &Comparison::shape_gap_m,
                            &Comparison::sim_standstill_share,
                            &Comparison::real_standstill_share,
                            &Comparison::hausdorff_m,
                            &Comparison::frechet_m,
                            &Comparison::dtw_m,
                            &Comparison::equal_time_m}) {
    CHECK(a.*member == Approx(b.*member).margin(1e-9));
  }
}

TEST_CASE("The gap in space is the planar one where the height is constant") {
  std::mt19937_64 generator(11);
  for (int i = 0; i < 20; ++i) {
    Trajectory sim = test::RandomPath(generator, 80);
    Trajectory real = test::Moved(sim, {0.05, -0.02, 0.1});
    std::normal_distribution<double> noise_m(0.0, 0.002);
    for (StampedPose& pose : real.poses) pose.x_m += noise_m(generator);
    for (Trajectory* path : {&sim, &real}) {
      for (StampedPose& pose : path->poses) pose.z_m = 0.3;
    }
    const Comparison planar = Compare(sim, real, {}), space = Compare(sim, real, InSpace());
    CheckEqual(planar, space);
    CHECK(space.mean_yaw_error_rad == planar.mean_yaw_error_rad);
    CHECK(std::isnan(space.real_from_sim.x_m));
    CHECK(Gap(sim, real, InSpace()) == space.gap_m);
  }
}

TEST_CASE("A helix is its radius from its axis and its lift from its lifted copy") {
  const Trajectory axis =
      PathOf([](double share) { return Eigen::Vector3d(0.0, 0.0, 0.5 * share); }, 2);
  const Comparison result = Compare(Helix(), axis, InSpace());
  CHECK(result.gap_m == Approx(0.2).epsilon(1e-5));  // the samples stand on chords of 3000 edges
  CHECK(result.exact_gap_m == Approx(0.2).epsilon(1e-12));
  CHECK(result.sim_length_m == Approx(std::hypot(6.0 * kPi * 0.2, 0.5)).epsilon(1e-5));
  CHECK(result.real_length_m == Approx(0.5));
  CHECK(Compare(Helix(), Helix(0.07), InSpace()).gap_m == Approx(0.07));
  CHECK(Compare(Helix(), Helix(0.07), {}).gap_m == 0.0);
  CHECK(Compare(Helix(), Helix(0.07), InSpace(Align::kStart)).gap_m < 1e-12);
}

TEST_CASE("Climbing counts as arc length in space") {
  // 0.5 m along x, 1 m straight up, 0.5 m along x, against 1 m along x: at u = 3/4 the one stands
  // at (0.5, 0, 1) and the other at (0.75, 0, 0).
  Trajectory flat{{{.t_s = 0, .x_m = 0, .z_m = 0}, {.t_s = 2, .x_m = 1, .z_m = 0}}, {}};
  Trajectory step{{{.t_s = 0, .x_m = 0, .z_m = 0},
                   {.t_s = 1, .x_m = 0.5, .z_m = 0},
                   {.t_s = 2, .x_m = 0.5, .z_m = 1},
                   {.t_s = 3, .x_m = 1, .z_m = 1}},
                  {}};
  const Comparison result = Compare(flat, step, InSpace());
  CHECK(result.exact_gap_m == Approx(std::hypot(0.25, 1.0)));
  CHECK(result.exact_gap_u == Approx(0.75));
  CHECK(result.gap_m == Approx(std::hypot(0.25, 1.0)).epsilon(1e-3));
  CHECK(result.length_ratio == Approx(0.5));
  CHECK(result.hausdorff_m == Approx(1.0));
  const ErrorProfile profile = ProfileAlong(flat, step, InSpace());
  REQUIRE(profile.real_z_m.size() == 2000);
  CHECK(profile.real_z_m.back() == Approx(1.0));
  CHECK(profile.sim_z_m.back() == 0.0);
  CHECK(ProfileAlong(flat, step, {}).real_z_m.empty());
}

TEST_CASE("The exact gap in space is what ever more samples approach from below") {
  std::mt19937_64 generator(13);
  for (int i = 0; i < 20; ++i) {
    const Trajectory sim = RandomInSpace(generator, 40), real = RandomInSpace(generator, 60);
    const Comparison result = Compare(sim, real, InSpace());
    GapOptions many = InSpace();
    many.samples = 200'000;
    CHECK(result.exact_gap_m >= result.gap_m);
    CHECK(Gap(sim, real, many) <= result.exact_gap_m + 1e-14);
    CHECK(Gap(sim, real, many) == Approx(result.exact_gap_m).margin(1e-5));
  }
}

TEST_CASE("Turning both paths in space leaves every measure as it is") {
  std::mt19937_64 generator(17);
  for (int i = 0; i < 20; ++i) {
    const Trajectory sim = RandomInSpace(generator, 60), real = RandomInSpace(generator, 70);
    const Eigen::Quaterniond turn = Eigen::Quaterniond::UnitRandom();
    const auto moved = [&](const Eigen::Vector3d& p) {
      return Eigen::Vector3d(turn * p + Eigen::Vector3d(0.3, -2.0, 1.0));
    };
    CheckEqual(Compare(sim, real, InSpace()),
               Compare(Changed(sim, moved), Changed(real, moved), InSpace()));
  }
}

TEST_CASE("The best motion in space undoes any rigid motion and says which") {
  std::mt19937_64 generator(19);
  const Trajectory sim = RandomInSpace(generator, 80);
  const Eigen::Quaterniond turn(
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, -1.0).normalized()));
  const Eigen::Vector3d offset_m(0.2, -0.3, 0.4);
  const Trajectory real =
      Changed(sim, [&](const Eigen::Vector3d& p) { return Eigen::Vector3d(turn * p + offset_m); });
  CHECK(Compare(sim, real, InSpace()).gap_m > 0.4);
  CHECK(Compare(sim, real, InSpace()).shape_gap_m < 1e-9);
  CHECK(Compare(sim, real, InSpace(Align::kSe3)).gap_m < 1e-9);
  // A yaw alone cannot be turned in space.
  CHECK_FALSE(std::isnan(Compare(sim, real, InSpace()).mean_yaw_error_rad));
  CHECK(std::isnan(Compare(sim, real, InSpace(Align::kSe3)).mean_yaw_error_rad));
  const geometry::Pose3 motion = BestMotionInSpace(sim, real, InSpace());
  CHECK(motion.Rotation().angularDistance(turn) < 1e-9);
  CHECK((motion.Position() - offset_m).norm() < 1e-9);
}

TEST_CASE("A path and its mirror image have one gap in the floor and in a wall") {
  std::mt19937_64 generator(23);
  Trajectory path = test::RandomPath(generator, 80);
  for (StampedPose& pose : path.poses) pose.z_m = 0.0;
  const Trajectory mirrored =
      Changed(path, [](const Eigen::Vector3d& p) { return Eigen::Vector3d(p.x(), -p.y(), p.z()); });
  const auto on_wall = [](const Eigen::Vector3d& p) {
    return Eigen::Vector3d(p.x(), p.z(), p.y());
  };
  const double planar_m = Gap(path, mirrored, {});
  CHECK(planar_m > 0.01);
  CHECK(Gap(Changed(path, on_wall), Changed(mirrored, on_wall), InSpace()) == Approx(planar_m));
  CHECK(Gap(mirrored, path, InSpace()) == Approx(Gap(path, mirrored, InSpace())));
}

TEST_CASE("Standstill, starts and ends are in space as well") {
  // It hovers on its way up and down at one place of the plane.
  const Trajectory up = PathOf(
      [](double share) {
        return Eigen::Vector3d(0.0, 0.0, std::clamp(2.0 * share - 0.5, 0.0, 1.0));
      },
      401);
  const Comparison result = Compare(up, up, InSpace());
  CHECK(result.sim_length_m == Approx(1.0));
  CHECK(result.sim_standstill_share < 0.05);
  CHECK_THROWS_WITH(Compare(up, up, {}), Catch::Contains("never moved"));
  GapOptions trimmed = InSpace();
  trimmed.trim_standstill = true;
  CHECK(Compare(up, up, trimmed).sim_length_m == Approx(1.0).margin(0.03));
}

TEST_CASE("A motion of the other dimension and a path without heights are refused") {
  const Trajectory flat = test::StraightPath(0.7, 50);
  CHECK_THROWS_WITH(Gap(flat, flat, InSpace()), Catch::Contains("no height z"));
  CHECK_THROWS_WITH(Gap(Helix(), Helix(), InSpace(Align::kSe2)), Catch::Contains("use se3"));
  GapOptions planar;
  planar.align = Align::kSe3;
  CHECK_THROWS_WITH(Compare(flat, flat, planar), Catch::Contains("use se2, or dimension xyz"));
}

TEST_CASE("The way to a goal is the gap in space") {
  const Goal goal{{0.2, 0.0}, 0.5};
  Trajectory shorter = Helix();
  shorter.poses.resize(2800);
  CHECK(WayGap_m(shorter, Helix(), goal, InSpace()) == Gap(shorter, Helix(), InSpace()));
  CHECK(WayGap_m(shorter, Helix(), goal, {}) != Gap(shorter, Helix(), {}));
}

TEST_CASE("An axis that points down is doubted in space") {
  const Trajectory down = Changed(
      Helix(), [](const Eigen::Vector3d& p) { return Eigen::Vector3d(p.x(), p.y(), -p.z()); });
  const auto doubts = Doubts(Helix(), down, InSpace());
  REQUIRE(doubts.size() == 1);
  CHECK(doubts[0].find("mirrored z") != std::string::npos);
  CHECK(Doubts(Helix(), Helix(0.01), InSpace()).empty());
  CHECK(Doubts(Helix(), Helix(0.01)).size() == 1);  // the same x and y
}

TEST_CASE("Small heights of the wrong sign are doubted beside a larger error in the plane") {
  const auto lifted = [](double share) {
    return Changed(Helix(), [share](const Eigen::Vector3d& p) {
      return Eigen::Vector3d(p.x(), p.y(), share * p.z());
    });
  };
  const Trajectory wider = Changed(lifted(0.3), [](const Eigen::Vector3d& p) {
    return Eigen::Vector3d(1.2 * p.x(), p.y(), p.z());
  });
  const Trajectory down = Changed(
      wider, [](const Eigen::Vector3d& p) { return Eigen::Vector3d(p.x(), p.y(), -p.z()); });
  CHECK(Doubts(lifted(0.3), wider, InSpace()).empty());
  const auto doubts = Doubts(lifted(0.3), down, InSpace());
  REQUIRE(doubts.size() == 1);
  CHECK(doubts[0].find("mirrored z") != std::string::npos);
}

TEST_CASE(
    "Heights of the wrong sign are doubted from 3 percent of the path on, and 0.3 left of it") {
  // A metre along x that climbs by as much: half of it above its middle on average.
  const auto slope = [](double climb_m) {
    return PathOf([=](double share) { return Eigen::Vector3d(share, 0.0, climb_m * share); }, 101);
  };
  const auto is_told = [&](double sim_m, double real_m) {
    const auto doubts = Doubts(slope(sim_m), slope(real_m), InSpace());
    if (!doubts.empty()) CHECK(doubts[0].find("mirrored z") != std::string::npos);
    return !doubts.empty();
  };
  CHECK_FALSE(is_told(0.0299, -0.0299));
  CHECK(is_told(0.0301, -0.0301));
  CHECK_FALSE(is_told(-0.0299, 0.0299));
  CHECK(is_told(-0.0301, 0.0301));
  // 0.1 + b apart and 0.1 - b once it is mended.
  CHECK(is_told(0.1, -0.1 * (1.0 - 0.29) / 1.29));
  CHECK_FALSE(is_told(0.1, -0.1 * (1.0 - 0.31) / 1.31));
}

}  // namespace
}  // namespace rift::gap
