#include "rift/vision/camera/camera_file.hpp"

#include <catch2/catch.hpp>
#include <opencv2/core.hpp>

#include "rift/yaml/load.hpp"
#include "rift/yaml/node.hpp"

namespace rift::vision {
namespace {

using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;

CameraModel SomeCamera() {
  CameraModel camera;
  camera.name = "victure: sc30";
  camera.width_px = 1920;
  camera.height_px = 1080;
  camera.k << 1091.4, 0.0, 908.9, 0.0, 1095.7, 1.0 / 3.0, 0.0, 0.0, 1.0;
  camera.distortion = {0.239, -0.435, 0.0123, -0.0021, 0.252};
  camera.rms_px = 0.31;
  camera.world.emplace();
  camera.world->world_from_camera =
      Eigen::Translation3d(0.1, -0.2, 0.87) * Eigen::AngleAxisd(3.1, Eigen::Vector3d::UnitX());
  camera.world->residual_m = 0.0004;
  camera.world->origin = "4 reference tags";
  camera.world->marks = {{7, {0.5, -0.25, 0.0}, {100.25, 200.5}}};
  return camera;
}

TEST_CASE("A camera file reads back to the same camera") {
  const CameraModel wrote = SomeCamera();
  const CameraModel read = ReadCamera(WriteCamera(wrote), "cam.yaml");
  CHECK(read.name == wrote.name);
  CHECK(read.width_px == 1920);
  CHECK(read.height_px == 1080);
  CHECK(read.k == wrote.k);
  CHECK(read.distortion == wrote.distortion);
  CHECK(read.rms_px == wrote.rms_px);
  REQUIRE(read.world);
  CHECK(read.world->world_from_camera.matrix() == wrote.world->world_from_camera.matrix());
  CHECK(read.world->residual_m == wrote.world->residual_m);
  CHECK(read.world->origin == wrote.world->origin);
  REQUIRE(read.world->marks.size() == 1);
  CHECK(read.world->marks[0].tag_id == 7);
  CHECK(read.world->marks[0].p_in_world == wrote.world->marks[0].p_in_world);
  CHECK(read.world->marks[0].seen_px == wrote.world->marks[0].seen_px);
}

TEST_CASE("A camera file of ours is read by OpenCV's FileStorage and has the fields of ROS") {
  CameraModel camera = SomeCamera();
  camera.name = "3 of \"them\": \\ all";
  const std::string text = WriteCamera(camera, "# hung over the table\n# in May\n");
  const cv::FileStorage file(text, cv::FileStorage::READ | cv::FileStorage::MEMORY);
  cv::Mat1d k, distortion;
  file["camera_matrix"] >> k;
  file["distortion_coefficients"] >> distortion;
  REQUIRE(k.size() == cv::Size(3, 3));
  REQUIRE(distortion.size() == cv::Size(5, 1));
  for (int i = 0; i < 9; ++i) CHECK(k(i / 3, i % 3) == camera.k(i / 3, i % 3));
  for (int i = 0; i < 5; ++i) CHECK(distortion(0, i) == camera.distortion[i]);
  CHECK(static_cast<int>(file["image_width"]) == 1920);
  CHECK(static_cast<std::string>(file["distortion_model"]) == "plumb_bob");
  CHECK(CommentOfCamera(text) == "# hung over the table\n# in May\n");
  CHECK(static_cast<std::string>(file["camera_name"]) == camera.name);
  CHECK(ReadCamera(text, "cam.yaml").name == camera.name);
  CHECK(ReadCamera(text, "cam.yaml").k == camera.k);
  // The fields that ROS's camera_calibration_parsers requires (parse_yml.cpp).
  const yaml::Node root = yaml::Parse(text, "cam.yaml");
  for (const char* key : {"image_width", "image_height", "camera_name", "distortion_model"}) {
    CHECK(root.Find(key) != nullptr);
  }
  for (const char* matrix :
       {"camera_matrix", "distortion_coefficients", "rectification_matrix", "projection_matrix"}) {
    REQUIRE(root.Find(matrix) != nullptr);
    for (const char* key : {"rows", "cols", "data"}) {
      CHECK(root.Find(matrix)->value.Find(key) != nullptr);
    }
  }
}

TEST_CASE("A fisheye camera keeps its lens") {
  CameraModel camera = SomeCamera();
  camera.lens = Lens::kEquidistant;
  camera.distortion = {0.1, 0.2, 0.3, 0.4};
  const CameraModel read = ReadCamera(WriteCamera(camera), "cam.yaml");
  CHECK(read.lens == Lens::kEquidistant);
  CHECK(read.distortion == camera.distortion);
}

TEST_CASE("A camera file of ROS is read") {
  const CameraModel camera = ReadCamera(R"(image_width: 640
image_height: 480
camera_name: narrow_stereo/left
camera_matrix:
  rows: 3
  cols: 3
  data: [438.783367, 0.000000, 305.593336, 0.000000, 437.302876, 243.738352, 0., 0., 1.]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [-0.361976, 0.110510, 0.001014, 0.000505, 0.000000]
rectification_matrix:
  rows: 3
  cols: 3
  data: [0.999978, 0.002789, -0.006046, -0.002816, 0.999986, -0.004401, 0.006034, 0.004417, 0.999972]
projection_matrix:
  rows: 3
  cols: 4
  data: [393.653800, 0., 322.797939, 0., 0., 393.653800, 241.090902, 0., 0., 0., 1., 0.]
)",
                                        "ros.yaml");
  CHECK(camera.width_px == 640);
  CHECK(camera.k(1, 2) == 243.738352);
  CHECK(camera.distortion[1] == 0.110510);
  CHECK_FALSE(camera.world);
}

TEST_CASE("A camera file of OpenCV is read with its own tags") {
  const CameraModel camera = ReadCamera(R"(%YAML:1.0
---
calibration_time: "Sat Nov 21 15:29:37 2026"
nframes: 25
image_width: 1280
image_height: 720
board_width: 9
flags: 0
fisheye_model: 0
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 9.1e+02, 0., 6.395e+02, 0., 9.2e+02, 3.595e+02, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 5
   cols: 1
   dt: d
   data: [ -4.1802327018241026e-001, 5.0715244063187526e-001, 0., 0.,
       -5.7843597214487474e-001 ]
avg_reprojection_error: 2.3e-01
)",
                                        "opencv.yml");
  CHECK(camera.height_px == 720);
  CHECK(camera.k(0, 0) == 910.0);
  CHECK(camera.distortion.size() == 5);
  CHECK(camera.rms_px == 0.23);
}

