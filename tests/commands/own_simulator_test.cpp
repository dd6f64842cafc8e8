// candidate.kind: program, end to end: somebody else's simulator swept, shrunk, replayed, killed.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "support/documented.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/npm.hpp"
#include "support/processes/process.hpp"
#include "support/processes/quick_gnuplot.hpp"
#include "support/processes/running_rift.hpp"
#include "support/processes/shell.hpp"
#include "support/tree.hpp"
#include "support/until.hpp"

namespace rift {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using nlohmann::json;
using test::ProcessResult;
using test::ReadFile;
using test::RunRift;
using test::TemporaryFolder;
using test::WriteText;

/// Processes with this text among their arguments.
int ProcessesWith(const std::string& text) {
  int count = 0;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    std::ostringstream arguments;  // not by an iterator, which throws when a process has just ended
    arguments << std::ifstream(entry.path() / "cmdline", std::ios::binary).rdbuf();
    count += arguments.str().find(text) != std::string::npos;
  }
  return count;
}

/// A reason in double quotes may hold commas.
std::vector<std::string> CellsOf(const std::string& line) {
  std::vector<std::string> cells(1);
  bool is_quoted = false;
  for (const char c : line) {
    if (c == '"') {
      is_quoted = !is_quoted;
    } else if (c == ',' && !is_quoted) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

std::vector<std::map<std::string, std::string>> Table(const std::string& folder) {
  std::istringstream lines(ReadFile(fs::path(folder) / "table.csv"));
  std::string line;
  std::vector<std::string> header;
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(lines, line)) {
    const std::vector<std::string> values = CellsOf(line);
    if (header.empty()) {
      header = values;
      continue;
    }
    rows.emplace_back();
    for (size_t i = 0; i < values.size(); ++i) rows.back()[header[i]] = values[i];
  }
  return rows;
}

const std::string kSpawned = test::SourceDir() + "/configs/programs/diff_drive.yaml";
const std::string kPersistent = test::SourceDir() + "/configs/programs/diff_drive_persistent.yaml";

/// A task that three poses of a program fulfil.
const std::string kStraight =
    "waypoints: [{name: a, x: 0, y: 0, heading: 0}, {name: b, x: 0.7, y: 0, stop: true}]\n";
const std::string kStraightLog = R"('t_s,x_m,y_m\n0,0,0\n1,0.35,0\n2,0.7,0\n')";

/// A short search with few repeats: each seed costs a nominal run before the first trial.
std::vector<std::string> SweepWords(const std::string& config, const std::string& jobs,
                                    const std::string& out) {
  return {"sweep", config,     "--jobs", jobs,    "--out",
          out,     "--budget", "12",     "--set", "falsify.most_repeats=4"};
}

std::string Sweep(const TemporaryFolder& folder, const std::string& name, const std::string& config,
                  const std::string& jobs) {
  const test::QuickGnuplot gnuplot;
  const ProcessResult result = RunRift(SweepWords(config, jobs, folder / name));
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  return folder / name;
}

TEST_CASE("A simulator of thirty lines of Python is falsified, shrunk and replayed") {
  const TemporaryFolder folder;
  const std::string out = Sweep(folder, "a", kSpawned, "2");
  const json summary = json::parse(ReadFile(fs::path(out) / "summary.json"));
  CHECK(ReadFile(fs::path(out) / "summary.json").find("falsified") != std::string::npos);
  std::string failing;
  for (const auto& row : Table(out)) {
    CHECK(row.at("status") == "ok");
    if (row.at("falsified") == "true" && failing.empty()) failing = row.at("id");
  }
  REQUIRE_FALSE(failing.empty());
  const ProcessResult replay = RunRift({"simulate", "--replay", out, failing});
  CHECK(replay.exit_code == 0);
  CHECK(replay.out.find("to the last bit as in the table") != std::string::npos);
  CHECK(fs::exists(fs::path(out) / "replay" / failing / "trajectory.csv"));
  std::vector<std::string> shrink = SweepWords(kSpawned, "2", out);
  shrink.insert(shrink.end(), {"--shrink", failing});
  const ProcessResult shrunk = RunRift(shrink);
  INFO(shrunk.err);
  CHECK(shrunk.out.find("still fails with 1 of its 2 changes") != std::string::npos);
  CHECK(shrunk.out.find("mu: ") != std::string::npos);
  CHECK(RunRift({"simulate", "--replay", out + "/shrunk", "2"}).exit_code == 0);
}

TEST_CASE("Spawned and persistent, with one worker and two, a sweep gives the same bytes") {
  const TemporaryFolder folder;
  const std::string spawned = Sweep(folder, "spawned", kSpawned, "2");
  const std::string one = Sweep(folder, "one", kPersistent, "1");
  const std::string two = Sweep(folder, "two", kPersistent, "2");
  for (const std::string file : {"table.csv", "summary.json"}) {
    INFO(file);
    CHECK(ReadFile(fs::path(one) / file) == ReadFile(fs::path(two) / file));
  }
  CHECK(ReadFile(fs::path(one) / "table.csv") == ReadFile(fs::path(spawned) / "table.csv"));
}

TEST_CASE("A row whose program has changed since is said to come out different") {
  const TemporaryFolder folder;
  const std::string script = ReadFile(test::SourceDir() + "/configs/programs/diff_drive.py");
  WriteText(folder / "diff_drive.py", script);
  fs::copy(kSpawned, folder / "sweep.yaml");
  REQUIRE(RunRift({"sweep", folder / "sweep.yaml", "--out", folder / "out", "--budget", "2",
                   "--set", "falsify.most_repeats=2"})
              .exit_code == 0);
  std::string changed = script;
  changed.replace(changed.find("0.2 * error"), 3, "0.3");
  WriteText(folder / "diff_drive.py", changed);
  const ProcessResult replay = RunRift({"simulate", "--replay", folder / "out", "1"});
  CHECK(replay.exit_code == 3);
  CHECK(replay.err.find("row 1 comes out different") != std::string::npos);
}

TEST_CASE("Replaying a program's row runs the program once") {
  const TemporaryFolder folder;
  WriteText(folder / "counting.py",
            "import sys\n"
            "open(sys.argv[2], 'a').write('x')\n"
            "open(sys.argv[1], 'w').write('t_s,x_m,y_m\\n0,0,0\\n1,0.5,0.1\\n')\n");
  WriteText(folder / "sweep.yaml",
            kStraight + "candidate: {kind: program, run: [python3, counting.py, '{out}', '" +
                (folder / "runs") + "']}\nreference: {kind: path}\n");
  REQUIRE(RunRift({"sweep", folder / "sweep.yaml", "--out", folder / "out"}).exit_code == 0);
  const std::string before = ReadFile(fs::path(folder / "runs"));
  CHECK(RunRift({"simulate", "--replay", folder / "out", "1"}).exit_code == 0);
  CHECK(ReadFile(fs::path(folder / "runs")) == before + "x");
  const std::string log = ReadFile(fs::path(folder / "out/replay/1/trajectory.csv"));
  const ProcessResult piped = RunRift({"simulate", "--replay", folder / "out", "1", "--out", "-"});
  CHECK(piped.exit_code == 0);
  CHECK(piped.out == log);
  CHECK(piped.err.find("to the last bit") != std::string::npos);
  const auto refusal = [&](const std::string& out) {
    const ProcessResult result =
        RunRift({"simulate", "--replay", folder / "out", "1", "--out", out});
    CHECK(result.exit_code == 2);
    return result.err;
  };
  CHECK(refusal(folder / "out").find("holds a sweep") != std::string::npos);
  CHECK(refusal(folder / "run.json").find("run.json") != std::string::npos);
  CHECK_FALSE(fs::exists(folder / "run.json"));
  CHECK_FALSE(fs::exists(folder / "out/trajectory.csv"));
}

TEST_CASE("A row whose program hung is replayed as such and ends") {
  const TemporaryFolder folder;
  WriteText(folder / "hanging.py", "import time; time.sleep(7357)\n");
  WriteText(folder / "sweep.yaml",
            kStraight +
                "candidate: {kind: program, run: [python3, hanging.py, '{mu}']}\n"
                "reference: {kind: path}\nspace: {mu: [1]}\nrun: {timeout_s: 0.5, retries: 0}\n");
  CHECK(RunRift({"sweep", folder / "sweep.yaml", "--out", folder / "out"}).exit_code == 1);
  const ProcessResult replay = RunRift({"simulate", "--replay", folder / "out", "1"});
  CHECK(replay.exit_code == 1);
  CHECK(replay.out.find("status hung") != std::string::npos);
}

TEST_CASE("A trial given up for its time is run again where run.timeout_s is another") {
  const TemporaryFolder folder;
  // Hangs where mu is 1 until there is a file by the name of mended.
  WriteText(folder / "sim.sh", "echo \"$1\" >> '" + (folder / "runs") +
                                   "'\n[ \"$1\" = 0 ] || [ -e '" + (folder / "mended") +
                                   "' ] || exec sleep 7357\n" + "printf " + kStraightLog +
                                   " > \"$2\"\n");
  WriteText(folder / "sweep.yaml",
            kStraight +
                "candidate: {kind: program, run: [sh, sim.sh, '{mu}', '{out}']}\n"
                "reference: {kind: path}\nspace: {mu: [0, 1]}\n");
  const test::QuickGnuplot gnuplot;
  const auto sweep = [&](const std::string& timeout_s) {
    return RunRift({"sweep", folder / "sweep.yaml", "--out", folder / "out", "--set",
                    "run.retries=0", "--set", "run.timeout_s=" + timeout_s});
  };
  const auto runs_of_1 = [&] {
    const std::string runs = ReadFile(folder / "runs");
    return std::count(runs.begin(), runs.end(), '1');
  };
  const std::string note =
      ": 1 trial that hung, crashed or ran out of memory under other limits "
      "(timeout_s=2 memory_mb=1024 retries=0) is run again";
  CHECK(sweep("2").err.find("run again") == std::string::npos);
  CHECK(Table(folder / "out").at(1).at("status") == "hung");
  WriteText(folder / "mended", "");
  sweep("2");
  CHECK(Table(folder / "out").at(1).at("status") == "hung");  // the same limits: it is kept
  CHECK(runs_of_1() == 1);
  CHECK_THAT(sweep("60").err, Contains(note));
  CHECK(Table(folder / "out").at(1).at("status") == "ok");
  CHECK(runs_of_1() == 2);
}

TEST_CASE("A sweep without a temporary folder ends with 3, keeps no trial, and goes on later") {
  const TemporaryFolder folder;
  WriteText(folder / "sim.sh", "printf " + kStraightLog + " > \"$1\"\n");
  WriteText(folder / "sweep.yaml", kStraight +
                                       "candidate: {kind: program, run: [sh, sim.sh, '{out}']}\n"
                                       "reference: {kind: path}\nspace: {mu: [0, 1]}\n");
  const test::QuickGnuplot gnuplot;
  const auto sweep = [&](const std::string& settings) {
    return test::RunShell(fmt::format("{} '{}' sweep '{}' --out '{}' 2> '{}'", settings,
                                      test::RiftBinary(), folder / "sweep.yaml", folder / "out",
                                      folder / "err"));
  };
  CHECK(sweep("TMPDIR='" + (folder / "gone") + "'") == 3);
  CHECK_THAT(ReadFile(folder / "err"),
             Contains("rift: cannot make a temporary folder in " + (folder / "gone")));
  CHECK_FALSE(fs::exists(folder / "out/table.csv"));
  CHECK(sweep("") == 0);
  for (const auto& row : Table(folder / "out")) CHECK(row.at("status") == "ok");
}

/// A simulator with every fault that the issue of foreign programs has; its rows are by mode.
const std::string kFaulty = R"py(
import json, os, signal, subprocess, sys, time

GOOD = "t_s,x_m,y_m\n" + "".join(f"{i / 10},{i / 20},0\n" for i in range(15))

def leave_child(marker):
    program = [sys.executable, "-c", "import time; time.sleep(7357)", marker]
    subprocess.Popen(program, start_new_session=True)

def run(mode, out, marker, write):
    if mode == "good": write(GOOD)
    if mode == "hang": leave_child(marker); time.sleep(7357)
    if mode == "crash": os.kill(os.getpid(), signal.SIGSEGV)
    if mode == "garbage": write("\x01 garbage\n1 2 3\n")
    if mode == "half": write(GOOD[:-5])
    if mode == "raise": raise ValueError("no such friction in " + out)
    if mode == "memory": bytearray(3 << 30)
    if mode == "orphan": leave_child(marker); write(GOOD)
    if mode == "backwards": write("t_s,x_m,y_m\n0,0,0\n0.2,0.1,0\n0.1,0.2,0\n")
    if mode == "large": open(out, "w").truncate(1 << 30)
    if mode == "big": open(out, "w").truncate(300 << 20)

def file(out):
    return lambda text: open(out, "w").write(text)

if sys.argv[1] == "--serve":
    for line in sys.stdin:
        trial = json.loads(line)
        mode = trial["theta"]["mode"]
        if mode == "babble": print("hello", flush=True); continue
        if mode == "late": print('{"status": "timed_out", "reason": "too slow"}', flush=True); continue
        if mode == "unknown": print('{"status": "great"}', flush=True); continue
        if mode == "nothing": print('{"status": "ok"}', flush=True); continue
        run(mode, trial["out"], sys.argv[2], file(trial["out"]))
        print('{"status": "ok"}', flush=True)
else:
    mode, out, marker = sys.argv[1:4]
    if mode == "late": print("too slow", file=sys.stderr); sys.exit(10)
    if mode == "fell": sys.exit(11)
    run(mode, out, marker, file(out))
)py";

