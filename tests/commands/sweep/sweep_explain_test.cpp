#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "support/documented.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"
#include "support/processes/quick_gnuplot.hpp"
#include "support/tree.hpp"

namespace rift {
namespace {

using Catch::Matchers::Contains;
using nlohmann::json;
using test::ProcessResult;
using test::ReadFile;
using test::RunRift;
using test::WriteText;

// A short task, so that a trial takes milliseconds. Only the mismatch of the wheels drives the
// robot off the path of the nominal run; the other parameters are decoration.
const std::string kSearch = R"(waypoints: [{x: 0, y: 0, heading: 0}, {x: 0.25, y: 0.02, stop: true}]
gap: {threshold_m: 0.01}
reference: {kind: nominal}
goal: falsify
space:
  surface: [ground, parchment]
  v_min: {min: 0.12, max: 0.2}
  mismatch: {min: -0.25, max: 0.25}
search: {budget: 40, strategy: random}
falsify: {until: budget, most_repeats: 1}
)";

struct Sweep {
  explicit Sweep(const std::string& text = kSearch) { WriteText(file, text); }
  ProcessResult Run(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"sweep", file, "--out", out, "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    return RunRift(words);
  }
  json File(const std::string& name) const { return json::parse(ReadFile(out + "/" + name)); }

  test::QuickGnuplot gnuplot;
  test::TemporaryFolder folder;
  std::string file = folder / "experiment.yaml";
  std::string out = folder / "out";
};

/// A line of a table; 0 is its head.
std::string Line(const std::string& table, int row) {
  size_t at = 0;
  for (int i = 0; i < row; ++i) at = table.find('\n', at) + 1;
  return table.substr(at, table.find('\n', at) - at);
}

/// Replays what a command of the form `rift simulate --replay DIR ID` names.
ProcessResult Replay(const std::string& command) {
  std::istringstream words(command);
  std::vector<std::string> arguments;
  for (std::string word; words >> word;) arguments.push_back(word);
  arguments.erase(arguments.begin());
  return RunRift(arguments);
}

TEST_CASE("A failure shrunk by rift sweep still falsifies and none of its changes can be dropped") {
  const Sweep sweep;
  REQUIRE(sweep.Run().exit_code == 0);
  const std::string table = ReadFile(sweep.out + "/table.csv");
  const ProcessResult result = sweep.Run({"--shrink", "worst"});
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.out, Contains("none of these changes can be left out"));
  CHECK(ReadFile(sweep.out + "/table.csv") == table);  // further trials are no part of the sweep

  const json shrunk = sweep.File("shrunk.json");
  CHECK(shrunk["is_minimal"] == true);
  CHECK(shrunk["failing"]["falsified"] == true);
  CHECK(shrunk["shrunk"]["falsified"] == true);
  CHECK(shrunk["shrunk"]["gap_m"].get<double>() > 0.01);
  REQUIRE(shrunk["changes"].size() >= 1);
  CHECK(shrunk["changes"].size() < 3);
  const ProcessResult again = Replay(shrunk["shrunk"]["replay"]);
  CHECK_THAT(again.err, Contains("to the last bit as in the table"));
  CHECK_THAT(Line(ReadFile(sweep.out + "/shrunk/table.csv"), 2), Contains(",true,ok,"));
  for (const json& change : shrunk["changes"]) {
    const std::string& name = change["parameter"].get_ref<const std::string&>();
    CHECK(change["nominal"] == shrunk["nominal"][name]);
    CHECK(change["failing"] == shrunk["failing"]["theta"][name]);
    CHECK(change["shrunk"] == shrunk["shrunk"]["theta"][name]);
    CHECK(change["without"]["falsified"] == false);
    CHECK_THAT(Replay(change["without"]["replay"]).err, Contains("to the last bit"));
  }
  // No larger in any change than the row it came from.
  for (const auto& [key, nominal] : shrunk["nominal"].items()) {
    if (!nominal.is_number()) continue;
    const double from = shrunk["failing"]["theta"][key], to = shrunk["shrunk"]["theta"][key];
    CHECK(std::abs(to - nominal.get<double>()) <= std::abs(from - nominal.get<double>()));
  }
}