TEST_CASE("A camera file with nested lists and no size is read") {
  const CameraModel camera = ReadCamera(R"(camera_matrix:
- - 1091.4
  - 0.0
  - 908.9
- [0.0, 1095.7, 643.0]
- [0.0, 0.0, 1.0]
dist_coeff:
- [0.239, -0.435, 0.0123, -0.0021, 0.252]
)",
                                        "authors.yaml");
  CHECK(camera.width_px == 0);
  CHECK(camera.k(0, 2) == 908.9);
  CHECK(camera.k(1, 1) == 1095.7);
  CHECK(camera.distortion.back() == 0.252);
}

TEST_CASE("A damaged camera file is refused with place and rule") {
  const std::string good = WriteCamera(SomeCamera());
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    REQUIRE(text.find(from) != std::string::npos);
    return text.replace(text.find(from), from.size(), to);
  };
  const auto message = [](const std::string& text) -> std::string {
    try {
      ReadCamera(text, "cam.yaml");
    } catch (const yaml::Error& error) {
      return error.what();
    }
    return "accepted";
  };
  CHECK_THAT(message("camera_matrix: 3"),
             Contains("cam.yaml:1") && EndsWith("is 3: 9 numbers, row by row"));
  CHECK_THAT(message("x: 1"), Contains("no camera matrix"));
  CHECK_THAT(message("- 1"), Contains("no camera file"));
  CHECK_THAT(message(with("1091.4", "-1091.4")), Contains("fx and fy above 0"));
  CHECK_THAT(message(with("1091.4", "nan")), Contains("cam.yaml:"));
  CHECK_THAT(
      message(with("plumb_bob", "pinhole")),
      EndsWith(
          "key 'distortion_model' is pinhole: one of plumb_bob, rational_polynomial, equidistant"));
  CHECK_THAT(message(with("cols: 5", "cols: 4")), EndsWith("rows and cols say 4 numbers"));
  CHECK_THAT(message(with("residual_m", "residual_mm")), Contains("residual_m"));
  CHECK_THAT(message(with("1095.7", "-1095.7")), Contains("fx and fy above 0"));
  CHECK_THAT(message(with("u_px: 100.25", "u_px: wide")), Contains("u_px"));
  CHECK_THAT(message(with("image_height: 1080", "image_height: 0")), Contains("image_height"));
  CHECK_THAT(message(with("image_width: 1920", "image_width: wide")), Contains("image_width"));
}

