// A tracking run without its camera: what it is asked for, its names, its log.
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "rift/files/files.hpp"
#include "rift/report/json/json.hpp"
#include "rift/sessions/track/tracking.hpp"
#include "rift/trajectory/log.hpp"
#include "sessions/track/log.hpp"
#include "sessions/track/window.hpp"
#include "support/processes/environment.hpp"
#include "support/processes/process.hpp"

namespace rift::sessions {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

TrackingJob JobWith(std::string TrackingJob::*member, const std::string& value) {
  TrackingJob job;
  job.*member = value;
  return job;
}

TEST_CASE("What is said of tracking stands in the place of the experiment's, and nothing else") {
  experiment::Experiment experiment;
  experiment.track.capture.fps = 30.0;
  experiment.track.capture.times = "own";
  experiment.track.tag.id = 3;
  experiment.track.tag.height_m = 0.07;
  const experiment::TrackOptions own = TrackingJob().OptionsFor(experiment);
  CHECK(own.capture.fps == 30.0);
  CHECK(own.capture.times == "own");
  CHECK(own.tag.id == 3);
  CHECK(own.tag.height_m == 0.07);
  TrackingJob job;
  job.fps = 15.0;
  CHECK(job.OptionsFor(experiment).capture.fps == 15.0);
  CHECK(job.OptionsFor(experiment).capture.times == "own");
  job.times = "exif";
  CHECK(job.OptionsFor(experiment).capture.times == "exif");
  job.ids = {8, 9};
  CHECK(job.OptionsFor(experiment).tag.id == 8);
  job.tag_height_m = 0.0;
  CHECK(job.OptionsFor(experiment).tag.height_m == 0.0);
}

TEST_CASE("A log has its run file beside it, and - is a pipe") {
  CHECK(RunFileOf("out/a.csv") == "out/a.run.json");
  CHECK(RunFileOf("out/a.b.csv") == "out/a.b.run.json");
  CHECK(JobWith(&TrackingJob::log, "-").IsPiped());
  CHECK_FALSE(JobWith(&TrackingJob::log, "a.csv").IsPiped());
  CHECK_FALSE(TrackingJob().IsPiped());
}

struct Names {
  test::TemporaryFolder folder;
  TrackingJob job;

