// What a sweep computes when one of its inputs has changed since it was run: the trials that depend
// on it, and no others. However it came about, its folder is that of a sweep into an empty one.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "support/inputs/png_bytes.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"
#include "support/processes/quick_gnuplot.hpp"

namespace rift {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using nlohmann::json;
using test::ProcessResult;
using test::ReadFile;
using test::RunRift;
using test::WriteText;
using Words = std::vector<std::string>;

/// One change, made on top of those before it.
struct Change {
  std::string what;
  std::function<void()> make = [] {};
  Words flags = {};
  /// Rows that depend on it: their cells begin so ("ground,0.14,1"). Nothing: no row does.
  std::vector<std::string> rows = {};
  /// What the sweep answers instead of going on; it then starts over with --fresh.
  std::string refusal = "";
};

struct Folder {
  Folder() {
    for (int i = 0; i < 41; ++i) {
      const double u = i / 40.0;
      line += fmt::format("{:.2f},{:.4f},{:.6f},0\n", 0.05 * i, 0.25 * u, 0.01 * u * u);
    }
  }

  /// A log of its own for each number.
  std::string Log(int number) const {
    return fmt::format("{}3,{:.4f},0.01,0\n", line, 0.251 + 1e-3 * number);
  }
  void Write(const std::string& name, const std::string& text) const {
    WriteText(folder / name, text);
  }
  /// The last digit but one of the log is another.
  void ChangeByte(const std::string& name) const {
    std::string text = ReadFile(folder / name);
    char& digit = text.at(text.rfind("0,0.01,") - 1);
    digit = digit == '9' ? '0' : static_cast<char>(digit + 1);
    Write(name, text);
  }
  std::vector<std::string> Table(const std::string& out) const {
    std::istringstream text(ReadFile(folder / (out + "/table.csv")));
    std::vector<std::string> lines;
    for (std::string row; std::getline(text, row);) lines.push_back(row);
    return lines;
  }
  /// All that a sweep leaves, by name, but its journal.
  std::map<std::string, std::string> Files(const std::string& out) const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder / out)) {
      if (!entry.is_regular_file() || entry.path().filename() == "journal.sqlite") continue;
      files[fs::relative(entry.path(), folder / out).string()] = ReadFile(entry.path());
    }
    return files;
  }
  ProcessResult Sweep(const std::string& out, const Words& flags) const {
    Words words{"sweep", folder / "sweep.yaml", "--out", folder / out, "--json-progress"};
    words.insert(words.end(), flags.begin(), flags.end());
    return RunRift(words);
  }

  std::string line = "t_s,x_m,y_m,yaw_rad\n";
  test::TemporaryFolder folder;
};

/// Trials that a sweep has computed, of all that it has.
struct Counts {
  int computed = 0;
  int all = 0;
};

Counts CountsOf(const ProcessResult& result) {
  const size_t at = result.err.rfind(R"({"state")");
  REQUIRE(at != std::string::npos);
  const json progress = json::parse(result.err.substr(at, result.err.find('\n', at) - at));
  const int all = progress["done"];
  return {all - progress["from_journal"].get<int>(), all};
}

/// What differs: names of files, and of rows their first cells.
std::string Difference(const std::map<std::string, std::string>& a,
                       const std::map<std::string, std::string>& b) {
  std::string names;
  for (const auto& [name, text] : a) {
    if (!b.contains(name) || b.at(name) != text) names += name + " ";
  }
  for (const auto& [name, text] : b) names += a.contains(name) ? "" : name + " ";
  return names;
}

/// The rows of `after` that are not so in `before`, cut at the length of those that are expected.
std::vector<std::string> ChangedRows(const std::vector<std::string>& before,
                                     const std::vector<std::string>& after, size_t labels) {
  std::vector<std::string> changed;
  REQUIRE(before.size() == after.size());
  for (size_t i = 1; i < after.size(); ++i) {
    if (before[i] == after[i]) continue;
    size_t end = 0;
    for (size_t label = 0; label < labels; ++label) end = after[i].find(',', end) + 1;
    changed.push_back(after[i].substr(0, end - 1));
  }
  return changed;
}

