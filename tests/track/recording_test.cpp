#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "rift/vision/camera/camera_file.hpp"
#include "rift/vision/camera/jpeg.hpp"
#include "rift/vision/rendering/print_sheet.hpp"
#include "support/documented.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/environment.hpp"
#include "support/processes/process.hpp"
#include "support/tree.hpp"
#include "vision/small_recording.hpp"

namespace rift {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using nlohmann::json;
using test::ProcessResult;
using test::RunRift;

const std::string kData = test::SourceDir() + "/data/camera";
const std::string kFrames = kData + "/frames/*.jpg";
const std::string kCamera = kData + "/camera.yaml";

std::vector<std::string> Tracking(const std::string& out,
                                  const std::string& calibration = kCamera) {
  return {"track", "--camera", kFrames, "--fps", "15", "--calibration", calibration, "--out", out};
}

std::vector<std::string> With(std::vector<std::string> words, std::vector<std::string> more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

const std::vector<double>& Column(const trajectory::Trajectory& log, const std::string& name) {
  for (const trajectory::Channel& channel : log.channels) {
    if (channel.name == name) return channel.values;
  }
  throw std::runtime_error("no column " + name);
}

TEST_CASE("The recording is tracked to within half a millimetre of its truth in every row") {
  const test::TemporaryFolder folder;
  const ProcessResult result = RunRift(Tracking(folder / "log.csv"));
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.out, Contains("30 rows") && Contains("15.0 a second"));
  const auto log = test::LoadTrajectory(folder / "log.csv", trajectory::Format::kRift);
  const auto truth = test::LoadTrajectory(kData + "/truth.csv", trajectory::Format::kRift);
  REQUIRE(log.poses.size() == truth.poses.size());
  double worst_m = 0.0, worst_z_m = 0.0, worst_rad = 0.0;
  for (std::size_t i = 0; i < truth.poses.size(); ++i) {
    CHECK(log.poses[i].t_s == Approx(truth.poses[i].t_s).margin(1e-9));
    worst_m = std::max(worst_m, (log.poses[i].Position() - truth.poses[i].Position()).norm());
    worst_z_m = std::max(worst_z_m, std::abs(log.poses[i].z_m - truth.poses[i].z_m));
    worst_rad = std::max(worst_rad, std::abs(log.poses[i].yaw_rad - truth.poses[i].yaw_rad));
  }
  INFO("position " << worst_m << " m, height " << worst_z_m << " m, yaw " << worst_rad << " rad");
  CHECK(worst_m < 0.5e-3);
  CHECK(worst_z_m < 2e-3);
  CHECK(worst_rad < 2e-3);
  // The covariance is that of what is left: neither far too small nor far too large.
  const auto& xx = Column(log, "cov_x_x_m2");
  const auto& yy = Column(log, "cov_y_y_m2");
  double squares = 0.0;
  for (std::size_t i = 0; i < xx.size(); ++i) {
    const Eigen::Vector2d off = log.poses[i].Position() - truth.poses[i].Position();
    squares += off.x() * off.x() / xx[i] + off.y() * off.y() / yy[i];
  }
  CHECK(squares / (2.0 * static_cast<double>(xx.size())) < 16.0);
  CHECK(squares / (2.0 * static_cast<double>(xx.size())) > 1.0 / 16.0);
}

TEST_CASE("What precision to expect is said before anything is driven, as a map and as JSON") {
  const test::TemporaryFolder folder;
  vision::CameraModel few_pixels = test::SmallCamera();
  few_pixels.width_px = 480;
  few_pixels.height_px = 360;
  few_pixels.k << 457.5, 0.0, 239.5, 0.0, 457.5, 179.5, 0.0, 0.0, 1.0;
  const std::string calibration = folder / "camera.yaml";
  test::WriteText(calibration, vision::WriteCamera(few_pixels));
  const ProcessResult result = RunRift({"track", "--check", "--calibration", calibration, "--out",
                                        folder / "map.json", "--set", "twin.camera.noise_grey=2"});
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.out, Contains("position, RMS error in mm") && Contains("smallest tag"));
  const auto map = nlohmann::json::parse(test::ReadFile(folder / "map.json"));
  CHECK(test::KeysOf(map) == test::DocumentedKeys("MAP.json of rift track --check"));
  CHECK(map["places"].size() == map["columns"].get<std::size_t>() * map["rows"].get<std::size_t>());
  CHECK(map["look"]["noise_grey"] == 2.0);
  CHECK(map["found"] == map["views"]);
  CHECK(map["position_p95_m"].get<double>() < 1e-4);
  CHECK(map["least_side_px"].get<double>() < map["places"][0]["side_px"].get<double>());
  // The same error of a tag that is hardly larger than the smallest one is many times as large.
  const ProcessResult small = RunRift({"track", "--check", "--calibration", calibration, "--set",
                                       "track.tag.size_m=0.023", "--out", folder / "small.json"});
  REQUIRE(small.exit_code == 0);
  const auto coarse = nlohmann::json::parse(test::ReadFile(folder / "small.json"));
  CHECK(coarse["position_p95_m"].get<double>() > 4.0 * map["position_p95_m"].get<double>());

