#include "rift/simulation/tilt_ambiguity.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "rift/geometry/pose3.hpp"
#include "rift/statistics/descriptive.hpp"
#include "simulation/quiet_mocap.hpp"

namespace rift::simulation {
namespace {

/// As above the authors' floor.
AmbiguityOptions Logs() {
  AmbiguityOptions options;
  options.share = 0.4;
  options.x_m = -0.28;
  options.y_m = -0.07;
  options.reach_m = 0.15;
  options.camera_x_m = -0.04;
  options.camera_z_m = 0.88;
  return options;
}

Eigen::Isometry3d Tag(double x_m, double y_m, double roll_rad, double pitch_rad, double yaw_rad) {
  Eigen::Isometry3d world_from_tag = Eigen::Isometry3d::Identity();
  world_from_tag.linear() = (Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()) *
                             Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()) *
                             Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitX()))
                                .toRotationMatrix();
  world_from_tag.translation() = Eigen::Vector3d(x_m, y_m, 0.02);
  return world_from_tag;
}

TEST_CASE("The mirrored tag looks the same from far and faces the camera as steeply") {
  const AmbiguityOptions options = Logs();
  const Eigen::Isometry3d tag = Tag(-0.2, 0.1, 0.1, -0.15, 0.7), other = Mirrored(options, tag);
  CHECK(other.linear().determinant() == Approx(1.0));
  CHECK((other.linear() * other.linear().transpose()).isIdentity(1e-12));
  CHECK(other.translation() == tag.translation());
  CHECK((other.linear() - tag.linear()).norm() > 0.2);
  const Eigen::Vector3d sight =
      (Eigen::Vector3d(options.camera_x_m, options.camera_y_m, options.camera_z_m) -
       tag.translation())
          .normalized();
  for (const Eigen::Vector3d& corner :
       {Eigen::Vector3d(0.02, 0.02, 0.0), Eigen::Vector3d(-0.02, 0.03, 0.0)}) {
    const Eigen::Vector3d apart = other.linear() * corner - tag.linear() * corner;
    CHECK(apart.cross(sight).norm() == Approx(0.0).margin(1e-12));  // along the line of sight
  }
  CHECK(sight.dot(other.linear().col(2)) == Approx(sight.dot(tag.linear().col(2))));
  CHECK(Mirrored(options, other).isApprox(tag, 1e-12));
}

TEST_CASE(
    "Where the authors' robot starts the mirrored tag is tilted and turned as in their logs") {
  // 16 standing robots with both: pitch -29.9 +- 2.7 deg nose down, yaw -2.9 +- 0.5 deg, z 4.6 mm.
  AmbiguityOptions options = Logs();
  options.nearer = 0.005;
  const Eigen::Isometry3d tag = Tag(-0.27, -0.075, 0.0, 0.0, 0.0), other = Mirrored(options, tag);
  const auto [roll_rad, pitch_rad, yaw_rad] = geometry::RollPitchYaw(other.linear());
  CHECK(pitch_rad == Approx(29.9 / 57.3).margin(2.7 / 57.3));
  CHECK(yaw_rad == Approx(-2.9 / 57.3).margin(0.5 / 57.3));
  const Eigen::Vector3d moved_m = other.translation() - tag.translation();
  CHECK(moved_m.z() == Approx(0.0046).margin(0.001));
  CHECK(moved_m.x() == Approx(0.0016).margin(0.0013));
}

TEST_CASE("A level tag is found from its mirrored pose, where tags are mirrored") {
  AmbiguityOptions options = Logs();
  options.nearer = 0.005;
  for (const double yaw_rad : {-0.1, 0.0, 0.05, 3.12}) {
    CAPTURE(yaw_rad);
    const Eigen::Isometry3d mirrored = Mirrored(options, Tag(-0.27, -0.075, 0.0, 0.0, yaw_rad));
    const geometry::Pose2 seen{mirrored.translation().x(), mirrored.translation().y(),
                               geometry::RollPitchYaw(mirrored.linear())[2]};
    CHECK(std::abs(geometry::WrapToPi(seen.yaw_rad - yaw_rad)) > 0.04);
    const geometry::Pose2 level = LevelTag(options, seen, 0.02);
    CHECK(level.x_m == Approx(-0.27).margin(1e-4));
    CHECK(level.y_m == Approx(-0.075).margin(1e-4));
    CHECK(std::abs(geometry::WrapToPi(level.yaw_rad - yaw_rad)) < 0.005);
    options.share = 0.0;
    CHECK(LevelTag(options, seen, 0.02) == seen);
    options.share = 0.4;
  }
}

