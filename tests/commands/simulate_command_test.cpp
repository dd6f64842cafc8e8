#include <catch2/catch.hpp>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"
#include "support/tree.hpp"

namespace rift {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::ProcessResult;
using test::RunRift;

const std::string kTask = test::SourceDir() + "/configs/waypoints/paper.yaml";

TEST_CASE("rift simulate reaches the paper's waypoints and leaves a whole run behind") {
  const test::TemporaryFolder folder;
  const ProcessResult result = RunRift({"simulate", kTask, "--out", folder / "sim.csv", "--json"});
  REQUIRE(result.exit_code == 0);
  CHECK(result.err == "log: " + (folder / "sim.csv") + "\n");
  const json summary = json::parse(result.out);
  CHECK(summary["outcome"] == "reached");
  CHECK(summary["waypoints"].size() == 3);
  CHECK(summary["waypoints"][2]["closest_m"].get<double>() < 0.06);
  const trajectory::Trajectory log =
      test::LoadTrajectory(folder / "sim.csv", trajectory::Format::kRift);
  CHECK(log.HasYaw());
  CHECK(log.poses.size() > 30);
  for (const char* name :
       {"sim.truth.csv", "sim.commands.csv", "sim.experiment.yaml", "sim.summary.json"}) {
    INFO(name);
    CHECK(fs::file_size(folder / name) > 100);
  }
}

TEST_CASE("A run that circles says why, and with the keys it proposes the robot arrives") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "task.yaml",
                  "include: [" + test::SourceDir() + "/configs/robots/turtlebot3_burger.yaml]\n" +
                      "control: {heading: {p: 0.1, d: 0.02}, w_max: 0.15}\n"
                      "waypoints: [{x: 0, y: 0, heading: 60}, {name: a, x: 0.3, y: 0, stop: true},"
                      " {name: b, x: 0.3, y: 0.3, stop: true}]\ntrial: {timeout_s: 40}\n");
  const ProcessResult circles =
      RunRift({"simulate", folder / "task.yaml", "--out", folder / "circles"});
  INFO(circles.err);
  REQUIRE(circles.exit_code == 1);
  CHECK(circles.out.find("was not reached within trial.timeout_s, 40 s") != std::string::npos);
  CHECK(circles.err.find("it circled: ") != std::string::npos);
  CHECK(circles.err.find("control.heading.p 0.1 asks for") != std::string::npos);
  CHECK(circles.err.find("limits that bound, of ") != std::string::npos);
  const json steering = json::parse(test::ReadFile(folder / "circles/summary.json")).at("steering");
  CHECK(steering["turns"].get<double>() > 1.0);
  CHECK(steering["causes"].size() >= 1);
  std::vector<std::string> again{"simulate", folder / "task.yaml", "--out", folder / "arrives"};
  const size_t at = circles.err.find("try: ");
  REQUIRE(at != std::string::npos);
  const std::string line = circles.err.substr(at, circles.err.find('\n', at) - at);
  for (const json& proposal : steering["proposals"]) {
    const std::string key = proposal["key"];
    CHECK(line.find("--set " + key + "=") != std::string::npos);
    again.insert(again.end(), {"--set", key + "=" + proposal["value"].dump()});
  }
  const ProcessResult arrives = RunRift(again);
  INFO(arrives.out << arrives.err);
  CHECK(arrives.exit_code == 0);
  CHECK(arrives.err.find("why: ") == std::string::npos);
}

/// What follows `try:`, as a shell would split it.
std::vector<std::string> TriedWords(const std::string& err) {
  const size_t at = err.find("try: ");
  if (at == std::string::npos) return {};
  const size_t from = at + 5;
  std::istringstream line(err.substr(from, err.find(" (", from) - from));
  return {std::istream_iterator<std::string>(line), {}};
}