  const ProcessResult camera =
      RunRift({"track", "--check", "--calibration", calibration, "--camera", "x"});
  CHECK(camera.exit_code == 2);
  CHECK_THAT(camera.err, Contains("--check opens no camera"));
  CHECK(RunRift({"track", "--check"}).exit_code == 2);
}

TEST_CASE("The same recording gives the same bytes") {
  const test::TemporaryFolder folder;
  REQUIRE(RunRift(Tracking(folder / "a.csv")).exit_code == 0);
  REQUIRE(RunRift(Tracking(folder / "b.csv")).exit_code == 0);
  CHECK(test::ReadFile(folder / "a.csv") == test::ReadFile(folder / "b.csv"));
}

TEST_CASE("The rows of a second are counted from the first row, not from the first picture") {
  const test::TemporaryFolder folder;
  const std::vector<std::uint8_t> empty =
      vision::WriteJpeg(cv::Mat1b(720, 960, std::uint8_t{128}), 80, false);
  for (int i = 0; i < 30; ++i) {
    const std::string name = fmt::format("{:03}.jpg", i);
    if (i < 10) {  // the robot is not there yet
      test::WriteText(folder / name, {empty.begin(), empty.end()});
    } else {
      fs::copy_file(kData + "/frames/" + name, folder / name);
    }
  }
  std::vector<std::string> words = Tracking(folder / "log.csv");
  words[2] = folder / "*.jpg";
  const ProcessResult result = RunRift(words);
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.out, Contains("20 rows in 1.3 s, 15.0 a second"));
  const json run = json::parse(test::ReadFile(folder / "log.run.json"));
  CHECK(run["rows"] == 20);
  CHECK(run["rows_per_s"].get<double>() == Approx(15.0));
}

TEST_CASE("rift gap reads a tracked log against its truth") {
  const test::TemporaryFolder folder;
  REQUIRE(RunRift(Tracking(folder / "log.csv")).exit_code == 0);
  const ProcessResult gap =
      RunRift({"gap", kData + "/truth.csv", folder / "log.csv", "--json", "-"});
  INFO(gap.err);
  REQUIRE(gap.exit_code == 0);
  CHECK(json::parse(gap.out)["trials"][0]["gap_m"].get<double>() < 1e-3);
}

TEST_CASE("The run file says what the poses mean and what they were made from") {
  const test::TemporaryFolder folder;
  REQUIRE(
      RunRift(With(Tracking(folder / "log.csv"), {"--set", "track.tag.max_hamming=0"})).exit_code ==
      0);
  const json run = json::parse(test::ReadFile(folder / "log.run.json"));
  CHECK(run["frame"]["name"] == "world");
  CHECK(run["rows"] == 30);
  CHECK(run["state"] == "ended");
  CHECK(run["track"]["tag"]["max_hamming"] == 0);
  CHECK(run["latency_s"]["p50"].is_null());
  CHECK(run["finding_s"]["p50"].get<double>() > 0.0);
  CHECK(run["calibration_hash"].get<std::string>().size() == 32);
}

