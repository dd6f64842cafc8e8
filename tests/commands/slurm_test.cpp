// rift sweep --engine slurm, end to end: with commands that take the place of Slurm's everywhere,
// and with a real slurmctld and two slurmd where they are installed.
#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "commands/short_task.hpp"
#include "rift/sweep/run/journal_summary.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"
#include "support/processes/quick_gnuplot.hpp"
#include "support/processes/running_rift.hpp"
#include "support/processes/slurm.hpp"
#include "support/tree.hpp"
#include "support/until.hpp"

namespace rift {
namespace {

namespace fs = std::filesystem;
using test::FakeSlurm;
using test::ProcessResult;
using test::ReadFile;
using test::RealSlurm;
using test::RunningRift;
using test::RunRift;
using test::WriteText;

const std::string kSearch = kTask + R"(goal: falsify
space:
  surface: [ground, parchment]
  v_min: {min: 0.12, max: 0.2}
search: {budget: 10}
falsify: {until: budget, most_repeats: 4}
)";
// Only the mismatch of the wheels drives the robot off the path of the nominal run.
const std::string kFailing = kTask + R"(goal: falsify
simulation: {step_s: 0.008}
space:
  surface: [ground, parchment]
  mismatch: {min: -0.25, max: 0.25}
search: {budget: 20, strategy: random}
falsify: {until: budget, most_repeats: 1}
)";
const std::string kDrive =
    "waypoints: [{x: 0, y: 0, heading: 0}, {x: 0.4, y: 0.05, stop: true}]\n"
    "simulation: {step_s: 0.008, motor: {dead_band: 0.05}}\ntrial: {pace: new_pose}\n";
const std::string kFit = kDrive + R"(goal: calibrate
reference: {kind: logs, path: "log{trial}.csv", trials: [1, 2, 3, 4]}
calibrate:
  holdout: [4]
  fit: {motor.mismatch: {min: -0.1, max: 0.1, mean: 0, sd: 0.05}, surfaces.bump.mu: {min: 0.5, max: 1.2}}
  starts: 2
  judge_runs: 2
  method: {runs: 1, iterations: 1, horizon: {phases: 1}, corrections: 1, simulated_logs: 2, resamples: 100}
likeness: {shuffles: 19}
)";