TEST_CASE("What is tried after a run that did not arrive arrives at the first paste") {
  struct Mistake {
    std::string robot, keys, why;
  };
  const Mistake mistake = GENERATE(
      Mistake{"3pi_plus", "control.v_min=0.05 control.v_max=0.11", "it does not move: "},
      Mistake{"3pi_plus", "control.v_min=0.02 control.v_max=0.05", "it does not move: "},
      Mistake{"3pi_plus", "simulation.mocap.processing_s=0.6", "zero power: poses are 0.6"},
      Mistake{"3pi_plus", "simulation.motor.mismatch=0.5", "it pulls to the right"},
      Mistake{"3pi_plus", "control.pose_gate.max_speed_mps=0.1", "control.pose_gate.max_speed_mps"},
      Mistake{"romi_32u4", "control.reach_radius_m=0.002", "control.reach_radius_m"},
      Mistake{"romi_32u4", "simulation.link.delay_s=1.2", "the steering is unstable"},
      Mistake{"romi_32u4", "control.heading.p=0.005", "control.w_min raises that to 0.02"});
  const test::TemporaryFolder folder;
  const std::string robot = test::SourceDir() + "/configs/robots/" + mistake.robot + ".yaml";
  test::WriteText(
      folder / "task.yaml",
      (mistake.robot == "3pi_plus" ? "" : "include: [" + robot + "]\n") +
          "waypoints: [{x: -0.28, y: -0.07, heading: -1}, {x: -0.07, y: -0.09, stop: true},"
          " {x: -0.1, y: 0.3, stop: true}, {x: 0.38, y: -0.06, stop: true}]\n");
  std::vector<std::string> words{"simulate", folder / "task.yaml", "--out", folder / "fails"};
  std::istringstream keys(mistake.keys);
  for (std::string key; keys >> key;) words.insert(words.end(), {"--set", key});
  const ProcessResult fails = RunRift(words);
  INFO(mistake.robot << " " << mistake.keys << "\n" << fails.err);
  REQUIRE(fails.exit_code == 1);
  CHECK(fails.err.find(mistake.why) != std::string::npos);
  const std::vector<std::string> tried = TriedWords(fails.err);
  REQUIRE_FALSE(tried.empty());
  words[3] = folder / "arrives";
  words.insert(words.end(), tried.begin(), tried.end());
  const ProcessResult arrives = RunRift(words);
  INFO(arrives.err);
  CHECK(arrives.exit_code == 0);
}

TEST_CASE("A robot's file alone is answered with how to give it waypoints") {
  const std::string robot = test::SourceDir() + "/configs/robots/template.yaml";
  const test::TemporaryFolder folder;
  for (const std::string command : {"simulate", "sweep"}) {
    const ProcessResult result = RunRift({command, robot, "--out", folder / command});
    INFO(result.err);
    CHECK(result.exit_code == 2);
    CHECK(result.err.find(robot + ": it has no waypoints") != std::string::npos);
    CHECK(result.err.find("include: [" + robot + ", configs/waypoints/paper.yaml]") !=
          std::string::npos);
  }
}

TEST_CASE("A simulated robot that stands tilted is named once") {
  const test::TemporaryFolder folder;
  const std::vector<std::string> tilted{"--set", "simulation.body.caster_below_m=0.0074"};
  std::vector<std::string> simulate{"simulate", kTask, "--out", folder / "run"};
  simulate.insert(simulate.end(), tilted.begin(), tilted.end());
  const std::string err = RunRift(simulate).err;
  INFO(err);
  const size_t at = err.find("warning: the simulated robot stands tilted by 3.2 deg");
  REQUIRE(at != std::string::npos);
  CHECK(err.find("stands tilted", at + 60) == std::string::npos);
}

TEST_CASE("The same seed gives the same bytes and another seed another log") {
  const test::TemporaryFolder folder;
  for (const std::string name : {"a", "b"}) {
    REQUIRE(RunRift({"simulate", kTask, "--seed", "7", "--out", folder / name}).exit_code == 0);
  }
  REQUIRE(RunRift({"simulate", kTask, "--seed", "8", "--out", folder / "c"}).exit_code == 0);
  for (const char* name :
       {"/trajectory.csv", "/truth.csv", "/commands.csv", "/summary.json", "/experiment.yaml"}) {
    INFO(name);
    CHECK(test::ReadFile(folder / "a" + name) == test::ReadFile(folder / "b" + name));
  }
  CHECK(test::ReadFile(folder / "a/trajectory.csv") != test::ReadFile(folder / "c/trajectory.csv"));
}

TEST_CASE("Encoders of an earlier run do not stay beside a robot that reports none") {
  const test::TemporaryFolder folder;
  const std::vector<std::string> command{"simulate", kTask, "--out", folder / "run", "--force"};
  std::vector<std::string> silent = command;
  silent.insert(silent.end(), {"--set", "simulation.encoder.reported=false"});
  REQUIRE(RunRift(command).exit_code == 0);
  CHECK(fs::exists(folder / "run/encoders.csv"));
  REQUIRE(RunRift(silent).exit_code == 0);
  CHECK_FALSE(fs::exists(folder / "run/encoders.csv"));
}