std::map<std::string, std::map<std::string, std::string>> FaultyRows(
    const TemporaryFolder& folder, const std::string& modes, const std::string& run,
    const std::string& jobs = "2") {
  WriteText(folder / "faulty.py", kFaulty);
  WriteText(folder / "faulty.yaml",
            "waypoints: [{name: a, x: 0, y: 0, heading: 0}, {name: b, x: 0.7, y: 0, stop: true}]\n"
            "candidate: {kind: program, persistent: " +
                std::string(run.find("--serve") == run.npos ? "false" : "true") + ", run: [" + run +
                "]}\n" +
                "reference: {kind: path}\n"
                "run: {timeout_s: 20, memory_mb: 512, retries: 0}\n"
                "space: {mode: [" +
                modes + "]}\n");
  const ProcessResult result =
      RunRift({"sweep", folder / "faulty.yaml", "--jobs", jobs, "--out", folder / "out"});
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  std::map<std::string, std::map<std::string, std::string>> rows;
  for (const auto& row : Table(folder / "out")) rows[row.at("mode")] = row;
  return rows;
}

/// The folder is in the arguments of every process of the program.
void CheckNothingIsLeft(const TemporaryFolder& folder) {
  test::WaitUntil("no process is left", [&] { return ProcessesWith(folder / "marker") == 0; });
}

