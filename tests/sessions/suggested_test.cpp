// suggested.yaml in the folder of a sweep, and the drives that were made from it.
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "rift/files/files.hpp"
#include "rift/sessions/sweep/suggested.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "rift/trajectory/log.hpp"
#include "sessions/sweep/robot_logs.hpp"
#include "sessions/sweep_folder.hpp"
#include "support/processes/process.hpp"

namespace rift::sessions {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

/// A floor and a speed that a person sets, and a mismatch that nobody can.
experiment::Experiment Search(const std::vector<std::string>& overrides = {}) {
  return LoadText(kShortWay +
                      "gap: {threshold_m: 0.01}\nreference: {kind: path, trials: 1}\nseed: 5\n"
                      "goal: falsify\nspace:\n  surface: [ground, parchment]\n"
                      "  v_min: {min: 0.12, max: 0.2, step: 0.04}\n"
                      "  mismatch: {min: -0.25, max: 0.25}\n",
                  overrides);
}

std::vector<SuggestedExperiment> Read(const std::string& text) {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "suggested.yaml", text);
  return ReadSuggested(folder.Path(), Search());
}

TEST_CASE("Suggestions are in suggested.yaml and their drives below suggested") {
  CHECK(SuggestedFile("out") == "out/suggested.yaml");
  CHECK(SuggestedFolder("out") == "out/suggested");
  CHECK(SuggestedDrive("out", 3, 12) == "out/suggested/3_12");
}

TEST_CASE("A folder without suggestions has none, and what was written is read back") {
  const test::TemporaryFolder folder;
  const experiment::Experiment experiment = Search();
  CHECK(ReadSuggested(folder.Path(), experiment).empty());
  const auto& all = experiment.space.parameters;
  const SuggestedExperiment first{.number = 1,
                                  .parameters = {all[0], all[1]},
                                  .values = {all[0].levels[1], experiment::NumberValue(0.16)},
                                  .repeats = 3,
                                  .is_predicted_to_fail = true,
                                  .why = "it is near"};
  const SuggestedExperiment second{
      .number = 2, .parameters = {all[1]}, .values = {experiment::NumberValue(0.2)}, .repeats = 1};
  const std::string text = WriteSuggested({first, second});
  CHECK_THAT(text, Catch::StartsWith("# Experiments on the robot, the best first"));
  test::WriteText(folder / "suggested.yaml", text);
  const auto read = ReadSuggested(folder.Path(), experiment);
  REQUIRE(read.size() == 2);
  CHECK(read[0].number == 1);
  REQUIRE(read[0].parameters.size() == 2);
  CHECK(read[0].parameters[0].key == all[0].key);
  CHECK(read[0].parameters[1].key == all[1].key);
  CHECK(read[0].values == first.values);
  CHECK(read[0].repeats == 3);
  CHECK(read[0].is_predicted_to_fail);
  CHECK(read[0].why == "it is near");
  CHECK(read[1].number == 2);
  CHECK(read[1].values == second.values);
  CHECK(read[1].repeats == 1);
  CHECK_FALSE(read[1].is_predicted_to_fail);
  CHECK(read[1].why.empty());
  CHECK_THAT(text, !Contains("why: \"\""));
}

TEST_CASE("Each part of a suggestion is held to its rule with its file and line") {
  const std::string head = "experiments:\n  - {set: {control.v_min: 0.16}, ";
  struct Wrong {
    std::string text, says;
  };
  const Wrong wrong = GENERATE(values<Wrong>(
      {{"", "must be a list of {set, repeats, predicted}"},
       {"experiments: {a: 1}\n", "must be a list of {set, repeats, predicted}"},
       {"- 1\n", "must be a list of {set, repeats, predicted}"},
       {"experiments: [7]\n", "must be a list of {set, repeats, predicted}"},
       {"experiments: [{repeats: 1, predicted: fails}]\n", "set is missing"},
       {"experiments: [{set: {control.v_min: 0.16}, predicted: fails}]\n", "repeats is missing"},
       {"experiments: [{set: {control.v_min: 0.16}, repeats: 1}]\n", "predicted is missing"}}));
  INFO(wrong.text);
  CHECK_THROWS_WITH(Read(wrong.text), Contains("suggested.yaml") &&
                                          Contains(wrong.says.substr(wrong.says.find(' ') + 1)));
  for (const std::string repeats : {"0", "-1", "1.5", "1001", "many"}) {
    INFO(repeats);
    CHECK_THROWS_WITH(
        Read(head + "repeats: " + repeats + ", predicted: fails}\n"),
        Contains("suggested.yaml:2") && Contains("must be a whole number from 1 to 1000"));
  }
  for (const int repeats : {1, 1000}) {
    CHECK(Read(head + "repeats: " + std::to_string(repeats) + ", predicted: fails}\n")[0].repeats ==
          repeats);
  }
  CHECK_THROWS_WITH(Read(head + "repeats: 1, predicted: maybe}\n"),
                    Contains("must be fails or holds"));
  CHECK_THROWS_WITH(
      Read("experiments:\n  - {set: {control.w_max: 1}, repeats: 1, predicted: fails}\n"),
      Contains("control.w_max") && Contains("is no parameter of the sweep's space"));
}

