// What docs/ lists of columns and keys is what the program writes, no more and no less.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "support/documented.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"
#include "support/processes/quick_gnuplot.hpp"
#include "support/tree.hpp"

namespace rift {
namespace {

using nlohmann::json;
using test::Columns;
using test::Documented;
using test::DocumentedKeys;
using test::KeysOf;
using test::ReadFile;
using test::RunRift;
using Names = std::vector<std::string>;

const std::string kTask = test::SourceDir() + "/configs/waypoints/paper.yaml";
const std::string kExample = test::SourceDir() + "/data/example/";

json JsonOf(const std::string& file) { return json::parse(ReadFile(file)); }

std::set<std::string> Without(std::set<std::string> names, const Names& optional) {
  for (const std::string& name : optional) names.erase(name);
  return names;
}

std::string RunInto(const test::TemporaryFolder& folder, const std::string& name,
                    std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), {"--out", folder / name});
  const test::ProcessResult result = RunRift(arguments);
  INFO(result.err);
  REQUIRE(result.exit_code <= 1);
  return folder / name;
}

TEST_CASE("The files of a simulated run are as documented") {
  const test::TemporaryFolder folder;
  const std::string out = RunInto(folder, "run", {"simulate", kTask});
  for (const std::string name : {"trajectory.csv", "truth.csv", "commands.csv"}) {
    INFO(name);
    CHECK(Columns(ReadFile(out + "/" + name)) == Documented("files.md", "Columns of " + name));
  }
  CHECK(KeysOf(JsonOf(out + "/summary.json")) == DocumentedKeys("summary.json of rift simulate"));
  CHECK(KeysOf(JsonOf(out + "/summary.json")["steering"]) == DocumentedKeys("steering"));
  for (const auto& entry : std::filesystem::directory_iterator(out)) {
    const Names names = Documented("files.md", "Files of a run");
    INFO(entry.path());
    CHECK(std::count(names.begin(), names.end(), entry.path().filename().string()) == 1);
  }
}

TEST_CASE("The output of rift gap is as documented") {
  const test::TemporaryFolder folder;
  const std::string evidence = folder / "gap.json", profile = folder / "profile.csv";
  const test::ProcessResult result =
      RunRift({"gap", kExample + "simulator.csv", kExample + "robot1.csv", kExample + "robot2.csv",
               "--json", evidence, "--profile", profile, "--sim-repeats", kExample + "robot2.csv"});
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  CHECK(KeysOf(JsonOf(evidence)) == DocumentedKeys("rift gap --json"));
  const Names of_sweeps{"loop_delay_s", "loop_r2",     "steering_gain_rad_s",
                        "runs",         "failed_runs", "circled_runs",
                        "prediction",   "ranks",       "classifier"};
  CHECK(KeysOf(JsonOf(evidence)["likeness"]) ==
        Without(DocumentedKeys("likeness.json"), of_sweeps));
  std::vector<std::string> columns = Documented("files.md", "Columns of the profile of rift gap");
  REQUIRE(columns.back() == "real_z_m");
  columns.resize(columns.size() - 2);  // of --dimension xyz
  CHECK(Columns(ReadFile(profile)) == columns);
}

TEST_CASE("The files of a sweep are as documented") {
  const test::QuickGnuplot gnuplot;
  const test::TemporaryFolder folder;
  const std::string out = RunInto(
      folder, "sweep",
      {"sweep", kExample + "failures.yaml", "--budget", "12", "--quiet", "--shrink", "worst"});
  Names columns = Columns(ReadFile(out + "/table.csv"));
  const auto first = std::find(columns.begin(), columns.end(), "trial");
  CHECK(first - columns.begin() == 4);  // the parameters of the space
  columns.erase(columns.begin(), first);
  CHECK(columns == Documented("files.md", "Columns of table.csv"));
  CHECK(KeysOf(JsonOf(out + "/summary.json")) ==
        Without(DocumentedKeys("summary.json of a sweep"), {"settings_omitted"}));
  CHECK(KeysOf(JsonOf(out + "/explanation.json")) == DocumentedKeys("explanation.json"));
  CHECK(KeysOf(JsonOf(out + "/shrunk.json")) == DocumentedKeys("shrunk.json"));
  const test::ProcessResult status = RunRift({"sweep", "--status", out, "--json"});
  CHECK(KeysOf(json::parse(status.out)) == DocumentedKeys("rift sweep --status --json"));
  const std::string files = ReadFile(test::SourceDir() + "/docs/files.md");
  for (const auto& entry : std::filesystem::directory_iterator(out)) {
    const std::string name = entry.path().filename().string() + (entry.is_directory() ? "/" : "");
    INFO(name);
    CHECK(files.find("`" + name + "`") != std::string::npos);
  }
}

TEST_CASE("The likeness of a sweep and the features of its classifier are as documented") {
  const test::TemporaryFolder folder;
  int seed = 0;
  for (const std::string of_setting : {"0.30", "0.31"}) {
    for (const std::string trial : {"1", "2"}) {
      RunInto(folder, "log" + of_setting + "_" + trial + ".csv",
              {"simulate", kTask, "--seed", std::to_string(++seed)});
    }
  }
  test::WriteText(folder / "like.yaml", "include: " + kTask + R"(
name: like
space: {control.v_max: [0.30, 0.31]}
start: reference
reference: {kind: logs, path: "log{v_max:.2f}_{trial}.csv", trials: [1, 2]}
likeness: {runs: 3, shuffles: 19, bootstrap: {resamples: 20}, classifier: {permutations: 3}}
)");
  const std::string out = RunInto(folder, "out", {"sweep", folder / "like.yaml", "--quiet"});
  const json all = JsonOf(out + "/likeness.json")["all"];
  CHECK(KeysOf(all) == DocumentedKeys("likeness.json"));
  CHECK(all["runs"] == 12);
  CHECK(all["classifier"]["reals"] == 4);
  std::set<std::string> features;
  for (const json& feature : all["classifier"]["features"]) features.insert(feature["name"]);
  CHECK(features == DocumentedKeys("Features of the classifier"));
}

TEST_CASE("The summary of a grid lacks only what a search adds") {
  const test::QuickGnuplot gnuplot;
  const test::TemporaryFolder folder;
  const std::string out =
      RunInto(folder, "grid",
              {"sweep", kTask, "--quiet", "--set", "space.simulation.terrain.surface=[ground]",
               "--set", "space.control.v_min=[0.15]", "--set", "space.control.v_max=[0.3, 0.4]"});
  CHECK(KeysOf(JsonOf(out + "/summary.json")) ==
        Without(DocumentedKeys("summary.json of a sweep"), {"falsification", "settings_omitted"}));
}

TEST_CASE("The log of rift track is as documented") {
  const test::TemporaryFolder folder;
  const std::string camera = test::SourceDir() + "/data/camera/";
  const std::string log = RunInto(folder, "log.csv",
                                  {"track", "--camera", camera + "frames/*.jpg", "--fps", "15",
                                   "--calibration", camera + "camera.yaml"});
  Names columns = Columns(ReadFile(log)),
        documented = Documented("files.md", "Columns of the log of rift track");
  const auto is_covariance = [](const std::string& name) { return name.starts_with("cov_"); };
  CHECK(std::erase_if(columns, is_covariance) == 21);
  CHECK(std::erase_if(documented, is_covariance) == 1);
  CHECK(columns == documented);
  CHECK(KeysOf(JsonOf(folder / "log.run.json")) == DocumentedKeys("LOG.run.json of rift track"));
}

}  // namespace
}  // namespace rift