/// Runs the sweep after each change. `labels` are the columns before gap_m. A sweep that keeps no
/// journal computes all its rows each time.
void CheckChanges(const Folder& folder, size_t labels, bool has_journal,
                  const std::vector<Change>& changes) {
  const test::QuickGnuplot gnuplot;
  const ProcessResult first = folder.Sweep("out", {});
  INFO(first.err);
  REQUIRE(first.exit_code == 0);
  const Counts all = CountsOf(first);
  REQUIRE(all.computed == all.all);
  for (const Change& change : changes) {
    const std::vector<std::string> before = folder.Table("out");
    change.make();
    Words flags = change.flags;
    if (!change.refusal.empty()) {
      const ProcessResult refused = folder.Sweep("out", flags);
      INFO(change.what << ": " << refused.err);
      CHECK(refused.exit_code == 2);
      CHECK_THAT(refused.err, Contains(change.refusal));
      CHECK(folder.Table("out") == before);
      flags.emplace_back("--fresh");
    }
    const ProcessResult result = folder.Sweep("out", flags);
    INFO(change.what << ": " << result.err);
    REQUIRE(result.exit_code == 0);
    const Counts counts = CountsOf(result);
    const bool is_anew = !has_journal || !change.refusal.empty();
    CHECK(counts.all == all.all);
    CHECK(counts.computed == (is_anew ? all.all : static_cast<int>(change.rows.size())));
    if (change.refusal.empty())
      CHECK(ChangedRows(before, folder.Table("out"), labels) == change.rows);
    fs::remove_all(folder.folder / "fresh");
    REQUIRE(folder.Sweep("fresh", flags).exit_code == 0);
    CHECK(Difference(folder.Files("out"), folder.Files("fresh")) == "");
  }
}

const std::string kWaypoints =
    "waypoints: [{x: 0, y: 0, heading: 0}, {x: 0.25, y: 0.02, stop: true}]\n";
const std::string kHill =
    "simulation: {terrain: {surfaces: {hill: {shape: heightfield, image: hill.png,\n"
    "  image_height_m: 0.05}}}}\n";

TEST_CASE("A sweep of the simulator computes the trials anew whose inputs have changed") {
  const Folder folder;
  for (const std::string surface : {"ground", "hill"}) {
    for (const int trial : {1, 2}) {
      folder.Write(fmt::format("{}_{}.csv", surface, trial),
                   folder.Log(trial + (surface == "hill" ? 2 : 0)));
    }
  }
  folder.Write("hill.png", test::RampPng(50));
  folder.Write("robot.yaml", "simulation: {motor: {mismatch: 0.02}}\n");
  const std::string sweep =
      "include: robot.yaml\nname: first\nseed: 3\n" + kWaypoints + kHill +
      "gap: {threshold_m: 0.03}\n"
      "likeness: {classifier: {permutations: 9}}\n"
      "reference: {kind: logs, path: '{surface}_{trial}.csv', trials: [1, 2]}\n"
      "space: {surface: [ground, hill], v_min: [0.14, 0.16]}\n";
  folder.Write("sweep.yaml", sweep);
  const auto now = [&folder](const std::string& name, const std::string& text) {
    return [&folder, name, text] { folder.Write(name, text); };
  };
  const std::vector<std::string> hill{"hill,0.14,1", "hill,0.14,2", "hill,0.16,1", "hill,0.16,2"};
  CheckChanges(folder, 3, true,
               {{"nothing"},
                {"another number of workers", [] {}, {"--jobs", "1"}},
                {"another name", [] {}, {"--set", "name=second"}},
                {"another limit of a trial", [] {}, {"--set", "run.timeout_s=50"}},
                {"comments",
                 [&] {
                   folder.Write("sweep.yaml", sweep + "# why\n");
                   folder.Write("robot.yaml", "simulation: {motor: {mismatch: 0.02}} # why\n");
                 }},
                {"a digit of a log",
                 [&] { folder.ChangeByte("ground_1.csv"); },
                 {},
                 {"ground,0.14,1", "ground,0.16,1"}},
                {"the picture of a surface", now("hill.png", test::RampPng(200)), {}, hill},
                {"a log that is gone",
                 [&] { fs::remove(folder.folder / "hill_2.csv"); },
                 {},
                 {"hill,0.14,2", "hill,0.16,2"}},
                {"an included file",
                 now("robot.yaml", "simulation: {motor: {mismatch: 0.03}}\n"),
                 {},
                 {},
                 "simulation.motor.mismatch was 0.02 and is 0.03"},
                {"the seed", [] {}, {"--set", "seed=4"}, {}, "seed was 3 and is 4"},
                {"the threshold",
                 [] {},
                 {"--set", "seed=4", "--set", "gap.threshold_m=0.02"},
                 {},
                 "gap.threshold_m was 0.03 and is 0.02"},
                {"a point ahead of the tag",
                 [] {},
                 {"--set", "seed=4", "--set", "gap.threshold_m=0.02", "--set",
                  "reference.tag_offset_m=0.03"},
                 {},
                 "reference.tag_offset_m was 0 and is 0.03"}});
}

