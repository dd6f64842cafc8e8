// Runs of the experiment's own values as references: which seeds have one, what takes the place of
// those that fail.

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <optional>
#include <stdexcept>

#include "job_status.hpp"
#include "program_side.hpp"
#include "rift/experiment/task.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "rift/sweep/run/byte_codec.hpp"
#include "rift/sweep/run/worker_pool.hpp"
#include "rift/yaml/enum_name.hpp"
#include "simulated_recording.hpp"

namespace rift::sweep {

using experiment::CandidateKind;
using experiment::ReferenceKind;

namespace {

/// Seeds that are tried in the place of one whose nominal run fails.
constexpr int kMostOthers = 50;

/// Ends of a run that another seed may mend: noise of the robot or of the camera.
bool IsMatterOfNoise(TrialStatus status) {
  return status == TrialStatus::kTimedOut || status == TrialStatus::kFell ||
         status == TrialStatus::kLeftArena || status == TrialStatus::kLost;
}

}  // namespace

/// The nominal run depends on the trial alone, and every setting is held against it.
const Recording& Evaluator::Nominal(std::uint64_t seed) {
  constexpr size_t kMostKept = 1000;
  const auto found = nominal_runs_.find(seed);
  if (found != nominal_runs_.end()) return found->second;
  if (nominal_runs_.size() >= kMostKept) nominal_runs_.clear();
  if (candidate_program_) {
    return nominal_runs_[seed] = candidate_program_->Run(NominalRequest(experiment_, seed));
  }
  const experiment::Experiment at = experiment::DrawnAt(experiment_, seed);
  const SimulatedTrial trial = TrialOf(at, experiment::AxleAtStart(at), seed);
  return nominal_runs_[seed] = RecordingOf(Simulate(trial), trial, experiment_.candidate.grid_fps);
}

std::uint64_t Evaluator::SeedWithReference(std::uint64_t seed) {
  if (experiment_.reference.kind != ReferenceKind::kNominal) return seed;
  if (const auto known = used_.find(seed); known != used_.end()) return known->second;
  std::uint64_t used = seed;
  for (int attempt = 1; IsMatterOfNoise(Nominal(used).status) && attempt <= kMostOthers;
       ++attempt) {
    used = FreshSeed(seed, static_cast<std::uint64_t>(attempt));
  }
  return used_[seed] = used;
}

namespace {

/// Nominal runs of seeds, each in a worker and timed on its own, until one of them ends in a way
/// that no seed mends.
class ReferenceSearch {
 public:
  using RunNominal = std::function<Recording(std::uint64_t seed)>;

  ReferenceSearch(RunNominal run, const RunOptions& options, const ReferenceWatch& watch)
      : pool_(
            [run = std::move(run)](const std::string& job) {
              ByteReader read(job);
              std::uint64_t seed = 0;
              read(seed);
              const Recording nominal = run(seed);
              ByteWriter write;
              write(nominal.status);
              write(nominal.reason);
              return write.Take();
            },
            watch.workers, options),
        watch_(watch) {}

  /// A seed that is asked for, and what was tried in its place.
  struct Place {
    std::uint64_t seed = 0;
    std::uint64_t used = 0;
    TrialStatus status = TrialStatus::kOk;  ///< of the last run
    std::string reason;                     ///< of the run with `seed` itself
    std::string last_reason;
  };

  /// False when it was told to stop, or a run ended in a way that no seed mends: see Broken().
  bool FillIn(std::vector<Place>& places) {
    std::vector<Place*> open;
    for (Place& place : places) open.push_back(&place);
    for (int attempt = 0; attempt <= kMostOthers && !open.empty(); ++attempt) {
      progress_.others_tried = attempt;
      for (Place* place : open) {
        place->used = attempt == 0 ? place->seed
                                   : FreshSeed(place->seed, static_cast<std::uint64_t>(attempt));
      }
      if (!RunOnce(open)) return false;
      std::erase_if(open, [](const Place* place) { return place->status == TrialStatus::kOk; });
    }
    return true;
  }

  void Expect(int seeds) { progress_.seeds = seeds; }
  /// The run that ended in a way that no seed mends.
  const std::optional<Place>& Broken() const { return broken_; }

 private:
  bool RunOnce(const std::vector<Place*>& open) {
    const auto place = [&](int i) -> Place& { return *open[static_cast<size_t>(i)]; };
    return pool_.Run({static_cast<int>(open.size()),
                      [&](int i) {
                        ByteWriter write;
                        write(place(i).used);
                        return write.Take();
                      },
                      [&](int i, const JobResult& result) { Take(place(i), result); },
                      [&] { return !broken_ && watch_.go_on(progress_); }}) &&
           !broken_;
  }

