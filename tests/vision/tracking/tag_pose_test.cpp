#include "rift/vision/tracking/tag_pose.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "vision/rendered_tags.hpp"

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

TEST_CASE("A tag seen from straight above is posed whatever its heading") {
  const CameraModel camera = test::PaperCamera();
  for (int degrees = -180; degrees < 180; degrees += 15) {
    INFO("heading " << degrees);
    for (const double tilt_rad : {0.0, 1e-9, 1e-5, 0.01}) {
      Eigen::Isometry3d truth = Eigen::Isometry3d::Identity();
      truth.translation() = Eigen::Vector3d(0.02, -0.03, 1.2);
      truth.linear() = Eigen::Matrix3d(Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal()) *
                       Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d::UnitY()).toRotationMatrix() *
                       Eigen::AngleAxisd(degrees * M_PI / 180.0, Eigen::Vector3d::UnitZ());
      const auto poses = SolveTagPoses(camera, Measured(TrueRays(truth)), 0.0475);
      REQUIRE(poses);
      CHECK(poses->best.reprojection_px < 1e-4);
      CHECK((poses->best.camera_from_tag.translation() - truth.translation()).norm() < 1e-5);
      CHECK(poses->best.camera_from_tag.linear().col(0).dot(truth.linear().col(0)) > 0.999);
    }
  }
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

TEST_CASE("A tag on the floor is held to its plane as tightly as the ground is flat") {
  const CameraModel camera = test::PaperCamera();
  TagOptions options{.height_m = 0.03};
  CHECK_FALSE(FloorPriorOf(camera, {.height_m = 0.03, .ground = Ground::kFree}));
  CameraModel by_the_tag = camera;
  by_the_tag.world->origin = std::string(kFirstPoseOrigin);
  CHECK_FALSE(FloorPriorOf(by_the_tag, options));
  CameraModel no_world = camera;
  no_world.world.reset();
  CHECK_FALSE(FloorPriorOf(no_world, options));

  const auto flat = FloorPriorOf(camera, options);
  options.ground = Ground::kBumps;
  const auto bumps = FloorPriorOf(camera, options);
  REQUIRE((flat && bumps));
  CHECK(flat->height_sigma_m == options.flat_height_sigma_m);
  CHECK(flat->tilt_sigma_rad == options.flat_tilt_sigma_rad);
  CHECK(bumps->height_sigma_m == options.bump_height_sigma_m);
  CHECK(bumps->tilt_sigma_rad == options.bump_tilt_sigma_rad);
  const Eigen::Isometry3d camera_from_world = camera.world->world_from_camera.inverse();
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(0.4, -0.2, 0.03), {-0.3, 0.1, 0.03}}) {
    CHECK(flat->up_in_camera.dot(camera_from_world * p) == Approx(flat->offset_m));
    const Eigen::Vector3d higher = p + Eigen::Vector3d(0.0, 0.0, 0.1);
    CHECK(flat->up_in_camera.dot(camera_from_world * higher) == Approx(flat->offset_m + 0.1));
  }
}

TEST_CASE(
    "Corners that are off leave a tag on its floor, and the covariance says how far along it") {
  const CameraModel camera = test::PaperCamera();
  const TagOptions options{.height_m = 0.03};
  const FloorPrior floor = *FloorPriorOf(camera, options);
  const vision::RobotMotion robot = test::RobotAt(0.3, -0.2, 0.7);
  const Eigen::Isometry3d camera_from_world = camera.world->world_from_camera.inverse();
  std::mt19937_64 generator(11);
  std::normal_distribution<double> noise(0.0, 0.02), height(0.0, floor.height_sigma_m),
      tilt(0.0, floor.tilt_sigma_rad);
  constexpr int kTries = 2000;
  PoseCovariance scatter = PoseCovariance::Zero(), said = PoseCovariance::Zero();
  for (int i = 0; i < kTries; ++i) {
    const double lean_rad = tilt(generator), roll_rad = tilt(generator);
    const Eigen::Isometry3d truth =
        camera_from_world * Eigen::Translation3d(0.0, 0.0, height(generator)) *
        robot.world_from_tag * Eigen::AngleAxisd(lean_rad, Eigen::Vector3d::UnitX()) *
        Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitY());
    auto rays = TrueRays(truth);
    for (Eigen::Vector2d& ray : rays) {
      ray += Eigen::Vector2d(noise(generator) / camera.k(0, 0), noise(generator) / camera.k(1, 1));
    }
    const TagPose pose =
        PoseOnFloor(camera, Measured(rays), 0.0475, floor, options.lens_sigma_px, truth);
    const Eigen::Isometry3d in_world = camera.world->world_from_camera * pose.camera_from_tag;
    REQUIRE(std::abs(in_world.translation().z() - 0.03) < 5.0 * floor.height_sigma_m);
    REQUIRE(in_world.linear()(2, 2) > std::cos(0.01));
    Eigen::Matrix<double, 6, 1> error;
    error.head<3>() = pose.camera_from_tag.translation() - truth.translation();
    const Eigen::AngleAxisd turn(
        Eigen::Matrix3d(pose.camera_from_tag.linear() * truth.linear().transpose()));
    error.tail<3>() = turn.angle() * turn.axis();
    scatter += error * error.transpose() / kTries;
    said += pose.covariance / kTries;
  }
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 6; ++k) {
      INFO("entry " << i << ", " << k);
      CHECK(std::abs(said(i, k) - scatter(i, k)) < 0.12 * std::sqrt(scatter(i, i) * scatter(k, k)));
    }
  }
}

