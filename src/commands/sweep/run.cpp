#include "run.hpp"

#include "engine.hpp"

#include <fmt/format.h>
#include <sched.h>

#include <chrono>
#include <cstdlib>

#include "doubt_notes.hpp"
#include "rift/files/files.hpp"
#include "rift/files/folder_lock.hpp"
#include "rift/files/network_file_system.hpp"
#include "rift/report/json/json.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"
#include "rift/sweep/falsify/sweep.hpp"
#include "rift/sweep/run/journal.hpp"
#include "rift/terminal/print.hpp"
#include "rift/terminal/stop_signal.hpp"

namespace rift::commands {

namespace {

using sweep::Journal;

/// Keys that say when a sweep ends and not what a trial is: a journal goes on with others.
bool IsFree(const std::string& key) {
  if (key.starts_with("run.")) return true;
  for (const char* free : {"name", "search.budget", "search.max_s", "falsify.until"}) {
    if (key == free) return true;
  }
  return false;
}

SweepSize SizeOf(const experiment::Experiment& experiment) {
  if (experiment.goal != experiment::Goal::kGrid) return {experiment.search.budget, true};
  double trials = static_cast<double>(experiment.reference.trials.names.size());
  for (const experiment::Parameter& parameter : experiment.space.parameters) {
    trials *= static_cast<double>(parameter.levels.size());
  }
  return {static_cast<int>(trials), false};
}

/// Wall-clock time of a sweep over all its runs, so that one that goes on keeps to its limit.
class Stopwatch {
 public:
  explicit Stopwatch(Journal& journal) : journal_(journal) {
    if (const auto note = journal.Note("elapsed_s"))
      before_s_ = std::strtod(note->c_str(), nullptr);
  }

  double Elapsed_s() const {
    const std::chrono::duration<double> since = Clock::now() - begun_;
    return before_s_ + since.count();
  }

  void Note(bool now = false) {
    if (!now && Clock::now() - noted_ < std::chrono::seconds(1)) return;
    noted_ = Clock::now();
    journal_.SetNote("elapsed_s", fmt::format("{:.3f}", Elapsed_s()));
  }

 private:
  using Clock = std::chrono::steady_clock;