  void Take(Place& place, const JobResult& result) {
    place.status = StatusOf(result.end);
    place.last_reason = result.bytes;
    if (result.end == JobEnd::kDone) {
      ByteReader read(result.bytes);
      read(place.status);
      read(place.last_reason);
    }
    progress_.arrived += place.status == TrialStatus::kOk;
    if (place.status == TrialStatus::kOk) return;
    if (place.used == place.seed) place.reason = place.last_reason;
    progress_.last_failure = place.last_reason;
    if (!IsMatterOfNoise(place.status) && !broken_) broken_ = place;
  }

  WorkerPool pool_;
  const ReferenceWatch& watch_;
  ReferenceProgress progress_;
  std::optional<Place> broken_;
};

}  // namespace

int Evaluator::NominalSeeds() const {
  const int seeds = static_cast<int>(experiment_.reference.trials.names.size());
  const bool is_search = experiment_.goal == experiment::Goal::kFalsify;
  // Draws have seeds of their own: the first alone tells whether there is a run to compare with.
  if (is_search && experiment_.search.strategy == search::Method::kRandom) return 1;
  const bool is_repeated = experiment_.falsify.repeat == Repeat::kEvery ||
                           (is_search && experiment_.falsify.repeat == Repeat::kDoubtful);
  return is_repeated ? std::max(seeds, std::min(experiment_.falsify.most_repeats, 100)) : seeds;
}

std::optional<std::vector<ReplacedReference>> Evaluator::CheckReferences(
    const ReferenceWatch& watch) {
  const bool is_run = experiment_.reference.kind == ReferenceKind::kNominal &&
                      experiment_.candidate.kind != CandidateKind::kLogs;
  if (!is_run) return std::vector<ReplacedReference>{};
  using Place = ReferenceSearch::Place;
  ReferenceSearch search([this](std::uint64_t seed) { return Nominal(seed); }, experiment_.run,
                         watch);
  // The first alone: what always fails is said after one run, and by the same seed for any workers.
  std::vector<Place> first(1), rest(static_cast<size_t>(NominalSeeds() - 1));
  first[0].seed = *FirstSeed(experiment_);
  for (size_t i = 0; i < rest.size(); ++i) rest[i].seed = first[0].seed + 1 + i;
  search.Expect(NominalSeeds());
  std::vector<ReplacedReference> replaced;
  for (std::vector<Place>* places : {&first, &rest}) {
    const bool is_whole = search.FillIn(*places);
    if (const std::optional<Place>& broken = search.Broken()) {
      throw std::invalid_argument(fmt::format(
          "{}: reference.kind is nominal, and the run with the experiment's own values and seed {} "
          "gives no trajectory to compare with ({}): {}",
          experiment_file_, broken->used, yaml::NameOf(broken->status), broken->last_reason));
    }
    if (!is_whole) return std::nullopt;
    for (const Place& place : *places) {
      if (place.status != TrialStatus::kOk) {
        throw std::invalid_argument(fmt::format(
            "{}: reference.kind is nominal, and the run with the experiment's own values does not "
            "arrive, with seed {} nor with {} others: {}",
            experiment_file_, place.seed, kMostOthers, place.reason));
      }
      used_[place.seed] = place.used;
      if (place.used == place.seed) continue;
      replaced.push_back({place.seed, place.used, place.reason});
    }
  }
  return replaced;
}

double Evaluator::NominalNoiseFloor_m(const std::function<bool()>& go_on) {
  const auto floor_m = [this](const std::string&) {
    std::vector<trajectory::Trajectory> runs;
    for (const TrialRequest& request : TrialsAt(experiment_, {})) {
      const Recording& run = Nominal(SeedWithReference(request.seed.value_or(experiment_.seed)));
      if (run.status == TrialStatus::kOk) runs.push_back(run.trajectory);
    }
    return fmt::format("{}", gap::NoiseFloor_m(runs, experiment_.gap));
  };
  double result_m = gap::kNotComputed;
  RunOptions options = experiment_.run;
  options.timeout_s *= static_cast<double>(experiment_.reference.trials.names.size());
  WorkerPool(floor_m, 1, options)
      .Run({1, [](int) { return std::string(); },
            [&](int, const JobResult& result) {
              if (result.end == JobEnd::kDone)
                result_m = std::strtod(result.bytes.c_str(), nullptr);
            },
            go_on});
  return result_m;
}

}  // namespace rift::sweep