  Names() {
    job.camera = folder / "frames/*.jpg";
    job.calibration = folder / "camera.yaml";
    job.log = folder / "log.csv";
    fs::create_directories(folder / "frames");
    for (const char* name : {"camera.yaml", "world.yaml", "path.csv", "frames/000.jpg"}) {
      test::WriteText(folder / name, "x");
    }
  }
  void Check(const std::vector<fs::path>& inputs = {},
             const std::vector<fs::path>& copies = {}) const {
    CheckNames(job, inputs, copies);
  }
};

TEST_CASE("The log of a tracking run is no input, whichever it is") {
  Names names;
  CHECK_NOTHROW(names.Check());
  names.job.force = true;
  names.job.world = names.folder / "world.yaml";
  names.job.path = names.folder / "path.csv";
  for (const char* input : {"camera.yaml", "world.yaml", "path.csv"}) {
    INFO(input);
    names.job.log = names.folder / input;
    CHECK_THROWS_WITH(names.Check(), Contains(input) && Contains("is an input"));
  }
  names.job.log = names.folder / "own.yaml";
  test::WriteText(names.folder / "own.yaml", "x");
  CHECK_THROWS_WITH(names.Check({names.folder / "own.yaml"}), Contains("is an input"));
  names.job.camera = names.folder / "video.avi";
  names.job.log = names.folder / "video.avi";
  test::WriteText(names.folder / "video.avi", "x");
  CHECK_THROWS_WITH(names.Check(), Contains("is an input"));
}

TEST_CASE("A log is no picture of its camera's pattern, but may lie beside them") {
  Names names;
  names.job.log = names.folder / "frames/001.jpg";
  CHECK_THROWS_WITH(names.Check(),
                    "--out " + names.job.log + " is one of the camera's pictures: name a log");
  names.job.log = names.folder / "frames/log.csv";
  CHECK_NOTHROW(names.Check());
  names.job.log = names.folder / "log.jpg";
  CHECK_NOTHROW(names.Check());
  names.job.camera = names.folder / "frames/000.jpg";
  names.job.log = names.folder / "frames/001.jpg";
  CHECK_NOTHROW(names.Check());
}

TEST_CASE("Log, recorded waypoints, copies and run file are files of their own") {
  Names names;
  names.job.record_waypoints = names.folder / "log.csv";
  CHECK_THROWS_WITH(names.Check(), Contains("another output"));
  names.job.record_waypoints = names.folder / "way.yaml";
  CHECK_NOTHROW(names.Check());
  CHECK_THROWS_WITH(names.Check({}, {names.folder / "way.yaml"}), Contains("another output"));
  CHECK_THROWS_WITH(names.Check({}, {names.folder / "log.run.json"}), Contains("log.run.json"));
  CHECK_THROWS_WITH(names.Check({names.folder / "log.run.json"}), Contains("log.run.json"));
  CHECK_NOTHROW(names.Check({}, {names.folder / "log.mcap"}));
  names.job.log = "-";  // a run file that is nobody's
  CHECK_NOTHROW(names.Check({}, {"-.run.json"}));
}

TEST_CASE("A log that is there is replaced with force alone, and a folder is no log") {
  Names names;
  test::WriteText(names.job.log, "x");
  CHECK_THROWS_WITH(names.Check(), Contains("log.csv"));
  names.job.force = true;
  CHECK_NOTHROW(names.Check());
  names.job.log = names.folder.Path().string();
  CHECK_THROWS_WITH(names.Check(), Contains("the log needs a file"));
  names.job.force = false;
  names.job.log = names.folder / "new.csv";
  test::WriteText(names.folder / "new.run.json", "of a camera that showed no tag");
  CHECK_NOTHROW(names.Check());
}

vision::Sighting Seen(int tag, double x_m = 0.0) {
  vision::Sighting sighting{.tag_id = tag};
  sighting.map_from_tag.translation() = Eigen::Vector3d(x_m, 0.5, 0.1);
  return sighting;
}

size_t Lines(const fs::path& path) {
  const std::string text = files::ReadIfThere(path).value_or("");
  return std::count(text.begin(), text.end(), '\n');
}

TEST_CASE("A log appears with its first sighting and holds every row once it is closed") {
  const test::TemporaryFolder folder;
  const fs::path path = folder / "new/log.csv";
  {
    TrackLog none(path, {});
    none.Close();
  }
  CHECK_FALSE(fs::exists(path.parent_path()));
  TrackLog log(path, {});
  CHECK(log.Add(0.1, Seen(0)));
  REQUIRE(fs::exists(path));
  CHECK(Lines(path) == 0);  // rows wait half a second of the log
  CHECK(log.Add(0.49, Seen(0)));
  CHECK(Lines(path) == 0);
  CHECK(log.Add(0.5, Seen(0)));
  CHECK(Lines(path) == 4);
  CHECK(log.Add(0.9, Seen(0)));
  CHECK(Lines(path) == 4);
  log.Close();
  std::string expected = report::SightingsHeader();
  for (const double t_s : {0.1, 0.49, 0.5, 0.9}) expected += report::SightingRow(t_s, Seen(0));
  CHECK(files::ReadFile(path) == expected);
  log.Close();  // nothing more
  CHECK(files::ReadFile(path) == expected);
}

TEST_CASE("Rows that wait are written every half second of the log, counted from the last time") {
  const test::TemporaryFolder folder;
  TrackLog log(folder / "log.csv", {});
  log.Add(10.0, Seen(0));
  CHECK(Lines(folder / "log.csv") == 2);
  log.Add(10.4, Seen(0));
  CHECK(Lines(folder / "log.csv") == 2);
  log.Add(10.6, Seen(0));
  CHECK(Lines(folder / "log.csv") == 4);
  log.Add(11.0, Seen(0));
  CHECK(Lines(folder / "log.csv") == 4);
}

TEST_CASE("A sighting that is not later than the one before of its tag is left out") {
  const test::TemporaryFolder folder;
  {
    TrackLog log(folder / "log.csv", {});
    CHECK(log.Add(1.0, Seen(4)));
    CHECK_FALSE(log.Add(1.0, Seen(4)));
    CHECK_FALSE(log.Add(0.9, Seen(4)));
    CHECK(log.Add(0.9, Seen(5)));  // of another robot
    CHECK(log.Add(1.1, Seen(4)));
    CHECK_FALSE(log.Add(1.05, Seen(4)));
  }
  CHECK(Lines(folder / "log.csv") == 4);  // written at its end without Close
}

TEST_CASE("A piped log is printed row by row, the header once, and makes no file") {
  std::vector<std::string> printed;
  TrackLog log("-", [&](std::string_view rows) { printed.emplace_back(rows); });
  CHECK(log.Add(1.0, Seen(4)));
  CHECK_FALSE(log.Add(1.0, Seen(4)));
  CHECK(log.Add(1.1, Seen(4, 2.0)));
  REQUIRE(printed.size() == 2);
  CHECK(printed[0] == report::SightingsHeader() + report::SightingRow(1.0, Seen(4)));
  CHECK(printed[1] == report::SightingRow(1.1, Seen(4, 2.0)));
  log.Close();
  CHECK_FALSE(fs::exists("-"));
}

TEST_CASE("A log that was moved away is said and not written elsewhere") {
  const test::TemporaryFolder folder;
  TrackLog log(folder / "log.csv", {});
  log.Add(1.0, Seen(0));
  fs::rename(folder / "log.csv", folder / "other.csv");
  log.Add(1.1, Seen(0));
  CHECK_THROWS_AS(log.Add(2.0, Seen(0)), std::runtime_error);
  CHECK_FALSE(fs::exists(folder / "log.csv"));
}

TEST_CASE("The window shows the path of a log or of waypoints, and keeps recorded ones in a file") {
  const test::TemporaryFolder folder;
  CHECK(ContentOf(TrackingJob()).path_m.empty());
  CHECK_FALSE(ContentOf(TrackingJob()).save);
  test::WriteText(folder / "path.csv", "t_s,x_m,y_m,yaw_rad\n0,1,2,0\n1,1.5,2.25,0\n");
  const auto of_log = ContentOf(JobWith(&TrackingJob::path, folder / "path.csv"));
  REQUIRE(of_log.path_m.size() == 2);
  CHECK(of_log.path_m[1] == Eigen::Vector2d(1.5, 2.25));
  CHECK(of_log.planned.empty());
  test::WriteText(folder / "way.yaml",
                  "waypoints: [{name: a, x: 0.5, y: 0.25, heading: 0}, {x: 1, y: 0.75}]\n");
  const auto of_way = ContentOf(JobWith(&TrackingJob::path, folder / "way.yaml"));
  REQUIRE(of_way.path_m.size() == 2);
  CHECK(of_way.path_m[0] == Eigen::Vector2d(0.5, 0.25));
  REQUIRE(of_way.planned.size() == 2);
  CHECK(of_way.planned[0].name == "a");
  const auto recorded = ContentOf(JobWith(&TrackingJob::record_waypoints, folder / "new.yaml"));
  REQUIRE(recorded.save);
  recorded.save(of_way.planned);
  CHECK(files::ReadFile(folder / "new.yaml") == report::WaypointsYaml(of_way.planned));
}

TEST_CASE("Without a display tracking goes on, and waypoints that cannot be made are told") {
  const test::Environment display("DISPLAY", "");
  std::vector<std::string> told;
  const TrackingListener listener{.say = [&](const std::string& line) { told.push_back(line); }};
  const auto window = [&](const TrackingJob& tracking) {
    told.clear();
    return WindowFor(tracking, listener, {}, {0}, {});
  };
  TrackingJob job;
  CHECK_FALSE(window(job));
  CHECK(told.empty());
  job.view = true;
  CHECK_FALSE(window(job));
  REQUIRE(told.size() == 1);
  CHECK_THAT(told[0], Catch::EndsWith("; tracking goes on without"));
  job = {};
  job.record_waypoints = "way.yaml";
  CHECK_FALSE(window(job));
  REQUIRE(told.size() == 1);
  CHECK_THAT(told[0], Catch::EndsWith("; tracking goes on without, no waypoints can be recorded"));
}

}  // namespace
}  // namespace rift::sessions
