#include "rift/sessions/drive/plan.hpp"

#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <set>

#include "rift/experiment/path_template.hpp"
#include "rift/files/files.hpp"
#include "rift/files/folder_lock.hpp"
#include "rift/sessions/drive/series.hpp"
#include "sessions/drive/before_each.hpp"
#include "support/inputs/paper_waypoints.hpp"
#include "support/processes/process.hpp"
#include "support/until.hpp"

namespace rift::sessions {
namespace {

namespace fs = std::filesystem;

experiment::ParameterValue Word(const std::string& text) { return {text, std::nullopt}; }

experiment::Experiment TwoFloors() {
  experiment::Experiment experiment;
  experiment.name = "floors";
  experiment.waypoints = test::PaperWaypoints();
  experiment.reference.trials.names = {"1", "2"};
  experiment.space.parameters = {
      {.key = "control.v_max",
       .levels = {experiment::NumberValue(0.3), experiment::NumberValue(0.4)}},
      {.key = "simulation.terrain.surface", .levels = {Word("parchment"), Word("ground")}}};
  return experiment;
}

TEST_CASE("A grid is driven floor by floor and every trial has a folder of its own") {
  const SeriesPlan plan = PlanGrid(TwoFloors(), "/out");
  REQUIRE(plan.trials.size() == 8);
  CHECK(plan.has_floors);
  CHECK(plan.sweeps_drives);
  int changes = 0;
  std::set<std::string> folders;
  for (std::size_t i = 0; i < plan.trials.size(); ++i) {
    const auto floor_of = [&](std::size_t k) {
      return plan.trials[k].experiment.simulation.terrain.surface;
    };
    changes += i > 0 && floor_of(i) != floor_of(i - 1);
    folders.insert(plan.trials[i].folder);
  }
  CHECK(changes == 1);
  CHECK(folders.size() == 8);
  CHECK(plan.trials[0].folder == "/out/v_max0.3_parchment_1");
  CHECK(plan.trials[0].experiment.control.v_max == 0.3);
  CHECK(plan.trials[7].folder == "/out/v_max0.4_ground_2");
  CHECK(plan.trials[7].experiment.control.v_max == 0.4);
  CHECK(plan.trials[7].label == "v_max 0.4, surface ground, trial 2");
}

TEST_CASE("A grid of which two drives would go into one folder is refused") {
  experiment::Experiment experiment = TwoFloors();
  auto& surfaces = experiment.simulation.terrain.surfaces;
  surfaces["ground_wet"] = surfaces.at("ground");
  experiment.space.parameters[1].levels = {Word("ground"), Word("ground_wet")};
  experiment.reference.trials.names = {"1", "2"};
  CHECK(PlanGrid(experiment, "/out").trials.size() == 8);
  experiment.reference.trials.names = {"1", "wet_1"};
  CHECK_THROWS_WITH(PlanGrid(experiment, "/out"),
                    Catch::StartsWith("/out/v_max0.3_ground_wet_1 would hold two drives, of v_max "
                                      "0.3, surface ground, trial wet_1 and of v_max 0.3, surface "
                                      "ground_wet, trial 1"));
}

TEST_CASE("The sweep of a grid holds the simulator, started as its log, against the drives") {
  const experiment::Experiment sweep = PlanGrid(TwoFloors(), "/out").sweep;
  CHECK(sweep.candidate.kind == experiment::CandidateKind::kSimulation);
  CHECK(sweep.start == experiment::Start::kReference);
  CHECK(sweep.reference.kind == experiment::ReferenceKind::kLogs);
  CHECK(sweep.reference.path.text == "/out/v_max{v_max}_{surface}_{trial}/trajectory.csv");
  CHECK(sweep.reference.trials.names == std::vector<std::string>{"1", "2"});
}

TEST_CASE("A grid without a space is the paper's") {
  experiment::Experiment experiment = TwoFloors();
  experiment.space.parameters.clear();
  CHECK(PlanGrid(experiment, "/out").trials.size() == 5 * 2 * 3 * 2);
}

TEST_CASE("What no drive can vary is refused with its name") {
  experiment::Experiment experiment = TwoFloors();
  experiment.space.parameters[0].key = "simulation.motor.lag_s";
  CHECK_THROWS_WITH(PlanGrid(experiment, "/out"), Catch::Contains("simulation.motor.lag_s"));
  experiment = TwoFloors();
  experiment.space.parameters[0].levels.clear();  // a range
  CHECK_THROWS_AS(PlanGrid(experiment, "/out"), std::invalid_argument);
  experiment = TwoFloors();
  experiment.candidate.kind = experiment::CandidateKind::kLogs;
  CHECK_THROWS_WITH(PlanGrid(experiment, "/out"), Catch::Contains("candidate.kind is logs"));
  experiment = TwoFloors();
  experiment.reference.trials.names = {"../1"};
  CHECK_THROWS_WITH(PlanGrid(experiment, "/out"), Catch::Contains("is no folder name"));
}

TEST_CASE("Repeats go into numbered folders that a sweep of one setting reads") {
  const SeriesPlan plan = PlanRepeats(TwoFloors(), 3, "/out");
  REQUIRE(plan.trials.size() == 3);
  CHECK_FALSE(plan.has_floors);
  CHECK(plan.trials[2].folder == "/out/3");
  CHECK(plan.sweep.reference.path.text == "/out/{trial}/trajectory.csv");
  CHECK(plan.sweep.reference.trials.names.size() == 3);
  REQUIRE(plan.sweep.space.parameters.size() == 1);  // none would mean the paper's grid
  CHECK(plan.sweep.space.parameters[0].levels ==
        std::vector{Word(TwoFloors().simulation.terrain.surface)});
}

/// A person who presses one key, and what this person was told and asked.
struct Answering {
  char key;
  std::vector<std::string> told{}, asked{}, keys{};