TEST_CASE("A failure of the experiment's own values shrinks to no change at all") {
  // The polyline is a thousandth of a millimetre from no path: every setting fails.
  const Sweep sweep(R"(waypoints: [{x: 0, y: 0, heading: 20}, {x: 0.25, y: 0.02, stop: true}]
gap: {threshold_m: 0.000001}
simulation:
  terrain: {surface: "floor #2", surfaces: {"floor #2": {mu: 0.4}}}
space:
  surface: [ground, "floor #2"]
  waypoints[0].x: [0.05]
)");
  const ProcessResult result = sweep.Run({"--shrink", "1"});
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  const json shrunk = sweep.File("shrunk.json");
  CHECK(shrunk["nominal"] == json{{"surface", "floor #2"}, {"x", 0.0}});
  CHECK(shrunk["changes"].empty());
  CHECK(shrunk["shrunk"]["theta"] == shrunk["nominal"]);
  CHECK(shrunk["shrunk"]["falsified"] == true);
  CHECK_THAT(Replay(shrunk["shrunk"]["replay"]).err, Contains("to the last bit"));
}

TEST_CASE("Where no gap fails the worst is a trial that did not arrive") {
  const Sweep sweep(R"(waypoints: [{x: 0, y: 0, heading: 0}, {x: 0.25, y: 0.02, stop: true}]
gap: {threshold_m: 10}
reference: {kind: nominal}
space: {trial.timeout_s: [20, 0.5], mismatch: [0.0, 0.1]}
)");
  const ProcessResult result = sweep.Run({"--shrink", "worst"});
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  const json shrunk = sweep.File("shrunk.json");
  CHECK(shrunk["failing"]["theta"]["timeout_s"] == 0.5);
  REQUIRE(shrunk["changes"].size() == 1);
  CHECK(shrunk["changes"][0]["parameter"] == "timeout_s");
  CHECK_THAT(result.out, Contains("own values (timed_out; "));
  const ProcessResult replay = RunRift({"simulate", "--replay", sweep.out, "worst"});
  CHECK_THAT(replay.err, Contains("row 4: status timed_out, no gap, to the last bit"));
}

TEST_CASE("A row that does not fail cannot be shrunk and neither can one that is not there") {
  const Sweep sweep;
  REQUIRE(sweep.Run().exit_code == 0);
  const std::string table = ReadFile(sweep.out + "/table.csv");
  int held = 1;
  while (Line(table, held).find(",false,ok,") == std::string::npos) ++held;
  const auto refusal = [&](const std::string& row) {
    const ProcessResult result = sweep.Run({"--shrink", row});
    CHECK(result.exit_code == 2);
    return result.err;
  };
  CHECK_THAT(refusal(std::to_string(held)), Contains("does not fail"));
  CHECK_THAT(refusal("41"), Contains("rows 1 to 40"));
  CHECK_THAT(refusal("best"), Contains("--shrink best: must be the id of a row"));
  CHECK_FALSE(std::filesystem::exists(sweep.out + "/shrunk.json"));
}