TEST_CASE("Without a world frame the poses are the camera's turned y up and the run file says so") {
  const test::TemporaryFolder folder;
  vision::CameraModel camera = vision::ReadCamera(test::ReadFile(kCamera), kCamera);
  const Eigen::Isometry3d world_from_camera = camera.world->world_from_camera;
  camera.world.reset();
  test::WriteText(folder / "cam.yaml", vision::WriteCamera(camera));
  REQUIRE(RunRift(Tracking(folder / "log.csv", folder / "cam.yaml")).exit_code == 0);
  const json run = json::parse(test::ReadFile(folder / "log.run.json"));
  CHECK(run["frame"]["name"] == "camera");
  const auto log = test::LoadTrajectory(folder / "log.csv", trajectory::Format::kRift);
  const auto truth = test::LoadTrajectory(kData + "/truth.csv", trajectory::Format::kRift);
  for (std::size_t i = 0; i < log.poses.size(); i += 7) {
    const auto& pose = log.poses[i];
    const Eigen::Vector3d p_in_camera(pose.x_m, -pose.y_m, -pose.z_m);
    const Eigen::Vector3d p = world_from_camera * p_in_camera;
    // Along the line of sight a tag of 44 px is good to some millimetres.
    CHECK((p.head<2>() - truth.poses[i].Position()).norm() < 2e-3);
  }
}

TEST_CASE("Reference tags set the world frame and it is kept in the calibration") {
  const test::TemporaryFolder folder;
  vision::CameraModel camera = vision::ReadCamera(test::ReadFile(kCamera), kCamera);
  const Eigen::Isometry3d truth = camera.world->world_from_camera;
  camera.world.reset();
  test::WriteText(folder / "cam.yaml", "# hung over the table\n" + vision::WriteCamera(camera));
  const ProcessResult set = RunRift({"track", "--camera", kFrames, "--calibration",
                                     folder / "cam.yaml", "--world", kData + "/tags.yaml"});
  INFO(set.err);
  REQUIRE(set.exit_code == 0);
  CHECK_THAT(set.err, Contains("4 reference tags") && Contains("mm off at its points"));
  const std::string text = test::ReadFile(folder / "cam.yaml");
  CHECK_THAT(text, Contains("# hung over the table\n"));
  camera = vision::ReadCamera(text, "cam.yaml");
  REQUIRE(camera.world);
  CHECK(camera.world->marks.size() == 4);
  CHECK(camera.world->residual_m < 1e-3);
  CHECK((camera.world->world_from_camera.translation() - truth.translation()).norm() < 5e-3);

  // The same camera, pushed: its reference tags are no longer where they were.
  for (vision::ReferenceMark& mark : camera.world->marks) mark.seen_px.x() += 20.0;
  camera.k(0, 2) += 20.0;  // else the frame would be of another lens
  test::WriteText(folder / "cam.yaml", vision::WriteCamera(camera));
  const ProcessResult moved = RunRift(Tracking(folder / "log.csv", folder / "cam.yaml"));
  CHECK_THAT(moved.err, Contains("the camera was moved"));
  const json run = json::parse(test::ReadFile(folder / "log.run.json"));
  CHECK(run["reference_tags_off_m"].get<double>() == Approx(20.0 / 1170.0 * 0.87).epsilon(0.1));
}

TEST_CASE("The robot's first pose can be the origin of the world") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "cam.yaml", test::ReadFile(kCamera));
  const ProcessResult result =
      RunRift(With(Tracking(folder / "log.csv", folder / "cam.yaml"),
                   {"--world", "first", "--world-average", "0", "--force"}));
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  const auto log = test::LoadTrajectory(folder / "log.csv", trajectory::Format::kRift);
  REQUIRE(log.poses.size() == 30);
  CHECK(log.poses[0].Position().norm() < 2e-3);
  CHECK(std::abs(log.poses[0].yaw_rad) < 0.01);
}

