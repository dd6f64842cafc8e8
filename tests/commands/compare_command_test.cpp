// rift sweep --compare: two folders, before and after a change.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "support/documented.hpp"
#include "support/inputs/paths.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/browser.hpp"
#include "support/processes/process.hpp"
#include "support/processes/quick_gnuplot.hpp"

namespace rift {
namespace {

using Catch::Matchers::Contains;
using nlohmann::json;
using test::ProcessResult;
using test::ReadFile;
using test::RunRift;
using test::WriteText;

/// Logs of a simulator that is `beside_m` to the left of a straight robot on ice, 0.02 m on ground.
struct Logs {
  std::string Swept(const std::string& name, double beside_m,
                    const std::vector<std::string>& more = {}) const {
    const trajectory::Trajectory path = test::StraightPath(0.7, 40);
    for (const std::string surface : {"ground", "ice"}) {
      for (int trial = 1; trial <= 6; ++trial) {
        const std::string stem = folder / (name + "_" + surface + std::to_string(trial));
        const double left_m = (surface == "ice" ? beside_m : 0.02) + 0.001 * trial;
        WriteText(stem + "_real.csv", trajectory::WriteRift(path));
        WriteText(stem + "_sim.csv", trajectory::WriteRift(test::Moved(path, {0.0, left_m, 0.0})));
      }
    }
    WriteText(folder / (name + ".yaml"),
              "space: {surface: [ground, ice]}\n"
              "candidate: {kind: logs, path: \"" +
                  name +
                  "_{surface}{trial}_sim.csv\"}\n"
                  "reference: {kind: logs, path: \"" +
                  name +
                  "_{surface}{trial}_real.csv\", "
                  "trials: [1, 2, 3, 4, 5, 6]}\n");
    std::vector<std::string> words{"sweep", folder / (name + ".yaml"), "--quiet", "--out",
                                   folder / name};
    words.insert(words.end(), more.begin(), more.end());
    const ProcessResult result = RunRift(words);
    INFO(result.err);
    REQUIRE(result.exit_code == 0);
    return folder / name;
  }
  test::QuickGnuplot gnuplot;
  test::TemporaryFolder folder;
};

TEST_CASE("Two sweeps are held against each other by setting and by trial") {
  const Logs logs;
  const std::string before = logs.Swept("before", 0.08), after = logs.Swept("after", 0.05);
  const ProcessResult text = RunRift({"sweep", "--compare", before, after});
  INFO(text.err);
  REQUIRE(text.exit_code == 0);
  CHECK_THAT(text.out,
             Contains("6 of 12 trials failed before and 0 of 12 fail after: better (6 now "
                      "hold, 0 now fail)"));
  const ProcessResult result = RunRift({"sweep", "--compare", before, after, "--json"});
  REQUIRE(result.exit_code == 0);
  const json change = json::parse(result.out);
  CHECK(test::KeysOf(change) == test::DocumentedKeys("rift sweep --compare --json"));
  REQUIRE(change["settings"].size() == 2);
  const json& ice = change["settings"][0];  // where it changed
  CHECK(ice["setting"] == "surface ice");
  CHECK(ice["before"]["failures"] == 6);
  CHECK(ice["after"]["failures"] == 0);
  CHECK(ice["before"]["verdict"] == "falsified");
  CHECK(ice["pairs"] == 6);
  CHECK(ice["gap_change_m"].get<double>() == Approx(-0.03).margin(1e-6));
  CHECK(change["settings"][1]["gap_change_m"].get<double>() == Approx(0.0).margin(1e-9));
  CHECK(change["all"]["gap_change_m"].get<double>() == Approx(-0.015).margin(1e-6));
  CHECK(change["now_hold"] == 6);
  CHECK(change["now_fail"] == 0);
  CHECK(change["better_share"]["low"].get<double>() > 0.5);
}

TEST_CASE("What became worse is called worse and the other way round better") {
  const Logs logs;
  const std::string a = logs.Swept("a", 0.05), b = logs.Swept("b", 0.08);
  CHECK_THAT(RunRift({"sweep", "--compare", a, b}).out,
             Contains(": worse (0 now hold, 6 now fail)"));
  CHECK_THAT(RunRift({"sweep", "--compare", a, a}).out,
             Contains("no trial changed sides") && Contains("no key differs"));
}

TEST_CASE("Folders of different experiments are refused with the key that differs") {
  const Logs logs;
  const std::string a = logs.Swept("a", 0.05);
  const std::string b = logs.Swept("b", 0.08, {"--set", "gap.threshold_m=0.03"});
  const ProcessResult refused = RunRift({"sweep", "--compare", a, b});
  CHECK(refused.exit_code == 2);
  CHECK(refused.out.empty());
  CHECK_THAT(refused.err,
             Contains("hold different experiments: gap.threshold_m is 0.06 in the first "
                      "and 0.03 in the second"));
  CHECK(std::count(refused.err.begin(), refused.err.end(), '\n') == 1);
  const ProcessResult no_sweep = RunRift({"sweep", "--compare", a, logs.folder / "nowhere"});
  CHECK(no_sweep.exit_code == 2);
  CHECK_THAT(no_sweep.err, Contains("it is not the folder of a finished sweep"));
  CHECK(RunRift({"sweep", "--compare", a}).exit_code == 2);
  CHECK_THAT(RunRift({"sweep", "--page", "x.html"}).err, Contains("--compare DIR DIR"));
}

TEST_CASE("A folder whose files are damaged is not compared, and the message says what to do") {
  const Logs logs;
  const std::string before = logs.Swept("before", 0.08), after = logs.Swept("after", 0.05);
  const auto refused = [&](const std::string& says) {
    const ProcessResult result = RunRift({"sweep", "--compare", before, after});
    INFO(result.err);
    CHECK(result.exit_code == 2);
    CHECK(result.out.empty());
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
    CHECK_THAT(result.err, Contains(says) && Contains("give the command of the sweep again"));
  };
  const std::string summary = after + "/summary.json", table = after + "/table.csv";
  const std::string text = ReadFile(summary);
  for (const std::string& damaged :
       {text.substr(0, text.size() / 2), std::string("{}"), std::string("{\"settings\": [7]}")}) {
    WriteText(summary, damaged);
    refused("after/summary.json: it is damaged");
  }
  WriteText(summary, text);
  const std::string rows = ReadFile(table);
  WriteText(table, rows.substr(0, rows.size() - 10));
  refused("after/table.csv: row 12 is cut short");
}

TEST_CASE("The page of a comparison opens offline, is not overwritten and replaces no input") {
  const Logs logs;
  const std::string a = logs.Swept("a", 0.08), b = logs.Swept("b", 0.05);
  const std::string page = logs.folder / "change.html";
  REQUIRE(RunRift({"sweep", "--compare", a, b, "--page", page}).exit_code == 0);
  const std::string html = ReadFile(page);
  CHECK_THAT(html, Contains("6 of 12 trials failed before") && Contains("surface ice") &&
                       Contains("width:100.0%"));
  CHECK_THAT(html, Contains("candidate.path"));
  const ProcessResult refused = RunRift({"sweep", "--compare", a, b, "--page", page});
  CHECK(refused.exit_code == 2);
  CHECK(ReadFile(page) == html);
  CHECK(RunRift({"sweep", "--compare", a, b, "--page", page, "--force"}).exit_code == 0);
  for (const std::string& input :
       {a + "/table.csv", a + "/experiment.yaml", b + "/summary.json", b + "/./journal.sqlite"}) {
    if (input.ends_with("sqlite")) WriteText(input, "a sweep of logs has none");
    const std::string bytes = ReadFile(input);
    CHECK(RunRift({"sweep", "--compare", a, b, "--page", input, "--force"}).exit_code == 2);
    CHECK(ReadFile(input) == bytes);
  }
  const test::BrowserVisit visit = test::Visit(html);
  if (!visit.available) {
    WARN("SKIPPED: there is no chromium on this machine");
    return;
  }
  CHECK(visit.console == "");
  CHECK(visit.requests == "");
}

}  // namespace
}  // namespace rift