  Console AtConsole() {
    return {.say = [this](const std::string& line) { told.push_back(line); },
            .ask =
                [this](const std::string& question, std::string_view offered) {
                  asked.push_back(question);
                  keys.emplace_back(offered);
                  return key;
                }};
  }
};

TEST_CASE("What comes after a series is done in its locked folder once every drive is there") {
  const test::TemporaryFolder folder;
  fs::create_directories(folder.Path() / "1");
  fs::create_directories(folder.Path() / "2");
  Answering person{'q'};
  bool was_locked = false;
  const SeriesEnd end =
      DriveAll({folder.Path(), PlanRepeats(TwoFloors(), 2, folder.Path())}, person.AtConsole(),
               [&] { was_locked = files::FolderLock::IsHeld(folder.Path()); });
  CHECK(end == SeriesEnd::kDone);
  CHECK(was_locked);
  CHECK_FALSE(files::FolderLock::IsHeld(folder.Path()));
  CHECK(person.told == std::vector{"2 drives into " + folder.Path().string() + ", 2 of them done"});
  CHECK(person.asked.empty());
  CHECK(fs::exists(folder / "sweep.yaml"));
}

TEST_CASE("A person says what becomes of a drive that did not reach the end") {
  const auto [key, expected] = GENERATE(table<char, SeriesEnd>(
      {{'k', SeriesEnd::kDone}, {'s', SeriesEnd::kLeft}, {'q', SeriesEnd::kQuit}}));
  const test::TemporaryFolder folder;
  fs::create_directories(folder.Path() / "1.unfinished");
  test::WriteText(folder / "1.unfinished/trajectory.csv", "t_s\n");
  Answering person{key};
  bool went_on = false;
  CHECK(DriveAll({folder.Path(), PlanRepeats(TwoFloors(), 1, folder.Path())}, person.AtConsole(),
                 [&] { went_on = true; }) == expected);
  CHECK(went_on == (expected != SeriesEnd::kQuit));
  CHECK(fs::exists(folder / "1") == (expected == SeriesEnd::kDone));
  CHECK(person.keys == std::vector<std::string>{"aks"});
  const bool is_left =
      person.told.back() ==
      "1 of 1 drives did not reach the end; the same command asks about them again";
  CHECK(is_left == (expected == SeriesEnd::kLeft));
  const bool is_quit = person.told.back() == "stopped; the same command goes on where it was";
  CHECK(is_quit == (expected == SeriesEnd::kQuit));
}

TEST_CASE("A series says which drives are to come, asks of those begun, and counts those left") {
  const test::TemporaryFolder folder;
  const std::string out = folder.Path().string();
  fs::create_directories(folder.Path() / "1");
  fs::create_directories(folder.Path() / "2.unfinished");
  fs::create_directories(folder.Path() / "4.unfinished");
  fs::create_directories(folder.Path() / "3");
  test::WriteText(folder / "4.unfinished/trajectory.csv", "t_s\n");
  Answering person{'s'};
  CHECK(DriveAll({folder.Path(), PlanRepeats(TwoFloors(), 4, folder.Path())}, person.AtConsole(),
                 [] {}) == SeriesEnd::kLeft);
  CHECK(person.told ==
        std::vector<std::string>{
            "4 drives into " + out + ", 2 of them done", "drive 2 of 4: trial 2",
            "drive 4 of 4: trial 4",
            "2 of 4 drives did not reach the end; the same command asks about them again"});
  CHECK(person.asked ==
        std::vector<std::string>{
            "trial 2 was begun and did not reach the end: Enter: again, s: skip, q: quit",
            "trial 4 was begun and did not reach the end: Enter: again, k: keep it as it is, s: "
            "skip, q: quit"});
}

TEST_CASE("A drive that is begun again is set aside beside its earlier tries") {
  const test::TemporaryFolder folder;
  for (const char* name : {"1.unfinished", "1.unfinished1", "1.unfinished3"}) {
    fs::create_directories(folder.Path() / name);
    test::WriteText(folder.Path() / name / "mine", name);
  }
  Answering person{'a'};
  // It has no robot to drive.
  CHECK_THROWS_WITH(
      DriveAll({folder.Path(), PlanRepeats(TwoFloors(), 1, folder.Path())}, person.AtConsole(),
               [] {}),
      "--port, --camera, --calibration are missing, and --before-each told none: name them, or let "
      "its program print port, camera and calibration as one line of JSON");
  REQUIRE_FALSE(person.told.empty());
  CHECK(person.told[0] == "1 drive into " + folder.Path().string() + ", 0 of them done");
  CHECK(files::ReadFile(folder / "1.unfinished2/mine") == "1.unfinished");
  CHECK(files::ReadFile(folder / "1.unfinished1/mine") == "1.unfinished1");
  CHECK(files::ReadFile(folder / "1.unfinished3/mine") == "1.unfinished3");
  CHECK_FALSE(fs::exists(folder / "1"));
}

TEST_CASE("A drive without a log cannot be kept, and is left as it is") {
  const test::TemporaryFolder folder;
  fs::create_directories(folder.Path() / "1.unfinished");
  Answering person{'s'};
  CHECK(DriveAll({folder.Path(), PlanRepeats(TwoFloors(), 1, folder.Path())}, person.AtConsole(),
                 [] {}) == SeriesEnd::kLeft);
  CHECK(person.keys == std::vector<std::string>{"as"});
}

TEST_CASE("A floor is laid before its first drive and a person who will not ends the series") {
  const test::TemporaryFolder folder;
  Answering person{'q'};
  CHECK(DriveAll({folder.Path(), PlanGrid(TwoFloors(), folder.Path())}, person.AtConsole(),
                 [] {}) == SeriesEnd::kQuit);
  CHECK(person.asked == std::vector<std::string>{"lay the parchment; Enter (q: quit)"});
}

TEST_CASE("The drives of one experiment are not mixed with those of another") {
  const test::TemporaryFolder folder;
  fs::create_directories(folder.Path() / "1");
  Answering person{'q'};
  experiment::Experiment experiment = TwoFloors();
  const auto drive = [&] {
    return DriveAll({folder.Path(), PlanRepeats(experiment, 1, folder.Path())}, person.AtConsole(),
                    [] {});
  };
  CHECK(drive() == SeriesEnd::kDone);
  CHECK(drive() == SeriesEnd::kDone);
  const std::string before = experiment::NumberValue(experiment.control.v_max).text;
  experiment.control.v_max = 0.45;
  CHECK_THROWS_WITH(drive(), (folder / "sweep.yaml") +
                                 " is the table of other drives: control.v_max was " + before +
                                 " and is 0.45 now; choose another --out");
}

TEST_CASE("A sweep of drives simulates the listener that answered all of them, else the told one") {
  const auto poll_after = [](const std::vector<std::string>& summaries) {
    const test::TemporaryFolder folder;
    const int drives = static_cast<int>(summaries.size());
    for (int i = 0; i < drives; ++i) {
      const std::string drive = folder / std::to_string(i + 1);
      fs::create_directories(drive);
      if (!summaries[i].empty()) test::WriteText(drive + "/summary.json", summaries[i]);
    }
    Answering person{'q'};
    CHECK(DriveAll({folder.Path(), PlanRepeats(TwoFloors(), drives, folder.Path())},
                   person.AtConsole(), [] {}) == SeriesEnd::kDone);
    const simulation::LinkOptions link =
        experiment::LoadExperiment(folder / "sweep.yaml", {}, files::ReadFile).simulation.link;
    const bool is_said = person.told.back().find("src/firmware") != std::string::npos;
    CHECK(is_said == (link.poll_s == 0.0));
    CHECK(link.uart_bytes == (link.poll_s == 0.0 ? 512 : 32));
    CHECK(link.watchdog_s == (link.poll_s == 0.0 ? 0.3 : 0.0));
    return link.poll_s;
  };
  const std::string framed = R"({"ping": {"protocol": "framed"}})";
  const std::string plain = R"({"ping": {"protocol": "plain"}})";
  CHECK(poll_after({framed}) == 0.0);
  CHECK(poll_after({framed, framed}) == 0.0);
  CHECK(poll_after({framed, ""}) == 0.0);
  CHECK(poll_after({plain}) == 0.1);
  CHECK(poll_after({framed, plain}) == 0.1);
  for (const char* says_nothing :
       {"", "{", "[]", "{}", R"({"ping": 1})", R"({"ping": {}})", R"({"ping": {"protocol": 1}})"}) {
    CHECK(poll_after({says_nothing}) == 0.1);
  }
}

TEST_CASE("A sweep of drives has rift's own host whatever host the robot's file tells of") {
  experiment::Experiment robot = TwoFloors();
  robot.simulation.mocap.host_period_s = 0.05;
  robot.simulation.mocap.processing_s = 0.01;
  robot.simulation.mocap.ambiguity.share = 0.5;
  robot.simulation.terrain.surfaces["ground"].host_period_s = 0.06;
  robot.simulation.link.late_share = 0.25;
  const auto& of_drives = PlanRepeats(robot, 1, "/out").sweep.simulation;
  CHECK_FALSE(of_drives.mocap.host_period_s);
  CHECK(of_drives.mocap.processing_s == 0.01 + robot.twin.host_share_s);
  CHECK(of_drives.mocap.ambiguity.share == 0.0);
  CHECK_FALSE(of_drives.terrain.surfaces.at("ground").host_period_s);
  CHECK(of_drives.link.late_share == 0.0);
  CHECK(of_drives.link.poll_s == robot.simulation.link.poll_s);
  robot.simulation.mocap.host_period_s.reset();
  CHECK(PlanRepeats(robot, 1, "/out").sweep.simulation.mocap.processing_s == 0.01);
}

TEST_CASE("Drives of another program, or of other wheels that a program is made for, are others") {
  const test::TemporaryFolder folder;
  fs::create_directories(folder.Path() / "1");
  Answering person{'q'};
  const auto drive = [&](const experiment::Experiment& experiment) {
    return DriveAll({folder.Path(), PlanRepeats(experiment, 1, folder.Path())}, person.AtConsole(),
                    [] {});
  };
  experiment::Experiment square = TwoFloors();
  square.waypoints.resize(1);
  square.program.segments = {{.straight_m = 0.5}, {.turn_deg = 90.0}};
  square.program.speed_mps = 0.2;
  CHECK(drive(square) == SeriesEnd::kDone);
  CHECK(drive(square) == SeriesEnd::kDone);
  experiment::Experiment line = square, power = square, wheels = square, battery = square;
  line.program.segments.pop_back();
  CHECK_THROWS_WITH(drive(line), Catch::Contains("other drives: program.segments was"));
  power.program.speed_mps.reset();
  CHECK_THROWS_WITH(drive(power), Catch::Contains("other drives: program.speed_mps was"));
  wheels.hardware.odometry.drive.track_m *= 1.01;
  CHECK_THROWS_WITH(drive(wheels),
                    Catch::Contains("other drives: hardware.odometry.drive.track_m was"));
  battery.hardware.guard.battery_min_v = 3.6;
  CHECK(drive(battery) == SeriesEnd::kDone);
}

TEST_CASE("Wheels that were measured anew leave drives to waypoints as they were") {
  const test::TemporaryFolder folder;
  fs::create_directories(folder.Path() / "1");
  Answering person{'q'};
  experiment::Experiment experiment = TwoFloors();
  for (const double track_m : {0.0848, 0.0852}) {
    experiment.hardware.odometry.drive.track_m = track_m;
    CHECK(DriveAll({folder.Path(), PlanRepeats(experiment, 1, folder.Path())}, person.AtConsole(),
                   [] {}) == SeriesEnd::kDone);
  }
}

TEST_CASE("A second series in a folder is told of drives and not of a sweep's status") {
  const test::TemporaryFolder folder;
  const files::FolderLock first(folder.Path());
  Answering person{'q'};
  CHECK_THROWS_WITH(
      DriveAll({folder.Path(), PlanRepeats(TwoFloors(), 1, folder.Path())}, person.AtConsole(),
               [] {}),
      Catch::Equals("another rift drive or sweep is at work in " + folder.Path().string() +
                    ": wait for it, or choose another folder with --out"));
}

TEST_CASE("A chosen setting is driven as often as it has folders, named by who chose it") {
  const experiment::Experiment experiment = TwoFloors();
  const SeriesPlan plan = PlanChosen(experiment, {{"experiment 3",
                                                   {experiment.space.parameters[0]},
                                                   {experiment::NumberValue(0.4)},
                                                   {"/out/3_1", "/out/3_2"}}});
  REQUIRE(plan.trials.size() == 2);
  CHECK_FALSE(plan.sweeps_drives);
  CHECK(plan.trials[1].folder == "/out/3_2");
  CHECK(plan.trials[1].label == "experiment 3 (v_max 0.4), trial 2");
  CHECK(plan.trials[1].experiment.control.v_max == 0.4);
  CHECK_FALSE(plan.has_floors);
}

TEST_CASE("Chosen settings that name other parameters each have the experiment's own of the rest") {
  experiment::Experiment experiment = TwoFloors();
  experiment.control.v_max = 0.35;
  const auto& all = experiment.space.parameters;  // v_max, surface
  const ChosenSetting speed{
      "experiment 1", {all[0]}, {experiment::NumberValue(0.4)}, {"/out/speed"}};
  const ChosenSetting floor{"experiment 2", {all[1]}, {Word("parchment")}, {"/out/floor"}};
  const ChosenSetting both{"experiment 3",
                           {all[1], all[0]},
                           {Word("parchment"), experiment::NumberValue(0.3)},
                           {"/out/both"}};
  for (const auto& settings : {std::vector{speed, floor, both}, std::vector{both, floor, speed}}) {
    const SeriesPlan plan = PlanChosen(experiment, settings);
    REQUIRE(plan.has_floors);
    REQUIRE(plan.parameters.size() == 2);
    REQUIRE(plan.trials.size() == 3);
    CHECK(plan.trials[2].folder == "/out/speed");  // on ground, the last floor of the space
    for (const PlannedTrial& trial : plan.trials) {
      const std::string said = experiment::FillTemplate("{surface} at {v_max}", plan.parameters,
                                                        trial.theta, trial.trial);
      CHECK(said == (trial.folder == "/out/speed"   ? "ground at 0.4"
                     : trial.folder == "/out/floor" ? "parchment at 0.35"
                                                    : "parchment at 0.3"));
      CHECK(said == trial.experiment.simulation.terrain.surface + " at " +
                        experiment::NumberValue(trial.experiment.control.v_max).text);
    }
  }
}

TEST_CASE("A scene that says where it is goes on until it is no longer needed") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "scene",
                  "trap 'echo over > " +
                      folder /
                          "over; exit' TERM\n"
                          "echo ready\necho '{\"port\": \"/dev/p\", \"camera\": \"c\"}'\n"
                          "echo $$ > " +
                      folder /
                          "pid\n"
                          "while :; do sleep 0.01; done\n");
  {
    const SceneCommand scene({"sh", folder / "scene"});
    REQUIRE(scene.address());
    CHECK(scene.address()->port == "/dev/p");
    CHECK(scene.address()->camera == "c");
    CHECK(scene.address()->calibration.empty());
    test::WaitUntil("it went on", [&] { return std::filesystem::exists(folder / "pid"); });
    test::WaitUntil("it can be told", [&] { return !files::ReadFile(folder / "pid").empty(); });
  }
  CHECK(std::filesystem::exists(folder / "over"));
  CHECK(::kill(std::stoi(files::ReadFile(folder / "pid")), 0) != 0);
}

