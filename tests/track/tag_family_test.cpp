// Tags of another family through the binary: pictures, and what is refused.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <string>

#include "rift/vision/camera/camera_file.hpp"
#include "rift/vision/rendering/synthetic_camera.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"
#include "support/tree.hpp"
#include "vision/rendered_tags.hpp"
#include "vision/small_recording.hpp"

namespace rift {
namespace {

using Catch::Matchers::Contains;
using test::RunRift;

constexpr int kId = 21, kPictures = 12;

/// Pictures of a robot with a tag25h9 that drives along x.
struct Recording {
  Recording() {
    const vision::CameraModel camera = test::SmallCamera();
    vision::SyntheticCameraOptions look;
    look.tag_family = vision::TagFamily::k25h9;
    look.tag_id = kId;
    vision::SyntheticCamera pictures(camera, look);
    std::mt19937_64 generator(4);
    for (int i = 0; i < kPictures; ++i) {
      const vision::Frame frame =
          pictures.Render(test::RobotAt(X_m(i), 0.05, 0.3), vision::PixelFormat::kJpeg, generator);
      std::ofstream file(folder / fmt::format("{:03}.jpg", i), std::ios::binary);
      file.write(reinterpret_cast<const char*>(frame.bytes.data()),
                 static_cast<std::streamsize>(frame.bytes.size()));
    }
    test::WriteText(folder / "camera.yaml", vision::WriteCamera(camera));
  }
  static double X_m(int picture) { return -0.1 + 0.015 * picture; }

  test::ProcessResult Track(std::vector<std::string> more) const {
    std::vector<std::string> words{"track",
                                   "--camera",
                                   folder / "*.jpg",
                                   "--fps",
                                   "15",
                                   "--calibration",
                                   folder / "camera.yaml",
                                   "--out",
                                   folder / "log.csv",
                                   "--force"};
    words.insert(words.end(), more.begin(), more.end());
    return RunRift(words);
  }

  test::TemporaryFolder folder;
};

TEST_CASE("A robot with a tag25h9 is tracked in every picture where its family is named") {
  const Recording recording;
  const auto result = recording.Track(
      {"--set", "track.tag.family=tag25h9", "--set", fmt::format("track.tag.id={}", kId)});
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  const auto log = test::LoadTrajectory(recording.folder / "log.csv", trajectory::Format::kRift);
  REQUIRE(log.poses.size() == kPictures);
  for (int i = 0; i < kPictures; ++i) {
    CHECK(log.poses[i].x_m == Approx(Recording::X_m(i)).margin(0.5e-3));
    CHECK(log.poses[i].y_m == Approx(0.05).margin(0.5e-3));
    CHECK(log.poses[i].yaw_rad == Approx(0.3).margin(4e-3));
  }
  const auto several =
      recording.Track({"--set", "track.tag.family=tag25h9", "--id", fmt::format("{},0", kId)});
  CHECK(several.exit_code == 0);

  const auto other = recording.Track({"--id", fmt::format("{}", kId)});
  CHECK(other.exit_code != 0);  // a tag36h11 is sought, and there is none
}

TEST_CASE("An id that the family lacks is refused with its range") {
  const Recording recording;
  const auto by_key =
      recording.Track({"--set", "track.tag.family=tag25h9", "--set", "track.tag.id=35"});
  CHECK(by_key.exit_code == 2);
  CHECK_THAT(by_key.err, Contains("tag id 35: the family tag25h9 has the ids 0 to 34"));
  const auto by_flag = recording.Track({"--set", "track.tag.family=tag16h5", "--id", "30"});
  CHECK(by_flag.exit_code == 2);
  CHECK_THAT(by_flag.err, Contains("tag id 30: the family tag16h5 has the ids 0 to 29"));
  const auto unknown = recording.Track({"--set", "track.tag.family=tag25h7"});
  CHECK(unknown.exit_code == 2);
  CHECK_THAT(unknown.err, Contains("tag25h9"));
}

TEST_CASE("What precision to expect of another family is told of its own pictures") {
  const test::TemporaryFolder folder;
  vision::CameraModel few_pixels = test::SmallCamera();
  few_pixels.width_px = 320;
  few_pixels.height_px = 240;
  few_pixels.k << 305.0, 0.0, 159.5, 0.0, 305.0, 119.5, 0.0, 0.0, 1.0;
  test::WriteText(folder / "camera.yaml", vision::WriteCamera(few_pixels));
  const auto check = RunRift({"track", "--check", "--calibration", folder / "camera.yaml", "--set",
                              "track.tag.family=tagStandard41h12", "--set", "track.tag.id=2114",
                              "--out", folder / "map.json"});
  INFO(check.err);
  REQUIRE(check.exit_code == 0);
  const std::string map = test::ReadFile(folder / "map.json");
  CHECK_THAT(map, Contains("\"tag_family\": \"tagStandard41h12\""));
  CHECK_THAT(map, !Contains("\"found\": 0,"));
}

}  // namespace
}  // namespace rift
