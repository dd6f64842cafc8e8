#include "rift/sessions/sweep/shard.hpp"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <optional>

#include "further_trials.hpp"
#include "kept_calibration.hpp"
#include "rift/files/files.hpp"
#include "rift/sessions/sweep/journal.hpp"
#include "rift/sessions/sweep/run.hpp"
#include "rift/statistics/hash.hpp"
#include "rift/sweep/explain/failure_probability.hpp"
#include "rift/sweep/explain/shrink.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "rift/sweep/run/external_program.hpp"

namespace rift::sessions {
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
                 Publisher& publisher, const SweepObserver& observer) {
  const GoOn go_on = observer.watch_for_stop();
  const sweep::ReferenceWatch watch{jobs,
                                    [&go_on](const sweep::ReferenceProgress&) { return go_on(); }};
  if (!evaluator.CheckReferences(watch)) return false;
  sweep::TrialRunner runner(
      [&](const sweep::TrialRequest& trial) { return evaluator.Evaluate(trial); },
      [&](const sweep::TrialRequest& trial) { return evaluator.KeyOf(trial); }, &journal, jobs,
      evaluator.experiment().run,
      {[](const sweep::TrialRow&, bool) {},
       [&] {
         publisher.Tick(journal);
         return go_on();
       },
       [&](sweep::TrialRow& row) { evaluator.NameSides(row); }},
      static_cast<size_t>(shard.paths));
  return runner.Run(std::move(requests)).has_value();
}

/// The trials that a search beyond the sweep asks for. True when it was done.
bool RunFurtherTrialsOf(const sweep::Shard& shard, sweep::Evaluator& evaluator, int jobs,
                        sweep::Journal& journal, Publisher& publisher,
                        const SweepObserver& observer) {
  const experiment::Experiment& experiment = evaluator.experiment();
  const GoOn go_on = observer.watch_for_stop();
  FurtherTrials trials(evaluator, jobs, observer, go_on, journal,
                       [&publisher](sweep::Journal& now) { publisher.Tick(now); });
  try {
    if (shard.kind == sweep::ShardKind::kShrink) {
      sweep::SweepResult result = sweep::EmptyResult(experiment);
      result.rows.push_back(sweep::RowFor(sweep::DecodeRequest(shard.requests.at(0))));
      sweep::ShrinkRow(experiment, result, 0, {}, trials.AsRun());
    } else {
      sweep::EstimateRareEvent(experiment, trials.AsRun(), {});
    }
    return true;
  } catch (const FurtherTrials::Stopped&) {
    return false;
  }
}

/// A row of the journal.
struct KeptFit {
  std::string key;
  sweep::JournalEntry entry;
};

/// Of a shard that is a calibration. Nothing of a fit is kept before its end, and there is no
/// folder for it before: SIGTERM ends it.
std::optional<KeptFit> FitOf(const sweep::Shard& shard, const std::string& file,
                             sweep::Evaluator& evaluator, int jobs, const SweepObserver& observer) {
  if (shard.kind != sweep::ShardKind::kCalibration) return std::nullopt;
  KeptCalibration kept(evaluator);
  sweep::KeysHash keys;
  keys.Add(kept.key());
  if (keys.Text() != shard.keys) ThrowOtherInputs(file);
  return KeptFit{kept.key(), kept.Fit(jobs, observer.say)};
}

}  // namespace

ShardFile ReadShard(const std::string& file, const experiment::Experiment& experiment) {
  const std::string bytes = files::ReadFile(file);
  ShardFile read{file, sweep::ShardName(bytes), sweep::DecodeShard(bytes, file)};
  const bool is_ours =
      read.shard.facts == sweep::HashOf(FactsOf(experiment)) &&
      read.shard.experiment == statistics::Hash128Text(experiment::WriteExperiment(experiment));
  if (is_ours) return read;
  throw std::invalid_argument(fmt::format(
      "{}: it is a shard of another experiment or of another build of rift ({}): every node must "
      "run the rift that submitted it",
      file, RIFT_VERSION));
}

bool RunShard(const ShardFile& shard, const experiment::Experiment& experiment,
              const std::string& experiment_file, const sweep::Inputs& inputs,
              const ShardRunRequest& request, const SweepObserver& observer) {
  const sweep::ShardKind kind = shard.shard.kind;
  const fs::path done = sweep::ShardJournal(request.out, shard.name),
                 unfinished = sweep::UnfinishedShardJournal(request.out, shard.name);
  const sweep::Facts facts = FactsOf(experiment);
  if (sweep::IsJournalOf(done, facts)) return true;

  sweep::Evaluator evaluator(experiment, experiment_file, inputs);
  evaluator.LoadLogs();
  const std::optional<KeptFit> fit =
      FitOf(shard.shard, shard.file, evaluator, request.jobs, observer);
  const LocalFolder folder;
  const fs::path local = folder / kJournalName;
  if (sweep::IsJournalOf(unfinished, facts)) fs::copy_file(unfinished, local);
  Publisher publisher(folder, unfinished, request.copy_every_s);
  bool is_done = false;
  if (kind == sweep::ShardKind::kSweep) {
    const SweepRunRequest run{.out = folder.Path(),
                              .jobs = request.jobs,
                              .tick = [&](sweep::Journal& journal) { publisher.Tick(journal); }};
    is_done = RunSweep(evaluator, run, observer).has_value();
  } else {
    sweep::Journal journal(local, facts);
    if (fit) {
      journal.Add(fit->key, fit->entry);
      is_done = true;
    } else if (kind == sweep::ShardKind::kTrials) {
      is_done = RunTrialsOf(shard.shard, RequestsOf(shard.shard, shard.file, evaluator), evaluator,
                            journal, request.jobs, publisher, observer);
    } else {
      is_done =
          RunFurtherTrialsOf(shard.shard, evaluator, request.jobs, journal, publisher, observer);
    }
  }
  sweep::Journal journal(local, facts);
  publisher.Publish(journal, is_done ? done : unfinished);
  if (!is_done) return false;
  std::error_code ignored;
  fs::remove(unfinished, ignored);
  return true;
}

}  // namespace rift::sessions