CameraModel ReadWith(const std::string& matrix, const std::string& distortion,
                     const std::string& further = "") {
  return ReadCamera("camera_matrix: " + matrix + "\ndist: " + distortion + "\n" + further,
                    "cam.yaml");
}

TEST_CASE("A camera matrix is one, and a lens has as many numbers as its model") {
  const std::string k = "[900, 0, 320, 0, 910, 240, 0, 0, 1]";
  CHECK(ReadWith(k, "[1, 2, 3, 4]").lens == Lens::kPlumbBob);
  CHECK(ReadWith(k, "[1, 2, 3, 4, 5]").distortion.size() == 5);
  CHECK(ReadWith(k, "[1, 2, 3, 4, 5, 6, 7, 8]").distortion.back() == 8.0);
  for (const char* wrong : {"[1, 2, 3]", "[1, 2, 3, 4, 5, 6]", "[1, 2, 3, 4, 5, 6, 7, 8, 9]"}) {
    CHECK_THROWS_WITH(ReadWith(k, wrong),
                      EndsWith(": 4, 5 or 8 numbers: k1 k2 p1 p2 [k3 [k4 k5 k6]]"));
  }
  for (const char* fisheye : {"distortion_model: equidistant", "distortion_model: fisheye",
                              "fisheye_model: 1", "fisheye_model: true"}) {
    CHECK(ReadWith(k, "[1, 2, 3, 4]", fisheye).lens == Lens::kEquidistant);
    CHECK_THROWS_WITH(
        ReadWith(k, "[1, 2, 3, 4, 5]", fisheye),
        EndsWith("key 'dist' is a list of 5: 4 numbers: k1 k2 k3 k4 of a fisheye lens"));
  }
  for (const char* plain : {"distortion_model: plumb_bob", "distortion_model: rational_polynomial",
                            "fisheye_model: 0"}) {
    CHECK(ReadWith(k, "[1, 2, 3, 4]", plain).lens == Lens::kPlumbBob);
  }
  for (const char* wrong :
       {"[0, 0, 320, 0, 910, 240, 0, 0, 1]", "[900, 0, 320, 0, 0, 240, 0, 0, 1]",
        "[900, 1, 320, 0, 910, 240, 0, 0, 1]", "[900, 0, 320, 1, 910, 240, 0, 0, 1]",
        "[900, 0, 320, 0, 910, 240, 1, 0, 1]", "[900, 0, 320, 0, 910, 240, 0, 1, 1]",
        "[900, 0, 320, 0, 910, 240, 0, 0, 2]"}) {
    CHECK_THROWS_WITH(
        ReadWith(wrong, "[1, 2, 3, 4]"),
        EndsWith("key 'camera_matrix' is a list of 9: [fx, 0, cx, 0, fy, cy, 0, 0, 1] "
                 "with fx and fy above 0 and no skew, not " +
                 std::string(wrong)));
  }
}