TEST_CASE("A robot that drives while its first pose is averaged makes no world frame") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "cam.yaml", test::ReadFile(kCamera));
  const auto set = [&](const std::string& frames, const std::string& average_s) {
    return RunRift({"track", "--camera", frames, "--fps", "10", "--calibration",
                    folder / "cam.yaml", "--world", "first", "--force", "--world-average",
                    average_s});
  };
  const ProcessResult moving = set(kFrames, "1");
  INFO(moving.err);
  CHECK(moving.exit_code == 2);
  CHECK_THAT(moving.err, Contains("tag 0 moved by") && Contains("let the robot stand still"));
  CHECK(test::ReadFile(folder / "cam.yaml") == test::ReadFile(kCamera));
  // Standing, and for a single picture of a moving one.
  fs::create_directory(fs::path(folder / "standing"));
  for (int i = 0; i < 15; ++i) {
    fs::copy_file(kData + "/frames/000.jpg", folder / ("standing/" + std::to_string(i) + ".jpg"));
  }
  CHECK(set(folder / "standing/*.jpg", "1").exit_code == 0);
  CHECK(set(kFrames, "0").exit_code == 0);
}

TEST_CASE("A calibration of another size than the stream is refused") {
  const test::TemporaryFolder folder;
  vision::CameraModel camera = vision::ReadCamera(test::ReadFile(kCamera), kCamera);
  camera.width_px = 1920;
  camera.height_px = 1080;
  test::WriteText(folder / "cam.yaml", vision::WriteCamera(camera));
  const ProcessResult result = RunRift(Tracking(folder / "log.csv", folder / "cam.yaml"));
  CHECK(result.exit_code == 2);
  CHECK_THAT(result.err, Contains("960 x 720") && Contains("1920 x 1080"));
  CHECK_FALSE(fs::exists(folder / "log.csv"));
}

TEST_CASE("Without a display the view says so and the tracking goes on") {
  const test::TemporaryFolder folder;
  const test::Environment display("DISPLAY", "");
  const ProcessResult result = RunRift(With(Tracking(folder / "log.csv"), {"--view"}));
  CHECK(result.exit_code == 0);
  CHECK_THAT(result.err, Contains("no window: DISPLAY is not set"));
  CHECK_THAT(result.out, Contains("30 rows"));
}

TEST_CASE("What is wrong with a request for tracking is said in one line") {
  const test::TemporaryFolder folder;
  struct Wrong {
    std::vector<std::string> words;
    std::string says;
    int exit_code;
  };
  test::WriteText(folder / "bad.yaml", "camera_matrix: 3\n");
  test::WriteText(folder / "none.yaml", "tags: []\n");
  const std::string log = folder / "log.csv";
  const std::vector<Wrong> wrongs{
      // beside those of "Wrong input: rift track"
      {Tracking(log, folder / "bad.yaml"), "bad.yaml:1", 2},
      {With(Tracking(log), {"--set", "track.tag.idd=3"}), "track.tag.id", 2},
      {With(Tracking(log), {"--world", folder / "none.yaml"}), "`tags:` or `points:`", 2},
      {{"track", "--camera", "/dev/video93", "--calibration", kCamera, "--out", log},
       "unplugged: /dev/video93",
       3},
      {{"track", "--calibrate", "--board", "13by9", "--images", kData + "/frames", "--out", log},
       "such as 13x9",
       2},
      {{"track", "--calibrate", "--board", "4294967309x9", "--images", kData + "/frames", "--out",
        log},
       "--board '4294967309x9'",
       2},
  };
  for (const Wrong& wrong : wrongs) {
    const ProcessResult result = RunRift(wrong.words);
    INFO(wrong.says << ": " << result.err);
    CHECK(result.exit_code == wrong.exit_code);
    CHECK_THAT(result.err, Contains(wrong.says));
  }
  const std::string none = folder / "none.csv";
  const ProcessResult other = RunRift(With(Tracking(none), {"--id", "77"}));
  CHECK(other.exit_code == 1);
  CHECK_THAT(other.err, Contains("the tag was never seen"));
  CHECK_THAT(other.out, Contains("only other tags"));
  CHECK_FALSE(fs::exists(log));
  CHECK_FALSE(fs::exists(none));
}