struct Sweep {
  explicit Sweep(const std::string& text) {
    WriteText(file, text);
    // What a task that is killed leaves on its node goes with the folder.
    fs::create_directories(folder / "tmp");
    WriteText(engine, "poll_s: 0.1\ncopy_every_s: 1\nprologue: [\"export TMPDIR=" +
                          (folder / "tmp") + "\"]\n");
  }
  std::vector<std::string> Local(const std::vector<std::string>& more = {}) const {
    return Command("local", more);
  }
  std::vector<std::string> OnCluster(std::vector<std::string> more = {}) const {
    more.insert(more.end(), {"--engine", engine});
    return Command("cluster", more);
  }
  std::vector<std::string> Command(const std::string& out,
                                   const std::vector<std::string>& more) const {
    std::vector<std::string> words{"sweep", file, "--out", folder / out};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  std::string Read(const std::string& name) const { return ReadFile(folder / name); }
  bool Has(const std::string& name) const { return fs::exists(folder / name); }

  test::QuickGnuplot gnuplot;
  test::TemporaryFolder folder;
  std::string file = folder / "experiment.yaml";
  std::string engine = folder / "engine.yaml";
};

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  for (size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

/// Every file that a local run writes, with its bytes, but for the journal, which keeps the order
/// and the times of the trials.
void CheckSameFiles(const Sweep& sweep) {
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(sweep.folder / "local")) {
    if (!entry.is_regular_file() || entry.path().filename() == "journal.sqlite") continue;
    const std::string name = fs::relative(entry.path(), sweep.folder / "local").string();
    if (entry.path().extension() == ".png") continue;  // gnuplot's, of the same SVG
    INFO(name);
    REQUIRE(sweep.Has("cluster/" + name));
    // Commands that replay a trial name the folder.
    CHECK(Replaced(sweep.Read("cluster/" + name), sweep.folder / "cluster",
                   sweep.folder / "local") == sweep.Read("local/" + name));
    ++files;
  }
  CHECK(files > 3);
}

/// Nothing of the shards is left but their script and the ids of their jobs.
void CheckTidy(const Sweep& sweep) {
  CHECK_FALSE(sweep.Has("cluster/shards"));
  for (const auto& entry : fs::recursive_directory_iterator(sweep.folder / "cluster/slurm")) {
    const std::string name = entry.path().filename().string();
    INFO(name << ": " << (entry.is_regular_file() ? ReadFile(entry.path()) : ""));
    CHECK((entry.is_directory() || name == "array.sh" || name == "jobs" || name.ends_with(".log")));
  }
}

void CheckSameAsLocal(const Sweep& sweep, const std::vector<std::string>& more,
                      const std::vector<std::string>& more_in_both = {}) {
  std::vector<std::string> all = more;
  all.insert(all.end(), more_in_both.begin(), more_in_both.end());
  const ProcessResult there = RunRift(sweep.OnCluster(all));
  INFO(there.err);
  REQUIRE(there.exit_code == 0);
  const ProcessResult here = RunRift(sweep.Local(more_in_both));
  REQUIRE(here.exit_code == 0);
  CHECK(Replaced(there.out, sweep.folder / "cluster", sweep.folder / "local") == here.out);
  CheckSameFiles(sweep);
  CheckTidy(sweep);
}

TEST_CASE("A grid in shards gives the files of a local run, byte for byte") {
  const FakeSlurm slurm;
  const Sweep sweep(kGrid);
  CheckSameAsLocal(sweep, {"--shards", "5"});
  // MaxArraySize is 4 here.
  const std::vector<std::string> submitted = slurm.Submitted();
  REQUIRE(submitted.size() == 2);
  CHECK(submitted[0].find("--array=0-3 ") != std::string::npos);
  CHECK(submitted[1].find("--array=0 ") != std::string::npos);
}

TEST_CASE("A grid with repeats takes an array for each round and gives the files of a local run") {
  const FakeSlurm slurm;
  const Sweep sweep(kGrid + "falsify: {repeat: every, most_repeats: 12}\n");
  CheckSameAsLocal(sweep, {"--shards", "2"});
  CHECK(slurm.Submitted().size() > 1);
}

TEST_CASE("A search runs as one job and gives the files of a local run, byte for byte") {
  const FakeSlurm slurm;
  const Sweep sweep(kSearch);
  CheckSameAsLocal(sweep, {});
  CHECK(slurm.Submitted().size() == 1);
  const size_t jobs = slurm.Submitted().size();
  REQUIRE(RunRift(sweep.OnCluster()).exit_code == 0);
  CHECK(slurm.Submitted().size() == jobs);  // nothing is left to be run
}

/// Logs of a robot whose left wheel is faster, beside the experiment that fits it.
struct FitSweep : Sweep {
  FitSweep() : Sweep(kFit) {
    WriteText(folder / "task.yaml", kDrive);
    for (const char* n : {"1", "2", "3", "4"}) {
      REQUIRE(RunRift({"simulate", folder / "task.yaml", "--set", "simulation.motor.mismatch=0.05",
                       "--seed", n, "--out", folder / ("log" + std::string(n) + ".csv")})
                  .exit_code == 0);
    }
  }
};

void CheckBesideTheTable() {
  CheckSameAsLocal(Sweep(kFailing), {}, {"--shrink", "worst"});
  CheckSameAsLocal(FitSweep(), {});
}

TEST_CASE("Shrinking and rare events are a job each and give the files of a local run") {
  const FakeSlurm slurm;
  const Sweep sweep(kFailing);
  const std::vector<std::string> asked{"--shrink", "worst", "--rare-event"};
  CheckSameAsLocal(sweep, {}, asked);
  CHECK(slurm.Submitted().size() == 3);  // the search as well
  // What the jobs brought back is in the journal, and is no trial of the sweep.
  REQUIRE(RunRift(sweep.OnCluster(asked)).exit_code == 0);
  CHECK(slurm.Submitted().size() == 3);
  const auto trials = [&](const std::string& out) {
    return sweep::ReadJournal(sweep.folder / (out + "/journal.sqlite")).trials_by_status;
  };
  CHECK(trials("cluster") == trials("local"));
  CHECK(trials("cluster").at("ok") == 40);  // of 20 settings
}

TEST_CASE("A calibration is a job and gives the files of a local run, byte for byte") {
  const FakeSlurm slurm;
  const FitSweep sweep;
  const auto robot = [&](const std::string& name) {
    return std::vector<std::string>{"--write-robot", sweep.folder / name};
  };
  CheckSameAsLocal(sweep, robot("cluster.yaml"));
  CHECK(slurm.Submitted().size() == 1);
  std::vector<std::string> fresh = robot("local.yaml");
  fresh.emplace_back("--fresh");
  const ProcessResult local = RunRift(sweep.Local(fresh));
  REQUIRE(local.exit_code == 0);
  CHECK(sweep.Read("cluster.yaml") == sweep.Read("local.yaml"));
  // What is there is not fitted again, unless a log has become another.
  REQUIRE(RunRift(sweep.OnCluster()).exit_code == 0);
  CHECK(slurm.Submitted().size() == 1);
  fs::copy_file(sweep.folder / "log2.csv", sweep.folder / "log1.csv",
                fs::copy_options::overwrite_existing);
  REQUIRE(RunRift(sweep.OnCluster()).exit_code == 0);
  CHECK(slurm.Submitted().size() == 2);
}

TEST_CASE("A calibration whose submitter is killed is waited for by the same command") {
  const FakeSlurm slurm;
  const FitSweep sweep;
  {
    RunningRift running(sweep.OnCluster());
    running.WaitUntil("jobs", [&] { return sweep.Has("cluster/slurm/1/jobs"); });
    running.Signal(SIGKILL);
    running.Wait();
  }
  CheckSameAsLocal(sweep, {});
  CHECK(slurm.Submitted().size() == 1);
}

TEST_CASE("A calibration that is stopped cancels its job, and the same command fits again") {
  const FakeSlurm slurm;
  const FitSweep sweep;
  {
    RunningRift running(sweep.OnCluster({"--set", "calibrate.method.iterations=40"}));
    running.WaitUntil("jobs", [&] { return sweep.Has("cluster/slurm/1/jobs"); });
    running.Signal(SIGINT);
    CHECK(running.Wait().exit_code == 130);
  }
  test::WaitUntil("the queue is empty", [&] { return slurm.Queued() == 0; });
  CHECK_FALSE(slurm.Cancelled().empty());
  CHECK_FALSE(sweep.Has("cluster/calibration.json"));
  CheckSameAsLocal(sweep, {"--fresh"});
}

TEST_CASE("What a cluster wants of its jobs stands in the arguments and the script of an array") {
  const FakeSlurm slurm;
  const Sweep sweep(kGrid);
  WriteText(sweep.engine,
            "poll_s: 0.1\naccount: lab's\ntime_limit: \"0:10:00\"\ncpus_per_task: 2\n"
            "shards_at_once: 1\narguments: [--qos=short]\n"
            "prologue: [export FROM_PROLOGUE=1]\n");
  const ProcessResult result = RunRift(sweep.OnCluster({"--shards", "2", "--partition", "night"}));
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  REQUIRE(slurm.Submitted().size() == 1);
  const std::string words = slurm.Submitted()[0];
  for (const char* word : {"--account=lab's", "--time=0:10:00", "--cpus-per-task=2", "--qos=short",
                           "--partition=night", "--array=0-1%1", "--propagate=NONE"}) {
    INFO(words);
    CHECK(words.find(word) != std::string::npos);
  }
  const std::string script = sweep.Read("cluster/slurm/1/array.sh");
  CHECK(script.find("\nexport FROM_PROLOGUE=1\n") != std::string::npos);
  CHECK(script.find("--jobs 2") != std::string::npos);
  CHECK(sweep.Read("cluster/slurm/1/jobs") == "1 0-1\n");
}

TEST_CASE("On a cluster waypoints may be anywhere where the command says so") {
  const FakeSlurm slurm;
  const Sweep sweep(Replaced(kGrid, "kind: nominal", "kind: path") +
                    "trial: {arena: {x_max_m: 0.2}}\n");
  CHECK(RunRift(sweep.OnCluster({"--shards", "2"})).err.find("--any-waypoints") !=
        std::string::npos);
  const ProcessResult result = RunRift(sweep.OnCluster({"--shards", "2", "--any-waypoints"}));
  INFO(result.err);
  CHECK(result.exit_code == 1);  // each robot leaves the arena
  CHECK(sweep.Read("cluster/table.csv").find("left_arena") != std::string::npos);
}

TEST_CASE("On a cluster a sweep may write into a folder of any name") {
  const FakeSlurm slurm;
  const Sweep sweep(kGrid);
  const std::string out = "it's 100% $HOME; \"x\"";
  const ProcessResult result =
      RunRift(sweep.Command(out, {"--engine", sweep.engine, "--shards", "2"}));
  INFO(result.err);
  CHECK(result.exit_code == 0);
  CHECK(sweep.Has(out + "/slurm/1/jobs"));
  CHECK_FALSE(sweep.Has(out + "/slurm/1/0.log"));  // empty, so it was found and removed
}

TEST_CASE("An array that Slurm refuses for the moment is submitted again, in smaller parts") {
  const FakeSlurm slurm;
  slurm.Refuse(2);
  const Sweep sweep(kGrid);
  const ProcessResult result = RunRift(sweep.OnCluster({"--shards", "4"}));
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  CHECK(result.err.find("temporarily unable to accept job") != std::string::npos);
  CHECK(slurm.Submitted().size() > 3);
}

TEST_CASE(
    "A job that Slurm refuses for good, or that leaves nothing, ends the sweep with its words") {
  const FakeSlurm slurm;
  const Sweep sweep(kGrid);
  const ProcessResult refused =
      RunRift(sweep.OnCluster({"--shards", "2", "--partition", "nowhere"}));
  CHECK(refused.exit_code == 3);
  CHECK(refused.err.find("Invalid partition name specified") != std::string::npos);
  WriteText(sweep.engine, "poll_s: 0.1\nprologue: [\"echo no such module: gcc >&2; exit 1\"]\n");
  const ProcessResult failed = RunRift(sweep.OnCluster({"--shards", "2"}));
  CHECK(failed.exit_code == 3);
  INFO(failed.err);
  CHECK(failed.err.find("no such module: gcc") != std::string::npos);
  test::WaitUntil("the queue is empty", [&] { return slurm.Queued() == 0; });
}

TEST_CASE("What no cluster can do is refused before anything is submitted") {
  const FakeSlurm slurm;
  const Sweep sweep(kGrid);
  const auto error = [&](const std::vector<std::string>& more) {
    const ProcessResult result = RunRift(sweep.Command("cluster", more));
    CHECK(result.exit_code == 2);
    return result.err;
  };
  CHECK(error({"--shards", "4"}).find("--shards is for --engine slurm") != std::string::npos);
  CHECK(error({"--engine", "pbs"}).find("local, slurm or a file") != std::string::npos);
  WriteText(sweep.engine, "partitions: night\n");
  CHECK(error({"--engine", sweep.engine}).find("partition") != std::string::npos);
  WriteText(sweep.engine, "arguments: [\"rm -rf\"]\n");
  CHECK(error({"--engine", sweep.engine}).find("rm -rf") != std::string::npos);
  CHECK(slurm.Submitted().empty());
}

TEST_CASE("A program may be on the nodes alone, and a node without it gives no row") {
  const FakeSlurm slurm;
  const Sweep sweep(
      "waypoints: [{x: 0, y: 0, heading: 0}, {x: 1, y: 0, stop: true}]\ngap: {threshold_m: 0.3}\n"
      "candidate: {kind: program, run: [mysim, \"{out}\", \"{mu}\"]}\n"
      "reference: {kind: path, trials: 1}\nspace: {mu: [0.1, 0.2, 0.4]}\n");
  fs::create_directories(sweep.folder / "bin");
  const std::string mysim = sweep.folder / "bin/mysim";
  WriteText(mysim,
            "#!/bin/sh\nprintf 't_s,x_m,y_m\\n0,0,0\\n1,0.5,0\\n2,1,%s\\n' \"$2\" > \"$1\"\n");
  fs::permissions(mysim, fs::perms::owner_all);
  const auto run = [&](const std::vector<std::string>& more) {
    return RunRift(sweep.OnCluster(more));
  };
  const ProcessResult unsized = run({});
  CHECK(unsized.exit_code == 2);
  CHECK(unsized.err.find("say --shards N") != std::string::npos);
  CHECK(slurm.Submitted().empty());
  const ProcessResult without = run({"--shards", "1"});
  CHECK(without.exit_code == 3);
  INFO(without.err);
  CHECK(without.err.find("candidate.run: cannot run mysim: No such file or directory, on ") !=
        std::string::npos);
  WriteText(sweep.engine, "poll_s: 0.1\nprologue: [\"export PATH='" + (sweep.folder / "bin") +
                              "':$PATH TMPDIR='" + (sweep.folder / "tmp") + "'\"]\n");
  const ProcessResult there = run({"--shards", "2"});
  INFO(there.err);
  CHECK(there.exit_code == 0);
  CHECK(there.err.find("row 3, the worst, is not drawn against its reference") !=
        std::string::npos);
  const test::Environment path("PATH", sweep.folder / "bin:" + std::getenv("PATH"));
  REQUIRE(RunRift(sweep.Local()).exit_code == 0);
  CHECK(sweep.Read("cluster/table.csv") == sweep.Read("local/table.csv"));
}

TEST_CASE("A cluster without Slurm's commands is said so") {
  const test::TemporaryFolder nothing;
  const test::Environment path("PATH", nothing.Path().string());
  const Sweep sweep(kGrid);
  const ProcessResult result = RunRift(sweep.OnCluster({"--shards", "2"}));
  CHECK(result.exit_code == 3);
  CHECK(result.err.find("needs Slurm's commands") != std::string::npos);
}

/// What a local run of the sweep that is hit below gives.
struct LocalRun {
  explicit LocalRun(int trials) : set("reference.trials=" + std::to_string(trials)) {
    const Sweep sweep(kGrid);
    REQUIRE(RunRift(sweep.Local({"--set", set})).exit_code == 0);
    table = sweep.Read("local/table.csv");
    summary = sweep.Read("local/summary.json");
  }
  std::string set, table, summary;
};

/// A sweep on a cluster that is hit on its way and still ends with the bytes of a local one.
struct HitSweep : Sweep {
  explicit HitSweep(const LocalRun& run) : Sweep(kGrid), local(run) {
    // Each task lasts long enough to be hit, and computes little.
    std::string text = ReadFile(engine);
    WriteText(engine, text.insert(text.rfind(']'), ", sleep 0.2"));
  }
  std::vector<std::string> Words() const {
    return OnCluster({"--shards", "4", "--set", local.set});
  }
  void CheckSameBytes() const {
    CHECK(Read("cluster/table.csv") == local.table);
    CHECK(Read("cluster/summary.json") == local.summary);
  }
  void CheckEnd(const ProcessResult& result) const {
    INFO(result.err);
    REQUIRE(result.exit_code == 0);
    CheckSameBytes();
    CheckTidy(*this);
  }
  /// What the tasks of the first array had to say; those that said nothing have no log.
  std::string TaskLogs() const {
    std::string logs;
    for (const auto& entry : fs::directory_iterator(folder / "cluster/slurm/1")) {
      if (entry.path().extension() != ".log") continue;
      logs += entry.path().filename().string() + ": " + ReadFile(entry.path()) + "\n";
    }
    return logs;
  }
  /// Kills the submitter (`kill -9`) once it has submitted.
  void SubmitAndDie() const {
    RunningRift running(Words());
    running.WaitUntil("jobs", [&] { return Has("cluster/slurm/1/jobs"); });
    running.Signal(SIGKILL);
    running.Wait();
  }

