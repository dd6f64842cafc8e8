#include "shard.hpp"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <optional>

#include "calibrate.hpp"
#include "explain.hpp"
#include "rift/commands/arguments/inputs.hpp"
#include "rift/commands/arguments/outputs.hpp"
#include "rift/files/files.hpp"
#include "rift/statistics/hash.hpp"
#include "rift/sweep/explain/failure_probability.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/run/external_program.hpp"
#include "rift/sweep/run/shard.hpp"
#include "rift/terminal/exit_code.hpp"
#include "rift/terminal/print.hpp"
#include "rift/terminal/stop_signal.hpp"

namespace rift::commands {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// A folder on the disk of this machine, gone at the end of the scope.
class LocalFolder {
 public:
  LocalFolder() = default;
  ~LocalFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  LocalFolder(const LocalFolder&) = delete;
  LocalFolder& operator=(const LocalFolder&) = delete;

  fs::path operator/(const char* name) const { return path_ / name; }
  const fs::path& Path() const { return path_; }

 private:
  fs::path path_ = sweep::ExternalProgram::MakeFolder();
};

/// The shard, if it is one of this experiment and this build.
sweep::Shard ReadShard(const std::string& file, const std::string& bytes,
                       const experiment::Experiment& experiment) {
  sweep::Shard shard = sweep::DecodeShard(bytes, file);
  const bool is_ours =
      shard.facts == sweep::HashOf(FactsOf(experiment)) &&
      shard.experiment == statistics::Hash128Text(experiment::WriteExperiment(experiment));
  if (is_ours) return shard;
  throw std::invalid_argument(fmt::format(
      "{}: it is a shard of another experiment or of another build of rift ({}): every node must "
      "run the rift that submitted it",
      file, RIFT_VERSION));
}

[[noreturn]] void ThrowOtherInputs(const std::string& file) {
  throw std::invalid_argument(fmt::format(
      "{}: its trials read logs or programs that are others on this machine than where it was "
      "submitted",
      file));
}

std::vector<sweep::TrialRequest> RequestsOf(const sweep::Shard& shard, const std::string& file,
                                            sweep::Evaluator& evaluator) {
  std::vector<sweep::TrialRequest> requests;
  sweep::KeysHash keys;
  for (const std::string& bytes : shard.requests) {
    requests.push_back(sweep::DecodeRequest(bytes));
    keys.Add(evaluator.KeyOf(requests.back()));
  }
  if (keys.Text() != shard.keys) ThrowOtherInputs(file);
  return requests;
}

/// Brings the journal back, now and then.
class Publisher {
 public:
  Publisher(const LocalFolder& folder, fs::path unfinished, double every_s)
      : folder_(folder), unfinished_(std::move(unfinished)), every_s_(every_s) {}

  void Publish(sweep::Journal& journal, const fs::path& target) const {
    const fs::path copy = folder_ / "copy.sqlite";
    std::error_code ignored;
    fs::remove(copy, ignored);
    journal.CopyTo(copy);
    sweep::PublishFile(copy, target);
  }
  void Tick(sweep::Journal& journal) {
    const std::chrono::duration<double> since = Clock::now() - published_;
    if (since.count() < every_s_) return;
    PublishUnfinished(journal);
  }
  void PublishUnfinished(sweep::Journal& journal) {
    Publish(journal, unfinished_);
    published_ = Clock::now();
  }