  Journal& journal_;
  double before_s_ = 0.0;
  Clock::time_point begun_ = Clock::now();
  Clock::time_point noted_ = begun_;
};

void NoteFileSystem(const std::filesystem::path& out) {
  const std::string_view name = files::NetworkFileSystemOf(out);
  if (name.empty()) return;
  terminal::Say(fmt::format(
      "note: {} is on {}, a network file system: its journal is kept without a write-ahead log, "
      "which is slower",
      out.string(), name));
}

std::optional<sweep::SweepResult> RunSimulated(sweep::Evaluator& evaluator,
                                               const SweepRunRequest& request,
                                               SweepProgress& progress, DoubtNotes& doubts,
                                               const terminal::StopSignal& stop) {
  const experiment::Experiment& experiment = evaluator.experiment();
  const std::filesystem::path file = request.out / kJournalName;
  if (request.fresh) {
    sweep::SlurmShards::Forget(request.out);
    Journal::Remove(file);
  }
  NoteFileSystem(request.out);
  const sweep::Facts facts = FactsOf(experiment);
  Journal journal(file, facts);
  if (journal.Damaged() > 0) {
    terminal::Say(fmt::format(
        "note: {}: {} of its entries were damaged and are left out; what is missing is run again",
        file.string(), journal.Damaged()));
  }
  files::WriteFile(request.out / "experiment.yaml", experiment::WriteExperiment(experiment));
  evaluator.LoadLogs();  // now, since workers are copies of what is there when they start
  journal.SetNote("name", experiment.name);
  const SweepSize size = SizeOf(experiment);
  journal.SetNote(size.is_settings ? "most_settings" : "most_trials", std::to_string(size.most));
  journal.SetNote("state", "running");
  journal.Commit();
  const auto stopped = [&journal]() -> std::optional<sweep::SweepResult> {
    journal.SetNote("state", "stopped");
    journal.Close();
    return std::nullopt;
  };
  std::optional<Cluster> cluster;
  if (request.cluster != nullptr) {
    cluster.emplace(evaluator, facts, *request.cluster, request.progress,
                    [&stop] { return !stop.IsAsked(); });
    if (!cluster->Resume(request.out, journal)) return stopped();
  } else if (sweep::SlurmShards::AreOpen(request.out)) {
    terminal::Say(fmt::format(
        "note: shards of this sweep were given to a cluster ({}); what they have done is taken in "
        "with --engine alone, and everything that is missing is run here",
        (request.out / "slurm").string()));
  }
  Stopwatch watch(journal);
  sweep::TrialRunner runner(
      [&](const sweep::TrialRequest& trial) { return evaluator.Evaluate(trial); },
      [&](const sweep::TrialRequest& trial) { return evaluator.KeyOf(trial); }, &journal,
      request.jobs, experiment.run,
      {[&](const sweep::TrialRow& row, bool from_journal) {
         progress.Seen(row, from_journal);
         doubts.Seen(row);
         if (request.live != nullptr) request.live->Seen(row);
       },
       [&] {
         progress.Tick();
         if (request.live != nullptr) request.live->Tick();
         watch.Note();
         request.tick(journal);
         return !stop.IsAsked();
       },
       [&](sweep::TrialRow& row) { evaluator.NameSides(row); }});
  const sweep::MayStart may_start = [&](const std::vector<sweep::TrialRequest>& trials) {
    const double limit_s = experiment.search.max_s;
    return limit_s == 0.0 || watch.Elapsed_s() < limit_s || runner.HasAll(trials);
  };
  std::optional<sweep::SweepResult> result = sweep::Sweep(
      evaluator,
      [&](std::vector<sweep::TrialRequest> trials) -> std::optional<std::vector<sweep::TrialRow>> {
        if (cluster && !cluster->Run(trials, runner)) return std::nullopt;
        return runner.Run(std::move(trials));
      },
      may_start, {request.jobs, [&](const sweep::ReferenceProgress& references) {
                    progress.Tick(references);
                    if (request.live != nullptr) request.live->Tick();
                    request.tick(journal);
                    return !stop.IsAsked();
                  }});
  watch.Note(true);
  journal.SetNote("state", result ? "done" : "stopped");
  journal.Close();
  return result;
}

}  // namespace

bool IsComputed(const experiment::Experiment& experiment) {
  return experiment.candidate.kind != experiment::CandidateKind::kLogs ||
         experiment.reference.kind == experiment::ReferenceKind::kProgram;
}

sweep::Facts FactsOf(const experiment::Experiment& experiment) {
  sweep::Facts facts;
  for (const auto& [key, value] : experiment::FlatValues(experiment)) {
    if (!IsFree(key)) facts[key] = value;
  }
  facts["the version of rift"] = fmt::format("{} ({})", RIFT_VERSION, sweep::PhysicsVersion());
  return facts;
}

int CoresToUse() {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  return ::sched_getaffinity(0, sizeof cores, &cores) == 0 ? CPU_COUNT(&cores) : 1;
}

std::optional<sweep::SweepResult> RunSweep(sweep::Evaluator& evaluator,
                                           const SweepRunRequest& request) {
  const terminal::StopSignal stop;
  const experiment::Experiment& experiment = evaluator.experiment();
  SweepProgress progress(request.progress, SizeOf(experiment));
  const sweep::SweepResult kinds = sweep::EmptyResult(experiment);
  DoubtNotes doubts(kinds, [&progress](const std::string& line) { progress.Warn(line); });
  std::optional<sweep::SweepResult> result;
  if (IsComputed(experiment)) {
    result = RunSimulated(evaluator, request, progress, doubts, stop);
  } else {
    const sweep::RunTrials run =
        sweep::RunHere([&](const sweep::TrialRequest& trial) { return evaluator.Evaluate(trial); },
                       {[&](const sweep::TrialRow& row, bool) {
                          progress.Seen(row, false);
                          doubts.Seen(row);
                          if (request.live != nullptr) request.live->Seen(row);
                        },
                        [&] {
                          progress.Tick();
                          if (request.live != nullptr) request.live->Tick();
                          return !stop.IsAsked();
                        }});
    result = sweep::Sweep(evaluator, run, [](const auto&) { return true; });
  }
  progress.End(result ? "done" : "stopped");
  if (result) doubts.End(*result);
  return result;
}

namespace {

/// A journal that says "running" while nobody holds the folder was left by a killed sweep.
std::string StateOf(const std::filesystem::path& folder, const sweep::JournalSummary& summary) {
  if (files::FolderLock::IsHeld(folder)) return "running";
  const auto noted = summary.notes.find("state");
  const bool is_done = noted != summary.notes.end() && noted->second == "done";
  return is_done ? "done" : "stopped";
}

}  // namespace

std::string SweepStatus(const std::filesystem::path& folder, bool json) {
  const sweep::JournalSummary summary = sweep::ReadJournal(folder / kJournalName);
  const std::string state = StateOf(folder, summary);
  const std::optional<sweep::ShardCounts> shards = sweep::ReadShardCounts(folder);
  return json ? report::StatusJson(summary, state, shards)
              : report::StatusText(summary, state, shards);
}

}  // namespace rift::commands
