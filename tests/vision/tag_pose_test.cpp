#include "rift/vision/tracking/tag_pose.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "rendered_tags.hpp"

namespace rift::vision {
namespace {

std::array<Eigen::Vector2d, 4> TrueRays(const Eigen::Isometry3d& camera_from_tag) {
  const double h = 0.02375;
  const std::array<Eigen::Vector3d, 4> corners{{{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}}};
  std::array<Eigen::Vector2d, 4> rays;
  for (int i = 0; i < 4; ++i) rays[i] = (camera_from_tag * corners[i]).hnormalized();
  return rays;
}

MeasuredCorners Measured(const std::array<Eigen::Vector2d, 4>& rays) {
  return {rays, 0.02 * 0.02 * CornerCovariance::Identity()};
}

Eigen::Isometry3d Leaning(double tilt_rad) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(0.1, -0.15, 0.8);
  pose.linear() = Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d(0.6, 0.8, 0.0)) *
                  Eigen::Matrix3d(Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal());
  return pose;
}

TEST_CASE("Exact corners give back the exact pose") {
  const Eigen::Isometry3d truth = Leaning(GENERATE(0.02, 0.3, -0.5));
  const auto poses = SolveTagPoses(test::PaperCamera(), Measured(TrueRays(truth)), 0.0475);
  REQUIRE(poses);
  CHECK((poses->best.camera_from_tag.matrix() - truth.matrix()).norm() < 1e-6);
  CHECK(poses->best.reprojection_px < 1e-6);
}

TEST_CASE("Both planar solutions are proper rotations and the floor tells which") {
  const Eigen::Isometry3d truth = Leaning(0.05);
  const auto poses = SolveTagPoses(test::PaperCamera(), Measured(TrueRays(truth)), 0.0475);
  REQUIRE(poses);
  REQUIRE(poses->other);
  for (const TagPose& pose : {poses->best, *poses->other}) {
    CHECK(pose.camera_from_tag.linear().determinant() == Approx(1.0));
  }
  // Near the front a lens that is wrong by a tenth of a pixel cannot tell them apart.
  const Eigen::Vector3d other_normal = poses->other->camera_from_tag.linear().col(2);
  CHECK(&LikelierPose(*poses, truth.linear().col(2), 0.1, 0.1) == &poses->best);
  CHECK(&LikelierPose(*poses, other_normal, 1.0, 0.1) == &*poses->other);
}

TEST_CASE("The covariance is the scatter of the pose over many noisy corners") {
  const CameraModel camera = test::PaperCamera();
  const Eigen::Isometry3d truth = Leaning(0.4);
  const auto exact = TrueRays(truth);
  std::mt19937_64 generator(5);
  std::normal_distribution<double> noise(0.0, 0.02);
  PoseCovariance scatter = PoseCovariance::Zero();
  constexpr int kTries = 4000;
  for (int n = 0; n < kTries; ++n) {
    auto rays = exact;
    for (Eigen::Vector2d& ray : rays) {
      ray += Eigen::Vector2d(noise(generator) / camera.k(0, 0), noise(generator) / camera.k(1, 1));
    }
    const auto poses = SolveTagPoses(camera, Measured(rays), 0.0475);
    REQUIRE(poses);
    const TagPose& pose = LikelierPose(*poses, truth.linear().col(2), 0.02, 0.25);
    const Eigen::AngleAxisd turn(
        Eigen::Matrix3d(pose.camera_from_tag.linear() * truth.linear().transpose()));
    Eigen::Matrix<double, 6, 1> error;
    error << pose.camera_from_tag.translation() - truth.translation(), turn.angle() * turn.axis();
    scatter += error * error.transpose() / kTries;
  }
  const auto poses = SolveTagPoses(camera, Measured(exact), 0.0475);
  for (int i = 0; i < 6; ++i) {
    CHECK(scatter(i, i) == Approx(poses->best.covariance(i, i)).epsilon(0.15));
  }
}

}  // namespace
}  // namespace rift::vision