TEST_CASE(
    "An input that is as it was gives the rows that are kept, and another rift none of them") {
  const Folder folder;
  const test::QuickGnuplot gnuplot;
  folder.Write("hill.png", test::RampPng(50));
  folder.Write("sweep.yaml", kWaypoints + kHill +
                                 "reference: {kind: nominal}\n"
                                 "space: {surface: [ground, hill], v_min: [0.14, 0.16]}\n");
  REQUIRE(CountsOf(folder.Sweep("out", {})).computed == 4);
  const std::vector<std::string> table = folder.Table("out");
  folder.Write("hill.png", test::RampPng(200));
  CHECK(CountsOf(folder.Sweep("out", {})).computed == 2);
  CHECK(folder.Table("out") != table);
  folder.Write("hill.png", test::RampPng(50));
  CHECK(CountsOf(folder.Sweep("out", {})).computed == 0);
  CHECK(folder.Table("out") == table);

  const std::string journal = folder.folder / "out/journal.sqlite", key = "the version of rift";
  std::string bytes = ReadFile(journal);
  char& digit = bytes.at(bytes.find(key) + key.size());
  REQUIRE(digit != '9');
  digit = '9';
  WriteText(journal, bytes);
  const ProcessResult refused = folder.Sweep("out", {});
  CHECK(refused.exit_code == 2);
  CHECK_THAT(refused.err, Contains("the version of rift was 9"));
}

TEST_CASE("The picture that the nominal run is driven on counts for every trial") {
  const Folder folder;
  folder.Write("hill.png", test::RampPng(50));
  folder.Write("sweep.yaml", kWaypoints + kHill +
                                 "reference: {kind: nominal, trials: 2}\n"
                                 "space: {surface: [ground, hill], v_min: [0.14]}\n");
  const Words chosen{"--set", "simulation.terrain.surface=hill"};
  const test::QuickGnuplot gnuplot;
  REQUIRE(CountsOf(folder.Sweep("out", chosen)).computed == 4);
  folder.Write("hill.png", test::RampPng(200));
  const ProcessResult again = folder.Sweep("out", chosen);
  REQUIRE(again.exit_code == 0);
  CHECK(CountsOf(again).computed == 4);
  REQUIRE(folder.Sweep("fresh", chosen).exit_code == 0);
  CHECK(Difference(folder.Files("out"), folder.Files("fresh")) == "");
  CHECK_THAT(ReadFile(folder.folder / "out/inputs.txt"),
             Contains("  " + (folder.folder / "hill.png")));
}

TEST_CASE("A search goes on with the trials that an input leaves as they were") {
  const Folder folder;
  const test::QuickGnuplot gnuplot;
  folder.Write("hill.png", test::RampPng(50));
  folder.Write("sweep.yaml",
               kWaypoints + kHill +
                   "goal: falsify\nreference: {kind: path}\n"
                   "search: {budget: 8}\nfalsify: {until: budget, most_repeats: 2}\n"
                   "space: {surface: [ground, hill], v_min: {min: 0.12, max: 0.2}}\n");
  const Counts all = CountsOf(folder.Sweep("out", {}));
  CHECK(all.computed == all.all);
  CHECK(CountsOf(folder.Sweep("out", {})).computed == 0);
  folder.Write("hill.png", test::RampPng(200));
  const ProcessResult again = folder.Sweep("out", {});
  REQUIRE(again.exit_code == 0);
  CHECK(CountsOf(again).computed > 0);
  CHECK(CountsOf(again).computed < CountsOf(again).all);
  REQUIRE(folder.Sweep("fresh", {}).exit_code == 0);
  CHECK(Difference(folder.Files("out"), folder.Files("fresh")) == "");
}

