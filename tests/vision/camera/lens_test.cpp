#include "rift/vision/camera/camera_model.hpp"

#include <catch2/catch.hpp>

#include "support/inputs/paper_camera.hpp"

namespace rift::vision {
namespace {

TEST_CASE("A ray through every part of the picture comes back to its pixel") {
  CameraModel camera = test::PaperCamera();
  if (GENERATE(false, true)) {
    camera.lens = Lens::kEquidistant;
    camera.distortion = {-0.02, 0.004, -0.001, 0.0002};
  }
  std::vector<Eigen::Vector2d> pixels;
  for (double u = 0; u < camera.width_px; u += 60) {
    for (double v = 0; v < camera.height_px; v += 60) pixels.emplace_back(u, v);
  }
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector2d& ray : RaysFromPixels(camera, pixels)) {
    points.push_back(Eigen::Vector3d(ray.homogeneous()) * 0.87);
  }
  const std::vector<Eigen::Vector2d> again = PixelsFromPoints(camera, points);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    INFO("pixel " << pixels[i].transpose());
    CHECK((again[i] - pixels[i]).norm() < 1e-5);
  }
}

TEST_CASE("Without a lens the pixel is the projection by hand") {
  CameraModel camera = test::PaperCamera();
  camera.distortion.clear();
  const auto pixel = PixelsFromPoints(camera, {{0.1, -0.2, 0.5}}).front();
  CHECK(pixel.x() == Approx(1091.4 * 0.2 + 908.9));
  CHECK(pixel.y() == Approx(1095.7 * -0.4 + 643.0));
}

}  // namespace
}  // namespace rift::vision
