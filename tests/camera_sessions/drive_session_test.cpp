// Drives before and after they are made: their plan, their start, the command before each, and a
// drive seen again.
#include <fcntl.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include "rift/files/files.hpp"
#include "rift/sessions/drive/identification.hpp"
#include "rift/sessions/drive/plan.hpp"
#include "rift/sessions/drive/replay.hpp"
#include "rift/sessions/drive/series.hpp"
#include "rift/sessions/drive/session.hpp"
#include "rift/sessions/sweep/suggested.hpp"
#include "rift/trajectory/log.hpp"
#include "sessions/drive/before_each.hpp"
#include "sessions/drive/start_gate.hpp"
#include "support/inputs/paper_task.hpp"
#include "support/processes/process.hpp"
#include "support/until.hpp"

namespace rift::sessions {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

TEST_CASE("A drive without port, camera or calibration is refused, and nothing is written") {
  const test::TemporaryFolder folder;
  DriveSetup setup{.yes = true};
  DriveSession session(setup, {});
  CHECK_THROWS_WITH(session.DriveInto(folder / "run", test::PaperTask()),
                    Contains("--port, --camera, --calibration are missing, and --before-each told "
                             "none: name them"));
  session.MoveTo({.port = "/dev/x", .camera = "/dev/y"});
  CHECK_THROWS_WITH(session.DriveInto(folder / "run", test::PaperTask()),
                    Contains("--calibration is missing, and --before-each told none: name it"));
  CHECK_FALSE(fs::exists(folder / "run"));
}

TEST_CASE("The segments of an identification are those that its fit was tried with") {
  const std::vector<control::Segment> segments =
      IdentificationDrive(test::PaperTask()).program.segments;
  // {way in m or turn in degrees, power} without the holds between them.
  const std::vector<std::pair<double, double>> motions{
      {0.20, 0.15}, {-0.20, 0.20}, {0.30, 0.30},  {-0.30, 0.45},  // straight
      {180, 0.15},  {-180, 0.15},  {360, 0.30},   {-360, 0.30},   // on the spot
      {90, 0.20},   {-90, 0.30},   {-0.30, 0.25}, {-90, 0.20},   {90, 0.30}, {-0.20, 0.20}};
  size_t motion = 0;
  for (size_t i = 0; i < segments.size(); ++i) {
    INFO("segment " << i);
    const control::Segment& segment = segments[i];
    if (segment.hold_s) {
      CHECK(*segment.hold_s == 1.0);
      CHECK_FALSE(segment.power);
      continue;
    }
    REQUIRE(motion < motions.size());
    CHECK(segment.straight_m.value_or(segment.turn_deg.value_or(0.0)) == motions[motion].first);
    CHECK(segment.power == motions[motion].second);
    const bool is_arc = segment.turn_deg && std::abs(*segment.turn_deg) == 90.0;
    CHECK(segment.radius_m.has_value() == is_arc);
    if (is_arc) CHECK(*segment.radius_m == 0.12);
    ++motion;
  }
  CHECK(motion == motions.size());
  CHECK(segments.size() == 2 * motions.size() - 1);  // a hold between each two
}

TEST_CASE("An identification keeps the first waypoint and rests long enough, longer where it was") {
  experiment::Experiment task = test::PaperTask();
  const experiment::Experiment drive = IdentificationDrive(task);
  CHECK(drive.name == "paper_identify");
  CHECK(drive.waypoints.size() == 1);
  CHECK(drive.program.rest_s == 1.5);
  CHECK(drive.trial.settle_s == std::max(1.0, task.trial.settle_s));
  CHECK(drive.trial.timeout_s == std::max(120.0, task.trial.timeout_s));
  task.trial.settle_s = 2.0;
  task.trial.timeout_s = 200.0;
  task.waypoints.clear();
  const experiment::Experiment longer = IdentificationDrive(task);
  CHECK(longer.trial.settle_s == 2.0);
  CHECK(longer.trial.timeout_s == 200.0);
  CHECK(longer.waypoints.empty());
  task.trial.settle_s = 0.0;
  task.trial.timeout_s = 1.0;
  CHECK(IdentificationDrive(task).trial.settle_s == 1.0);
  CHECK(IdentificationDrive(task).trial.timeout_s == 120.0);
}

TEST_CASE("What an identification fits has these ranges and is known so well beside the logs") {
  const auto fit = IdentificationFit(test::PaperTask()).calibrate.fit.list;
  struct Free {
    std::string key;
    double min, max, mean, sd;
  };
  const std::vector<Free> expected{
      {"simulation.link.delay_s", 0.0, 0.20, 0.05, 0.05},
      {"simulation.motor.supply_ratio", 0.6, 1.7, 1.2, 0.25},
      {"simulation.motor.friction_torque_nm", 0.0, 0.003, 0.0019, 0.0008},
      {"simulation.motor.mismatch", -0.10, 0.10, 0.0, 0.04},
      {"simulation.body.caster_mu", 0.0, 0.5, 0.15, 0.1}};
  REQUIRE(fit.size() == expected.size());
  for (size_t i = 0; i < fit.size(); ++i) {
    CHECK(fit[i].key == expected[i].key);
    CHECK(fit[i].min == expected[i].min);
    CHECK(fit[i].max == expected[i].max);
    CHECK(fit[i].prior_mean == expected[i].mean);
    CHECK(fit[i].prior_sd == expected[i].sd);
  }
}

TEST_CASE(
    "A series is whatever of its four flags was given, and what comes next says the command") {
  CHECK_FALSE(SeriesRequest{}.IsSeries());
  CHECK(SeriesRequest{.repeat = 1}.IsSeries());
  CHECK(SeriesRequest{.grid = true}.IsSeries());
  CHECK(SeriesRequest{.identify = true}.IsSeries());
  CHECK(SeriesRequest{.suggested = "out"}.IsSeries());
  CHECK_FALSE(SeriesRequest{.before_each = "reset"}.IsSeries());
  CHECK(PlanSeries({.grid = true}, test::PaperTask(), "/out").next.empty());
  const SeriesPlan repeats = PlanSeries({.repeat = 2}, test::PaperTask(), "/out");
  CHECK(repeats.next == "against the simulator: rift sweep /out/sweep.yaml --out /out/sweep");
  REQUIRE(repeats.trials.size() == 2);
  CHECK(repeats.trials[1].label == "trial 2");
  CHECK(repeats.trials[1].trial == "2");
  CHECK(repeats.trials[1].Unfinished() == "/out/2.unfinished");
  CHECK(repeats.parameters.empty());
  CHECK(repeats.sweep.goal == experiment::Goal::kGrid);
  CHECK(repeats.sweep.reference.tag_offset_m == 0.0);
  CHECK(repeats.sweep.reference.format == trajectory::Format::kRift);
  const SeriesPlan identify = PlanSeries({.identify = true}, test::PaperTask(), "/out");
  CHECK(identify.next ==
        "fit the simulated robot: rift sweep /out/sweep.yaml --out /out/sweep --write-robot "
        "/out/robot.yaml");
  CHECK(identify.trials.size() == 5);
  CHECK(identify.sweep.goal == experiment::Goal::kCalibrate);
  CHECK(PlanSeries({.repeat = 3, .identify = true}, test::PaperTask(), "/out").trials.size() == 3);
}

TEST_CASE("Suggested experiments are driven as often as they say, into folders of their sweep") {
  const test::TemporaryFolder folder;
  experiment::Experiment experiment = test::PaperTask();
  experiment.space.parameters = {
      {.key = "simulation.terrain.surface", .levels = {{"ground", {}}, {"parchment", {}}}},
      {.key = "control.v_min", .min = 0.1, .max = 0.2}};
  const SeriesRequest request{.suggested = folder.Path().string()};
  CHECK_THROWS_WITH(PlanSeries(request, experiment, "/elsewhere"),
                    (folder / "suggested.yaml") + " has no experiments to drive: rift sweep " +
                        (folder / "experiment.yaml") + " --out " + folder.Path().string() +
                        " --suggest 3 writes them");
  test::WriteText(folder / "suggested.yaml",
                  "experiments:\n"
                  "  - {set: {simulation.terrain.surface: parchment, control.v_min: 0.16}, "
                  "repeats: 2, predicted: fails}\n"
                  "  - {set: {simulation.terrain.surface: ground, control.v_min: 0.2}, repeats: 1, "
                  "predicted: holds}\n");
  const SeriesPlan plan = PlanSeries(request, experiment, "/elsewhere");
  CHECK(plan.next == "what they confirm: rift sweep " + (folder / "experiment.yaml") + " --out " +
                         folder.Path().string());
  REQUIRE(plan.trials.size() == 3);
  CHECK(plan.has_floors);
  // Ground is the first floor of the space.
  CHECK(plan.trials[0].folder == folder.Path() / "suggested/2_1");
  CHECK(plan.trials[0].label == "experiment 2 (surface ground, v_min 0.2), trial 1");
  CHECK(plan.trials[1].folder == folder.Path() / "suggested/1_1");
  CHECK(plan.trials[2].folder == folder.Path() / "suggested/1_2");
  CHECK(plan.trials[2].trial == "2");
  CHECK(plan.trials[2].experiment.control.v_min == 0.16);
  CHECK(plan.trials[2].experiment.simulation.terrain.surface == "parchment");
  CHECK(plan.parameters.size() == 2);
}

TEST_CASE("A grid that is no grid to drive is refused with its name and why") {
  experiment::Experiment experiment = test::PaperTask();
  experiment.goal = experiment::Goal::kFalsify;
  CHECK_THROWS_WITH(PlanGrid(experiment, "/out"),
                    "paper: only goal: grid has a table of settings to drive");
  experiment = test::PaperTask();
  experiment.candidate.kind = experiment::CandidateKind::kLogs;
  CHECK_THROWS_WITH(
      PlanGrid(experiment, "/out"),
      "paper: candidate.kind is logs, and a grid is driven to be held against the simulator");
  experiment = test::PaperTask();
  experiment.space.parameters = {{.key = "simulation.motor.lag_s",
                                  .levels = {experiment::NumberValue(0.1)},
                                  .origin = "task.yaml:7"}};
  CHECK_THROWS_WITH(PlanGrid(experiment, "/out"),
                    "task.yaml:7: simulation.motor.lag_s changes the simulator and no robot: of "
                    "simulation, a grid that is driven may vary terrain.surface alone");
  experiment.space.parameters = {
      {.key = "control.v_max", .levels = {experiment::NumberValue(0.3)}}};
  experiment.reference.trials.names = {"a/b"};
  CHECK_THROWS_WITH(PlanGrid(experiment, "/out"),
                    "'v_max0.3_a/b' is no folder name: name the trials and levels without '/' and "
                    "a leading '.'");
  auto& surfaces = experiment.simulation.terrain.surfaces;
  surfaces[".dark"] = surfaces.at("ground");
  experiment.space.parameters = {{.key = "simulation.terrain.surface", .levels = {{".dark", {}}}}};
  experiment.reference.trials.names = {"1"};
  CHECK_THROWS_WITH(PlanGrid(experiment, "/out"),
                    "'.dark_1' is no folder name: name the trials and levels without '/' and a "
                    "leading '.'");
}

/// A person who answers with one key.
Console Answering(char key, std::vector<std::string>& told) {
  return {.say = [&told](const std::string& line) { told.push_back(line); },
          .ask = [key](const std::string&, std::string_view) { return key; }};
}

TEST_CASE(
    "A series tells of each drive that is left, counts those done, and goes on with the next") {
  const test::TemporaryFolder folder;
  fs::create_directories(folder / "2");
  for (const char* name : {"1.unfinished", "3.unfinished"}) fs::create_directories(folder / name);
  std::vector<std::string> told;
  CHECK(DriveAll({folder.Path(), PlanRepeats(test::PaperTask(), 3, folder.Path())},
                 Answering('s', told), [] {}) == SeriesEnd::kLeft);
  CHECK(told == std::vector<std::string>{
                    "3 drives into " + folder.Path().string() + ", 1 of them done",
                    "drive 1 of 3: trial 1", "drive 3 of 3: trial 3",
                    "2 of 3 drives did not reach the end; the same command asks about them again"});
}

TEST_CASE("An earlier try is set aside under the next number before the drive is made again") {
  const test::TemporaryFolder folder;
  std::vector<std::string> told;
  Console console = Answering('a', told);
  console.show = [](const std::string&) {};
  console.hide = console.ring = [] {};
  DriveSeries series{folder.Path(), PlanRepeats(test::PaperTask(), 1, folder.Path())};
  series.setup.yes = true;
  series.setup.address = {"/dev/none", "none", folder / "none.yaml"};
  for (int tries = 1; tries <= 2; ++tries) {
    fs::create_directories(folder / "1.unfinished");
    test::WriteText(folder / "1.unfinished/trajectory.csv", std::to_string(tries));
    // There is no calibration: the drive itself cannot begin.
    CHECK_THROWS_WITH(DriveAll(series, console, [] {}), Contains("none.yaml"));
    CHECK_FALSE(fs::exists(folder / "1.unfinished"));
  }
  CHECK(files::ReadFile(folder / "1.unfinished1/trajectory.csv") == "1");
  CHECK(files::ReadFile(folder / "1.unfinished2/trajectory.csv") == "2");
  CHECK_FALSE(fs::exists(folder / "1"));
}

TEST_CASE(
    "What a drive depends on keeps another series out, what may change from day to day does not") {
  const test::TemporaryFolder folder;
  fs::create_directories(folder / "1");
  std::vector<std::string> told;
  const auto drive = [&](const experiment::Experiment& experiment) {
    DriveAll({folder.Path(), PlanRepeats(experiment, 1, folder.Path())}, Answering('q', told),
             [] {});
  };
  const experiment::Experiment first = test::PaperTask();
  drive(first);
  experiment::Experiment next = first;
  next.hardware.line.baud = 9600;
  next.track.tag.id = 7;
  next.name = "other";
  CHECK_NOTHROW(drive(next));
  experiment::Experiment slower = first;
  slower.trial.timeout_s = 77.0;
  CHECK_THROWS_WITH(drive(slower), Contains("trial.timeout_s was") && Contains("and is 77 now"));
  experiment::Experiment moved = first;
  moved.waypoints.back().x_m += 0.1;
  CHECK_THROWS_WITH(drive(moved), Contains("waypoints"));
  experiment::Experiment other_floor = first;
  other_floor.simulation.terrain.surface = "parchment";
  CHECK_THROWS_WITH(drive(other_floor), Contains("space"));
}

TEST_CASE("An address takes what a scene says and leaves the rest as it was") {
  const DriveAddress all =
      AddressOf(R"({"port": "/dev/a", "camera": "http://b", "calibration": "c.yaml", "more": 1})");
  CHECK(all.port == "/dev/a");
  CHECK(all.camera == "http://b");
  CHECK(all.calibration == "c.yaml");
  const DriveAddress one = AddressOf(R"({"calibration": "c.yaml"})");
  CHECK(one.port.empty());
  CHECK(one.camera.empty());
  CHECK(one.calibration == "c.yaml");
  CHECK_THROWS_WITH(AddressOf(R"({"port": 3})"), Contains("which is no object of port"));
  CHECK_THROWS_WITH(AddressOf("{"), Contains("--before-each said '{'"));
}

TEST_CASE("A scene command that fails says how, by its code or its signal") {
  CHECK_THROWS_WITH(SceneCommand({"sh", "-c", "exit 7"}), "--before-each: sh ended with 7");
  CHECK_THROWS_WITH(SceneCommand({"sh", "-c", "kill -9 $$"}),
                    "--before-each: sh was ended by signal 9");
  CHECK_THROWS_WITH(SceneCommand({"no_such_program_anywhere"}),
                    "--before-each: no_such_program_anywhere could not be run");
  CHECK_NOTHROW(SceneCommand({"sh", "-c", "echo text; printf 'no line end'"}));
  CHECK_FALSE(SceneCommand({"sh", "-c", "echo text"}).address());
  // A line of JSON at the end of the output, without an end of its own.
  CHECK(SceneCommand({"printf", "{\"port\": \"/dev/a\"}"}).address()->port == "/dev/a");
}

TEST_CASE("A scene command that prints on is read on, and a line without an end is refused") {
  const test::TemporaryFolder folder;
  const SceneCommand scene({"sh", "-c",
                            "echo '{\"port\": \"/dev/a\"}'; head -c 300000 /dev/zero; "
                            "touch \"$0\"; exec sleep 100",
                            folder / "printed"});
  test::WaitUntil("all was printed", [&] { return std::filesystem::exists(folder / "printed"); });
  CHECK_THROWS_WITH(SceneCommand({"sh", "-c", "exec cat /dev/zero"}),
                    "--before-each: a line of more than 65536 bytes was printed");
}

TEST_CASE("The input of a scene command is empty, so that no key is taken from the person") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "keys", "a key\n");
  const int own = ::dup(STDIN_FILENO), keys = ::open((folder / "keys").c_str(), O_RDONLY);
  ::dup2(keys, STDIN_FILENO);
  CHECK_NOTHROW(SceneCommand({"sh", "-c", "! read line"}));
  char first = 0;
  CHECK(::read(STDIN_FILENO, &first, 1) == 1);
  CHECK(first == 'a');
  ::dup2(own, STDIN_FILENO);
  ::close(own);
  ::close(keys);
}