/// Notes each of its runs in the file `runs` beside it.
const std::string kProgram = R"(import os, sys
import shape
gain, bend, out = float(sys.argv[1]), float(open(sys.argv[2]).read()), sys.argv[3]
here = os.path.dirname(os.path.abspath(__file__))
open(os.path.join(here, 'runs'), 'a').write('x')
with open(out, 'w') as log:
    log.write('t_s,x_m,y_m,yaw_rad\n')
    for i in range(41):
        log.write(f'{i * 0.05},{i * 0.00625},{gain * bend * shape.rise(i / 40)},0\n')
)";

void WriteProgram(const Folder& folder) {
  folder.Write("sim.py", kProgram);
  folder.Write("shape.py", "def rise(u): return u * u\n");
  folder.Write("bend.txt", "0.02\n");
}

/// Drives longer steps than kProgram.
std::string OtherProgram() {
  std::string text = kProgram;
  return text.replace(text.find("0.00625"), 7, "0.00650");
}

TEST_CASE("A sweep of a program computes the trials anew whose inputs have changed") {
  const test::QuickGnuplot gnuplot;
  const Folder folder;
  WriteProgram(folder);
  for (const int gain : {1, 2, 3}) folder.Write(fmt::format("{}.csv", gain), folder.Log(gain));
  folder.Write("sweep.yaml",
               "name: first\nseed: 3\n"
               "candidate: {kind: program, run: [python3, sim.py, '{gain}', bend.txt, '{out}']}\n"
               "reference: {kind: logs, path: '{gain}.csv'}\nspace: {gain: [1, 2, 3]}\n");
  const std::vector<std::string> all{"1,1", "2,1", "3,1"};
  const Words other_run{"--set", "candidate.run=[python3, sim.py, '{gain}', /dev/null, '{out}']"};
  CheckChanges(folder, 2, true,
               {{"nothing"},
                {"another number of workers", [] {}, {"--jobs", "1"}},
                {"another name", [] {}, {"--set", "name=second"}},
                {"another limit of a trial", [] {}, {"--set", "run.retries=0"}},
                {"a digit of a log", [&] { folder.ChangeByte("2.csv"); }, {}, {"2,1"}},
                {"the program", [&] { folder.Write("sim.py", OtherProgram()); }, {}, all},
                {"a file that it is given", [&] { folder.Write("bend.txt", "0.03\n"); }, {}, all},
                {"the seed", [] {}, {"--set", "seed=4"}, {}, "seed was 3 and is 4"},
                {"a block that means nothing to it",
                 [] {},
                 {"--set", "seed=4", "--set", "control.v_min=0.1"},
                 {},
                 "control.v_min was "}});
  const auto runs = [&folder] { return ReadFile(folder.folder / "runs").size(); };
  const size_t before = runs();
  const Words flags{"--set", "seed=4", "--set", "control.v_min=0.1"};
  CHECK(CountsOf(folder.Sweep("out", flags)).computed == 0);
  CHECK(runs() == before + 1);  // the worst trial, which the report draws
  // What it imports is not seen (docs/programs.md).
  folder.Write("shape.py", "def rise(u): return u\n");
  CHECK(CountsOf(folder.Sweep("out", flags)).computed == 0);
  const std::vector<std::string> kept = folder.Table("out");
  Words fresh = flags;
  fresh.emplace_back("--fresh");
  CHECK(CountsOf(folder.Sweep("out", fresh)).computed == 3);
  CHECK(ChangedRows(kept, folder.Table("out"), 2) == all);
  CHECK(runs() == before + 1 + 1 + 3 + 1);
}