/// What the page of a sweep is drawn from.
json PageData(const std::string& report) {
  const std::string page = ReadFile(report), open = R"(id="page-data">)";
  const size_t begin = page.find(open) + open.size();
  return json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

TEST_CASE("The report holds the path of every trial and what it is held against") {
  const Sweep sweep;
  REQUIRE(sweep.Run({"--jobs", "2"}).exit_code == 0);
  const json paths = PageData(sweep.out + "/report.html")["paths"];
  CHECK(paths["rows"].size() == 40);
  REQUIRE(paths["references"].size() >= 1);
  CHECK(paths["waypoints"].size() >= 2);
  const json& worst = paths["rows"][std::to_string(paths["views"][0]["worst"].get<int>())];
  CHECK(worst["fails"] == true);
  CHECK(worst["reference"].get<int>() >= 0);
  CHECK(worst["d"].size() == 130);  // 65 points
  // The same from the journal alone: nothing is computed again.
  REQUIRE(sweep.Run({"--jobs", "1"}).exit_code == 0);
  CHECK(PageData(sweep.out + "/report.html")["paths"] == paths);
  int drawn = 0;
  for (const auto& file : std::filesystem::directory_iterator(sweep.out + "/figures")) {
    drawn += file.path().extension() == ".svg";
  }
  const std::string page = ReadFile(sweep.out + "/report.html");
  size_t shown = 0;
  for (size_t at = page.find("base64,"); at != page.npos; at = page.find("base64,", at + 1))
    ++shown;
  CHECK(shown == static_cast<size_t>(drawn));
}

TEST_CASE("Each row of a sweep names its number and the report tells how to drive it again") {
  const Sweep sweep;
  REQUIRE(sweep.Run().exit_code == 0);
  const json explanation = sweep.File("explanation.json");
  REQUIRE(explanation["failures"].size() >= 1);
  const int row = explanation["failures"][0]["typical_row"];
  const ProcessResult again = RunRift({"simulate", "--replay", sweep.out, std::to_string(row)});
  CHECK_THAT(again.err, Contains("to the last bit as in the table"));
  CHECK_THAT(ReadFile(sweep.out + "/report.html"), Contains("rift simulate --replay"));
  CHECK(explanation["failure_probability"]["draws"] == 40);
}

TEST_CASE("The next experiments are printed with what each would decide") {
  const Sweep sweep(R"(waypoints: [{x: 0, y: 0, heading: 0}, {x: 0.25, y: 0.02, stop: true}]
gap: {threshold_m: 0.01}
reference: {kind: path, trials: 3}
space: {surface: [ground, parchment], v_min: [0.14, 0.18]}
simulation.mocap: {noise_across_m: 0.002}
)");
  const ProcessResult result = sweep.Run({"--suggest", "2"});
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.out, Contains("1. ") && Contains("the risk of calling it wrongly falls from"));
  const json suggestions = sweep.File("explanation.json")["suggestions"]["experiments"];
  REQUIRE(suggestions.size() >= 1);
  CHECK(suggestions.size() <= 2);
  CHECK(suggestions[0]["repeats"].get<int>() >= 1);
  CHECK(suggestions[0]["wrong_after"] < suggestions[0]["wrong_now"]);
  CHECK_THAT(ReadFile(sweep.out + "/suggested.yaml"),
             Contains("\"simulation.terrain.surface\": ") && Contains("predicted: "));
}

/// The drive of a robot that is a simulation with other values, where rift drive saves it.
void DriveInto(const Sweep& sweep, const std::string& name, const std::vector<std::string>& sets) {
  std::vector<std::string> words{"simulate", sweep.file, "--out", sweep.out + "/suggested/" + name};
  for (const std::string& set : sets) {
    words.push_back("--set");
    words.push_back(set);
  }
  const ProcessResult result = RunRift(words);
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
}

TEST_CASE("Drives of suggested experiments come back into the sweep that suggested them") {
  const Sweep sweep(R"(waypoints: [{x: 0, y: 0, heading: 0}, {x: 0.25, y: 0.02, stop: true}]
gap: {threshold_m: 0.01}
reference: {kind: nominal}
goal: falsify
space:
  v_min: {min: 0.12, max: 0.2, step: 0.04}
  mismatch: {min: -0.25, max: 0.25}
search: {budget: 30}
falsify: {until: budget, most_repeats: 3}
)");
  REQUIRE(sweep.Run({"--suggest", "2"}).exit_code == 0);
  const std::string table = ReadFile(sweep.out + "/table.csv");
  const json before = sweep.File("explanation.json");
  REQUIRE(before["robot"].empty());
  REQUIRE(before["suggestions"]["experiments"].size() >= 1);
  const json first = before["suggestions"]["experiments"][0];
  CHECK(first["predicted_to_fail"] == true);
  CHECK_FALSE(first["set"].contains("mismatch"));
  // A robot whose motors differ by as much as the worst of the space.
  const std::string v_min = "control.v_min=" + first["set"]["v_min"].dump();
  for (const char* trial : {"1_1", "1_2"}) {
    DriveInto(sweep, trial, {v_min, "simulation.motor.mismatch=0.25"});
  }
  const ProcessResult result = sweep.Run({"--suggest", "2"});
  INFO(result.out << result.err);
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.out, Contains("1 of 1 predicted failures confirmed by the robot (falsified)"));
  CHECK(ReadFile(sweep.out + "/table.csv") == table);
  const json after = sweep.File("explanation.json");
  REQUIRE(after["robot"].size() == 1);
  CHECK(after["robot"][0]["n"] == 2);
  CHECK(after["robot"][0]["failures"] == 2);
  CHECK(after["robot"][0]["verdict"] == "falsified");
  CHECK(after["suggestions"]["trusted"] > before["suggestions"]["trusted"]);
  // What was driven keeps its number.
  CHECK_THAT(ReadFile(sweep.out + "/suggested.yaml"),
             Contains("\"control.v_min\": " + first["set"]["v_min"].dump()));
}