 private:
  const LocalFolder& folder_;
  fs::path unfinished_;
  double every_s_;
  Clock::time_point published_ = Clock::now();
};

/// True when it was done; false when it was told to stop.
bool RunTrialsOf(const sweep::Shard& shard, std::vector<sweep::TrialRequest> requests,
                 sweep::Evaluator& evaluator, sweep::Journal& journal, int jobs,
                 Publisher& publisher) {
  const terminal::StopSignal stop;
  const sweep::ReferenceWatch watch{
      jobs, [&stop](const sweep::ReferenceProgress&) { return !stop.IsAsked(); }};
  if (!evaluator.CheckReferences(watch)) return false;
  sweep::TrialRunner runner(
      [&](const sweep::TrialRequest& trial) { return evaluator.Evaluate(trial); },
      [&](const sweep::TrialRequest& trial) { return evaluator.KeyOf(trial); }, &journal, jobs,
      evaluator.experiment().run,
      {[](const sweep::TrialRow&, bool) {},
       [&] {
         publisher.Tick(journal);
         return !stop.IsAsked();
       },
       [&](sweep::TrialRow& row) { evaluator.NameSides(row); }},
      static_cast<size_t>(shard.paths));
  return runner.Run(std::move(requests)).has_value();
}

/// The trials that a search beyond the sweep asks for. True when it was done.
bool RunFurtherTrialsOf(const sweep::Shard& shard, sweep::Evaluator& evaluator,
                        const SweepRequest& request, sweep::Journal& journal,
                        Publisher& publisher) {
  const terminal::StopSignal stop;
  FurtherTrials trials(evaluator, {.jobs = request.jobs}, stop, journal,
                       [&publisher](sweep::Journal& now) { publisher.Tick(now); });
  try {
    if (shard.kind == sweep::ShardKind::kShrink) {
      RunTrialsOfShrinking(evaluator.experiment(), sweep::DecodeRequest(shard.requests.at(0)),
                           request.explain.shrink_options, trials);
    } else {
      sweep::EstimateRareEvent(evaluator.experiment(), trials.AsRun(),
                               request.explain.rare_event_options);
    }
    return true;
  } catch (const FurtherTrials::Stopped&) {
    return false;
  }
}

/// A row of the journal.
struct Fit {
  std::string key;
  sweep::JournalEntry entry;
};

/// Of a shard that is a calibration. Nothing of a fit is kept before its end, and there is no
/// folder for it before: SIGTERM ends it.
std::optional<Fit> FitOf(const sweep::Shard& shard, const std::string& file,
                         sweep::Evaluator& evaluator, int jobs) {
  if (shard.kind != sweep::ShardKind::kCalibration) return std::nullopt;
  KeptCalibration kept(evaluator);
  sweep::KeysHash keys;
  keys.Add(kept.key());
  if (keys.Text() != shard.keys) ThrowOtherInputs(file);
  return Fit{kept.key(), kept.Fit(jobs, [](const std::string& line) { terminal::Say(line); })};
}

}  // namespace

int RunShard(const SweepRequest& request, const experiment::Experiment& experiment) {
  const std::string& file = request.engine.shard;
  const std::string bytes = files::ReadFile(file);
  const sweep::Shard shard = ReadShard(file, bytes, experiment);
  const std::string name = sweep::ShardName(bytes);
  const fs::path out = OutputOf(request.out, experiment.name);
  const fs::path done = sweep::ShardJournal(out, name),
                 unfinished = sweep::UnfinishedShardJournal(out, name);
  const sweep::Facts facts = FactsOf(experiment);
  if (sweep::IsJournalOf(done, facts)) return terminal::kDone;

  sweep::Evaluator evaluator(experiment, request.experiment, FileInputs());
  evaluator.LoadLogs();
  const std::optional<Fit> fit = FitOf(shard, file, evaluator, request.jobs);
  const LocalFolder folder;
  const fs::path local = folder / kJournalName;
  if (sweep::IsJournalOf(unfinished, facts)) fs::copy_file(unfinished, local);
  Publisher publisher(folder, unfinished, request.engine.copy_every_s);
  bool is_done = false;
  if (shard.kind == sweep::ShardKind::kSweep) {
    const SweepRunRequest run{.out = folder.Path(),
                              .jobs = request.jobs,
                              .tick = [&](sweep::Journal& journal) { publisher.Tick(journal); }};
    is_done = RunSweep(evaluator, run).has_value();
  } else {
    sweep::Journal journal(local, facts);
    if (fit) {
      journal.Add(fit->key, fit->entry);
      is_done = true;
    } else if (shard.kind == sweep::ShardKind::kTrials) {
      is_done = RunTrialsOf(shard, RequestsOf(shard, file, evaluator), evaluator, journal,
                            request.jobs, publisher);
    } else {
      is_done = RunFurtherTrialsOf(shard, evaluator, request, journal, publisher);
    }
  }
  sweep::Journal journal(local, facts);
  publisher.Publish(journal, is_done ? done : unfinished);
  if (!is_done) return terminal::kStopped;
  std::error_code ignored;
  fs::remove(unfinished, ignored);
  return terminal::kDone;
}

}  // namespace rift::commands