  const LocalRun& local;
};

void CheckNodeFails(test::Cluster& slurm, const LocalRun& local) {
  const HitSweep sweep(local);
  RunningRift running(sweep.Words());
  running.WaitUntil("tasks that can be killed", [&] { return slurm.KillTasks() > 0; });
  sweep.CheckEnd(running.Wait());
}

/// What was submitted is waited for by the next start and not submitted again.
void CheckSubmitterKilled(const LocalRun& local) {
  const HitSweep sweep(local);
  sweep.SubmitAndDie();
  const ProcessResult status = RunRift({"sweep", "--status", sweep.folder / "cluster", "--json"});
  CHECK(nlohmann::json::parse(status.out)["shards"]["total"] == 4);
  const std::string text = RunRift({"sweep", "--status", sweep.folder / "cluster"}).out;
  CHECK(text.find("shards on the cluster: ") != std::string::npos);
  const ProcessResult result = RunRift(sweep.Words());
  const std::string jobs = sweep.Read("cluster/slurm/1/jobs");
  INFO(jobs << result.err << sweep.TaskLogs());
  CHECK(std::count(jobs.begin(), jobs.end(), '\n') == 1);
  sweep.CheckEnd(result);
}

void CheckInterrupted(test::Cluster& slurm, const LocalRun& local) {
  const HitSweep sweep(local);
  RunningRift running(sweep.Words());
  running.WaitUntil("jobs", [&] { return sweep.Has("cluster/slurm/1/jobs"); });
  running.Signal(SIGINT);
  const ProcessResult stopped = running.Wait();
  CHECK(stopped.exit_code == 130);
  CHECK(stopped.err.find("the same command goes on") != std::string::npos);
  test::WaitUntil("the queue is empty", [&] { return slurm.Queued() == 0; });
  sweep.CheckEnd(RunRift(sweep.Words()));
}

void CheckDamaged(test::Cluster& slurm, const LocalRun& local) {
  const HitSweep sweep(local);
  sweep.SubmitAndDie();
  test::WaitUntil("the queue is empty", [&] { return slurm.Queued() == 0; });
  std::vector<fs::path> journals;
  std::ifstream names(sweep.folder / "cluster/slurm/1/shards");
  for (std::string name; names >> name;) {
    journals.push_back(sweep.folder / ("cluster/shards/" + name + ".sqlite"));
    REQUIRE(fs::exists(journals.back()));
  }
  REQUIRE(journals.size() == 4);
  WriteText(journals[0], "no journal at all");
  fs::remove(journals[2]);
  WriteText(sweep.folder / "cluster/slurm/1/2.shard", "no shard at all");
  std::string bytes = ReadFile(journals[1]);  // in the middle of a row
  const size_t at = bytes.rfind("simulation with seed");
  REQUIRE(at != std::string::npos);
  bytes.replace(at, 4, "????");
  WriteText(journals[1], bytes);
  const ProcessResult result = RunRift(sweep.Words());
  CHECK(result.err.find("its shard is run again") != std::string::npos);
  CHECK(result.err.find("1 of its rows were damaged") != std::string::npos);
  CHECK(result.err.find("2.shard is not there or not what was submitted") != std::string::npos);
  sweep.CheckEnd(result);
}

void CheckFinishedHere(const LocalRun& local) {
  const HitSweep sweep(local);
  sweep.SubmitAndDie();
  const ProcessResult here = RunRift(sweep.Command("cluster", {"--set", local.set}));
  CHECK(here.err.find("were given to a cluster") != std::string::npos);
  sweep.CheckSameBytes();
  const ProcessResult over =
      RunRift(sweep.Command("cluster", {"--set", "reference.trials=2", "--fresh"}));
  INFO(over.err);
  CHECK(over.exit_code == 0);
  CHECK_FALSE(sweep.Has("cluster/slurm"));
}

TEST_CASE("Whatever fails while a sweep is on a cluster, it ends with the bytes of a local run") {
  FakeSlurm slurm;
  const LocalRun local(10);
  CheckNodeFails(slurm, local);
  CheckSubmitterKilled(local);
  CheckInterrupted(slurm, local);
  CHECK_FALSE(slurm.Cancelled().empty());
  CheckDamaged(slurm, local);
  CheckFinishedHere(local);
}

TEST_CASE("A task that Slurm holds after too many requeues is cancelled and submitted anew") {
  FakeSlurm slurm;
  const LocalRun local(10);
  const HitSweep sweep(local);
  slurm.Hold(true);
  RunningRift running(sweep.Words());
  running.WaitUntil("tasks that can be killed", [&] { return slurm.KillTasks() > 0; });
  running.WaitUntil("an end of them", [&] { return !slurm.Cancelled().empty(); });
  slurm.Hold(false);
  const ProcessResult result = running.Wait();
  CHECK(result.err.find("JobHoldMaxRequeue") != std::string::npos);
  CHECK(slurm.Submitted().size() > 1);
  sweep.CheckEnd(result);
}

TEST_CASE("A shard that is there already is not computed again") {
  const FakeSlurm slurm;
  const Sweep sweep(kGrid);
  {
    RunningRift running(sweep.OnCluster({"--shards", "4"}));
    running.WaitUntil("jobs", [&] { return sweep.Has("cluster/slurm/1/jobs"); });
    running.Signal(SIGKILL);
    running.Wait();
  }
  test::WaitUntil("the queue is empty", [&] { return slurm.Queued() == 0; });
  const std::string array = sweep.folder / "cluster/slurm/1/";
  std::vector<fs::file_time_type> before, after;
  for (auto* const times : {&before, &after}) {
    for (const auto& entry : fs::directory_iterator(sweep.folder / "cluster/shards")) {
      times->push_back(entry.last_write_time());
    }
    const ProcessResult again = RunRift({"sweep", array + "experiment.yaml", "--out",
                                         sweep.folder / "cluster", "--shard", array + "0.shard"});
    INFO(again.err);
    CHECK(again.exit_code == 0);
  }
  CHECK(before == after);
  const ProcessResult other =
      RunRift({"sweep", array + "experiment.yaml", "--out", sweep.folder / "cluster", "--shard",
               array + "0.shard", "--set", "gap.threshold_m=0.02"});
  CHECK(other.exit_code == 2);
  CHECK(other.err.find("a shard of another experiment") != std::string::npos);
}

TEST_CASE("With real daemons of Slurm: the bytes of a local run, whatever fails on the way") {
  if (const auto reason = RealSlurm::WhyNot()) {
    WARN("SKIPPED: " + *reason);
    return;
  }
  RealSlurm slurm;
  CheckSameAsLocal(Sweep(kGrid), {"--shards", "3"});
  CheckSameAsLocal(Sweep(kSearch), {});
  CheckBesideTheTable();
  const LocalRun local(10);
  CheckSubmitterKilled(local);
  CheckInterrupted(slurm, local);
  CheckNodeFails(slurm, local);
}

/// Kills running tasks again and again until the sweep is done, or was hit often enough.
void CheckUnderFire(test::Cluster& slurm, int kills) {
  std::mt19937_64 generator(23);
  const LocalRun local(2000);  // longer than twenty kills on a machine twice as fast
  const HitSweep sweep(local);
  RunningRift running(sweep.Words());
  int hits = 0;
  while (hits < kills && running.IsRunning()) {
    const auto pause = std::chrono::milliseconds(generator() % 1500);
    const auto end = std::chrono::steady_clock::now() + pause;
    while (std::chrono::steady_clock::now() < end && running.IsRunning()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    hits += slurm.KillTasks();
  }
  WARN(hits << " tasks were killed");
  CHECK(hits >= kills);
  sweep.CheckEnd(running.Wait());
}

// Takes minutes: run by name.
TEST_CASE("Twenty random kills of tasks leave the bytes of a sweep as they are", "[.][long]") {
  FakeSlurm slurm;
  CheckUnderFire(slurm, 20);
}

TEST_CASE("With real daemons of Slurm: random failures of a node leave the bytes as they are",
          "[.][long]") {
  if (const auto reason = RealSlurm::WhyNot()) {
    WARN("SKIPPED: " + *reason);
    return;
  }
  RealSlurm slurm;
  CheckUnderFire(slurm, 20);
}

}  // namespace
}  // namespace rift