TEST_CASE("A log that is there is replaced only on request, and with its run file") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "log.csv", "hours of work\n");
  const ProcessResult refused = RunRift(Tracking(folder / "log.csv"));
  CHECK(refused.exit_code == 2);
  CHECK_THAT(refused.err, Contains("is there already") && Contains("--force"));
  CHECK(test::ReadFile(folder / "log.csv") == "hours of work\n");
  CHECK(RunRift(With(Tracking(folder / "log.csv"), {"--force"})).exit_code == 0);
  CHECK_THAT(test::ReadFile(folder / "log.csv"), Catch::Matchers::StartsWith("t_s,"));
}

TEST_CASE("A camera that is not there costs nobody the log of before, nor its run file") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "log.csv", "hours of work\n");
  test::WriteText(folder / "log.run.json", "of these hours\n");
  for (const auto& [camera, exit_code] :
       {std::pair{folder / "typo.mp4", 2}, {"http://127.0.0.1:9/video", 3}}) {
    INFO(camera);
    const ProcessResult result = RunRift({"track", "--camera", camera, "--calibration", kCamera,
                                          "--out", folder / "log.csv", "--force"});
    CHECK(result.exit_code == exit_code);
    CHECK((exit_code == 2) == (result.err.find("is left as it was") == std::string::npos));
    CHECK(test::ReadFile(folder / "log.csv") == "hours of work\n");
    CHECK(test::ReadFile(folder / "log.run.json") == "of these hours\n");
  }
}

TEST_CASE("Several robots go into one log, a row each, and one of them is compared at a time") {
  const test::TemporaryFolder folder;
  // A reference tag stands in for a second robot.
  const ProcessResult result = RunRift(With(Tracking(folder / "log.csv"), {"--id", "0,10"}));
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.out, Contains("60 rows"));
  const ProcessResult gap = RunRift({"gap", kData + "/truth.csv", folder / "log.csv"});
  CHECK(gap.exit_code == 2);
  CHECK_THAT(gap.err, Contains("several robots"));
  CHECK(RunRift(With(Tracking(folder / "twice.csv"), {"--id", "3,3"})).exit_code == 2);
}

TEST_CASE("A tag that lies elsewhere than told, and a worse frame, are refused by name") {
  const test::TemporaryFolder folder;
  const std::string calibration = folder / "cam.yaml";
  test::WriteText(calibration, test::ReadFile(kCamera));
  const auto set = [&](const std::string& world) {
    return RunRift({"track", "--camera", kFrames, "--fps", "10", "--calibration", calibration,
                    "--world", world, "--world-average", "0"});
  };
  const ProcessResult kept = set("first");
  CHECK(kept.exit_code == 2);
  CHECK_THAT(kept.err, Contains("is left as it is") && Contains("--force"));
  std::string places = test::ReadFile(kData + "/tags.yaml");
  places.replace(places.find("-0.24"), 5, "-0.44");
  test::WriteText(folder / "tags.yaml", places);
  const ProcessResult wrong = set(folder / "tags.yaml");
  CHECK(wrong.exit_code == 2);
  CHECK_THAT(wrong.err, Contains("do not fit what the camera sees"));
  CHECK(test::ReadFile(calibration) == test::ReadFile(kCamera));
}

TEST_CASE("A tag of another side, height or camera place is told while it is tracked") {
  const test::TemporaryFolder folder;
  const auto said = [&](const std::vector<std::string>& more) {
    const ProcessResult result =
        RunRift(With(Tracking(folder / "log.csv"), With({"--force"}, more)));
    CHECK(result.exit_code == 0);
    return result.err;
  };
  CHECK_THAT(said({}), !Contains("not on the floor"));
  const std::string small = said({"--set", "track.tag.size_m=0.04"});
  CHECK_THAT(small, Contains("the tag is not on the floor in 10 of 10 pictures"));
  const size_t at = small.find("track.tag.size_m=") + 17;
  CHECK(std::stod(small.substr(at, 6)) == Approx(0.0475).margin(0.0002));
  CHECK_THAT(small, Contains(", its height 0.1"));
  const std::string large = said({"--set", "track.tag.size_m=0.06"});
  CHECK_THAT(large, Contains("size_m=0.047") && !Contains("its height"));
  CHECK_THAT(said({"--set", "track.tag.size_m=0.04", "--set", "track.tag.ground=free"}),
             !Contains("not on the floor"));
}