TEST_CASE("Each fault of a program is a row with its reason, and no process is left") {
  const TemporaryFolder folder;
  auto rows = FaultyRows(folder,
                         "good, hang, crash, garbage, half, raise, memory, orphan, late, fell, "
                         "nothing, large, big, backwards",
                         "python3, faulty.py, '{mode}', '{out}', '" + (folder / "marker") + "'");
  CHECK(rows["good"]["status"] == "ok");
  CHECK(rows["orphan"]["status"] == "ok");
  CHECK(rows["hang"]["status"] == "hung");
  CHECK(rows["hang"]["reason"] == "had not ended after 20 s (run.timeout_s)");
  CHECK(rows["hang"]["candidate"] == "program with seed 1");
  CHECK(rows["hang"]["reference"] == "waypoint path");
  CHECK(rows["large"]["status"] == "out_of_memory");
  CHECK(rows["large"]["reason"].find("wanted a file of more than 512 MB (run.memory_mb)") !=
        std::string::npos);
  CHECK(rows["backwards"]["status"] == "unreadable");
  CHECK(rows["backwards"]["reason"].find("time runs backwards") != std::string::npos);
  CHECK(rows["big"]["status"] == "unreadable");
  CHECK(rows["big"]["reason"].find("its trajectory: 314572800 bytes: at most") !=
        std::string::npos);
  CHECK(rows["crash"]["status"] == "crashed");
  CHECK(rows["crash"]["reason"].find("signal 11") != std::string::npos);
  CHECK(rows["garbage"]["status"] == "unreadable");
  CHECK(rows["garbage"]["reason"].find("its trajectory: is not text") != std::string::npos);
  CHECK(rows["half"]["status"] == "unreadable");
  CHECK(rows["half"]["reason"].find("cut short") != std::string::npos);
  CHECK(rows["raise"]["status"] == "fault");
  CHECK(rows["raise"]["reason"].find("ValueError: no such friction in {folder}/trajectory.csv") !=
        std::string::npos);
  CHECK(rows["memory"]["status"] == "out_of_memory");
  CHECK(rows["late"]["status"] == "timed_out");
  CHECK(rows["late"]["falsified"] == "true");
  CHECK(rows["late"]["reason"].find("too slow") != std::string::npos);
  CHECK(rows["fell"]["status"] == "fell");
  CHECK(rows["nothing"]["status"] == "fault");
  CHECK(rows["nothing"]["reason"].find("no trajectory") != std::string::npos);
  CheckNothingIsLeft(folder);
}