TEST_CASE("A file of suggestions that sets what the space does not vary is refused") {
  const Sweep sweep;
  REQUIRE(sweep.Run().exit_code == 0);
  WriteText(sweep.out + "/suggested.yaml",
            "experiments:\n  - {set: {control.w_max: 0.4}, repeats: 1, predicted: fails}\n");
  const ProcessResult result = sweep.Run();
  CHECK(result.exit_code == 2);
  CHECK_THAT(result.err, Contains("suggested.yaml:2") && Contains("control.w_max") &&
                             Contains("is no parameter of the sweep's space"));
}

TEST_CASE("A rare event is estimated over the space with an interval") {
  const Sweep sweep;
  const ProcessResult result = sweep.Run({"--rare-event"});
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  const json rare = sweep.File("rare_event.json");
  CHECK(test::KeysOf(rare) == test::DocumentedKeys("rare_event.json"));
  const json often = sweep.File("explanation.json")["failure_probability"];
  CHECK_THAT(result.out, Contains("fails with a probability of"));
  CHECK(rare["is_reached"] == true);
  // The draws of the sweep see the same space: the intervals overlap.
  CHECK(rare["low"].get<double>() < often["high"].get<double>());
  CHECK(rare["high"].get<double>() > often["low"].get<double>());
}

TEST_CASE("Further trials need a simulator and a space") {
  const Sweep logs("candidate: {kind: logs, path: a.csv}\nreference: {kind: logs, path: b.csv}\n");
  CHECK_THAT(logs.Run({"--shrink", "1"}).err, Contains("candidate.kind is logs"));
  CHECK(logs.Run({"--rare-event"}).exit_code == 2);
  const Sweep sweep;
  CHECK(sweep.Run({"--suggest", "0"}).exit_code == 2);
}

/// The paper's grid over recorded logs: what its data alone say (authors' Webots against 48
/// trials).
TEST_CASE("The paper's grid says that v_max is inert and why and what matters") {
  RIFT_SKIP_WITHOUT_TRIALS()
  const test::QuickGnuplot gnuplot;
  const test::TemporaryFolder folder;
  const std::string out = folder / "out";
  const ProcessResult result =
      RunRift({"sweep", test::SourceDir() + "/configs/paper_webots.yaml", "--out", out, "--quiet",
               "--set", "likeness.classifier.permutations=0"});
  REQUIRE(result.exit_code == 0);
  const json explanation = json::parse(ReadFile(out + "/explanation.json"));
  const json& v_max = explanation["parameters"]["v_max"];
  CHECK(v_max["inert"] == true);
  CHECK(v_max["effect_seen"] == false);
  const json& pair = v_max["identical_paths"].back();  // downhill alone has runs that differ
  CHECK(pair["values"] == json{"0.40", "0.50"});
  CHECK(pair["identical"] == 12);
  CHECK(pair["compared"] == 16);
  for (const char* side : {"candidate_limit", "reference_limit"}) {
    for (const json& use : v_max[side]) {
      if (use["value"] < 0.4) continue;
      CHECK(use["runs"] > 0);
      CHECK(use["decisions_bound"] == 0);
      CHECK(use["largest_asked_for"] < use["value"]);
    }
  }
  CHECK(explanation["parameters"]["surface"]["effect_seen"] == true);
  CHECK(explanation["anatomy"]["start_matters"] == true);

  const json summary = json::parse(ReadFile(out + "/summary.json"));
  const auto undecided =
      std::count_if(summary["settings"].begin(), summary["settings"].end(),
                    [](const json& setting) { return setting["verdict"] == "undecided"; });
  CHECK(undecided > 0);
  CHECK(explanation["undecided"].size() == static_cast<size_t>(undecided));
  const std::string page = ReadFile(out + "/report.html");
  CHECK_THAT(page, Contains("v_max is inert") && Contains("never bound: the candidate"));
  CHECK_THAT(page, Contains("surface: ") && Contains("Start placement matters"));
  CHECK_THAT(page, Contains("Undecided: ") && Contains("rift gap"));
}

}  // namespace
}  // namespace rift
