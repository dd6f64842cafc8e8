#include "rift/sessions/sweep/run.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <memory>
#include <utility>

#include "cluster.hpp"
#include "doubt_notes.hpp"
#include "rift/files/files.hpp"
#include "rift/files/network_file_system.hpp"
#include "rift/sessions/sweep/folder.hpp"
#include "rift/sessions/sweep/journal.hpp"
#include "rift/sweep/falsify/sweep.hpp"

namespace rift::sessions {

namespace {

using sweep::Journal;

SweepSize SizeOf(const experiment::Experiment& experiment) {
  if (experiment.goal != experiment::Goal::kGrid) return {experiment.search.budget, true};
  const bool is_repeated = sweep::IsRepeatedGrid(experiment);
  double steps = is_repeated ? 1.0 : static_cast<double>(experiment.reference.trials.names.size());
  for (const experiment::Parameter& parameter : experiment.space.parameters) {
    steps *= static_cast<double>(parameter.levels.size());
  }
  return {static_cast<int>(steps), is_repeated};
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

void NoteDamage(const Journal& journal, const std::filesystem::path& file,
                const SweepObserver& observer) {
  if (journal.Damaged() == 0) return;
  observer.say(fmt::format(
      "note: {}: {} of its entries were damaged and are left out; what is missing is run again",
      file.string(), journal.Damaged()));
}

/// What a trial may cost is no fact of the journal. One that was given up for it is run again where
/// the limit is another: it says nothing of the experiment.
void ForgetOtherLimits(Journal& journal, const sweep::RunOptions& now,
                       const std::filesystem::path& file, const SweepObserver& observer) {
  std::string limits;
  sweep::RunOptions::Fields(now, [&limits](const char* key, auto value, const auto&...) {
    limits += fmt::format("{}{}={}", limits.empty() ? "" : " ", key, value);
  });
  const std::string before = journal.Note("limits").value_or(limits);
  journal.SetNote("limits", limits);
  if (before == limits) return;
  int count = 0;
  for (const std::string_view status : sweep::kGivenUp) {
    count += journal.Forget(std::string(status));
  }
  if (count == 0) return;
  observer.say(fmt::format(
      "note: {}: {} that hung, crashed or ran out of memory under other limits ({}) {} run again",
      file.string(), count == 1 ? "1 trial" : fmt::format("{} trials", count), before,
      count == 1 ? "is" : "are"));
}

void NoteOpenShards(const std::filesystem::path& out, const SweepObserver& observer) {
  if (!sweep::SlurmShards::AreOpen(out)) return;
  observer.say(fmt::format(
      "note: shards of this sweep were given to a cluster ({}); what they have done is taken in "
      "with --engine alone, and everything that is missing is run here",
      (out / "slurm").string()));
}

/// What readers of the folder find from now on. False when it was told to stop.
bool Begin(Journal& journal, sweep::Evaluator& evaluator, const std::filesystem::path& out,
           const GoOn& go_on) {
  const experiment::Experiment& experiment = evaluator.experiment();
  files::WriteFile(out / "experiment.yaml", experiment::WriteExperiment(experiment));
  // Now, since workers are copies of what is there when they start.
  if (!evaluator.LoadLogs(go_on)) return false;
  journal.SetNote("name", experiment.name);
  const SweepSize size = SizeOf(experiment);
  journal.SetNote(size.is_settings ? "most_settings" : "most_trials", std::to_string(size.most));
  journal.SetNote("state", "running");
  journal.Commit();
  return true;
}

/// Everybody who is told of the trials while they run.
struct Watchers {
  TrialProgress& progress;
  DoubtNotes& doubts;
  LivePage* live;  ///< may be nullptr

  void Seen(const sweep::TrialRow& row, bool from_journal) const {
    progress.Seen(row, from_journal);
    doubts.Seen(row);
    if (live != nullptr) live->Seen(row);
  }
  void Tick() const {
    progress.Tick();
    if (live != nullptr) live->Tick();
  }
  void Tick(const sweep::ReferenceProgress& references) const {
    progress.Tick(references);
    if (live != nullptr) live->Tick();
  }
};

/// Trials through the journal, in worker processes here or on a cluster.
std::optional<sweep::SweepResult> RunComputed(sweep::Evaluator& evaluator,
                                              const SweepRunRequest& request,
                                              const SweepObserver& observer,
                                              const Watchers& watchers, const GoOn& go_on) {
  const std::filesystem::path file = request.out / kJournalName;
  if (request.fresh) {
    sweep::SlurmShards::Forget(request.out, observer.say);
    Journal::Remove(file);
  }
  NoteFileSystem(request.out, observer);
  const sweep::Facts facts = FactsOf(evaluator.experiment());
  Journal journal(file, facts);
  NoteDamage(journal, file, observer);
  const auto end = [&journal](const char* state) {
    journal.SetNote("state", state);
    journal.Close();
  };
  if (!Begin(journal, evaluator, request.out, go_on)) {
    end("stopped");
    return std::nullopt;
  }
  ForgetOtherLimits(journal, evaluator.experiment().run, file, observer);
  std::optional<Cluster> cluster;
  if (request.cluster != nullptr) {
    cluster.emplace(evaluator, facts, *request.cluster, observer, go_on);
    if (!cluster->Resume(request.out, journal)) {
      end("stopped");
      return std::nullopt;
    }
  } else {
    NoteOpenShards(request.out, observer);
  }
  Stopwatch watch(journal);
  sweep::TrialRunner runner(
      [&](const sweep::TrialRequest& trial) { return evaluator.Evaluate(trial); },
      [&](const sweep::TrialRequest& trial) { return evaluator.KeyOf(trial); }, &journal,
      request.jobs, evaluator.experiment().run,
      {[&](const sweep::TrialRow& row, bool from_journal) { watchers.Seen(row, from_journal); },
       [&] {
         watchers.Tick();
         watch.Note();
         request.tick(journal);
         return go_on();
       },
       [&](sweep::TrialRow& row) { evaluator.NameSides(row); }});
  const sweep::RunTrials run =
      [&](std::vector<sweep::TrialRequest> trials) -> std::optional<std::vector<sweep::TrialRow>> {
    if (cluster && !cluster->Run(trials, runner)) return std::nullopt;
    return runner.Run(std::move(trials));
  };
  // The first setting is tried whatever the time: a search without any has nothing to tell.
  bool has_begun = false;
  const sweep::MayStart may_start = [&](const std::vector<sweep::TrialRequest>& trials) {
    const double limit_s = evaluator.experiment().search.max_s;
    const bool is_first = !std::exchange(has_begun, true);
    return is_first || limit_s == 0.0 || watch.Elapsed_s() < limit_s || runner.HasAll(trials);
  };
  std::optional<sweep::SweepResult> result = sweep::Sweep(
      evaluator, run, may_start, {request.jobs, [&](const sweep::ReferenceProgress& references) {
                                    watchers.Tick(references);
                                    request.tick(journal);
                                    return go_on();
                                  }});
  watch.Note(true);
  end(result ? "done" : "stopped");
  return result;
}

/// Logs held against logs or a path, in this process.
std::optional<sweep::SweepResult> RunLogs(sweep::Evaluator& evaluator, const Watchers& watchers,
                                          const GoOn& go_on) {
  const sweep::RunTrials run =
      sweep::RunHere([&](const sweep::TrialRequest& trial) { return evaluator.Evaluate(trial); },
                     {[&](const sweep::TrialRow& row, bool) { watchers.Seen(row, false); },
                      [&] {
                        watchers.Tick();
                        return go_on();
                      }});
  return sweep::Sweep(evaluator, run, [](const auto&) { return true; });
}

}  // namespace

std::optional<sweep::SweepResult> RunSweep(sweep::Evaluator& evaluator,
                                           const SweepRunRequest& request,
                                           const SweepObserver& observer) {
  // One that was killed leaves its page, which would say for ever that it runs.
  if (request.live == nullptr) std::filesystem::remove(request.out / kLivePageName);
  const GoOn go_on = observer.watch_for_stop();
  const experiment::Experiment& experiment = evaluator.experiment();
  const std::unique_ptr<TrialProgress> progress = observer.begin(SizeOf(experiment));
  const sweep::SweepResult kinds = sweep::EmptyResult(experiment);
  DoubtNotes doubts(kinds, [&progress](const std::string& line) { progress->Warn(line); });
  const Watchers watchers{*progress, doubts, request.live};
  std::optional<sweep::SweepResult> result =
      IsComputed(experiment) ? RunComputed(evaluator, request, observer, watchers, go_on)
                             : RunLogs(evaluator, watchers, go_on);
  progress->End(result ? "done" : "stopped");
  if (result) doubts.End(*result);
  return result;
}

}  // namespace rift::sessions
