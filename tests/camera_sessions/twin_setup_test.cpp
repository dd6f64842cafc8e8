// The twin before it is served: its folder, its simulation, its camera, and what is said of it.
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "rift/files/files.hpp"
#include "rift/sessions/simulate/twin.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"
#include "rift/vision/camera/camera_file.hpp"
#include "support/inputs/paper_task.hpp"
#include "support/processes/process.hpp"

namespace rift::sessions {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

experiment::Experiment SeededTask() {
  experiment::Experiment experiment = test::PaperTask();
  experiment.seed = 9;
  return experiment;
}

PreparedTwin Prepare(const experiment::Experiment& experiment, const fs::path& folder) {
  const sweep::Inputs inputs{[](const std::string& path) { return files::ReadIfThere(path); },
                             [](const std::string&) {}};
  return PrepareTwin(experiment, "paper.yaml", folder, inputs);
}

TEST_CASE("Every file of a twin's folder keeps another twin out, and none is an input") {
  for (const char* name :
       {"experiment.yaml", "camera.yaml", "truth.csv", "trajectory.csv", "summary.json"}) {
    const test::TemporaryFolder folder;
    INFO(name);
    CHECK_NOTHROW(CheckTwinNames(folder.Path(), {}, false));
    CHECK_THROWS_WITH(CheckTwinNames(folder.Path(), {folder / name}, true),
                      Contains(name) && Contains("is an input"));
    test::WriteText(folder / name, "of another twin");
    CHECK_THROWS_WITH(CheckTwinNames(folder.Path(), {}, false), Contains(name));
    CHECK_NOTHROW(CheckTwinNames(folder.Path(), {}, true));
  }
}

TEST_CASE("A twin begins with its tag on the first waypoint and the seed, and its files say so") {
  const test::TemporaryFolder folder;
  experiment::Experiment experiment = SeededTask();
  experiment.track.tag.family = vision::TagFamily::k25h9;
  experiment.simulation.mocap.exposure_s = 0.004;
  experiment.simulation.mocap.tag_ahead_m = -0.03;
  experiment.twin.fps = 20.0;
  const PreparedTwin prepared = Prepare(experiment, folder.Path());
  CHECK(prepared.folder == folder.Path());
  CHECK(prepared.setup.seed == 9);
  CHECK(prepared.setup.start.x_m == Approx(-0.2822 + 0.03 * std::cos(geometry::RadFromDeg(0.9))));
  CHECK(prepared.setup.start.y_m == Approx(-0.0655 - 0.03 * std::sin(geometry::RadFromDeg(0.9))));
  CHECK(prepared.setup.start.yaw_rad == Approx(geometry::RadFromDeg(-0.9)));
  CHECK(prepared.setup.look.tag_family == vision::TagFamily::k25h9);
  CHECK(prepared.setup.look.shutter_s == 0.004);
  CHECK(prepared.setup.twin.fps == 20.0);
  CHECK(prepared.Calibration() == folder.Path() / "camera.yaml");
  const std::string saved = files::ReadFile(folder / "experiment.yaml");
  CHECK(saved == experiment::WriteExperiment(prepared.experiment));
  // The simulation as the twin runs it, so that the saved experiment repeats it.
  const simulation::SimulationOptions as_twin =
      twin::AsTwin(experiment.simulation, experiment.twin);
  CHECK(prepared.setup.simulation.mocap.rate_hz == as_twin.mocap.rate_hz);
  CHECK(prepared.experiment.simulation.mocap.rate_hz == 20.0);
  const vision::CameraModel camera =
      vision::ReadCamera(files::ReadFile(prepared.Calibration()), "camera.yaml");
  REQUIRE(camera.world);
  CHECK(camera.width_px == prepared.setup.camera.width_px);
}

TEST_CASE("A twin is the robot of its seed's draw, and its saved experiment is that robot alone") {
  const test::TemporaryFolder folder;
  experiment::Experiment experiment = SeededTask();
  experiment.simulation.motor.mismatch = 0.5;
  experiment.ensemble = {.keys = {"simulation.motor.mismatch"}, .draws = {{0.01}, {-0.02}}};
  bool is_first = false, is_second = false;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8}) {
    INFO("seed " << seed);
    experiment.seed = seed;
    const PreparedTwin prepared = Prepare(experiment, folder.Path());
    // As `rift simulate` drives it with this seed.
    const double drawn =
        sweep::SimulatedTrialOf(experiment, {}, seed, "paper.yaml", {}).simulation.motor.mismatch;
    CHECK(prepared.setup.simulation.motor.mismatch == drawn);
    is_first = is_first || drawn == 0.01;
    is_second = is_second || drawn == -0.02;
    const experiment::Experiment saved =
        experiment::LoadExperiment(folder / "experiment.yaml", {}, files::ReadFile);
    CHECK(saved.simulation.motor.mismatch == drawn);
    CHECK(saved.ensemble.IsEmpty());
  }
  CHECK(is_first);
  CHECK(is_second);
}