TEST_CASE("A persistent program that fails is started again for the next trial") {
  const TemporaryFolder folder;
  auto rows =
      FaultyRows(folder, "crash, good, babble, hang, raise, late, nothing, memory, orphan, unknown",
                 "python3, faulty.py, --serve, '" + (folder / "marker") + "'");
  CHECK(rows["good"]["status"] == "ok");
  CHECK(rows["orphan"]["status"] == "ok");
  CHECK(rows["crash"]["status"] == "crashed");
  CHECK(rows["babble"]["status"] == "fault");
  CHECK(rows["babble"]["reason"].find("answered 'hello'") != std::string::npos);
  CHECK(rows["hang"]["status"] == "hung");
  CHECK(rows["unknown"]["status"] == "fault");
  CHECK(rows["unknown"]["reason"].find(
            "the status 'great', and it must be one of ok, timed_out, fell, left_arena, lost, "
            "fault") != std::string::npos);
  CHECK(rows["raise"]["status"] == "crashed");
  CHECK(rows["raise"]["reason"].find("ValueError") != std::string::npos);
  CHECK(rows["late"]["status"] == "timed_out");
  CHECK(rows["nothing"]["status"] == "fault");
  CHECK(rows["memory"]["status"] == "out_of_memory");
  CheckNothingIsLeft(folder);
}

