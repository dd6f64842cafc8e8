#include <catch2/catch.hpp>
#include <opencv2/core.hpp>

#include "support/paper_camera.hpp"
#include "view/track_picture.hpp"

namespace rift::view {
namespace {

TEST_CASE("Where a robot has to stand is drawn as its outline around the place and nowhere else") {
  const vision::CameraModel camera = test::PaperCamera();
  TrackScene scene{.camera = &camera};
  const TrackPicture empty = DrawTrack(scene);
  scene.stand_at = geometry::Pose2{0.2, 0.1, 0.5};
  const TrackPicture drawn = DrawTrack(scene);
  cv::Mat differs;
  cv::extractChannel(empty.bgr != drawn.bgr, differs, 1);
  std::vector<cv::Point> changed;
  cv::findNonZero(differs, changed);
  REQUIRE(changed.size() > 100);

  const Eigen::Vector3d middle_in_camera =
      vision::MapFromCamera(camera).inverse() * Eigen::Vector3d(0.2, 0.1, 0.0);
  const Eigen::Vector2d middle =
      vision::PixelsFromPoints(camera, {middle_in_camera}).front() / drawn.px_per_shown;
  const double metre_px = camera.k(0, 0) / middle_in_camera.z() / drawn.px_per_shown;
  double farthest_m = 0.0, ahead_m = 0.0;
  for (const cv::Point& pixel : changed) {
    const Eigen::Vector2d off = (Eigen::Vector2d(pixel.x, pixel.y) - middle) / metre_px;
    farthest_m = std::max(farthest_m, off.norm());
    ahead_m = std::max(ahead_m, off.dot(Eigen::Vector2d(std::cos(0.5), -std::sin(0.5))));
  }
  CHECK(farthest_m < 0.075);
  CHECK(farthest_m == Approx(ahead_m).margin(0.006));  // the nose
  CHECK(ahead_m > 0.055);
}

}  // namespace
}  // namespace rift::view
