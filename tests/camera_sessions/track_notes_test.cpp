// What a tracking run says of its calibration and its world frame, over a few pictures.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "rift/files/files.hpp"
#include "rift/sessions/track/tracking.hpp"
#include "rift/vision/camera/camera_file.hpp"
#include "support/http.hpp"
#include "support/processes/process.hpp"
#include "support/tree.hpp"

namespace rift::sessions {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

const std::string kData = test::SourceDir() + "/data/camera";

/// Two pictures of the recording, and the calibration as a text that may be changed.
struct Recorded {
  Recorded() {
    fs::create_directories(folder / "frames");
    for (const char* name : {"000.jpg", "001.jpg"}) {
      fs::copy_file(kData + "/frames/" + name, folder / ("frames/" + std::string(name)));
    }
  }
  /// What is said.
  std::string Run(const std::string& calibration, const std::string& world, bool has_log) {
    TrackingJob job;
    job.camera = folder / "frames/*.jpg";
    job.calibration = folder / "cam.yaml";
    test::WriteText(job.calibration, calibration);
    job.world = world;
    job.fps = 15.0;
    job.options = job.OptionsFor({});
    if (has_log) job.log = folder / "log.csv";
    job.force = true;
    std::string said;
    const TrackingListener listener{.is_stopped = [] { return false; },
                                    .say = [&](const std::string& line) { said += line + "\n"; },
                                    .print = [](std::string_view) {}};
    reports = 0;
    Track(job, ReadInputs(job), listener, [&](const auto&...) { ++reports; });
    return said;
  }
  std::string Calibration() const { return files::ReadFile(folder / "cam.yaml"); }

  test::TemporaryFolder folder;
  std::string whole = files::ReadFile(kData + "/camera.yaml");
  int reports = 0;
};

TEST_CASE(
    "A new world frame is told with its origin and how far it is off in mm, and no log made") {
  Recorded recorded;
  vision::CameraModel camera = vision::ReadCamera(recorded.whole, "camera.yaml");
  camera.world.reset();
  const std::string said =
      recorded.Run(vision::WriteCamera(camera, ""), kData + "/tags.yaml", false);
  const auto world = vision::ReadCamera(recorded.Calibration(), "cam.yaml").world;
  REQUIRE(world);
  CHECK_THAT(said, Contains(fmt::format(
                       "world frame from {}, {:.2f} mm off at its points, is now in {}\n",
                       world->origin, 1e3 * world->residual_m, recorded.folder / "cam.yaml")));
  CHECK(recorded.reports == 0);
  CHECK_FALSE(fs::exists(recorded.folder / "log.csv"));
}

TEST_CASE(
    "A calibration without a size or a world frame is told so, with the size of the pictures") {
  Recorded recorded;
  const std::string size = "does not say for which size it was made; 960x720 is taken as given";
  const std::string frame = "holds no world frame";
  CHECK_THAT(recorded.Run(recorded.whole, "", true), !Contains(size) && !Contains(frame));
  CHECK(recorded.reports == 1);
  std::string sizeless = recorded.whole;
  for (const std::string line : {"image_width: 960\n", "image_height: 720\n"}) {
    REQUIRE(sizeless.find(line) != sizeless.npos);
    sizeless.erase(sizeless.find(line), line.size());
  }
  CHECK_THAT(recorded.Run(sizeless, "", true),
             Contains("note: " + (recorded.folder / "cam.yaml") + " " + size) && !Contains(frame));
  vision::CameraModel camera = vision::ReadCamera(recorded.whole, "camera.yaml");
  camera.world.reset();
  CHECK_THAT(recorded.Run(vision::WriteCamera(camera, ""), "", true),
             !Contains(size) && Contains("note: " + (recorded.folder / "cam.yaml") + " " + frame));
}

TEST_CASE("Points that make no frame are refused before anybody is asked to click them") {
  Recorded recorded;
  const std::string world = recorded.folder / "points.yaml";
  const auto refuses = [&](const std::string& points, const std::string& why) {
    test::WriteText(world, "points:\n" + points);
    CHECK_THROWS_WITH(recorded.Run(recorded.whole, world, false), Contains(why));
  };
  const std::string three =
      "  - {name: a, x_m: 0, y_m: 0}\n  - {name: b, x_m: 1, y_m: 0}\n"
      "  - {name: c, x_m: 2, y_m: 0}\n";
  refuses(three, "needs 4 points that are seen, there are 3");
  refuses(three + "  - {name: d, x_m: 3, y_m: 0}\n", "these lie on a line");
}

TEST_CASE("A stop is heard while a calibration without a size waits for the first picture") {
  const Recorded recorded;
  const test::SilentServer server;
  std::string sizeless = recorded.whole;
  for (const std::string line : {"image_width: 960\n", "image_height: 720\n"}) {
    sizeless.erase(sizeless.find(line), line.size());
  }
  TrackingJob job;
  job.camera = fmt::format("http://127.0.0.1:{}/video", server.Port());
  job.calibration = recorded.folder / "cam.yaml";
  test::WriteText(job.calibration, sizeless);
  job.options = job.OptionsFor({});
  job.options.capture.open_timeout_s = 600.0;
  job.log = recorded.folder / "log.csv";
  int asked = 0;
  std::string said;
  vision::TrackRun run{.frames = 7};
  Track(job, ReadInputs(job),
        {.is_stopped = [&asked] { return ++asked >= 3; },
         .say = [&](const std::string& line) { said += line; },
         .print = [](std::string_view) {}},
        [&](const vision::TrackRun& stopped, const auto&) { run = stopped; });
  CHECK(asked == 3);
  CHECK(run.frames == 0);
  CHECK_FALSE(run.has_failed);
  CHECK(said.empty());
  CHECK_FALSE(fs::exists(job.log));
  CHECK_THAT(files::ReadFile(RunFileOf(job.log)), Contains("\"pictures\": 0"));
}

TEST_CASE("The run file of a network camera names it without its user and password") {
  const test::TemporaryFolder folder;
  TrackingJob job;
  job.camera = "http://me:secret@127.0.0.1:9/video";  // nobody answers there
  job.calibration = kData + "/camera.yaml";
  job.options = job.OptionsFor({});
  job.log = folder / "log.csv";
  std::string said;
  Track(job, ReadInputs(job),
        {.is_stopped = [] { return false; },
         .say = [&](const std::string& line) { said += line + "\n"; },
         .print = [](std::string_view) {}},
        [](const auto&...) {});
  const std::string run = files::ReadFile(RunFileOf(job.log));
  CHECK_THAT(run, Contains("\"camera\": \"http://***@127.0.0.1:9/video\"") && !Contains("secret"));
  CHECK_THAT(said, Contains("http://***@127.0.0.1:9/video: ") && !Contains("secret"));
}

}  // namespace
}  // namespace rift::sessions