TEST_CASE("A program is given no file or socket of the sweep") {
  const TemporaryFolder folder;
  WriteText(folder / "sim.sh", "ls -l /proc/$$/fd > " + (folder / "open.txt") +
                                   "\nprintf 't_s,x_m,y_m\\n0,0,0\\n1,1,0\\n2,1,1\\n' > \"$1\"\n");
  WriteText(folder / "task.yaml", R"(
candidate: {kind: program, run: [sh, sim.sh, "{out}"]}
reference: {kind: nominal}
space: {wind: [1, 2]}
)");
  const ProcessResult result =
      RunRift({"sweep", folder / "task.yaml", "--jobs", "2", "--out", folder / "out"});
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  const std::string open = ReadFile(folder / "open.txt");
  CAPTURE(open);
  CHECK_THAT(open, Contains("0 -> ") && Contains("2 -> "));
  for (const char* other : {"socket:", "pipe:", "anon_inode:", "journal"}) {
    CHECK_THAT(open, !Contains(other));
  }
}

TEST_CASE("The end of a persistent program is seen though its child holds its output open") {
  const TemporaryFolder folder;
  auto rows = FaultyRows(folder, "orphan, raise",
                         "python3, faulty.py, --serve, '" + (folder / "marker") + "'", "1");
  CHECK(rows["orphan"]["status"] == "ok");
  CHECK(rows["raise"]["status"] == "crashed");
  CHECK(rows["raise"]["reason"].find("ValueError") != std::string::npos);
  CheckNothingIsLeft(folder);
}