TEST_CASE("The message that ROS sends of a camera is read with its size") {
  const CameraModel camera = ReadCamera(
      "height: 480\nwidth: 640\ndistortion_model: plumb_bob\nD: [-0.36, 0.11, 0.001, 0.0005, 0]\n"
      "K: [438.8, 0, 305.6, 0, 437.3, 243.7, 0, 0, 1]\nbinning_x: 0\n",
      "ros.yaml");
  CHECK(camera.width_px == 640);
  CHECK(camera.height_px == 480);
}

TEST_CASE("A camera matrix that no lens has is refused, since its poses would be anywhere") {
  const std::string size = "image_width: 960\nimage_height: 720\n";
  const auto refusal = [&](const std::string& matrix) -> std::string {
    try {
      ReadWith(matrix, "[0, 0, 0, 0]", size);
    } catch (const yaml::Error& error) {
      return error.what();
    }
    return "accepted";
  };
  CHECK(refusal("[96, 0, 0, 0, 96000, 720, 0, 0, 1]") == "accepted");
  CHECK(refusal("[96000, 0, 960, 0, 96, 0, 0, 0, 1]") == "accepted");
  // Of which no size is known, or but one side, it may have any.
  for (const char* side : {"image_width: 960", "image_height: 720", "x: 1"}) {
    CHECK_NOTHROW(ReadWith("[4.2, 0, 2000, 0, 4.2, 2000, 0, 0, 1]", "[0, 0, 0, 0]", side));
  }
  CHECK(refusal("[4.2, 0, 477, 0, 4.2, 365, 0, 0, 1]") ==
        "cam.yaml:1:16: key 'camera_matrix' is a list of 9: the focal length 4.2 px must be 0.1 to "
        "100 times the longer side of the picture, 960 px: give it in pixels, its millimetres "
        "divided by those of a pixel");
  CHECK_THAT(refusal("[1170, 0, 477, 0, 96001, 365, 0, 0, 1]"), Contains("the focal length 96001"));
  for (const char* outside :
       {"[1170, 0, -1, 0, 1170, 365, 0, 0, 1]", "[1170, 0, 961, 0, 1170, 365, 0, 0, 1]",
        "[1170, 0, 477, 0, 1170, -1, 0, 0, 1]", "[1170, 0, 477, 0, 1170, 721, 0, 0, 1]"}) {
    CHECK_THAT(refusal(outside), Contains("the principal point (") &&
                                     Contains("must be in the picture of 960x720 px"));
  }
}

TEST_CASE("A lens of eight numbers is named as ROS names it and has its projection beside it") {
  CameraModel camera = SomeCamera();
  camera.distortion = {1, 2, 3, 4, 5, 6, 7, 8};
  const std::string text = WriteCamera(camera);
  CHECK_THAT(text, Contains("distortion_model: rational_polynomial"));
  CHECK(ReadCamera(text, "cam.yaml").distortion == camera.distortion);
  const cv::FileStorage file(text, cv::FileStorage::READ | cv::FileStorage::MEMORY);
  cv::Mat1d projection, rectification;
  file["projection_matrix"] >> projection;
  file["rectification_matrix"] >> rectification;
  REQUIRE(projection.size() == cv::Size(4, 3));
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      CHECK(projection(row, column) == camera.k(row, column));
      CHECK(rectification(row, column) == (row == column ? 1.0 : 0.0));
    }
    CHECK(projection(row, 3) == 0.0);
  }
}

TEST_CASE("A place of the camera that is no rotation is refused") {
  CameraModel camera = SomeCamera();
  auto& pose = camera.world->world_from_camera;
  const Eigen::Matrix3d turn = pose.linear();
  pose.linear() = 1.001 * turn;
  CHECK_THROWS_WITH(ReadCamera(WriteCamera(camera), "cam.yaml"),
                    EndsWith("key 'world_frame.world_from_camera' is a block of keys: must be a "
                             "rotation and a translation: 16 numbers, row by row"));
  pose.linear() = -turn;  // a mirror
  CHECK_THROWS_WITH(ReadCamera(WriteCamera(camera), "cam.yaml"),
                    EndsWith("key 'world_frame.world_from_camera' is a block of keys: must be a "
                             "rotation and a translation: 16 numbers, row by row"));
}