TEST_CASE("A saved experiment repeats its run with start and seed and overrides") {
  const test::TemporaryFolder folder;
  REQUIRE(RunRift({"simulate", kTask, "--seed", "7", "--start", "-0.25,-0.05,12", "--set",
                   "control.v_min=0.2", "--out", folder / "a"})
              .exit_code == 0);
  REQUIRE(RunRift({"simulate", folder / "a/experiment.yaml", "--out", folder / "b"}).exit_code ==
          0);
  CHECK(test::ReadFile(folder / "a/trajectory.csv") == test::ReadFile(folder / "b/trajectory.csv"));
  const trajectory::Trajectory truth =
      test::LoadTrajectory(folder / "a/truth.csv", trajectory::Format::kRift);
  CHECK(truth.poses.front().x_m == Approx(-0.25));
  CHECK(truth.poses.front().y_m == Approx(-0.05));
}

TEST_CASE("A robot that cannot get there ends with 1 and says why") {
  const test::TemporaryFolder folder;
  const ProcessResult result =
      RunRift({"simulate", kTask, "--set", "trial.timeout_s=1", "--out", folder / "out", "--json"});
  CHECK(result.exit_code == 1);
  CHECK(json::parse(result.out)["outcome"] == "timed_out");
  CHECK(fs::exists(folder / "out/trajectory.csv"));
}

TEST_CASE("A bad experiment is refused with its place and nothing is written") {
  const test::TemporaryFolder folder;
  const auto refusal = [&](const std::string& text, std::vector<std::string> more = {}) {
    test::WriteText(folder / "bad.yaml", text);
    std::vector<std::string> arguments{"simulate", folder / "bad.yaml", "--out", folder / "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProcessResult result = RunRift(arguments);
    CHECK(result.exit_code == 2);
    CHECK_FALSE(fs::exists(folder / "out"));
    const size_t at = result.err.find("bad.yaml");
    return at == std::string::npos ? result.err : result.err.substr(at);
  };
  const std::string task = "waypoints: [{x: 0, y: 0}, {x: 0.5, y: 0}]\n";
  CHECK(refusal(task + "simulation: {body: {chassis_mass_kg: 0}}\n").starts_with("bad.yaml:2:38"));
  CHECK(refusal(task + "simulation: {step_s: -1}\n").starts_with("bad.yaml:2:22"));
  CHECK(refusal("waypoints: [{x: 0, y: 0}, {x: .nan, y: 0}]\n").starts_with("bad.yaml:1:31"));
  CHECK(refusal(task + "simulation: {terrain: {surfaces: {ground: {mu: -0.1}}}}\n")
            .starts_with("bad.yaml:2:48"));
  CHECK(refusal(task + "simulation: {terrain: {surface: grund}}\n").starts_with("bad.yaml:2:"));
  CHECK(refusal("{}\n").starts_with("bad.yaml: "));
  CHECK(refusal("waypoints: [{x: 0, y: 0}, {y: 0.3}]\n")
            .starts_with("bad.yaml:1:27: key 'waypoints[1].x' is missing"));
  CHECK(refusal(task, {"--start", "1,2"}).find("--start '1,2': give X,Y,YAW_DEG") !=
        std::string::npos);
  CHECK(refusal(task, {"--start=0,0,1e300"}).find("waypoints[0].heading") != std::string::npos);
  CHECK(refusal(task, {"--seed=-1"}).find("seed") != std::string::npos);
}

TEST_CASE("rift simulate overwrites no input and no other output and no sweep") {
  const test::TemporaryFolder folder;
  const std::string task = folder / "task.yaml", text = test::ReadFile(kTask);
  test::WriteText(task, text);
  const auto refused = [&](const std::vector<std::string>& more, const std::string& rule) {
    std::vector<std::string> arguments{"simulate", task};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProcessResult result = RunRift(arguments);
    INFO(result.err);
    CHECK(result.exit_code == 2);
    CHECK(result.err.find(rule) != std::string::npos);
    CHECK_FALSE(fs::exists(folder / "sim.csv"));
    CHECK(test::ReadFile(task) == text);
  };
  const std::string out = folder / "sim.csv";
  refused({"--out", out, "--tum", task}, "is an input");
  refused({"--out", out, "--tum", out}, "another output");
  refused({"--out", out, "--tum", folder / "sim.truth.csv"}, "another output");
  refused({"--out", out, "--figure", folder / "run.txt"}, ".svg or .png");
  refused({"--out", out, "--video", folder / "run.avi"}, ".mp4");
  fs::create_directory(folder / "swept");
  test::WriteText(folder / "swept/table.csv", "id\n");
  refused({"--out", folder / "swept"}, "holds a sweep");
}

TEST_CASE("rift simulate replaces no drive of the robot, whatever is asked for") {
  const test::TemporaryFolder folder;
  const std::string drive = folder / "drive";
  REQUIRE(RunRift({"simulate", kTask, "--out", drive}).exit_code == 0);
  fs::remove(folder / "drive/truth.csv");
  test::WriteText(folder / "drive/stages.csv", "t_s\n");  // what only a drive writes
  test::WriteText(folder / "drive/trajectory.csv", "hours of work\n");
  for (const std::vector<std::string>& more : {std::vector<std::string>{"--out", drive},
                                               {"--out", drive, "--force"},
                                               {"--out", drive, "--seed", "9", "--force"},
                                               {"--out", drive + "/trajectory.csv", "--force"},
                                               {"--out", drive, "--twin", "--force"}}) {
    std::vector<std::string> words{"simulate", kTask};
    words.insert(words.end(), more.begin(), more.end());
    const ProcessResult result = RunRift(words);
    INFO(result.err);
    CHECK(result.exit_code == 2);
    CHECK_THAT(result.err, Catch::Contains("is a drive of the robot"));
    CHECK(test::ReadFile(folder / "drive/trajectory.csv") == "hours of work\n");
  }
  // Its folder may hold other files.
  CHECK(RunRift({"simulate", kTask, "--out", folder / "drive/simulated.csv"}).exit_code == 0);
}

TEST_CASE("A picture of a heightfield is an input, which no figure replaces") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "h.png", "hills");
  test::WriteText(folder / "e.yaml",
                  "waypoints: [{x: 0, y: 0}, {x: 0.2, y: 0}]\nsimulation:\n  terrain:\n    "
                  "surface: hill\n    surfaces:\n      hill: {shape: heightfield, image: h.png}\n");
  const ProcessResult result = RunRift({"simulate", folder / "e.yaml", "--out", folder / "out",
                                        "--figure", folder / "h.png", "--force"});
  CHECK(result.exit_code == 2);
  CHECK_THAT(result.err, Catch::Contains("h.png is an input or another output"));
  CHECK(test::ReadFile(folder / "h.png") == "hills");
}