TEST_CASE("A sweep of a program that is killed goes on and leaves no process") {
  const test::QuickGnuplot gnuplot;
  const TemporaryFolder folder;
  const std::string script = folder / "diff_drive.py";
  fs::copy(test::SourceDir() + "/configs/programs/diff_drive.py", script);
  fs::copy(kSpawned, folder / "sweep.yaml");
  const std::vector<std::string> arguments{"sweep", folder / "sweep.yaml",   "--jobs",   "2",
                                           "--out", folder / "killed",       "--budget", "12",
                                           "--set", "falsify.most_repeats=2"};
  test::RunningRift killed(arguments);
  killed.WaitUntil("programs run", [&] { return ProcessesWith(script) > 0; });
  killed.Signal(SIGKILL);
  killed.Wait();
  test::WaitUntil("no process is left", [&] { return ProcessesWith(script) == 0; });
  REQUIRE(RunRift(arguments).exit_code == 0);
  std::vector<std::string> whole = arguments;
  whole[5] = folder / "whole";
  REQUIRE(RunRift(whole).exit_code == 0);
  CHECK(ReadFile(fs::path(folder / "killed") / "table.csv") ==
        ReadFile(fs::path(folder / "whole") / "table.csv"));
}

TEST_CASE("A robot in an engine of others is falsified and replayed, with the same bytes") {
  if (!test::HasNpm("Rapier")) return;
  const TemporaryFolder folder;
  // Node looks for packages beside a script and above it.
  const std::string programs = test::SourceDir() + "/configs/programs/";
  fs::copy(programs + "rapier_robot.mjs", folder / "rapier_robot.mjs");
  fs::create_directory_symlink(test::NpmDir() + "/node_modules", folder / "node_modules");
  // Without the compiler that takes two seconds in each process, and which runs of minutes pay for.
  std::string experiment = ReadFile(programs + "rapier_robot.yaml");
  const std::string run = "[node, ";
  experiment.insert(experiment.find(run) + run.size(), "--liftoff-only, ");
  const std::string budget = "budget: 40";
  REQUIRE(experiment.find(budget) != std::string::npos);
  experiment.replace(experiment.find(budget), budget.size(), "budget: 16");
  const std::string config = folder / "rapier_robot.yaml";
  WriteText(config, experiment);
  const std::string one = Sweep(folder, "one", config, "1");
  const std::string two = Sweep(folder, "two", config, "2");
  CHECK(ReadFile(fs::path(one) / "table.csv") == ReadFile(fs::path(two) / "table.csv"));
  std::string fallen;
  for (const auto& row : Table(one)) {
    if (row.at("status") == "fell" && row.at("falsified") == "true") fallen = row.at("id");
  }
  REQUIRE_FALSE(fallen.empty());
  const ProcessResult replay = RunRift({"simulate", "--replay", one, fallen});
  CHECK(replay.exit_code == 1);
  CHECK(replay.out.find("status fell") != std::string::npos);
}