/// Root of the mean squared distance in pixels between rays and the corners of that pose.
double Misfit_px(const CameraModel& camera, const Eigen::Isometry3d& pose,
                 const std::array<Eigen::Vector2d, 4>& rays) {
  const auto at = TrueRays(pose);
  double squares = 0.0;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector2d off = at[i] - rays[i];
    squares += std::pow(camera.k(0, 0) * off.x(), 2) + std::pow(camera.k(1, 1) * off.y(), 2);
  }
  return std::sqrt(squares / 4.0);
}

TEST_CASE("The error of a pose is the RMS distance of its corners, and no pose nearby has less") {
  const CameraModel camera = test::PaperCamera();
  const Eigen::Isometry3d truth = Leaning(0.5);
  auto rays = TrueRays(truth);
  rays[2] += Eigen::Vector2d(2.0 / camera.k(0, 0), -1.0 / camera.k(1, 1));
  const auto poses = SolveTagPoses(camera, Measured(rays), 0.0475);
  REQUIRE(poses);
  const Eigen::Isometry3d& best = poses->best.camera_from_tag;
  CHECK(poses->best.reprojection_px == Approx(Misfit_px(camera, best, rays)));
  CHECK(poses->best.reprojection_px > 0.1);
  if (poses->other) {
    CHECK(poses->other->reprojection_px ==
          Approx(Misfit_px(camera, poses->other->camera_from_tag, rays)));
    CHECK(poses->other->reprojection_px >= poses->best.reprojection_px);
  }
  for (int i = 0; i < 6; ++i) {
    for (const double step : {-1e-4, 1e-4}) {
      Eigen::Isometry3d moved = best;
      if (i < 3) moved.translation()[i] += step;
      if (i >= 3)
        moved.linear() = Eigen::AngleAxisd(step, Eigen::Vector3d::Unit(i - 3)) * best.linear();
      CHECK(Misfit_px(camera, moved, rays) > poses->best.reprojection_px);
    }
  }
  CameraModel with_floor = camera;
  const auto floor = FloorPriorOf(with_floor, {.height_m = 0.03});
  const auto on_floor = PoseOnFloor(camera, Measured(rays), 0.0475, *floor, 0.1, best);
  CHECK(on_floor.reprojection_px == Approx(Misfit_px(camera, on_floor.camera_from_tag, rays)));
}

TEST_CASE("Of two poses the first is the one that fits better, however little they differ") {
  const CameraModel camera = test::PaperCamera();
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0.0, 0.3);
  int pairs = 0;
  for (int i = 0; i < 300; ++i) {
    auto rays = TrueRays(Leaning(0.1 + 0.001 * i));
    for (Eigen::Vector2d& ray : rays) {
      ray += Eigen::Vector2d(noise(random) / camera.k(0, 0), noise(random) / camera.k(1, 1));
    }
    const auto poses = SolveTagPoses(camera, Measured(rays), 0.0475);
    if (!poses || !poses->other) continue;
    ++pairs;
    CHECK(poses->best.reprojection_px <= poses->other->reprojection_px);
  }
  CHECK(pairs > 100);
}

TEST_CASE("Corners that run the other way round are a tag's back, which has no pose") {
  const auto rays = TrueRays(Leaning(0.4));
  CHECK(SolveTagPoses(test::PaperCamera(), Measured(rays), 0.0475));
  const std::array<Eigen::Vector2d, 4> back{rays[1], rays[0], rays[3], rays[2]};
  CHECK_FALSE(SolveTagPoses(test::PaperCamera(), Measured(back), 0.0475));
}

TEST_CASE("Of two poses the likelier weighs corners in lens errors against tilt in its own") {
  TagPoses poses;
  poses.best.reprojection_px = 0.1;
  poses.other.emplace();
  poses.other->reprojection_px = 0.2;
  poses.best.camera_from_tag.linear() =
      Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  // 4 (0.1 / s)^2 + (0.3 / t)^2 against 4 (0.2 / s)^2: equal at t = 0.3 s / sqrt(0.12).
  const double sigma_px = 0.1, even_rad = 0.3 * sigma_px / std::sqrt(0.12);
  CHECK(&LikelierPose(poses, up, sigma_px, 1.01 * even_rad) == &poses.best);
  CHECK(&LikelierPose(poses, up, sigma_px, 0.99 * even_rad) == &*poses.other);
  poses.other.reset();
  CHECK(&LikelierPose(poses, up, sigma_px, 0.01) == &poses.best);
}

}  // namespace
}  // namespace rift::vision
