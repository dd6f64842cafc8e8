// What a camera file looks like, and what is said of one that is none.
#include <catch2/catch.hpp>

#include "rift/vision/camera/camera_file.hpp"
#include "rift/yaml/node.hpp"

namespace rift::vision {
namespace {

using Catch::Matchers::Contains;

TEST_CASE("A camera is written with every number at its place") {
  CameraModel camera;
  camera.name = "a \"b\" c";
  camera.width_px = 1920;
  camera.height_px = 1080;
  camera.k << 1091.5, 0, 908.75, 0.0, 1095.5, 643.0, 0.0, 0.0, 1.0;
  camera.distortion = {0.25, -0.5, 0.125, -0.0625, 0.75};
  camera.rms_px = 0.375;
  camera.world.emplace();
  camera.world->world_from_camera.matrix() << 0.0, -1.0, 0.0, 0.5,  //
      1.0, 0.0, 0.0, -0.25,                                         //
      0.0, 0.0, 1.0, 2.0,                                           //
      0.0, 0.0, 0.0, 1.0;
  camera.world->residual_m = 0.0005;
  camera.world->origin = "2 reference tags";
  camera.world->marks = {{7, {0.5, -0.25, 0.125}, {100.25, 200.5}},
                         {8, {1.0, 2.0, 3.0}, {4.0, 5.0}}};
  CHECK(WriteCamera(camera, "# a comment\n") == R"(%YAML 1.1
---
# a comment
image_width: 1920
image_height: 1080
camera_name: "a \"b\" c"
camera_matrix:
  rows: 3
  cols: 3
  dt: d
  data: [1091.5, 0, 908.75, 0, 1095.5, 643, 0, 0, 1]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  dt: d
  data: [0.25, -0.5, 0.125, -0.0625, 0.75]
rectification_matrix:
  rows: 3
  cols: 3
  dt: d
  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]
projection_matrix:
  rows: 3
  cols: 4
  dt: d
  data: [1091.5, 0, 908.75, 0, 0, 1095.5, 643, 0, 0, 0, 1, 0]
calibration:
  rms_px: 0.375
world_frame:
  origin: "2 reference tags"
  residual_m: 0.0005
  world_from_camera: [0, -1, 0, 0.5, 1, 0, 0, -0.25, 0, 0, 1, 2, 0, 0, 0, 1]
  tags:
    - { id: 7, x_m: 0.5, y_m: -0.25, z_m: 0.125, u_px: 100.25, v_px: 200.5 }
    - { id: 8, x_m: 1, y_m: 2, z_m: 3, u_px: 4, v_px: 5 }
)");
  camera.world->marks.clear();
  CHECK_THAT(WriteCamera(camera), !Contains("tags:"));
  camera.world.reset();
  CHECK_THAT(WriteCamera(camera), Catch::Matchers::EndsWith("rms_px: 0.375\n"));
}

TEST_CASE("The comment of a file is that of the lines before its first key") {
  CHECK(CommentOfCamera("%YAML 1.1\n---\n# one\n# two\nimage_width: 3\n# three\n") ==
        "# one\n# two\n");
  CHECK(CommentOfCamera("# before\n%YAML:1.0\n---\n# after\nx: 1\n") == "# before\n# after\n");
  CHECK(CommentOfCamera("# alone") == "# alone");
  CHECK(CommentOfCamera("image_width: 3\n# later\n").empty());
  CHECK(CommentOfCamera("\n# later\n").empty());
  CHECK(CommentOfCamera("").empty());
}

constexpr const char* kMatrix = "K: [900, 0, 320, 0, 910, 240, 0, 0, 1]\n";
constexpr const char* kLens = "D: [1, 2, 3, 4]\n";

CameraModel Read(const std::string& text) { return ReadCamera(text, "cam.yaml"); }

std::string Refusal(const std::string& text) {
  try {
    Read(text);
  } catch (const yaml::Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST_CASE("The keys of others are read, the first of them where there are several") {
  for (const char* key : {"camera_matrix", "K", "mtx"}) {
    CHECK(Read(std::string(key) + &kMatrix[1] + kLens).k(1, 1) == 910.0);
  }
  for (const char* key : {"distortion_coefficients", "dist_coeff", "dist_coeffs", "dist", "D"}) {
    CHECK(Read(std::string(kMatrix) + key + &kLens[1]).distortion ==
          std::vector<double>{1.0, 2.0, 3.0, 4.0});
  }
  CHECK(Read(std::string("mtx: 3\n") + kMatrix + kLens + "dist_coeff: [5, 6, 7, 8]\n")
            .distortion[0] == 5.0);
  const std::string both = std::string(kMatrix) + kLens;
  CHECK(Read(both).rms_px == 0.0);
  CHECK(Read(both + "avg_reprojection_error: 0.5\n").rms_px == 0.5);
  CHECK(Read(both + "calibration: {rms_px: 0.25}\navg_reprojection_error: 0.5\n").rms_px == 0.25);
  CHECK(Read(both + "calibration: {made: today}\navg_reprojection_error: 0.5\n").rms_px == 0.5);
  CHECK(Read(both + "image_width: 100000\n").width_px == 100'000);
  CHECK(Read(both + "image_width: 1\n").height_px == 0);
  CHECK(Read(both + "image_height: 7\n").height_px == 7);
  CHECK(Read(both + "distortion_model: plumb_bob\nfisheye_model: 1\n").lens == Lens::kPlumbBob);
  // A directive is one at the head alone.
  CHECK(Read("# %YAML:1.0 is below\n%YAML:1.0\n---\n" + both).k(0, 0) == 900.0);
  CHECK(Read(both + "camera_name: \"a %YAML b\"\n").name == "a %YAML b");
  CHECK(
      Read("camera_matrix: !!opencv-matrix\n   rows: 3\n   data: [900, 0, 320, 0, 910, 240, 0, 0, "
           "1]\nD: !!opencv-matrix\n   cols: 2\n   data: [1, 2, 3, 4]\n")
          .distortion[3] == 4.0);
}

TEST_CASE("What is wrong with a camera file is said with its place, its key and the rule") {
  const std::string k = kMatrix, d = kLens;
  CHECK(Refusal("x: 1\n") ==
        "cam.yaml: no camera matrix: a camera file has the key 'camera_matrix' (rift track "
        "--calibrate makes one)");
  CHECK_THAT(Refusal(k), Contains("cam.yaml: no distortion: a camera file has the key "
                                  "'distortion_coefficients'"));
  CHECK(Refusal("- 1\n") == "cam.yaml: this is no camera file (rift track --calibrate makes one)");
  CHECK_THAT(Refusal("K: {rows: 3, cols: 3}\n" + d),
             Contains("cam.yaml:1") && Contains("a matrix needs rows, cols and data"));
  CHECK_THAT(Refusal("K: {rows: 3, cols: 4, data: [1, 2]}\n" + d),
             Contains("K.data") && Contains("rows and cols say 12 numbers"));
  CHECK_THAT(Refusal("K: {rows: 101, cols: 4, data: [1, 2]}\n" + d), Contains("K.rows"));
  CHECK_THAT(Refusal("K: {rows: 3, cols: -1, data: [1, 2]}\n" + d), Contains("K.cols"));
  CHECK_THAT(Refusal("K: [900, 0, 320, 0, 910, 240, 0, 0]\n" + d),
             Contains("cam.yaml:1") && Contains("9 numbers, row by row"));
  CHECK_THAT(Refusal("K: [[900, 0, wide], [0, 910, 240], [0, 0, 1]]\n" + d), Contains("wide"));
  CHECK_THAT(Refusal(k + "D: [1, 2, 3, 4]\nimage_width: 100001\n"), Contains("image_width"));
  CHECK_THAT(Refusal(k + d + "avg_reprojection_error: some\n"),
             Contains("cam.yaml:3") && Contains("avg_reprojection_error"));
  CHECK_THAT(Refusal(k + d + "calibration: {rms_px: some}\n"), Contains("calibration.rms_px"));
  const std::string row = "1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0";
  const auto world = [&](const std::string& numbers, const std::string& more = "") {
    return k + d + "world_frame:\n  world_from_camera: [" + numbers + "]\n" + more;
  };
  CHECK(Refusal(world(row + ", 1")) == "accepted");
  CHECK_THAT(Refusal(world(row)),
             Contains("world_frame.world_from_camera") && Contains("16 numbers, 4 x 4 row by row"));
  CHECK_THAT(Refusal(world(row + ", 1", "  residual_m: -1\n")), Contains("residual_m"));
  CHECK_THAT(Refusal(world(row + ", 1", "  tags: [{id: 2115}]\n")), Contains("id"));
  CHECK_THAT(Refusal(world(row + ", 1", "  tags: [{id: -1}]\n")), Contains("id"));
  CHECK(Refusal(world(row + ", 1",
                      "  tags: [{id: 0, x_m: 1000, y_m: -1000, z_m: 1000, u_px: "
                      "1000000, v_px: -1000000}]\n")) == "accepted");
  for (const char* one :
       {"x_m: 1001", "y_m: -1001", "z_m: 1001", "u_px: 1000001", "v_px: -1000001"}) {
    INFO(one);
    CHECK_THAT(Refusal(world(row + ", 1", "  tags: [{id: 0, " + std::string(one) + "}]\n")),
               Contains(std::string(one).substr(0, 3)));
  }
}

}  // namespace
}  // namespace rift::vision