TEST_CASE("Recorded logs against a program that takes the robot's place are computed anew alike") {
  const Folder folder;
  WriteProgram(folder);
  for (const std::string speed : {"0.14", "0.16"}) {
    folder.Write(speed + ".csv", folder.Log(speed == "0.14" ? 1 : 2));
  }
  folder.Write("sweep.yaml",
               "name: first\ncandidate: {kind: logs, path: '{v_min}.csv'}\n"
               "reference: {kind: program, run: [python3, sim.py, '{v_min}', bend.txt, '{out}']}\n"
               "space: {control.v_min: [0.14, 0.16]}\n");
  const std::vector<std::string> all{"0.14,1", "0.16,1"};
  CheckChanges(folder, 2, true,
               {{"nothing"},
                {"another name", [] {}, {"--set", "name=second"}},
                {"a digit of a log", [&] { folder.ChangeByte("0.16.csv"); }, {}, {"0.16,1"}},
                {"the program", [&] { folder.Write("sim.py", OtherProgram()); }, {}, all}});
  const std::string inputs = ReadFile(folder.folder / "out/inputs.txt");
  for (const char* name : {"0.14.csv", "0.16.csv", "sim.py", "bend.txt"}) {
    CHECK_THAT(inputs, Contains("  " + (folder.folder / name) + "\n"));
  }
}

TEST_CASE("A sweep over logs reads them each time and tells which of them has changed") {
  const Folder folder;
  for (const std::string speed : {"0.14", "0.16"}) {
    folder.Write(speed + "_sim.csv", folder.Log(speed == "0.14" ? 1 : 2));
    for (const int trial : {1, 2}) {
      folder.Write(fmt::format("{}_{}.csv", speed, trial), folder.Log(3 * trial));
    }
  }
  folder.Write("sweep.yaml",
               "name: first\ncandidate: {kind: logs, path: '{v_min}_sim.csv'}\n"
               "reference: {kind: logs, path: '{v_min}_{trial}.csv', trials: [1, 2]}\n"
               "space: {v_min: [0.14, 0.16]}\n");
  CheckChanges(
      folder, 2, false,
      {{"nothing"},
       {"another number of workers", [] {}, {"--jobs", "1"}},
       {"a digit of a log of the robot", [&] { folder.ChangeByte("0.14_2.csv"); }, {}, {"0.14,2"}},
       {"a digit of a log of the simulator",
        [&] { folder.ChangeByte("0.16_sim.csv"); },
        {},
        {"0.16,1", "0.16,2"}},
       {"a log that is gone", [&] { fs::remove(folder.folder / "0.14_1.csv"); }, {}, {"0.14,1"}},
       {"another name", [] {}, {"--set", "name=second"}, {}, "holds another experiment"},
       {"the threshold",
        [] {},
        {"--set", "gap.threshold_m=0.001"},
        {},
        "holds another experiment"}});
}

TEST_CASE("A sweep that starts over leaves no findings of the one before, and keeps suggestions") {
  const Folder folder;
  const test::QuickGnuplot gnuplot;
  for (const int trial : {1, 2}) folder.Write(fmt::format("{}.csv", trial), folder.Log(trial));
  folder.Write("sweep.yaml", kWaypoints +
                                 "gap: {threshold_m: 0.001}\n"
                                 "reference: {kind: logs, path: '{trial}.csv', trials: [1, 2]}\n"
                                 "space: {v_min: [0.14, 0.16]}\n");
  const ProcessResult first = folder.Sweep("out", {"--suggest", "2"});
  INFO(first.err);
  REQUIRE(first.exit_code == 0);
  CHECK(fs::exists(folder.folder / "out/likeness.json"));
  // What --shrink and --rare-event leave takes seconds to compute.
  for (const char* name : {"shrunk.json", "shrunk/table.csv", "rare_event.json"}) {
    folder.Write(std::string("out/") + name, "x");
  }
  const std::string suggested = ReadFile(folder.folder / "out/suggested.yaml");
  const Words other{"--fresh", "--set", "reference.trials=[1]"};
  REQUIRE(folder.Sweep("out", other).exit_code == 0);
  REQUIRE(folder.Sweep("fresh", other).exit_code == 0);
  CHECK(Difference(folder.Files("out"), folder.Files("fresh")) == "suggested.yaml ");
  CHECK(ReadFile(folder.folder / "out/suggested.yaml") == suggested);
}

}  // namespace
}  // namespace rift