TEST_CASE("A run that ends at its first pose keeps its verdict and has no figure") {
  const test::TemporaryFolder folder;
  std::vector<std::string> words{"simulate",     kTask,      "--out",
                                 folder / "out", "--figure", folder / "run.svg"};
  for (const char* value :
       {"body.contact_stiffness_n_per_m=1e7", "body.contact_damping_ns_per_m=0.1", "step_s=0.05",
        "body.chassis_mass_kg=0.01", "body.gravity_mps2=30", "body.wheel_mass_kg=0.0001",
        "terrain.surface=bump", "terrain.surfaces.bump.bump_height_m=0.1"}) {
    words.insert(words.end(), {"--set", std::string("simulation.") + value});
  }
  const ProcessResult result = RunRift(words);
  CHECK(result.exit_code == 1);
  CHECK_THAT(result.out, Catch::Contains("fault"));
  CHECK_THAT(result.err, Catch::Contains("run.svg is not drawn"));
  CHECK_FALSE(fs::exists(folder / "run.svg"));
}

TEST_CASE("A picture of a heightfield is found from the file that names it") {
  const test::TemporaryFolder folder;
  // 2 x 2 grey pixels.
  const std::string png("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\2\0\0\0\2\b\0\0\0\0", 29);
  test::WriteText(folder / "maps/h.png", png);
  test::WriteText(
      folder / "e.yaml",
      "waypoints: [{x: 0, y: 0}, {x: 0.2, y: 0}]\nsimulation:\n  terrain:\n    surface: "
      "hill\n    surfaces:\n      hill: {shape: heightfield, image: maps/h.png}\n");
  const ProcessResult result = RunRift({"simulate", folder / "e.yaml", "--out", folder / "out"});
  CHECK(result.exit_code == 2);  // found, and found to be no whole picture
  CHECK(result.err.find(folder / "maps/h.png") != std::string::npos);
  CHECK(result.err.find("No such file") == std::string::npos);
}

TEST_CASE("rift simulate draws its run and films it") {
  const test::TemporaryFolder folder;
  const ProcessResult result =
      RunRift({"simulate", kTask, "--out", folder / "out", "--figure", folder / "run.svg",
               "--video", folder / "run.mp4", "--tum", folder / "run.tum"});
  REQUIRE(result.exit_code == 0);
  CHECK(test::ReadFile(folder / "run.svg").find("</svg>") != std::string::npos);
  CHECK(fs::file_size(folder / "run.mp4") > 10'000);
  CHECK(trajectory::ReadLog(test::ReadFile(folder / "run.tum"), "run.tum").format ==
        trajectory::Format::kTum);
}

}  // namespace
}  // namespace rift
