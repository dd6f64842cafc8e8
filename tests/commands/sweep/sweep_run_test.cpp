#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>

#include "commands/short_task.hpp"
#include "rift/sweep/run/journal_summary.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/environment.hpp"
#include "support/processes/process.hpp"
#include "support/processes/quick_gnuplot.hpp"
#include "support/processes/running_rift.hpp"

namespace rift {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::ProcessResult;
using test::ReadFile;
using test::RunRift;
using test::WriteText;

const std::string kSearch = kTask + R"(goal: falsify
space:
  surface: [ground, parchment]
  v_min: {min: 0.12, max: 0.2}
  mismatch: {min: -0.15, max: 0.15}
search: {budget: 24}
falsify: {until: budget, most_repeats: 4}
)";

struct Sweep {
  explicit Sweep(const std::string& text) { WriteText(file, text); }
  std::vector<std::string> Command(const std::string& out,
                                   const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"sweep", file, "--out", folder / out};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  std::string Table(const std::string& out) const {
    return ReadFile(folder / (out + "/table.csv"));
  }
  std::string Summary(const std::string& out) const {
    return ReadFile(folder / (out + "/summary.json"));
  }
  /// What the journal holds by now; nothing while there is none that can be read.
  sweep::JournalSummary Journal(const std::string& out) const {
    try {
      return sweep::ReadJournal(folder / (out + "/journal.sqlite"));
    } catch (const std::exception&) {
      return {};
    }
  }
  int Committed(const std::string& out) const {
    int trials = 0;
    for (const auto& [status, count] : Journal(out).trials_by_status) trials += count;
    return trials;
  }

  test::QuickGnuplot gnuplot;
  test::TemporaryFolder folder;
  std::string file = folder / "experiment.yaml";
};

TEST_CASE("A sweep gives the same bytes for one worker and for two") {
  for (const std::string& text : {kGrid, kSearch}) {
    const Sweep sweep(text);
    REQUIRE(RunRift(sweep.Command("one", {"--jobs", "1"})).exit_code == 0);
    REQUIRE(RunRift(sweep.Command("two", {"--jobs", "2"})).exit_code == 0);
    CHECK(sweep.Table("one") == sweep.Table("two"));
    CHECK(sweep.Summary("one") == sweep.Summary("two"));
    CHECK(sweep.Table("one").find(",ok,") != std::string::npos);
  }
}

/// Runs a sweep in one go and another of the same command under fire, and compares their bytes.
test::KilledSweep CheckKilled(const Sweep& sweep, const std::vector<std::string>& more, int kills,
                              std::mt19937_64& generator) {
  REQUIRE(RunRift(sweep.Command("whole", more)).exit_code == 0);
  // Without retries: a worker that somebody else kills costs its trial nothing.
  std::vector<std::string> words = sweep.Command("killed", more);
  words.insert(words.end(), {"--set", "run.retries=0"});
  const test::KilledSweep killed = test::SweepUnderFire(
      words, kills, [&] { return sweep.Committed("killed"); }, generator);
  INFO(killed.last.err);
  REQUIRE(killed.last.exit_code == 0);
  CHECK(sweep.Table("killed") == sweep.Table("whole"));
  CHECK(sweep.Summary("killed") == sweep.Summary("whole"));
  return killed;
}

TEST_CASE("A sweep killed again and again ends with the bytes of one that was not") {
  std::mt19937_64 generator(20261121);
  int resumed_starts = 0;
  const std::vector<std::pair<std::string, std::vector<std::string>>> sweeps{
      {kGrid, {"--set", "reference.trials=40"}}, {kSearch, {"--budget", "40"}}};
  for (const auto& [text, more] : sweeps) {
    const test::KilledSweep killed = CheckKilled(Sweep(text), more, 6, generator);
    CHECK(killed.coordinator_kills > 0);
    CHECK(killed.worker_kills > 0);
    CHECK(killed.starts == killed.coordinator_kills + 1);
    resumed_starts += killed.resumed_starts;
  }
  CHECK(resumed_starts > 0);
}

// Takes minutes: run by name. The sweeps last long enough to be hit fifty times.
TEST_CASE("Fifty kills of coordinator and workers leave the bytes of a sweep as they are",
          "[.][long]") {
  std::mt19937_64 generator(4);
  const std::vector<std::pair<std::string, std::vector<std::string>>> sweeps{
      {kGrid, {"--set", "reference.trials=1000"}}, {kSearch, {"--budget", "500"}}};
  for (const auto& [text, more] : sweeps) {
    const test::KilledSweep killed = CheckKilled(Sweep(text), more, 50, generator);
    WARN(killed.coordinator_kills << " kills of the coordinator and " << killed.worker_kills
                                  << " of workers in " << killed.starts << " starts");
    CHECK(killed.coordinator_kills + killed.worker_kills == 50);
  }
}

