// What the commands answer to whom on crooked, unequal logs made here: exit code, both streams and
// every document, beside what was approved (tests/pinned/commands).

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "rift/trajectory/log.hpp"
#include "support/inputs/trials.hpp"
#include "support/pinned.hpp"
#include "support/processes/process.hpp"
#include "support/processes/quick_gnuplot.hpp"

namespace rift {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::DifferenceFromPinned;
using test::ProcessResult;
using test::RunRift;
using test::WriteText;

/// A drive with a shape, a pace and a heading of its own.
trajectory::Trajectory Drive(double bend_m, double shift_m, double pace_s, int rows) {
  trajectory::Trajectory path;
  for (int i = 0; i < rows; ++i) {
    const double u = i / (rows - 1.0);
    trajectory::StampedPose pose;
    pose.t_s = 0.2 + pace_s * i * (1.0 + 0.3 * u);
    pose.x_m = 1.1 * u + shift_m + 0.004 * std::sin(31.0 * u);
    pose.y_m = bend_m * std::sin(4.0 * u) + 0.2 * u * u - 0.3 * shift_m;
    pose.yaw_rad = std::atan2(4.0 * bend_m * std::cos(4.0 * u) + 0.4 * u, 1.1);
    pose.target_x_m = u < 0.4 ? 0.5 : 1.1;
    pose.target_y_m = u < 0.4 ? 0.1 : 0.05;
    path.poses.push_back(pose);
  }
  return path;
}

/// In a folder of their own, which is the current one: no name in an answer is of this machine.
struct Logs {
  Logs() {
    fs::current_path(folder.Path());
    int n = 0;
    for (const std::string surface : {"ground", "ice", "mud"}) {
      for (const std::string speed : {"0.15", "0.20"}) {
        const double bend_m = 0.1 + 0.02 * ++n;
        const std::string stem = surface + "/v" + speed;
        WriteText(stem + "_sim.csv",
                  trajectory::WriteRift(Drive(bend_m, 0.0, 0.047 + 0.0013 * n, 60 + n)));
        for (int trial = 1; trial <= 3; ++trial) {
          const double off_m = 0.006 * n * (trial == 2 ? -0.7 : 1.0) + 0.003 * trial;
          WriteText(stem + fmt::format("_real{}.csv", trial),
                    trajectory::WriteRift(
                        Drive(bend_m + off_m, 0.01 * trial, 0.04 + 0.002 * n, 50 + 3 * n)));
        }
      }
    }
    fs::remove("mud/v0.20_real3.csv");
    WriteText("mud/v0.15_real2.csv", "t_s,x_m,y_m\n0,0,0\n1,nan,0\n");
    WriteText("./experiment.yaml", R"(name: crooked
space:
  surface: [ground, ice, mud]
  control.v_min: [0.15, 0.20]
candidate: {kind: logs, path: "{surface}/v{v_min:.2f}_sim.csv"}
reference: {kind: logs, path: "{surface}/v{v_min:.2f}_real{trial}.csv", trials: [1, 2, 3],
            tag_offset_m: 0.02}
gap: {threshold_m: 0.045, skip_start: 0.1}
falsify: {share: 0.2, confidence: 0.9}
)");
  }
  ~Logs() { fs::current_path(before); }
  Logs(const Logs&) = delete;
  Logs& operator=(const Logs&) = delete;