TEST_CASE("How often a tag is mirrored falls with the way from the worst place") {
  AmbiguityOptions options = Logs();
  options.angle_rad = 1.5;
  CHECK(MirroredShare(options, Tag(-0.28, -0.07, 0, 0, 0)) == Approx(0.4));
  CHECK(MirroredShare(options, Tag(-0.28, 0.08, 0, 0, 1)) == Approx(0.4 * std::exp(-0.5)));
  CHECK(MirroredShare(options, Tag(0.02, -0.07, 0, 0, 1)) == Approx(0.4 * std::exp(-2.0)));
}

TEST_CASE("A tag seen from the side and one near the camera are not mirrored") {
  AmbiguityOptions options = Logs();
  const double sight_rad = std::atan(std::hypot(0.24, 0.07) / 0.86);
  const auto share = [&](double pitch_rad) {
    return MirroredShare(options, Tag(-0.28, -0.07, 0.0, pitch_rad, 0.0));
  };
  options.angle_rad = sight_rad + 0.001;
  CHECK(share(0.0) > 0.0);
  options.angle_rad = sight_rad - 0.001;
  CHECK(share(0.0) == 0.0);
  CHECK(share(0.05) > 0.0);  // nose down, so that it faces the camera ahead of it
  CHECK(share(-0.05) == 0.0);
  options = Logs();
  const double range_m = std::hypot(0.24, 0.07, 0.86);
  options.range_m = range_m - 0.001;
  CHECK(share(0.0) > 0.0);
  options.range_m = range_m + 0.001;
  CHECK(share(0.0) == 0.0);
}

/// The shares of mirrored pictures of one run each, 100 pictures of a robot at that speed.
std::vector<double> SharesOf(double speed_mps, double runs = 1.0) {
  MocapOptions options = Quiet();
  options.rate_hz = 50.0;
  options.ambiguity = Logs();
  options.ambiguity.reach_m = 100.0;
  options.ambiguity.runs = runs;
  std::vector<double> shares;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Mocap mocap(options, seed);
    double mirrored = 0.0;
    for (int i = 1; i <= 105; ++i) {
      const double before_s = 0.02 * (i - 1), after_s = 0.02 * i;
      mocap.Observe({.t_s = before_s, .x_m = -0.28 + speed_mps * before_s, .y_m = -0.07},
                    {.t_s = after_s, .x_m = -0.28 + speed_mps * after_s, .y_m = -0.07});
      if (i > 5) mirrored += mocap.Newest(after_s)->pitch_rad > 0.01;
    }
    shares.push_back(mirrored / 100.0);
  }
  return shares;
}

TEST_CASE("A moving tag is mirrored picture by picture, a standing one as often as its run says") {
  for (const double speed_mps : {0.05, 0.0}) {
    const std::vector<double> shares = SharesOf(speed_mps);
    CAPTURE(speed_mps);
    CHECK(statistics::Mean(shares) == Approx(0.4).margin(0.06));
    // Of 100 even draws 0.049; of u^1.5 with even u the standard deviation is 0.3.
    CHECK(statistics::StandardDeviation(shares) ==
          Approx(speed_mps > 0.0 ? 0.049 : 0.3).epsilon(0.15));
  }
}

TEST_CASE("A run mirrors no picture, or as many as it would without such runs") {
  const std::vector<double> always = SharesOf(0.05), shares = SharesOf(0.05, 0.7);
  int mirroring = 0;
  for (size_t i = 0; i < shares.size(); ++i) {
    CHECK((shares[i] == 0.0 || shares[i] == always[i]));
    mirroring += shares[i] > 0.0 ? 1 : 0;
  }
  CHECK(mirroring / static_cast<double>(shares.size()) == Approx(0.7).margin(0.08));
}

TEST_CASE("Without ambiguity no pose is mirrored") {
  MocapOptions options = Quiet();
  options.rate_hz = 50.0;
  options.ambiguity = Logs();
  options.ambiguity.share = 0.0;
  Mocap mocap(options, 1);
  for (int i = 1; i <= 300; ++i) {
    mocap.Observe({.t_s = 0.02 * (i - 1), .x_m = -0.28}, {.t_s = 0.02 * i, .x_m = -0.28});
    if (const auto seen = mocap.Newest(0.02 * i)) CHECK(seen->pitch_rad == 0.0);
  }
}

}  // namespace
}  // namespace rift::simulation