TEST_CASE("What a scene command has started may tidy up after it has ended itself") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "scene", "(trap 'sleep 0.2; echo done > " + folder / "tidy" +
                                        "; exit' TERM\n"
                                        "echo 1 > " +
                                        folder / "ready" +
                                        "\nwhile :; do sleep 0.01; done) &\n"
                                        "trap exit TERM\n"
                                        "echo '{\"port\": \"/dev/p\"}'\n"
                                        "while :; do sleep 0.01; done\n");
  {
    const SceneCommand scene({"sh", folder / "scene"});
    test::WaitUntil("it can be told", [&] { return fs::exists(folder / "ready"); });
  }
  test::WaitUntil("it has tidied up", [&] { return fs::exists(folder / "tidy"); });
}

TEST_CASE("A scene that was reset needs no address and one that fails ends the series") {
  CHECK_FALSE(SceneCommand({"true"}).address());
  CHECK_THROWS_WITH(SceneCommand({"false"}), Catch::Contains("false ended with 1"));
  CHECK_THROWS_WITH(SceneCommand({"/no/such/program"}), Catch::Contains("could not be run"));
  CHECK_THROWS_WITH(SceneCommand({"echo", "{port}"}), Catch::Contains("no object of port"));
}

}  // namespace
}  // namespace rift::sessions