TEST_CASE("A tag that is never seen is answered with those that are") {
  const test::TemporaryFolder folder;
  const auto said = [&](const std::vector<std::string>& more) {
    const ProcessResult result = RunRift(With(Tracking(folder / "log.csv"), more));
    CHECK(result.exit_code == 1);
    return result.err;
  };
  CHECK_THAT(said({"--id", "5"}), Contains("tag36h11 id 0 (--id 0)"));
  CHECK_THAT(said({"--set", "track.tag.family=tag25h9"}),
             Contains("tag36h11 id 0 (--set track.tag.family=tag36h11 --id 0)"));
  CHECK_THAT(RunRift(With(Tracking(folder / "log.csv"), {"--id", "600"})).err,
             Contains("tag id 600: the family tag36h11 has the ids 0 to 586"));
}

TEST_CASE("Tags of any family and chessboards are written to be printed") {
  const test::TemporaryFolder folder;
  const std::string sheet = folder / "tag.svg";
  const auto print = [&](const std::vector<std::string>& more) {
    return RunRift(With({"track", "--print-tag", sheet}, more));
  };
  REQUIRE(print({}).exit_code == 0);
  CHECK(test::ReadFile(sheet) == test::ReadFile(kData + "/print/tag36h11_0.svg"));
  CHECK(print({}).exit_code == 2);
  const ProcessResult other = print({"--force", "--set", "track.tag.family=tag16h5", "--id", "7",
                                     "--set", "track.tag.size_m=0.06"});
  CHECK_THAT(other.err, Contains("tag16h5 id 7, side 0.06 m"));
  CHECK(test::ReadFile(sheet) == vision::TagSheet(7, 0.06, vision::TagFamily::k16h5));
  CHECK(print({"--force", "--id", "600"}).exit_code == 2);
  CHECK(print({"--force", "--camera", kFrames}).exit_code == 2);
  CHECK(RunRift({"track", "--print-tag", folder / "tag.png"}).exit_code == 2);
  const std::string board = folder / "board.svg";
  REQUIRE(RunRift({"track", "--print-board", board}).exit_code == 0);
  CHECK(test::ReadFile(board) == test::ReadFile(kData + "/print/chessboard_13x9_25mm.svg"));
}

TEST_CASE("Help and the gap load no camera library") {
  const test::TemporaryFolder folder;
  for (const bool gap : {false, true}) {
    const test::Environment debug("LD_DEBUG", "files");
    const test::Environment into("LD_DEBUG_OUTPUT", folder / (gap ? "gap" : "help"));
    const std::vector<std::string> words =
        gap ? std::vector<std::string>{"gap", kData + "/truth.csv", kData + "/truth.csv"}
            : std::vector<std::string>{"track", "--help"};
    REQUIRE(RunRift(words).exit_code == 0);
  }
  int files = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.Path())) {
    const std::string text = test::ReadFile(entry.path().string());
    ++files;
    CHECK_THAT(text, Contains("libc.so.6"));
    CHECK_THAT(text, !Contains("opencv") && !Contains("apriltag"));
  }
  CHECK(files == 2);
}

TEST_CASE("A log replaces no picture of its camera, with force neither, however it is named") {
  const test::TemporaryFolder folder;
  std::filesystem::copy(kData + "/frames", folder / "frames");
  const std::string picture = folder / "frames/000.jpg", before = test::ReadFile(picture);
  for (const char* camera : {"frames", "frames/", "frames/*", "frames/0??.jpg", "fra*/*.jpg"}) {
    for (const bool is_log : {true, false}) {
      std::vector<std::string> words{"track",         "--camera", folder / camera,
                                     "--calibration", kCamera,    "--force"};
      const std::string log = is_log ? picture : folder / "log.csv";
      words.insert(words.end(), {"--out", log});
      if (!is_log) words.insert(words.end(), {"--tum", picture});
      const ProcessResult result = RunRift(words);
      INFO(camera << ": " << result.err);
      CHECK(result.exit_code == 2);
      CHECK(test::ReadFile(picture) == before);
    }
  }
}

}  // namespace
}  // namespace rift