TEST_CASE("Reference tags of every family's ids are read back") {
  CameraModel camera = SomeCamera();
  camera.world->marks = {{2114, {0.5, -0.25, 0.125}, {100.25, 200.5}}};
  const CameraModel read = ReadCamera(WriteCamera(camera), "cam.yaml");
  REQUIRE(read.world->marks.size() == 1);
  CHECK(read.world->marks[0].tag_id == 2114);
  CHECK(read.world->marks[0].p_in_world.z() == 0.125);
}

/// A camera whose only reference tag lies and was seen there.
struct MarkOf {
  double x_m = 0.25, y_m = -0.5, z_m = 0.125, u_px = 10.0, v_px = 20.0;

  CameraModel Camera() const {
    CameraModel camera = SomeCamera();
    camera.world->marks = {{7, {x_m, y_m, z_m}, {u_px, v_px}}};
    return camera;
  }
};

TEST_CASE("The places and the error of a world frame go up to their limits on either side") {
  struct Limit {
    double MarkOf::*number;
    double most;
  };
  for (const Limit& limit : {Limit{&MarkOf::x_m, 1e3},
                             {&MarkOf::y_m, 1e3},
                             {&MarkOf::z_m, 1e3},
                             {&MarkOf::u_px, 1e6},
                             {&MarkOf::v_px, 1e6}}) {
    for (const double sign : {-1.0, 1.0}) {
      MarkOf mark;
      mark.*limit.number = sign * limit.most;
      CHECK_NOTHROW(ReadCamera(WriteCamera(mark.Camera()), "cam.yaml"));
      mark.*limit.number = sign * (limit.most + 1.0);
      CHECK_THROWS_AS(ReadCamera(WriteCamera(mark.Camera()), "cam.yaml"), yaml::Error);
    }
  }
  CameraModel camera = SomeCamera();
  for (const auto& [residual_m, is_taken] :
       {std::pair{0.0, true}, {1e3, true}, {1001.0, false}, {-0.1, false}}) {
    camera.world->residual_m = residual_m;
    if (is_taken) CHECK_NOTHROW(ReadCamera(WriteCamera(camera), "cam.yaml"));
    if (!is_taken) CHECK_THROWS_AS(ReadCamera(WriteCamera(camera), "cam.yaml"), yaml::Error);
  }
}

TEST_CASE("Of a reference tag the id is enough, and a camera may stand a million metres off") {
  const auto read = [](const std::string& x_m, const std::string& y_m) {
    return ReadCamera(
        "K: [900, 0, 320, 0, 910, 240, 0, 0, 1]\nD: [0, 0, 0, 0]\nworld_frame:\n  "
        "world_from_camera: [1, 0, 0, " +
            x_m + ", 0, 1, 0, " + y_m + ", 0, 0, 1, 2, 0, 0, 0, 1]\n  tags: [{id: 3}]\n",
        "cam.yaml");
  };
  const auto world = read("1000000", "-1000000").world;
  REQUIRE(world);
  CHECK(world->world_from_camera.translation() == Eigen::Vector3d(1e6, -1e6, 2.0));
  CHECK((world->residual_m == 0.0 && world->origin.empty()));
  REQUIRE(world->marks.size() == 1);
  CHECK(world->marks[0].tag_id == 3);
  CHECK(world->marks[0].p_in_world == Eigen::Vector3d::Zero());
  CHECK(world->marks[0].seen_px == Eigen::Vector2d::Zero());
  CHECK_THROWS_AS(read("1000001", "0"), yaml::Error);
  CHECK_THROWS_AS(read("0", "-1000001"), yaml::Error);
}

}  // namespace
}  // namespace rift::vision
