#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "rift/vision/camera/camera_file.hpp"
#include "rift/vision/rendering/synthetic_camera.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"
#include "support/tree.hpp"
#include "track/camera_to_calibrate.hpp"

namespace rift {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using test::CameraToCalibrate;
using test::ProcessResult;
using test::RunRift;

/// Pictures of a board of 7 x 5 corners held before the camera in many ways. Renders one picture a
/// pose into the folder.
void RenderViews(const vision::CameraModel& camera, int count,
                 const test::TemporaryFolder& folder) {
  std::mt19937_64 generator(3);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator);
  };
  for (int i = 0; i < count; ++i) {
    vision::PlacedBoard board{.columns = 7, .rows = 5, .square_m = 0.03};
    // Board frame: z into the paper; its middle at p, turned about it.
    const double distance_m = uniform(0.3, 0.6);
    const Eigen::Vector3d p_in_camera(uniform(-0.22, 0.22) * distance_m,
                                      uniform(-0.15, 0.15) * distance_m, distance_m);
    const Eigen::Matrix3d turn = (Eigen::AngleAxisd(uniform(-0.3, 0.3), Eigen::Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(uniform(-0.6, 0.6), Eigen::Vector3d::UnitY()) *
                                  Eigen::AngleAxisd(uniform(-0.6, 0.6), Eigen::Vector3d::UnitX()))
                                     .toRotationMatrix();
    Eigen::Isometry3d camera_from_board = Eigen::Isometry3d::Identity();
    camera_from_board.linear() = turn;
    camera_from_board.translation() =
        p_in_camera - turn * Eigen::Vector3d(0.5 * 6 * 0.03, 0.5 * 4 * 0.03, 0.0);
    board.world_from_board = camera.world->world_from_camera * camera_from_board;
    vision::SyntheticCamera renderer(camera, {.noise_grey = 1.5}, {.boards = {board}});
    const vision::Frame frame = renderer.Render({}, vision::PixelFormat::kJpeg, generator);
    std::ofstream(folder / ("view" + std::to_string(100 + i) + ".jpg"), std::ios::binary)
        .write(reinterpret_cast<const char*>(frame.bytes.data()),
               static_cast<std::streamsize>(frame.bytes.size()));
  }
}

TEST_CASE("A camera is calibrated from a folder of pictures and from a recording of them") {
  const vision::CameraModel truth = CameraToCalibrate();
  const test::TemporaryFolder photos, out;
  RenderViews(truth, 12, photos);
  fs::create_symlink("gone/drawn.png", out / "recording.png");  // a picture that cannot be drawn
  for (const bool from_camera : {false, true}) {
    const std::string name = out / (from_camera ? "recording.yaml" : "photos.yaml");
    const std::string images = photos / "*.jpg";
    const ProcessResult result =
        RunRift({"track", "--calibrate", "--board", "7x5", "--square", "0.03",
                 from_camera ? "--camera" : "--images", images, "--out", name});
    INFO(result.out << result.err);
    REQUIRE(result.exit_code == (from_camera ? 3 : 0));
    if (from_camera) CHECK_THAT(result.err, Contains("cannot write the picture"));
    CHECK_THAT(result.out, Contains("verdict: ") && Contains("on the floor"));
    if (!from_camera) CHECK(fs::file_size(out / "photos.png") > 10'000);
    const std::string text = test::ReadFile(name);
    CHECK_THAT(text, Contains("# rift track --calibrate, board 7x5"));
    const vision::CameraModel found = vision::ReadCamera(text, name);
    CHECK(found.width_px == 640);
    CHECK(found.k(0, 0) == Approx(610.0).epsilon(0.01));
    CHECK(found.rms_px < 0.3);
  }
}

TEST_CASE("A picture without a board is refused with its name and no file") {
  const test::TemporaryFolder out;
  for (int run = 0; run < 2; ++run) {  // its picture is in the way of no second run
    const ProcessResult result =
        RunRift({"track", "--calibrate", "--board", "5x4", "--square", "0.03", "--images",
                 test::SourceDir() + "/data/camera/frames/000.jpg", "--out", out / "cam.yaml"});
    INFO(result.out << result.err);
    CHECK(result.exit_code == 1);
    CHECK_THAT(result.out, Contains("verdict: refuse") &&
                               Contains("000.jpg is left out: no chessboard of 5 x 4"));
    CHECK_THAT(result.err, Contains("is not written"));
    CHECK_FALSE(fs::exists(out / "cam.yaml"));
    CHECK_FALSE(fs::exists(out / "cam.png"));
    CHECK(fs::exists(out / "cam.refused.png"));
  }
}

TEST_CASE("A calibration replaces none of its photographs, with force neither") {
  const test::TemporaryFolder photos;
  const std::string photo = photos / "view1.png";
  fs::copy_file(test::SourceDir() + "/data/readme/demo.png", photo);
  const std::string before = test::ReadFile(photo);
  const std::vector<std::string> command{"track",    "--calibrate",    "--board",
                                         "5x4",      "--square",       "0.03",
                                         "--images", photos / "*.png", "--force"};
  for (const std::vector<std::string>& names :
       {std::vector<std::string>{"--out", photo},
        std::vector<std::string>{"--out", photos / "cam.yaml", "--picture", photo}}) {
    std::vector<std::string> words = command;
    words.insert(words.end(), names.begin(), names.end());
    const ProcessResult result = RunRift(words);
    INFO(result.out << result.err);
    CHECK(result.exit_code == 2);
    CHECK_THAT(result.err, Contains(photo + " is an input or another output"));
    CHECK(test::ReadFile(photo) == before);
  }
}

}  // namespace
}  // namespace rift