const geometry::Pose2 kStart{1.0, 2.0, 0.0};

/// Whether a gate lets a robot start that stands there, with nobody to ask again.
bool Starts(const geometry::Pose2& seen, const hardware::StartOptions& options) {
  StartGate gate(options, kStart, false,
                 {.has_agreed = [] { return true; }, .say = [](const std::string&) {}});
  try {
    return gate.MayStart(0.0, seen);
  } catch (const std::runtime_error&) {
    return false;
  }
}

TEST_CASE("A robot starts within the distance and the turn that are allowed, to every side") {
  hardware::StartOptions options;
  CHECK(options.within_m == 0.05);
  CHECK(options.within_deg == 5.0);
  CHECK(options.countdown_s == 3.0);
  options = {.within_m = 0.25, .within_deg = 8.0, .countdown_s = 0.0};
  for (const double sign : {1.0, -1.0}) {
    CHECK(Starts({1.0 + 0.25 * sign, 2.0, 0.0}, options));  // exactly the bound
    CHECK(Starts({1.0, 2.0 + 0.25 * sign, 0.0}, options));
    CHECK_FALSE(Starts({1.0 + 0.2501 * sign, 2.0, 0.0}, options));
    CHECK_FALSE(Starts({1.0, 2.0 + 0.2501 * sign, 0.0}, options));
    CHECK_FALSE(Starts({1.0 + 0.2 * sign, 2.2, 0.0}, options));
    CHECK(Starts({1.0, 2.0, sign * geometry::RadFromDeg(7.99)}, options));
    CHECK_FALSE(Starts({1.0, 2.0, sign * geometry::RadFromDeg(8.01)}, options));
  }
}