TEST_CASE("A folder with the journal of another experiment is refused with the keys named") {
  const Sweep sweep(kGrid);
  REQUIRE(RunRift(sweep.Command("out")).exit_code == 0);
  const std::string table = sweep.Table("out");
  const ProcessResult refused = RunRift(sweep.Command("out", {"--set", "gap.threshold_m=0.02"}));
  CHECK(refused.exit_code == 2);
  CHECK(refused.err.find("gap.threshold_m was 0.01 and is 0.02") != std::string::npos);
  CHECK(std::count(refused.err.begin(), refused.err.end(), '\n') == 1);
  CHECK(sweep.Table("out") == table);
  CHECK(RunRift(sweep.Command("out", {"--set", "run.timeout_s=30"})).exit_code == 0);
  CHECK(RunRift(sweep.Command("out", {"--set", "gap.threshold_m=0.02", "--fresh"})).exit_code == 0);
  CHECK(sweep.Table("out").find("fals") != std::string::npos);
}

TEST_CASE("A finished sweep runs nothing again and a larger budget goes on with it") {
  const Sweep sweep(kSearch);
  REQUIRE(RunRift(sweep.Command("out")).exit_code == 0);
  const auto last_progress = [](const ProcessResult& result) {
    const size_t at = result.err.rfind("{\"state\"");
    return json::parse(result.err.substr(at, result.err.find('\n', at) - at));
  };
  const ProcessResult again = RunRift(sweep.Command("out", {"--json-progress"}));
  REQUIRE(again.exit_code == 0);
  const json progress = last_progress(again);
  CHECK(progress["state"] == "done");
  CHECK(progress["done"] == progress["from_journal"]);
  const ProcessResult more = RunRift(sweep.Command("out", {"--json-progress", "--budget", "30"}));
  REQUIRE(more.exit_code == 0);
  CHECK(last_progress(more)["from_journal"] > 0);
  CHECK(json::parse(sweep.Summary("out"))["falsification"]["evaluations"] == 30);
}