TEST_CASE("What a program's experiment lacks is said before the first trial") {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::string& yaml) {
    WriteText(folder / "bad.yaml", yaml);
    const ProcessResult result = RunRift({"sweep", folder / "bad.yaml", "--out", folder / "out"});
    CHECK(result.exit_code == 2);
    return result.err;
  };
  const std::string nominal = "reference: {kind: nominal}\nspace: {mu: [1, 2]}\n";
  CHECK(refusal("candidate: {kind: program}\n" + nominal).find("candidate.run is missing") !=
        std::string::npos);
  CHECK(refusal("candidate: {kind: program, run: [cat, '{nu}']}\n" + nominal)
            .find("names {nu}, and the space has only mu, seed, folder, out, theta") !=
        std::string::npos);
  CHECK(refusal("candidate: {kind: program, persistent: true, run: [cat, '{mu}']}\n" + nominal)
            .find("told of its trials in lines of JSON") != std::string::npos);
  CHECK(refusal("candidate: {kind: simulation}\nspace: {control.v_min: {min: 0.1, max: 0.2, "
                "nominal: 0.15}}\ngoal: falsify\n")
            .find("nominal is of a program's parameters") != std::string::npos);
  CHECK(refusal("candidate: {kind: program, run: [python3, perz.py, '{mu}']}\n" + nominal)
            .find("bad.yaml: candidate.run: there is no file 'perz.py' beside the experiment") !=
        std::string::npos);
  CHECK(refusal("reference: {kind: program, run: [node, ../perz.mjs]}\nspace: {mu: [1, 2]}\n"
                "candidate: {kind: program, run: [cat, '{mu}']}\n")
            .find("reference.run: there is no file '../perz.mjs'") != std::string::npos);
}

/// A simulator that writes a line of 1 m, after `before` (Python, with k, seed and out).
std::string LineSimulator(const std::string& before) {
  return "import os, sys, time\nk, seed, out = float(sys.argv[1]), int(sys.argv[2]), "
         "sys.argv[3]\n" +
         before +
         "\nrows = [f'{i / 10},{i / 10},{k * seed * 1e-6 * i}' for i in range(11)]\n"
         "open(out, 'w').write('t_s,x_m,y_m\\n' + '\\n'.join(rows) + '\\n')\n";
}

std::string AgainstNominal(const std::string& run) {
  return "candidate: {kind: program, run: [python3, line.py, '{k}', '{seed}', '{out}', marker]}\n"
         "reference: {kind: nominal}\nspace: {k: {min: 0.6, max: 1}}\ngoal: falsify\n"
         "search: {budget: 2}\n" +
         run;
}

TEST_CASE("A program that always fails is named with its reason after one nominal run") {
  const auto refusal = [](const std::string& fault, const std::string& run) {
    const TemporaryFolder folder;
    WriteText(folder / "line.py",
              LineSimulator("open('" + (folder / "runs") + "', 'a').write('x')\n" + fault));
    WriteText(folder / "line.yaml", AgainstNominal(run));
    const ProcessResult result = RunRift({"sweep", folder / "line.yaml", "--out", folder / "out"});
    CHECK(result.exit_code == 2);
    // A worker has the job under way and the next; two workers may have begun. One that is killed
    // after 1 s may not have come so far.
    const std::string runs = folder / "runs";
    CHECK((fs::exists(runs) ? fs::file_size(runs) : 0) <= 2);
    return result.err;
  };
  const std::string fault = refusal("raise ValueError('division by wheel')", "");
  CHECK_THAT(fault, Catch::Contains("the run with the experiment's own values and seed 1 gives no "
                                    "trajectory to compare with (fault): ended with exit code 1: "
                                    "ValueError: division by wheel"));
  CHECK_THAT(refusal("open(out, 'wb').write(bytes(range(256)) * 9); sys.exit(0)", ""),
             Catch::Contains("(unreadable): its trajectory: is not text"));
  CHECK_THAT(refusal("time.sleep(7357)", "run: {timeout_s: 1, retries: 0}\n"),
             Catch::Contains("(hung): had not ended after 1 s (run.timeout_s)"));
}

TEST_CASE(
    "Only a nominal run that did not arrive is tried with other seeds, each on its own time") {
  const TemporaryFolder folder;
  // Ten nominal runs of 2.2 s: together they take longer than one may. A busy machine may take
  // seconds to start Python: a run that hangs is tried again.
  WriteText(folder / "line.py",
            LineSimulator("if k == 0.8: time.sleep(2.2)\n"
                          "if seed in (1, 3): print('too slow', file=sys.stderr); sys.exit(10)"));
  WriteText(folder / "line.yaml",
            AgainstNominal("falsify: {most_repeats: 8}\nrun: {timeout_s: 21, retries: 2}\n"));
  const ProcessResult result =
      RunRift({"sweep", folder / "line.yaml", "--out", folder / "out", "--jobs", "1"});
  INFO(result.err);
  CHECK(result.exit_code == 0);
  const json summary = json::parse(ReadFile(fs::path(folder / "out") / "summary.json"));
  REQUIRE(summary["replaced_references"].size() == 2);
  CHECK(summary["replaced_references"][0]["seed"] == 1);
  CHECK(summary["replaced_references"][1]["seed"] == 3);
  CHECK_THAT(summary["replaced_references"][1]["reason"].get<std::string>(),
             Catch::Contains("too slow"));
}