  test::TemporaryFolder folder;
  fs::path before = fs::current_path();
};

/// The text with DIR for the current folder.
std::string Plain(std::string text) {
  const std::string name = fs::current_path().string();
  for (size_t at = text.find(name); at != text.npos; at = text.find(name, at)) {
    text.replace(at, name.size(), "DIR");
  }
  return text;
}

std::string Say(const std::vector<std::string>& words) {
  const ProcessResult result = RunRift(words);
  return Plain(fmt::format("$ rift {}\nexit {}\n{}---\n{}\n", fmt::join(words, " "),
                           result.exit_code, result.out, result.err));
}

TEST_CASE("rift gap answers each of its flags as it was approved") {
  const Logs logs;
  const std::string sim = "ice/v0.15_sim.csv";
  const std::string one = "ice/v0.15_real1.csv";
  const std::string two = "ice/v0.15_real2.csv";
  const std::string three = "ice/v0.15_real3.csv";
  std::string text;
  const std::vector<std::vector<std::string>> all{
      {},
      {"--samples", "50"},
      {"--skip-start", "0.3"},
      {"--align", "start"},
      {"--align", "se2"},
      {"--threshold", "0.02"},
      {"--threshold", "0.02", "--exit-code"},
      {"--threshold", "0.2", "--exit-code"},
      {"--trim-standstill", "--standstill-radius", "0.1"},
      {"--share", "0.6", "--confidence", "0.6", "--threshold", "0.01", "--exit-code"},
      {"--tag-offset", "0.05"},
      {"--tag-offset", "-0.05"},
      {"--sim-format", "rift", "--real-format", "rift"},
      {"--sim-format", "tum"},
      {"--units", "mm"},
      {"--json", "-"},
      {"--json", "-", "--skip-start", "0.2", "--align", "se2", "--tag-offset", "0.03"},
      {"--profile", "-", "--samples", "12"},
      {"--sim-repeats", "ice/v0.20_sim.csv", "mud/v0.15_sim.csv"},
      {"--json", "-", "--sim-repeats", "ice/v0.20_sim.csv"},
      {"--odometry"},
      {"--samples", "1"},
      {"--skip-start", "0.96"}};
  for (const auto& flags : all) {
    std::vector<std::string> words{"gap", sim, one, two, three};
    words.insert(words.end(), flags.begin(), flags.end());
    text += Say(words);
  }
  text += Say({"gap", sim, one, "--exit-code", "--threshold", "0.02"});
  text += Say({"gap", sim, "mud/v0.15_real2.csv"});
  text += Say({"gap", sim, "mud/v0.20_real3.csv"});
  text += Say({"gap", one, two});
  CHECK(DifferenceFromPinned("commands/gap.txt", text) == "");
}

using TableRow = std::map<std::string, std::string>;

/// Of a table without quotes.
std::vector<TableRow> ReadTable(const std::string& path) {
  std::istringstream text(test::ReadFile(path));
  std::vector<std::string> columns;
  std::vector<TableRow> rows;
  for (std::string line; std::getline(text, line);) {
    std::istringstream cells(line);
    std::vector<std::string> words;
    for (std::string cell; std::getline(cells, cell, ',');) words.push_back(cell);
    if (columns.empty()) {
      columns = words;
      continue;
    }
    rows.emplace_back();
    for (size_t i = 0; i < words.size(); ++i) rows.back()[columns.at(i)] = words[i];
  }
  return rows;
}

json PageData(const std::string& page) {
  const std::string open = R"(<script type="application/json" id="page-data">)";
  const size_t begin = page.find(open) + open.size();
  return json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

/// Where a path of the page ends.
std::pair<double, double> End(const json& paths, const json& steps) {
  double x = 0.0, y = 0.0;
  for (size_t i = 0; i + 1 < steps.size(); i += 2) {
    x += steps[i].get<double>();
    y += steps[i + 1].get<double>();
  }
  return {x * paths["unit_m"].get<double>(), y * paths["unit_m"].get<double>()};
}

/// Each row of the page names the logs that it was made of and the flags that measure it again, and
/// draws the paths that these logs hold.
void CheckPage(const json& page) {
  const json& paths = page["paths"];
  const std::vector<TableRow> rows = ReadTable("out/table.csv");
  REQUIRE(page["trials"]["rows"].size() == rows.size());
  int measured = 0;
  for (size_t i = 0; i < rows.size(); ++i) {
    const TableRow& row = rows[i];
    INFO("row " << i + 1);
    const json& again = page["trials"]["rows"][i].back();
    if (row.at("status") != "ok") {
      CHECK(again.is_null());
      continue;
    }
    std::string unquoted = again.get<std::string>();
    std::erase(unquoted, '\'');
    const std::vector<std::string> flags{"--sim-format", "auto", "--real-format", "auto",
                                         "--tag-offset", "0.02", "--skip-start",  "0.1",
                                         "--threshold",  "0.045"};
    CHECK(unquoted ==
          fmt::format("{} {} {}", row.at("candidate"), row.at("reference"), fmt::join(flags, " ")));
    const auto pose = [&](const char* side) {
      const std::string path = row.at(side);
      return trajectory::ReadLog(test::ReadFile(path), path).trajectory.poses.back();
    };
    const trajectory::StampedPose sim = pose("candidate"), real = pose("reference");
    const json& drawn = paths["rows"][std::to_string(i + 1)];
    const auto sim_end = End(paths, drawn["d"]);
    CHECK(sim_end.first == Approx(sim.x_m).margin(1.1e-4));
    CHECK(sim_end.second == Approx(sim.y_m).margin(1.1e-4));
    const json& reference = paths["references"][drawn["reference"].get<size_t>()];
    CHECK(reference["name"] == "robot, trial " + row.at("trial"));
    const auto real_end = End(paths, reference["d"]);
    CHECK(real_end.first == Approx(real.x_m + 0.02 * std::cos(real.yaw_rad)).margin(1.1e-4));
    CHECK(real_end.second == Approx(real.y_m + 0.02 * std::sin(real.yaw_rad)).margin(1.1e-4));
    if (++measured % 7 != 1) continue;
    std::vector<std::string> words{"gap", row.at("candidate"), row.at("reference"), "--json", "-"};
    words.insert(words.end(), flags.begin(), flags.end());
    const json gap = json::parse(RunRift(words).out);
    CHECK(gap["trials"][0]["gap_m"].dump() == json(std::stod(row.at("gap_m"))).dump());
    CHECK(gap["trials"][0]["u"].dump() == json(std::stod(row.at("u"))).dump());
  }
}

TEST_CASE("rift sweep over unequal logs says and writes what was approved") {
  const test::QuickGnuplot gnuplot;
  const Logs logs;
  const std::string out = "out";
  std::string text = Say({"sweep", "./experiment.yaml", "--out", out});
  for (const std::string file :
       {"table.csv", "summary.json", "explanation.json", "likeness.json"}) {
    text += "==== " + file + "\n" + Plain(test::ReadFile(out + "/" + file));
  }
  CheckPage(PageData(test::ReadFile(out + "/report.html")));

  const ProcessResult failing = RunRift(
      {"sweep", "./experiment.yaml", "--out", out, "--json", "--json-progress", "--exit-code"});
  CHECK(failing.exit_code == 1);
  CHECK(failing.out == test::ReadFile(out + "/summary.json"));
  std::istringstream lines(failing.err);
  std::string told;  // the last line of progress: a slow run has others before it
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("{")) told = line;
  }
  const json progress = json::parse(told);
  const json expected = {{"state", "done"}, {"done", 18},  {"total", 18},      {"from_journal", 0},
                         {"falsified", 7},  {"failed", 2}, {"left_s", nullptr}};
  for (const auto& [key, value] : expected.items()) {
    INFO(key);
    CHECK(progress[key] == value);
  }
  double largest_m = 0.0;
  for (const TableRow& row : ReadTable(out + "/table.csv")) {
    if (row.at("status") == "ok") largest_m = std::max(largest_m, std::stod(row.at("gap_m")));
  }
  CHECK(progress["largest_gap_m"] == largest_m);