/// A drive straight ahead, `off_m` beside the way at its end.
void SaveDrive(const fs::path& folder, double off_m, const std::string& summary) {
  trajectory::Trajectory path;
  for (int i = 0; i <= 100; ++i) {
    const double u = 0.01 * i;
    path.poses.push_back(
        {.t_s = 0.02 * i, .x_m = 0.25 * u, .y_m = 0.02 * u + off_m * u, .yaw_rad = 0.08});
  }
  fs::create_directories(folder);
  test::WriteText(folder / "trajectory.csv", trajectory::WriteRift(path));
  test::WriteText(folder / "summary.json", summary);
}

constexpr const char* kReached = "{\"outcome\": \"reached\"}";

/// The folder of a sweep with two suggestions, of which the second sets the speed alone.
struct Suggested {
  Suggested() {
    test::WriteText(folder / "suggested.yaml",
                    "experiments:\n"
                    "  - {set: {simulation.terrain.surface: parchment, control.v_min: 0.16}, "
                    "repeats: 2, predicted: fails}\n"
                    "  - {set: {control.v_min: 0.2}, repeats: 1, predicted: holds}\n");
  }
  std::vector<sweep::RobotTrials> Take(const experiment::Experiment& experiment) const {
    sweep::Evaluator evaluator(experiment, "sweep.yaml", FileInputs());
    return TakeRobotLogs(folder.Path(), evaluator);
  }
  fs::path Drive(int number, int trial) const {
    return SuggestedDrive(folder.Path(), number, trial);
  }

  test::TemporaryFolder folder;
};

TEST_CASE("Drives of suggestions are counted by what their gaps say, each with its suggestion") {
  const Suggested suggested;
  const experiment::Experiment experiment = Search();
  CHECK(suggested.Take(experiment).empty());
  SaveDrive(suggested.Drive(2, 1), 0.002, kReached);
  auto taken = suggested.Take(experiment);
  REQUIRE(taken.size() == 1);
  CHECK(taken[0].trials == 1);
  CHECK(taken[0].failures == 0);
  CHECK_FALSE(taken[0].is_predicted_to_fail);
  CHECK(taken[0].values == experiment::Theta{experiment::NumberValue(0.2)});
  SaveDrive(suggested.Drive(1, 1), 0.05, kReached);
  SaveDrive(suggested.Drive(1, 2), 0.001, kReached);
  SaveDrive(suggested.Drive(1, 4), 0.05, kReached);  // behind a gap
  taken = suggested.Take(experiment);
  REQUIRE(taken.size() == 2);
  CHECK(taken[0].trials == 2);
  CHECK(taken[0].failures == 1);
  CHECK(taken[0].is_predicted_to_fail);
  REQUIRE(taken[0].values.size() == 2);
  CHECK(taken[0].values[0].text == "parchment");
  CHECK(taken[1].trials == 1);
}

TEST_CASE("A drive is judged at the setting that it was suggested for, whatever that leaves out") {
  const experiment::Experiment experiment =
      LoadText(kShortWay +
               "gap: {threshold_m: 0.01}\nreference: {kind: path, trials: 1}\ngoal: falsify\n"
               "space:\n  surface: [ground, parchment]\n  waypoints[1].y: {min: 0, max: 0.2}\n");
  const Suggested suggested;
  test::WriteText(suggested.folder / "suggested.yaml",
                  "experiments:\n"
                  "  - {set: {\"waypoints[1].y\": 0.07}, repeats: 2, predicted: holds}\n"
                  "  - {set: {simulation.terrain.surface: parchment}, repeats: 2, predicted: "
                  "holds}\n");
  for (const int number : {1, 2}) {
    SaveDrive(suggested.Drive(number, 1), 0.0, kReached);   // to y 0.02
    SaveDrive(suggested.Drive(number, 2), 0.05, kReached);  // to y 0.07
  }
  SaveDrive(suggested.Drive(1, 3), 0.05, kReached);
  const auto taken = suggested.Take(experiment);
  REQUIRE(taken.size() == 2);
  CHECK(taken[0].trials == 3);
  CHECK(taken[0].failures == 1);
  CHECK(taken[1].trials == 2);
  CHECK(taken[1].failures == 1);
}

TEST_CASE("A drive that did not arrive is a failure where its end counts, else it tells nothing") {
  const Suggested suggested;
  SaveDrive(suggested.Drive(1, 1), 0.0, "{\"outcome\": \"timed_out\"}");
  auto taken = suggested.Take(Search());
  REQUIRE(taken.size() == 1);
  CHECK(taken[0].trials == 1);
  CHECK(taken[0].failures == 1);
  taken = suggested.Take(Search({"falsify.count.timed_out=false"}));
  REQUIRE(taken.size() == 1);
  CHECK(taken[0].trials == 0);
  CHECK(taken[0].failures == 0);
  // Those after it are taken all the same.
  SaveDrive(suggested.Drive(1, 2), 0.05, kReached);
  taken = suggested.Take(Search({"falsify.count.timed_out=false"}));
  CHECK(taken[0].trials == 1);
  CHECK(taken[0].failures == 1);
}