TEST_CASE("Where a robot stands is told in centimetres and degrees without a sign") {
  const Placement right = PlacementOf({1.0, 1.97, -0.1}, kStart);
  CHECK(right.off_m == Approx(0.03));
  CHECK(right.off_deg == Approx(geometry::DegFromRad(0.1)));
  CHECK(PlacementText({0.0314, 2.4}) == "3.1 cm, 2 deg off");
}

TEST_CASE("A drive needs its experiment and its log to be seen again") {
  for (const char* name : {"experiment.yaml", "trajectory.csv"}) {
    const test::TemporaryFolder folder;
    test::WriteText(folder / "experiment.yaml", "x");
    test::WriteText(folder / "trajectory.csv", "x");
    CHECK_NOTHROW(RequireDrive(folder.Path()));
    fs::remove(folder.Path() / name);
    CHECK_THROWS_WITH(RequireDrive(folder.Path()),
                      folder.Path().string() + " holds no drive: there is no " + name + " in it");
  }
}

TEST_CASE("A drive is seen again level on the floor, with the task it had and how it ended") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "experiment.yaml", experiment::WriteExperiment(test::PaperTask()));
  trajectory::Trajectory seen;
  for (int i = 0; i < 5; ++i) {
    seen.poses.push_back({.t_s = 0.1 * i,
                          .x_m = 0.01 * i,
                          .y_m = 0.002 * i,
                          .z_m = 0.08,
                          .roll_rad = 0.02,
                          .pitch_rad = -0.03,
                          .yaw_rad = 0.1 * i});
  }
  std::swap(seen.poses[1], seen.poses[2]);  // out of order, which is mended and said
  test::WriteText(folder / "trajectory.csv", trajectory::WriteRift(seen));
  std::vector<std::string> told;
  const view::Run shown =
      LoadDrive(folder.Path(), [&](const std::string& line) { told.push_back(line); });
  REQUIRE(told.size() == 1);
  CHECK_THAT(told[0], Catch::StartsWith("note: " + (folder / "trajectory.csv") + ": "));
  CHECK(shown.title == "paper, " + folder.Path().string());
  REQUIRE(shown.truth.poses.size() == 5);
  CHECK(shown.truth.poses[4].x_m == 0.04);
  CHECK(shown.truth.poses[4].y_m == 0.008);
  CHECK(shown.truth.poses[4].yaw_rad == 0.4);
  CHECK(std::isnan(shown.truth.poses[4].z_m));
  CHECK(std::isnan(shown.truth.poses[4].roll_rad));
  CHECK(std::isnan(shown.truth.poses[4].pitch_rad));
  CHECK(shown.logged.poses[4].z_m == 0.08);
  REQUIRE(shown.waypoints.size() == 4);
  CHECK(shown.waypoints[3].name == "end");
  CHECK(shown.body.track_m == view::ShapeOf(test::PaperTask().simulation.body).track_m);
}