TEST_CASE("Two sweeps cannot work in one folder and Ctrl-C stops one that goes on later") {
  const Sweep sweep(kGrid);
  const std::vector<std::string> command =
      sweep.Command("out", {"--set", "reference.trials=200", "--jobs", "1"});
  test::RunningRift first(command);
  first.WaitUntil("its first trials", [&] { return sweep.Committed("out") > 0; });
  REQUIRE(first.Freeze());
  const ProcessResult second = RunRift(command);
  CHECK(second.exit_code == 3);
  CHECK(second.err.find("another sweep is at work in") != std::string::npos);
  const ProcessResult status = RunRift({"sweep", "--status", sweep.folder / "out", "--json"});
  REQUIRE(status.exit_code == 0);
  CHECK(json::parse(status.out)["state"] == "running");
  first.Signal(SIGINT);
  first.Thaw();
  const ProcessResult stopped = first.Wait();
  CHECK(stopped.exit_code == 130);
  CHECK(stopped.err.find("the same command goes on where it was") != std::string::npos);
  CHECK_FALSE(fs::exists(sweep.folder / "out/table.csv"));
  const json after =
      json::parse(RunRift({"sweep", "--status", sweep.folder / "out", "--json"}).out);
  CHECK(after["state"] == "stopped");
  CHECK(after["done"] > 0);
  CHECK(after["done"] < 1'200);
  test::RunningRift anew(
      sweep.Command("anew", {"--set", "reference.trials=200", "--jobs", "1", "--force"}));
  anew.WaitUntil("its first trials", [&] { return sweep.Committed("anew") > 0; });
  anew.Signal(SIGINT);
  CHECK(anew.Wait().err.find("the same command without --force (or --fresh) goes on where") !=
        std::string::npos);
}

TEST_CASE("What a sweep found is with its reader before the trials of a further question") {
  const Sweep sweep(kSearch);
  test::RunningRift running(sweep.Command("out", {"--rare-event", "--jobs", "1"}));
  running.WaitUntil("its findings",
                    [&] { return running.Out().find("\nsettings: ") != std::string::npos; });
  CHECK_FALSE(fs::exists(sweep.folder / "out/rare_event.json"));
  running.Signal(SIGINT);
  CHECK(running.Wait().exit_code == 130);
}

TEST_CASE("A worker that stands still or crashes costs its trial and the sweep ends") {
  constexpr int kTrials = 6 * 30;
  const Sweep sweep(kGrid);
  test::RunningRift running(
      sweep.Command("out", {"--set", "reference.trials=30", "--set", "run.timeout_s=3", "--set",
                            "run.retries=0", "--jobs", "1"}));
  pid_t last = 0;
  // The first process only runs the references.
  running.WaitUntil("a worker that runs trials",
                    [&] { return sweep.Committed("out") > 0 && !running.Workers().empty(); });
  last = running.Workers().front();
  REQUIRE(::kill(last, SIGSTOP) == 0);
  // One that is hit between two trials costs none: then the next worker is.
  int crashes = 0, committed_before = -1;
  running.WaitUntil("a trial that crashed", [&] {
    if (sweep.Journal("out").trials_by_status.contains("crashed")) return true;
    const std::vector<pid_t> workers = running.Workers();
    const bool has_passed = sweep.Committed("out") > committed_before;
    if (workers.empty() || workers.front() == last || !has_passed) return false;
    last = workers.front();
    committed_before = sweep.Committed("out");
    ++crashes;
    REQUIRE(::kill(last, SIGSEGV) == 0);
    return false;
  });
  REQUIRE(running.Wait().exit_code == 0);
  const std::string table = sweep.Table("out");
  CHECK(table.find(",crashed,") != std::string::npos);
  CHECK(table.find("ended by signal 11 (Segmentation fault)") != std::string::npos);
  CHECK(table.find(",hung,") != std::string::npos);
  CHECK(table.find("had not ended after 3 s") != std::string::npos);
  const json summary = json::parse(sweep.Summary("out"));
  CHECK(summary["not_ok"] >= 2);
  CHECK(summary["not_ok"] <= 1 + crashes);
  CHECK(summary["n"].get<int>() + summary["not_ok"].get<int>() == kTrials);
}

TEST_CASE("Limits of a search are refused by a grid") {
  const Sweep sweep(kGrid);
  for (const char* flag : {"--budget", "--seconds"}) {
    const ProcessResult refused = RunRift(sweep.Command("out", {flag, "5"}));
    CHECK(refused.exit_code == 2);
    CHECK(refused.err.find("goal is grid") != std::string::npos);
  }
}

TEST_CASE("A sweep whose folder is removed, moved or replaced while it runs is exit 3") {
  const Sweep sweep(kGrid);
  const fs::path out = sweep.folder / "out", elsewhere = sweep.folder / "elsewhere";
  const std::vector<std::function<void()>> troubles{[&] { fs::remove_all(out); },
                                                    [&] { fs::rename(out, elsewhere); },
                                                    [&] {
                                                      fs::remove_all(elsewhere);
                                                      fs::rename(out, elsewhere);
                                                      fs::create_directory(out);
                                                    }};
  for (const auto& make_trouble : troubles) {
    test::RunningRift running(
        sweep.Command("out", {"--set", "reference.trials=100", "--jobs", "1"}));
    running.WaitUntil("its first trials", [&] { return sweep.Committed("out") > 0; });
    REQUIRE(running.Freeze());
    make_trouble();
    running.Thaw();
    const ProcessResult result = running.Wait();
    CHECK(result.exit_code == 3);
    CHECK(result.err.find("out/journal.sqlite was removed, moved or replaced") !=
          std::string::npos);
    CHECK_FALSE(fs::exists(out / "table.csv"));
  }
}

TEST_CASE("A sweep of a cluster starts over where Slurm does not answer, which is said") {
  const Sweep sweep(kGrid);
  REQUIRE(RunRift(sweep.Command("out")).exit_code == 0);
  const std::string table = sweep.Table("out"), bin = sweep.folder / "bin";
  WriteText(sweep.folder / "out/slurm/1/shards", "deadbeef\n");
  WriteText(bin + "/squeue", "#!/bin/sh\necho 'squeue: fatal: no configuration' >&2\nexit 1\n");
  fs::permissions(bin + "/squeue", fs::perms::owner_all);
  const test::Environment path("PATH", bin + ":" + std::getenv("PATH"));
  const ProcessResult result = RunRift(sweep.Command("out", {"--fresh"}));
  INFO(result.err);
  CHECK(result.exit_code == 0);
  CHECK(result.err.find("may still be in the queue") != std::string::npos);
  CHECK(result.err.find("squeue: fatal: no configuration") != std::string::npos);
  CHECK_FALSE(fs::exists(sweep.folder / "out/slurm"));
  CHECK(sweep.Table("out") == table);
}

TEST_CASE("A damaged row of a journal is told, run again, and the table stays as it was") {
  const Sweep sweep(kGrid);
  REQUIRE(RunRift(sweep.Command("out")).exit_code == 0);
  const std::string table = sweep.Table("out"), file = sweep.folder / "out/journal.sqlite";
  std::string bytes = ReadFile(file);
  const size_t at = bytes.find("simulation with seed");
  REQUIRE(at != std::string::npos);
  bytes[at] = 'S';
  WriteText(file, bytes);
  const ProcessResult status = RunRift({"sweep", "--status", sweep.folder / "out", "--json"});
  CHECK(json::parse(status.out)["damaged"] == 1);
  CHECK(json::parse(status.out)["done"] == 11);
  const ProcessResult again = RunRift(sweep.Command("out"));
  CHECK(again.exit_code == 0);
  CHECK(again.err.find("1 of its entries were damaged and are left out") != std::string::npos);
  CHECK(sweep.Table("out") == table);
  CHECK(RunRift(sweep.Command("out")).err.find("damaged") == std::string::npos);
}

TEST_CASE("Folders and journals that cannot be used end with one line") {
  const Sweep sweep(kGrid);
  const auto refusal = [&](const std::string& out) {
    const ProcessResult result = RunRift({"sweep", sweep.file, "--out", out});
    CHECK(result.exit_code == 3);
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
    return result.err;
  };
  CHECK(refusal("/proc/nowhere").find("cannot make folder /proc/nowhere") != std::string::npos);
  CHECK(refusal("/proc/self").find("cannot be written here") != std::string::npos);
  WriteText(sweep.folder / "bad/journal.sqlite", std::string(10'000, 'x'));
  CHECK(refusal(sweep.folder / "bad").find("it is damaged") != std::string::npos);
  if (::geteuid() != 0) {
    fs::create_directory(sweep.folder / "read_only");
    ::chmod((sweep.folder / "read_only").c_str(), 0500);
    CHECK(refusal(sweep.folder / "read_only").find("cannot be written") != std::string::npos);
  }
  CHECK(RunRift({"sweep", "--status", sweep.folder / "none"}).exit_code == 2);
}

TEST_CASE("A row of a sweep is replayed bit for bit with its trajectory and figure") {
  const Sweep sweep(kSearch);
  REQUIRE(RunRift(sweep.Command("out")).exit_code == 0);
  const std::string out = sweep.folder / "replay";
  const ProcessResult result = RunRift({"simulate", "--replay", sweep.folder / "out", "7", "--out",
                                        out, "--figure", sweep.folder / "seven.svg"});
  REQUIRE(result.exit_code == 0);
  CHECK(result.err.find("row 7: status ok") != std::string::npos);
  CHECK(fs::exists(out + "/trajectory.csv"));
  CHECK(fs::exists(sweep.folder / "seven.svg"));
  const ProcessResult none = RunRift({"simulate", "--replay", sweep.folder / "out", "7000"});
  CHECK(none.exit_code == 2);
  CHECK(none.err.find("its ids are 1 to") != std::string::npos);
  std::string table = sweep.Table("out");
  const size_t gap = table.find('\n') + 1;
  const size_t at = table.find(",ok,", gap);
  table[table.rfind("0.", at) + 4] ^= 1;
  WriteText(sweep.folder / "out/table.csv", table);
  const ProcessResult differs = RunRift({"simulate", "--replay", sweep.folder / "out", "1"});
  CHECK(differs.exit_code == 3);
  CHECK(differs.err.find("row 1 comes out different") != std::string::npos);
}

TEST_CASE("A setting that breaks a rule is a row of a search and refused in a grid") {
  const std::string space =
      "space:\n  v_min: {min: 0.1, max: 0.4}\n  v_max: {min: 0.2, max: 0.5}\n";
  const Sweep search(kTask + "goal: falsify\nsearch: {budget: 16}\nfalsify: {until: budget}\n" +
                     space);
  REQUIRE(RunRift(search.Command("out")).exit_code == 0);
  CHECK(search.Table("out").find(",invalid,") != std::string::npos);
  const Sweep grid(kTask + "space: {v_min: [0.1, 0.4], v_max: [0.2]}\n");
  CHECK(RunRift(grid.Command("out")).exit_code == 2);
}

TEST_CASE("A range of a key of whole numbers is searched in whole numbers") {
  const auto search_over = [](const std::string& range) {
    return kTask + "goal: falsify\nsearch: {budget: 8}\nfalsify: {until: budget}\n" +
           "space: {simulation.link.uart_bytes: " + range + "}\n";
  };
  const Sweep whole(search_over("{min: 20, max: 60}"));
  REQUIRE(RunRift(whole.Command("out")).exit_code == 0);
  CHECK(whole.Table("out").find(",ok,") != std::string::npos);
  CHECK(whole.Table("out").find(",invalid,") == std::string::npos);
  const Sweep broken(search_over("{min: 20.5, max: 60}"));
  const ProcessResult refused = RunRift(broken.Command("out"));
  CHECK(refused.exit_code == 2);
  CHECK(refused.err.find("uart_bytes holds whole numbers") != std::string::npos);
}

}  // namespace
}  // namespace rift