TEST_CASE("A twin's address is one line of JSON with an absolute calibration") {
  PreparedTwin prepared;
  prepared.folder = "out/twin";
  const std::string line = AddressJson(prepared, {"/dev/pts/7", "http://127.0.0.1:8080/video"});
  CHECK(line.back() == '\n');
  CHECK(std::count(line.begin(), line.end(), '\n') == 1);
  const auto said = nlohmann::json::parse(line);
  CHECK(said["port"] == "/dev/pts/7");
  CHECK(said["camera"] == "http://127.0.0.1:8080/video");
  CHECK(said["calibration"] == (fs::current_path() / "out/twin/camera.yaml").string());
}

TEST_CASE("A twin says whether its robot drove and whether it ended by itself") {
  CHECK(EndingOf({.is_over = true, .has_driven = true}) == "the robot drove and stood still again");
  CHECK(EndingOf({.has_driven = true}) ==
        "ended from outside while the robot drove or shortly after");
  CHECK(EndingOf({}) == "ended from outside before the robot drove");
}

TEST_CASE("A twin that is ended before it drove leaves its whole folder, made again if removed") {
  const bool is_removed = GENERATE(false, true);
  const test::TemporaryFolder folder;
  const fs::path out = folder / "twin";
  const PreparedTwin prepared = Prepare(SeededTask(), out);
  const std::string setup = files::ReadFile(out / "experiment.yaml");
  bool is_announced = false;
  const twin::TwinRun run = ServeTwin(
      prepared,
      [&](const twin::TwinAddress&) {
        is_announced = true;
        if (is_removed) fs::remove_all(out);
      },
      [&] { return is_announced; });
  CHECK(is_announced);
  CHECK_FALSE(run.has_driven);
  for (const char* name :
       {"experiment.yaml", "camera.yaml", "truth.csv", "trajectory.csv", "summary.json"}) {
    INFO(name);
    CHECK(fs::exists(out / name));
  }
  CHECK(files::ReadFile(out / "experiment.yaml") == setup);
  const auto summary = nlohmann::json::parse(files::ReadFile(out / "summary.json"));
  CHECK(summary["name"] == "paper");
  CHECK(summary["seed"] == 9);
  CHECK(summary["ending"] == "ended from outside before the robot drove");
  CHECK(summary["has_driven"] == false);
  CHECK(summary["true_path_length_m"].get<double>() < 0.01);
  CHECK(summary["robot_stopped_by_itself"] == run.stops);
  CHECK(summary["robot_rejected"] == run.rejected);
  CHECK(summary["pictures"] == run.pictures);
  CHECK(summary["skipped_s"] == run.skipped_s);
  CHECK(summary["began_steady_s"] == run.began_s);
  CHECK(summary["picture_cpu_s"] == run.picture_cpu_s);
  CHECK(summary["picture_late_p99_s"] == run.picture_late_p99_s);
}

}  // namespace
}  // namespace rift::sessions
