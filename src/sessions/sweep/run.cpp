#include "rift/sessions/sweep/run.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <memory>

#include "cluster.hpp"
#include "doubt_notes.hpp"
#include "rift/files/files.hpp"
#include "rift/files/network_file_system.hpp"
#include "rift/sessions/sweep/journal.hpp"
#include "rift/sweep/falsify/sweep.hpp"

namespace rift::sessions {

namespace {

using sweep::Journal;

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

void NoteFileSystem(const std::filesystem::path& out, const SweepObserver& observer) {
  const std::string_view name = files::NetworkFileSystemOf(out);
  if (name.empty()) return;
  observer.say(fmt::format(
      "note: {} is on {}, a network file system: its journal is kept without a write-ahead log, "
      "which is slower",
      out.string(), name));
}

std::optional<sweep::SweepResult> RunSimulated(sweep::Evaluator& evaluator,
                                               const SweepRunRequest& request,
                                               const SweepObserver& observer,
                                               TrialProgress& progress, DoubtNotes& doubts,
                                               const GoOn& go_on) {
  const experiment::Experiment& experiment = evaluator.experiment();
  const std::filesystem::path file = request.out / kJournalName;
  if (request.fresh) {
    sweep::SlurmShards::Forget(request.out);
    Journal::Remove(file);
  }
  NoteFileSystem(request.out, observer);
  const sweep::Facts facts = FactsOf(experiment);
  Journal journal(file, facts);
  if (journal.Damaged() > 0) {
    observer.say(fmt::format(
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
    cluster.emplace(evaluator, facts, *request.cluster, observer, go_on);
    if (!cluster->Resume(request.out, journal)) return stopped();
  } else if (sweep::SlurmShards::AreOpen(request.out)) {
    observer.say(fmt::format(
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
         return go_on();
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
                    return go_on();
                  }});
  watch.Note(true);
  journal.SetNote("state", result ? "done" : "stopped");
  journal.Close();
  return result;
}

}  // namespace

std::optional<sweep::SweepResult> RunSweep(sweep::Evaluator& evaluator,
                                           const SweepRunRequest& request,
                                           const SweepObserver& observer) {
  const GoOn go_on = observer.watch_for_stop();
  const experiment::Experiment& experiment = evaluator.experiment();
  const std::unique_ptr<TrialProgress> progress = observer.begin(SizeOf(experiment));
  const sweep::SweepResult kinds = sweep::EmptyResult(experiment);
  DoubtNotes doubts(kinds, [&progress](const std::string& line) { progress->Warn(line); });
  std::optional<sweep::SweepResult> result;
  if (IsComputed(experiment)) {
    result = RunSimulated(evaluator, request, observer, *progress, doubts, go_on);
  } else {
    const sweep::RunTrials run =
        sweep::RunHere([&](const sweep::TrialRequest& trial) { return evaluator.Evaluate(trial); },
                       {[&](const sweep::TrialRow& row, bool) {
                          progress->Seen(row, false);
                          doubts.Seen(row);
                          if (request.live != nullptr) request.live->Seen(row);
                        },
                        [&] {
                          progress->Tick();
                          if (request.live != nullptr) request.live->Tick();
                          return go_on();
                        }});
    result = sweep::Sweep(evaluator, run, [](const auto&) { return true; });
  }
  progress->End(result ? "done" : "stopped");
  if (result) doubts.End(*result);
  return result;
}

}  // namespace rift::sessions