TEST_CASE("A drive without a proper end is named and not judged") {
  const std::string summary =
      GENERATE(as<std::string>{}, "{\"outcome\": null}", "{}", "[1]", "{\"outcome\": 3}",
               "not json", "{\"outcome\": \"arrived\"}");
  const Suggested suggested;
  SaveDrive(suggested.Drive(1, 1), 0.0, summary);
  CHECK_THROWS_WITH(suggested.Take(Search()),
                    Contains((suggested.Drive(1, 1) / "summary.json").string()) &&
                        Contains("move " + suggested.Drive(1, 1).string() + " away"));
}

TEST_CASE("No drive of a sweep over logs is taken, nor a suggestion of it written") {
  const Suggested suggested;
  SaveDrive(suggested.Drive(1, 1), 0.0, kReached);
  const experiment::Experiment logs = LoadText(
      "candidate: {kind: logs, path: \"{a}.csv\"}\nreference: {kind: logs, path: \"{a}_r.csv\", "
      "trials: [1]}\nspace: {a: [x, y]}\n");
  CHECK(suggested.Take(logs).empty());
  const std::string before = files::ReadFile(suggested.folder / "suggested.yaml");
  CHECK_FALSE(SaveSuggested(suggested.folder.Path(), logs, sweep::EmptyResult(logs), {}));
  CHECK(files::ReadFile(suggested.folder / "suggested.yaml") == before);
}

TEST_CASE("New suggestions follow those that were driven, and the others make room") {
  const Suggested suggested;
  const experiment::Experiment experiment = Search();
  const sweep::SweepResult result = sweep::EmptyResult(experiment);
  SaveDrive(suggested.Drive(1, 1), 0.0, kReached);
  const experiment::Theta driven{{"parchment", {}}, experiment::NumberValue(0.16)};
  const experiment::Theta fresh{{"ground", {}}, experiment::NumberValue(0.12)};
  sweep::Suggestions suggestions{.settable = {0, 1}};
  suggestions.list.push_back({.values = fresh, .repeats = 4, .sentence = "because"});
  suggestions.list.push_back({.values = driven, .repeats = 2});
  suggestions.list[0].is_predicted_to_fail = true;
  SaveSuggested(suggested.folder.Path(), experiment, result, suggestions);
  const auto saved = ReadSuggested(suggested.folder.Path(), experiment);
  REQUIRE(saved.size() == 2);
  CHECK(saved[0].values == driven);
  CHECK(saved[0].repeats == 3);  // one was driven, two more are asked for
  CHECK(saved[0].is_predicted_to_fail);
  CHECK(saved[1].values == fresh);
  CHECK(saved[1].repeats == 4);
  CHECK(saved[1].is_predicted_to_fail);
  CHECK(saved[1].why == "because");
  CHECK(saved[1].parameters[0].key == "simulation.terrain.surface");
  CHECK(saved[1].parameters[1].key == "control.v_min");
}

/// Two more drives of a setting that was driven once are suggested: they are further repeats of it.
void CheckTwoMoreAre(const Suggested& suggested, const experiment::Experiment& experiment,
                     const experiment::Theta& driven) {
  sweep::Suggestions suggestions{.settable = {0, 1}};
  suggestions.list.push_back({.values = driven, .repeats = 2});
  SaveSuggested(suggested.folder.Path(), experiment, sweep::EmptyResult(experiment), suggestions);
  const auto saved = ReadSuggested(suggested.folder.Path(), experiment);
  REQUIRE(saved.size() == 1);
  CHECK(saved[0].repeats == 3);
}

TEST_CASE("An edited number is the suggestion that it was, however it is written") {
  const Suggested suggested;
  test::WriteText(suggested.folder / "suggested.yaml",
                  "experiments:\n"
                  "  - {set: {simulation.terrain.surface: parchment, control.v_min: 0.160}, "
                  "repeats: 2, predicted: fails}\n");
  const experiment::Experiment experiment = Search();
  SaveDrive(suggested.Drive(1, 1), 0.0, kReached);
  CheckTwoMoreAre(suggested, experiment, {{"parchment", {}}, experiment::NumberValue(0.16)});
}

TEST_CASE("A suggestion is the same in whichever order its keys are written") {
  const Suggested suggested;
  test::WriteText(suggested.folder / "suggested.yaml",
                  "experiments:\n"
                  "  - {set: {control.v_min: 0.16, simulation.terrain.surface: parchment}, "
                  "repeats: 2, predicted: fails}\n");
  const experiment::Experiment experiment = Search();
  SaveDrive(suggested.Drive(1, 1), 0.05, kReached);
  const experiment::Theta driven{{"parchment", {}}, experiment::NumberValue(0.16)};
  const auto taken = suggested.Take(experiment);
  REQUIRE(taken.size() == 1);
  CHECK(sweep::IsSameSetting(taken[0].values, driven));
  CHECK(taken[0].failures == 1);
  CheckTwoMoreAre(suggested, experiment, driven);
}

}  // namespace
}  // namespace rift::sessions
