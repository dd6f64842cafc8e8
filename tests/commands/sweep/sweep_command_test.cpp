#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "support/inputs/paths.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"
#include "support/processes/quick_gnuplot.hpp"
#include "support/tree.hpp"

namespace rift {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::ProcessResult;
using test::RunRift;
using test::WriteText;

const std::string kExperiment = R"(space:
  surface: [ground, ice]
  control.v_min: [0.15, 0.20]
candidate: {kind: logs, path: "{surface}/v{v_min:.2f}_sim.csv"}
reference: {kind: logs, path: "{surface}/v{v_min:.2f}_real{trial}.csv", trials: [1, 2]}
)";

/// An experiment with its logs: on ice the robot is 0.08 m beside the simulator, else 0.04 m.
struct LogFolder {
  LogFolder() {
    WriteText(experiment, kExperiment);
    const trajectory::Trajectory path = test::StraightPath(0.7, 40);
    for (const std::string surface : {"ground", "ice"}) {
      for (const std::string speed : {"0.15", "0.20"}) {
        const std::string stem = folder / (surface + "/v" + speed);
        WriteText(stem + "_sim.csv", trajectory::WriteRift(path));
        for (const int trial : {1, 2}) {
          const double offset_m = (surface == "ice" ? 0.08 : 0.04) + 0.002 * trial;
          WriteText(stem + "_real" + std::to_string(trial) + ".csv",
                    trajectory::WriteRift(test::Moved(path, {0.0, offset_m, 0.0})));
        }
      }
    }
  }
  test::TemporaryFolder folder;
  std::string experiment = folder / "experiment.yaml";
  std::string out = folder / "out";
};

TEST_CASE("rift sweep over logs writes table and summary and figures and report") {
  const LogFolder logs;
  const ProcessResult result = RunRift({"sweep", logs.experiment, "--out", logs.out});
  REQUIRE(result.exit_code == 0);
  CHECK(result.out.find("surface: ") != std::string::npos);
  CHECK(result.out.find("of the loss's variance goes with it") != std::string::npos);
  const std::string table = test::ReadFile(logs.out + "/table.csv");
  CHECK(table.starts_with("surface,v_min,trial,gap_m,falsified,status,"));
  CHECK(std::count(table.begin(), table.end(), '\n') == 9);
  const json summary = json::parse(test::ReadFile(logs.out + "/summary.json"));
  CHECK(summary["n"] == 8);
  CHECK(summary["failures"] == 4);
  CHECK(summary["mean_gap_m"].get<double>() == Approx(0.063));
  CHECK(summary["by"]["surface"]["ice"]["failures"] == 4);
  CHECK(summary["by"]["surface"]["ground"]["mean_gap_m"].get<double>() == Approx(0.043));
  CHECK(summary["by"]["v_min"]["0.20"]["n"] == 4);
  CHECK(summary["anova"]["v_min"]["p"] > 0.05);
  for (const char* name : {"fig07", "fig08", "fig09", "fig10", "fig11", "fig12", "fig13"}) {
    int found = 0;
    for (const auto& entry : fs::directory_iterator(logs.out + "/figures")) {
      found += entry.path().filename().string().starts_with(name);
    }
    INFO(name);
    CHECK(found == 2);
  }
  CHECK(test::ReadFile(logs.out + "/report.html").find("</html>") != std::string::npos);
}

TEST_CASE("A resolved experiment gives the same bytes again") {
  const test::QuickGnuplot gnuplot;
  const LogFolder logs;
  REQUIRE(RunRift({"sweep", logs.experiment, "--out", logs.out, "--set", "gap.skip_start=0.1"})
              .exit_code == 0);
  const std::string again = logs.folder / "again";
  REQUIRE(RunRift({"sweep", logs.out + "/experiment.yaml", "--out", again}).exit_code == 0);
  for (const auto& entry : fs::recursive_directory_iterator(logs.out)) {
    if (!entry.is_regular_file()) continue;
    const fs::path twin = again / fs::relative(entry.path(), logs.out);
    INFO(twin.string());
    CHECK(test::ReadFile(entry.path()) == test::ReadFile(twin));
  }
}

TEST_CASE("A missing log is a row with its status and a bad one too") {
  const test::QuickGnuplot gnuplot;
  const LogFolder logs;
  fs::remove(logs.folder / "ice/v0.15_real2.csv");
  WriteText(logs.folder / "ice/v0.20_real1.csv", "t_s,x_m,y_m\n0,0,0\n1,nan,0\n");
  const ProcessResult result = RunRift({"sweep", logs.experiment, "--out", logs.out});
  REQUIRE(result.exit_code == 0);
  const std::string table = test::ReadFile(logs.out + "/table.csv");
  CHECK(std::count(table.begin(), table.end(), '\n') == 9);
  CHECK(table.find("ice,0.15,2,,,missing,") != std::string::npos);
  CHECK(table.find("ice,0.20,1,,,unreadable,") != std::string::npos);
  CHECK(table.find("v0.20_real1.csv:3: column x_m is 'nan'") != std::string::npos);
  const json summary = json::parse(test::ReadFile(logs.out + "/summary.json"));
  CHECK(summary["n"] == 6);
  CHECK(summary["not_ok"] == 2);
}