  text += Say({"sweep", "./experiment.yaml", "--out", "holds", "--brief", "--suggest", "2", "--set",
               "gap.threshold_m=0.2", "--exit-code"});
  CHECK(DifferenceFromPinned("commands/sweep.txt", text) == "");
}

/// All help and what packages make of it. The default of --jobs is the number of cores.
TEST_CASE("The manual, the completions and the keys are those that were approved") {
  std::string text;
  for (const std::vector<std::string>& words : {std::vector<std::string>{"--help"},
                                                {"help", "--man"},
                                                {"help", "--man", "simulate"},
                                                {"help", "--man", "track"},
                                                {"help", "--man", "drive"},
                                                {"help", "--man", "gap"},
                                                {"help", "--man", "sweep"},
                                                {"help", "--bash"},
                                                {"help", "--zsh"},
                                                {"help", "gap"},
                                                {"help", "--elf"},
                                                {"help", "--man", "swep"},
                                                {"help", "gap", "sweep"}}) {
    const ProcessResult result = RunRift(words);
    text += fmt::format("$ rift {}\nexit {}\n{}---\n{}\n", fmt::join(words, " "), result.exit_code,
                        result.out, result.err);
  }
  text = std::regex_replace(text, std::regex("(the results are the same for any) \\[\\d+\\]"),
                            "$1 [CORES]");
  text = std::regex_replace(text, std::regex("rift [0-9]+\\.[0-9]+\\.[0-9]+"), "rift VERSION");
  CHECK(DifferenceFromPinned("commands/manual.txt", text) == "");
}

}  // namespace
}  // namespace rift
