#include "vision/tracking/motion_guess.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "support/mirror.hpp"

namespace rift::vision {
namespace {

constexpr double kLost_s = 0.25;

Eigen::Isometry3d PoseAt(double x_m, double y_m, double yaw_rad) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(x_m, y_m, 0.03);
  pose.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return pose;
}

/// A square of `side_px` about (u, v), turned by `turn_rad` in the picture.
TagCorners SquareAt(double u, double v, double side_px, double turn_rad) {
  const Eigen::Rotation2Dd turn(turn_rad);
  const double h = 0.5 * side_px;
  TagCorners corners{{{-h, h}, {h, h}, {h, -h}, {-h, -h}}};
  for (Eigen::Vector2d& corner : corners) corner = Eigen::Vector2d(u, v) + turn * corner;
  return corners;
}

Sighting SeenAt(double t_s, const TagCorners& corners, const Eigen::Isometry3d& pose) {
  Sighting sighting;
  sighting.captured_s = t_s;
  sighting.corners = corners;
  sighting.map_from_tag = pose;
  sighting.covariance = 1e-6 * PoseCovariance::Identity();
  sighting.decision_margin = 50.0;
  sighting.edge_px = sighting.reprojection_px = sighting.latency_s = 0.1;
  return sighting;
}

TEST_CASE("A tag goes on moving and turning in the picture as it did, to either side") {
  test::OnBothSides("forwards", "backwards", [](const test::Side& side) {
    const double sign = side.IsFirst() ? 1.0 : -1.0;
    MotionGuess guess;
    guess.Saw(SeenAt(1.0, SquareAt(100.0, 200.0, 40.0, 0.3), PoseAt(0.0, 0.0, 0.0)));
    guess.Saw(SeenAt(1.1, SquareAt(100.0 + sign * 10.0, 200.0 - sign * 4.0, 40.0, 0.3 + sign * 0.2),
                     PoseAt(0.0, 0.0, 0.0)));
    const auto at = guess.CornersAt(1.15, kLost_s);
    REQUIRE(at);
    const TagCorners expected =
        SquareAt(100.0 + sign * 15.0, 200.0 - sign * 6.0, 40.0, 0.3 + sign * 0.3);
    for (int i = 0; i < 4; ++i) CHECK(((*at)[i] - expected[i]).norm() < 1e-9);
  });
}

TEST_CASE("A tag that grows in the picture is expected as large as it was last") {
  MotionGuess guess;
  guess.Saw(SeenAt(0.0, SquareAt(50.0, 50.0, 40.0, 0.0), PoseAt(0.0, 0.0, 0.0)));
  guess.Saw(SeenAt(0.1, SquareAt(50.0, 50.0, 44.0, 0.0), PoseAt(0.0, 0.0, 0.0)));
  CHECK(Side_px(*guess.CornersAt(0.2, kLost_s)) == Approx(44.0));
}

TEST_CASE("A pose goes on along its way and about its axis, and its covariance grows with time") {
  test::OnBothSides("left", "right", [](const test::Side& side) {
    const double sign = side.IsFirst() ? 1.0 : -1.0;
    MotionGuess guess;
    guess.Saw(SeenAt(2.0, SquareAt(0.0, 0.0, 40.0, 0.0), PoseAt(0.1, 0.2, 0.0)));
    guess.Saw(
        SeenAt(2.1, SquareAt(9.0, 0.0, 40.0, 0.0), PoseAt(0.12, 0.2 + sign * 0.01, sign * 0.3)));
    const auto at = guess.PoseAt(2.15, kLost_s);
    REQUIRE(at);
    CHECK(at->captured_s == 2.15);
    CHECK(at->state == TrackState::kPredicted);
    CHECK(at->map_from_tag.translation().x() == Approx(0.13));
    CHECK(at->map_from_tag.translation().y() == Approx(0.2 + sign * 0.015));
    CHECK(at->map_from_tag.translation().z() == Approx(0.03));
    CHECK(at->Planar().yaw_rad == Approx(sign * 0.45));
    for (const double none : {at->decision_margin, at->edge_px, at->reprojection_px,
                              at->other_reprojection_px, at->latency_s}) {
      CHECK(std::isnan(none));
    }
    // 1.5 times the last pose less half of the one before, and 2 m/s2 and 20 rad/s2 on top.
    const double of_speed = 1e-6 * (1.5 * 1.5 + 0.5 * 0.5);
    CHECK(at->covariance(0, 0) == Approx(of_speed + std::pow(2.0 / 2.0 * 0.05 * 0.05, 2)));
    CHECK(at->covariance(1, 1) == Approx(at->covariance(0, 0)));
    CHECK(at->covariance(2, 2) == Approx(of_speed));
    CHECK(at->covariance(3, 3) == Approx(of_speed));
    CHECK(at->covariance(4, 4) == Approx(of_speed));
    CHECK(at->covariance(5, 5) == Approx(of_speed + std::pow(20.0 / 2.0 * 0.05 * 0.05, 2)));
    CHECK(at->covariance(0, 1) == 0.0);
  });
}

TEST_CASE("Seen once, or twice at a time too far apart, a tag is expected where it was") {
  const TagCorners first = SquareAt(10.0, 10.0, 30.0, 0.0),
                   second = SquareAt(30.0, 10.0, 30.0, 0.0);
  MotionGuess guess;
  CHECK_FALSE(guess.CornersAt(0.0, kLost_s));
  CHECK_FALSE(guess.PoseAt(0.0, kLost_s));
  CHECK_FALSE(guess.Last());
  guess.Saw(SeenAt(0.0, first, PoseAt(0.0, 0.0, 0.0)));
  CHECK((*guess.CornersAt(0.1, kLost_s))[0] == first[0]);
  CHECK(guess.PoseAt(0.1, kLost_s)->map_from_tag.translation().x() == 0.0);
  const double after_s = GENERATE(0.0, 0.26, 0.25);
  guess.Saw(SeenAt(after_s, second, PoseAt(0.1, 0.0, 0.0)));
  const bool has_speed = after_s == 0.25;  // as far apart as is put up with
  const auto at = guess.PoseAt(after_s + 0.125, kLost_s);
  REQUIRE(at);
  CHECK(at->map_from_tag.translation().x() == Approx(has_speed ? 0.15 : 0.1));
  CHECK(at->corners[0].x() == Approx(second[0].x() + (has_speed ? 10.0 : 0.0)));
  CHECK(guess.Last()->captured_s == after_s);
}

TEST_CASE("Nothing is expected of a tag that was last seen too long before, or was forgotten") {
  MotionGuess guess;
  guess.Saw(SeenAt(5.0, SquareAt(0.0, 0.0, 30.0, 0.0), PoseAt(0.0, 0.0, 0.0)));
  CHECK(guess.CornersAt(5.25, kLost_s));
  CHECK(guess.CornersAt(4.75, kLost_s));
  CHECK_FALSE(guess.CornersAt(5.2501, kLost_s));
  CHECK_FALSE(guess.PoseAt(5.2501, kLost_s));
  guess.Forget();
  CHECK_FALSE(guess.CornersAt(5.0, kLost_s));
  CHECK_FALSE(guess.Last());
}

TEST_CASE("Around a tag are all pixels that are within the margin of a corner") {
  const TagCorners corners{{{10.2, 40.9}, {30.7, 44.0}, {33.5, 20.1}, {12.0, 18.4}}};
  const Region region = Around(corners, 2.5);
  CHECK(region.x_px == 7);                          // 10.2 - 2.5 = 7.7
  CHECK(region.y_px == 15);                         // 18.4 - 2.5 = 15.9
  CHECK(region.x_px + region.width_px - 1 == 36);   // 33.5 + 2.5
  CHECK(region.y_px + region.height_px - 1 == 47);  // 44.0 + 2.5 = 46.5
  TagCorners wild = corners;
  wild[2] = {1e300, -1e300};
  CHECK(Around(wild, 0.0).y_px == -1'000'000);
}

TEST_CASE("The side of a tag in the picture is the mean of its four") {
  CHECK(Side_px({{{0.0, 0.0}, {3.0, 0.0}, {3.0, 4.0}, {0.0, 4.0}}}) == Approx(3.5));
  CHECK(Side_px({{{0.0, 0.0}, {4.0, 0.0}, {4.0, 3.0}, {0.0, 0.0}}}) == Approx(3.0));
}

}  // namespace
}  // namespace rift::vision