TEST_CASE("The search for nominal runs says how far it is and ends at a signal") {
  const TemporaryFolder folder;
  WriteText(folder / "line.py",
            LineSimulator("open('" + (folder / "runs") +
                          "', 'a').write('x')\n"
                          "time.sleep(0.2); print('slow', file=sys.stderr); sys.exit(10)"));
  WriteText(folder / "line.yaml", AgainstNominal(""));
  test::RunningRift running(
      {"sweep", folder / "line.yaml", "--out", folder / "out", "--json-progress"});
  running.WaitUntil("progress of the references", [&] {
    return running.Err().find("\"references\":100,\"references_done\":0") != std::string::npos;
  });
  running.Signal(SIGTERM);
  const ProcessResult result = running.Wait();
  INFO(result.err);
  CHECK(result.exit_code == 130);
  test::WaitUntil("no process is left", [&] { return ProcessesWith(folder / "line.py") == 0; });
  const std::string runs = folder / "runs";
  CHECK((fs::exists(runs) ? fs::file_size(runs) : 0) < 50);  // and not after all that it wanted
}

TEST_CASE("A program's reference may be another program") {
  const TemporaryFolder folder;
  fs::copy(test::SourceDir() + "/configs/programs/diff_drive.py", folder / "sim.py");
  WriteText(
      folder / "two.yaml",
      "candidate: {kind: program, columns: 't=time,x=pose_x,y=pose_y', units: mm,\n"
      "  run: [python3, sim.py, --mu, '{mu}', --mismatch, 0.1, --seed, '{seed}', --out, '{out}']}\n"
      "reference: {kind: program, columns: 't=time,x=pose_x,y=pose_y', units: mm,\n"
      "  run: [python3, sim.py, --mu, '{mu}', --mismatch, 0, --seed, '{seed}', --out, '{out}']}\n"
      "space: {mu: [0.05, 0.8]}\n");
  const ProcessResult result = RunRift({"sweep", folder / "two.yaml", "--out", folder / "out"});
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  const auto rows = Table(folder / "out");
  REQUIRE(rows.size() == 2);
  for (const auto& row : rows) {
    CHECK(row.at("status") == "ok");
    CHECK(std::stod(row.at("gap_m")) > 0.001);
  }
}

TEST_CASE("The pages on programs and logs list what there is") {
  const std::string keys = RunRift({"sweep", "--keys"}).out;
  for (const std::string& key : test::Documented("programs.md", "What the exit codes say")) {
    if (key.empty()) continue;
    INFO(key);
    CHECK(keys.find("candidate.exit_codes." + key + ":") != std::string::npos);
  }
  const TemporaryFolder folder;
  WriteText(folder / "a.csv", "t_s,x_m,y_m\n0,0,0\n1,1,1\n");
  const ProcessResult refused =
      RunRift({"gap", folder / "a.csv", folder / "a.csv", "--columns", "no=t_s"});
  std::string quantities, units;
  for (const std::string& name : test::Documented("logs.md", "Quantities")) {
    quantities += (quantities.empty() ? "" : ", ") + name;
  }
  CHECK(refused.err.find("they are " + quantities) != std::string::npos);
  for (const std::string& name : test::Documented("logs.md", "Units")) {
    units += (units.empty() ? "" : ", ") + name;
  }
  const ProcessResult no_unit =
      RunRift({"gap", folder / "a.csv", folder / "a.csv", "--units", "furlong"});
  CHECK(no_unit.err.find("is none of " + units) != std::string::npos);
}

}  // namespace
}  // namespace rift