TEST_CASE("What a robot is driven with is the experiment's task, control, trial and hardware") {
  experiment::Experiment experiment = test::PaperTask();
  experiment.control.v_max = 0.37;
  experiment.trial.timeout_s = 33.0;
  experiment.hardware.line.baud = 57600;
  const hardware::DriveTask task = DriveTaskOf(experiment);
  CHECK(task.task.waypoints.size() == 4);
  CHECK(task.control.v_max == 0.37);
  CHECK(task.trial.timeout_s == 33.0);
  CHECK(task.hardware.line.baud == 57600);
}

TEST_CASE("A calibration without a world frame drives nothing and says what to do") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "lens.yaml",
                  "fx: 1000\nfy: 1000\ncx: 640\ncy: 360\nwidth_px: 1280\nheight_px: 720\n");
  std::vector<std::string> told;
  Console console = Answering('q', told);
  console.show = [](const std::string&) {};
  console.hide = [] {};
  console.ring = [] {};
  DriveSession session({.address = {"/dev/none", "none", folder / "lens.yaml"}}, console);
  CHECK_NOTHROW(session.RequireLog());
  CHECK(session.LogFailure().empty());
  CHECK_THROWS(session.DriveInto(folder.Path() / "run", test::PaperTask()));
}

}  // namespace
}  // namespace rift::sessions