TEST_CASE("rift sweep says in one line what is wrong with its experiment") {
  const LogFolder logs;
  const std::string bad = logs.folder / "bad.yaml";
  const auto refusal = [&](const std::string& text, const std::string& set = "") {
    WriteText(bad, text);
    std::vector<std::string> arguments{"sweep", bad, "--out", logs.out};
    if (!set.empty()) arguments.insert(arguments.end(), {"--set", set});
    const ProcessResult result = RunRift(arguments);
    CHECK(result.exit_code == 2);
    CHECK_FALSE(fs::exists(logs.out));
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
    const size_t at = result.err.find("bad.yaml");
    return at == std::string::npos ? result.err : result.err.substr(at);
  };
  CHECK(refusal("gap:\n  smaples: 5\n") ==
        "bad.yaml:2:3: key 'gap.smaples' is 5: no such key; did you mean 'gap.samples'?\n");
  CHECK(refusal(kExperiment + "gap: {samples: 1}\n") ==
        "bad.yaml:6:16: key 'gap.samples' is 1: must be in [2, 10000000]; meaning: evenly spaced "
        "values of u in [0, 1] (paper, section 3.1)\n");
  CHECK(refusal(kExperiment, "gap.samples=many").find("--set gap.samples") != std::string::npos);
  CHECK(refusal("space: {v_min: []}\n") ==
        "bad.yaml:1:16: key 'space.v_min' is a list of 0: an axis needs at least one value\n");
  CHECK(refusal("space: {v_min: 3}\n") ==
        "bad.yaml:1:16: key 'space.v_min' is 3: must be a list of values, or {min: a, max: b}\n");
  CHECK(refusal("space: {a.v: [1], b.v: [2]}\n") ==
        "bad.yaml:1:8: key 'space' is a block of keys: a.v and b.v have the same last name 'v'\n");
  CHECK(refusal("reference: {trials: 0}\n").find("must be a list of trials") != std::string::npos);
  CHECK(refusal("candidate: {kind: logs}\n").find("candidate.path is missing") !=
        std::string::npos);
  CHECK(refusal("waypoints: []\n").starts_with("bad.yaml: "));
  CHECK(refusal("waypoints: [{x: 0, y: 0}, {x: 1, y: 0}]\nstart: reference\n")
            .starts_with("bad.yaml: start is reference, and reference.kind is path"));
  const std::string simulated = "waypoints: [{x: 0, y: 0}, {x: 1, y: 0}]\n";
  CHECK(refusal(simulated + "space: {seed: [1, 2]}\n").find("for repeats set reference.trials") !=
        std::string::npos);
  CHECK(refusal(simulated + "space: {gap.threshold_m: [1, 2]}\n").starts_with("bad.yaml:2:9"));
  CHECK(refusal("space: {gap_m: [1]}\n").find("is a column of table.csv") != std::string::npos);
}

TEST_CASE("A sweep in which nothing could be compared still leaves its rows") {
  const LogFolder logs;
  fs::remove_all(logs.folder / "ground");
  fs::remove_all(logs.folder / "ice");
  const ProcessResult result = RunRift({"sweep", logs.experiment, "--out", logs.out});
  CHECK(result.exit_code == 2);
  CHECK(result.err.find("not one of 8 trials could be compared") != std::string::npos);
  const std::string table = test::ReadFile(logs.out + "/table.csv");
  CHECK(std::count(table.begin(), table.end(), '\n') == 9);
}

TEST_CASE("A sweep in which nothing could be compared leaves no report of an earlier one") {
  const test::QuickGnuplot gnuplot;
  const LogFolder logs;
  REQUIRE(RunRift({"sweep", logs.experiment, "--out", logs.out}).exit_code == 0);
  fs::remove_all(logs.folder / "ground");
  fs::remove_all(logs.folder / "ice");
  CHECK(RunRift({"sweep", logs.experiment, "--out", logs.out}).exit_code == 2);
  CHECK(fs::exists(logs.out + "/table.csv"));
  for (const char* name : {"report.html", "explanation.json", "likeness.json", "figures"}) {
    INFO(name);
    CHECK_FALSE(fs::exists(logs.out + "/" + name));
  }
}

