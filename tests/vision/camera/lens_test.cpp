#include "rift/vision/camera/camera_model.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <string>
#include <utility>

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

TEST_CASE("What no lens has is told in a whole line, and each bound of it is one") {
  CameraModel camera{.name = "c", .width_px = 640, .height_px = 480};
  const auto why = [&](double fx, double fy, double cx, double cy) {
    camera.k << fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0;
    return WhyNoLens(camera).value_or("");
  };
  for (const auto& [fx, fy, cx, cy] : {std::array{64.0, 64.0, 0.0, 0.0},
                                       {64000.0, 64.0, 640.0, 480.0},
                                       {64.0, 64000.0, 640.0, 0.0},
                                       {610.0, 620.0, 0.0, 480.0}}) {
    CHECK(why(fx, fy, cx, cy) == "");
  }
  const std::string millimetres =
      " px must be 0.1 to 100 times the longer side of the picture, 640 px: give it in pixels, its "
      "millimetres divided by those of a pixel";
  CHECK(why(63.5, 610.0, 320.0, 240.0) == "the focal length 63.5" + millimetres);
  CHECK(why(610.0, 63.5, 320.0, 240.0) == "the focal length 63.5" + millimetres);
  CHECK(why(64001.0, 610.0, 320.0, 240.0) == "the focal length 64001" + millimetres);
  CHECK(why(610.0, -610.0, 320.0, 240.0) == "the focal length -610" + millimetres);
  const std::string another =
      ") px must be in the picture of 640x480 px: is this the calibration of another camera, or of "
      "pictures of another size?";
  CHECK(why(610.0, 610.0, 640.5, 240.0) == "the principal point (640.5, 240" + another);
  CHECK(why(610.0, 610.0, 320.0, 480.5) == "the principal point (320, 480.5" + another);
  CHECK(why(610.0, 610.0, -0.5, 240.0) == "the principal point (-0.5, 240" + another);
  CHECK(why(610.0, 610.0, 320.0, -0.5) == "the principal point (320, -0.5" + another);
  std::swap(camera.width_px, camera.height_px);  // the longer side is the height
  CHECK(why(64.0, 64.0, 240.0, 320.0) == "");
  CHECK(why(63.5, 64.0, 240.0, 320.0) == "the focal length 63.5" + millimetres);
  CHECK(why(64.0, 64.0, 481.0, 320.0) != "");
  CHECK(why(64.0, 64.0, 240.0, 640.0) == "");
}

TEST_CASE("Of a picture whose width or height is not known no lens is refused") {
  for (const auto& [width_px, height_px] : {std::pair{0, 480}, {640, 0}, {0, 0}}) {
    CameraModel camera{.name = "c", .width_px = width_px, .height_px = height_px};
    camera.k << 6.0, 0.0, 320.0, 0.0, 6e9, 240.0, 0.0, 0.0, 1.0;
    CHECK_FALSE(WhyNoLens(camera));
  }
}

TEST_CASE("No pixels have no rays, and no points no pixels, by either lens") {
  CameraModel camera = test::PaperCamera();
  for (const Lens lens : {Lens::kPlumbBob, Lens::kEquidistant}) {
    camera.lens = lens;
    camera.distortion = {0.0, 0.0, 0.0, 0.0};
    CHECK(RaysFromPixels(camera, {}).empty());
    CHECK(PixelsFromPoints(camera, {}).empty());
  }
}

}  // namespace
}  // namespace rift::vision