TEST_CASE("Robots that never arrive are failures and end with 1") {
  const test::TemporaryFolder folder;
  const ProcessResult result =
      RunRift({"sweep", test::SourceDir() + "/configs/waypoints/paper.yaml", "--out",
               folder / "out", "--set", "trial.timeout_s=1", "--set", "space.v_min=[0.15]"});
  CHECK(result.exit_code == 1);
  CHECK(result.out.find("0 passed, 0 not seen to fail") != std::string::npos);
  CHECK(test::ReadFile(folder / "out/table.csv").find("0.15,1,,true,timed_out,") !=
        std::string::npos);
}

TEST_CASE("A key that is true or false can be an axis") {
  const test::QuickGnuplot gnuplot;
  const test::TemporaryFolder folder;
  WriteText(folder / "bool.yaml",
            "waypoints: [{x: 0, y: 0}, {x: 0.4, y: 0}]\n"
            "space: {simulation.link.two_decimals: [true, false]}\n");
  REQUIRE(RunRift({"sweep", folder / "bool.yaml", "--out", folder / "out"}).exit_code == 0);
  const std::string table = test::ReadFile(folder / "out/table.csv");
  CHECK(table.find("\ntrue,") != std::string::npos);
  CHECK(table.find("\nfalse,") != std::string::npos);
}

TEST_CASE("Settings whose labels would read alike stay apart") {
  const test::QuickGnuplot gnuplot;
  const LogFolder logs;
  for (const std::string name : {"x|y, z", "x, y|z", "x|z", "x, y|y, z"}) {
    const trajectory::Trajectory path = test::StraightPath(0.7, 40);
    WriteText(logs.folder / (name + "_1.csv"), trajectory::WriteRift(path));
    WriteText(logs.folder / (name + "_2.csv"), trajectory::WriteRift(path));
  }
  WriteText(logs.experiment, R"(space:
  a: [x, "x, y"]
  b: ["y, z", z]
candidate: {kind: logs, path: "{a}|{b}_1.csv"}
reference: {kind: logs, path: "{a}|{b}_{trial}.csv", trials: 2}
)");
  const ProcessResult result = RunRift({"sweep", logs.experiment, "--out", logs.out, "--json"});
  REQUIRE(result.exit_code == 0);
  CHECK(json::parse(result.out)["settings"].size() == 4);
}

TEST_CASE("A waypoint file alone is swept on the simulator over the paper's grid") {
  const test::QuickGnuplot gnuplot;
  const test::TemporaryFolder folder;
  const ProcessResult result =
      RunRift({"sweep", test::SourceDir() + "/configs/waypoints/paper.yaml", "--out",
               folder / "out", "--json"});
  REQUIRE(result.exit_code == 0);
  CHECK(result.err.find("names no space: the paper's grid") != std::string::npos);
  const json summary = json::parse(result.out);
  CHECK(summary["n"] == 30);
  CHECK(summary["candidate"] == "simulation");
  CHECK(summary["reference"] == "path");
  CHECK(summary["anova"]["v_max"]["p"] > 0.05);
}

TEST_CASE("A simulation against its own nominal run has no gap at the nominal setting") {
  const test::QuickGnuplot gnuplot;
  const test::TemporaryFolder folder;
  const ProcessResult result = RunRift(
      {"sweep", test::SourceDir() + "/configs/waypoints/paper.yaml", "--out", folder / "out",
       "--set", "reference={kind: nominal, trials: 2}", "--set", "space.surface=[ground, bump]",
       "--set", "simulation.terrain.surfaces.bump.bump_height_m=0.0015", "--json"});
  REQUIRE(result.exit_code == 0);
  const json summary = json::parse(result.out);
  CHECK(summary["n"].get<int>() >= 3);  // a run may stay hanging at a block
  CHECK(summary["by"]["surface"]["ground"]["mean_gap_m"] == 0.0);
  CHECK(summary["by"]["surface"]["bump"]["mean_gap_m"] > 0.001);
}

TEST_CASE("The paper's table comes out of the authors' logs") {
  RIFT_SKIP_WITHOUT_TRIALS();
  const test::QuickGnuplot gnuplot;
  const test::TemporaryFolder folder;
  const ProcessResult result =
      RunRift({"sweep", test::SourceDir() + "/configs/paper_webots.yaml", "--out", folder / "out",
               "--json", "--set", "likeness.classifier.permutations=0"});
  REQUIRE(result.exit_code == 0);
  const json summary = json::parse(result.out);
  CHECK(summary["n"] == 48);
  CHECK(summary["not_ok"] == 0);
  // Trials 1 and 2 of the paper's figure 12.
  CHECK(summary["by"]["surface"]["ground"]["failures"] == 6);
  CHECK(summary["by"]["surface"]["cardboard"]["failures"] == 0);
  CHECK(summary["anova"]["surface"]["p"] < 0.05);
  CHECK(summary["anova"]["v_max"]["p"] > 0.05);
}

}  // namespace
}  // namespace rift
