#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "fitted_simulator.hpp"
#include "rift/experiment/parameter.hpp"
#include "rift/statistics/random.hpp"
#include "rift/sweep/calibrate/likeness.hpp"
#include "rift/sweep/falsify/candidate_runs.hpp"
#include "rift/sweep/falsify/result.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "rift/sweep/run/for_each.hpp"
#include "rift/trajectory/frame_grid.hpp"
#include "rift/yaml/node.hpp"

namespace rift::sweep {
namespace {

struct Labelled {
  std::string level;
  RepeatedTrial trial;
};

/// A search tried no more than a part of the settings that its lists can make.
bool IsGridOverRepeatedLogs(const experiment::Experiment& experiment) {
  const auto& parameters = experiment.space.parameters;
  return experiment.goal == experiment::Goal::kGrid &&
         experiment.reference.kind == experiment::ReferenceKind::kLogs &&
         experiment.reference.trials.names.size() > 1 &&
         std::none_of(parameters.begin(), parameters.end(),
                      [](const experiment::Parameter& axis) { return axis.IsContinuous(); });
}

/// A simulated trial that is yet to be driven: for which of the real ones, and how.
struct Planned {
  size_t trial = 0;
  SimulatedTrial run;
};

/// Beside those that sweeps count up from the experiment's seed; no two trials share one.
std::uint64_t SeedOfRun(std::uint64_t seed, size_t trial, int run) {
  constexpr std::uint64_t kTrials = 1'000'000;
  return statistics::SeedOfStream(seed, kTrials * static_cast<std::uint64_t>(run) + trial);
}

/// Each real trial with what is known of the controller that drove it, and the candidate's run. A
/// candidate log that serves all repeats is one run, not several.
class Gathering {
 public:
  explicit Gathering(Evaluator& evaluator)
      : evaluator_(evaluator), experiment_(evaluator.experiment()) {}

  /// Nothing of a setting at which no trial can be made: its rows are `invalid` or `fault`.
  void Add(const experiment::Theta& theta);
  std::vector<Labelled> Drive(int threads);

 private:
  bool IsSimulated() const {
    return experiment_.candidate.kind == experiment::CandidateKind::kSimulation;
  }
  void AddTrials(const experiment::Theta& theta);
  void Plan(const TrialRequest& request, const Recording& real, size_t trial);
  void AddLog(const TrialRequest& request, const Recording& real, std::set<std::string>& seen);
  void RunPrograms(int workers);

  Evaluator& evaluator_;
  const experiment::Experiment& experiment_;
  std::vector<Labelled> trials_;
  std::vector<Planned> planned_;
  std::vector<TrialRequest> program_runs_;  ///< of a program, one for each of trials_
};

void Gathering::Add(const experiment::Theta& theta) {
  const size_t trials = trials_.size(), planned = planned_.size(), programs = program_runs_.size();
  const auto forget = [&] {
    trials_.resize(trials);
    planned_.resize(planned);
    program_runs_.resize(programs);
  };
  try {
    AddTrials(theta);
  } catch (const yaml::Error&) {
    forget();
  } catch (const std::invalid_argument&) {
    forget();
  }
}

void Gathering::AddTrials(const experiment::Theta& theta) {
  const experiment::Experiment at = ExperimentFor(experiment_, {.theta = theta});
  std::set<std::string> logs;
  for (const TrialRequest& request : TrialsAt(experiment_, theta)) {
    const Recording real = evaluator_.Reference(request);
    if (real.status != TrialStatus::kOk) continue;
    trials_.push_back(
        {MainLevel(experiment_.space.parameters, theta),
         {.setting = SettingKey(experiment_.space.parameters, theta),
          .real = real.trajectory,
          .waypoints = at.waypoints,
          .control = IsSimulated() ? at.control : ControllerFor(experiment_, request)}});
    if (IsSimulated()) {
      Plan(request, real, trials_.size() - 1);
    } else if (experiment_.candidate.kind == experiment::CandidateKind::kProgram) {
      program_runs_.push_back(request);
    } else {
      AddLog(request, real, logs);
    }
  }
}

void Gathering::AddLog(const TrialRequest& request, const Recording& real,
                       std::set<std::string>& seen) {
  Recording run = evaluator_.Candidate(request, real);
  RepeatedTrial& trial = trials_.back().trial;
  if (run.status != TrialStatus::kOk) {
    ++trial.failed_runs;
  } else if (seen.insert(run.source).second) {
    trial.runs.push_back(std::move(run.trajectory));
  }
}

void Gathering::Plan(const TrialRequest& request, const Recording& real, size_t trial) {
  const bool starts_as_real = experiment_.start == experiment::Start::kReference;
  if (starts_as_real && !real.trajectory.HasYaw()) {
    ++trials_[trial].trial.failed_runs;
    return;
  }
  TrialRequest run = request;
  for (int i = 0; i < experiment_.likeness.runs; ++i) {
    if (i > 0) run.seed = SeedOfRun(experiment_.seed, trial, i);
    planned_.push_back({trial, evaluator_.TrialFor(run, real)});  // the seed draws its ensemble too
  }
}

/// In processes that are given up when they hang, as the trials of the sweep were.
void Gathering::RunPrograms(int workers) {
  if (program_runs_.empty()) return;
  std::vector<Recording> runs = CandidateRuns(evaluator_, workers).Run(program_runs_);
  for (size_t i = 0; i < runs.size(); ++i) {
    RepeatedTrial& trial = trials_[i].trial;
    const bool is_run = runs[i].status == TrialStatus::kOk && HasPath(runs[i]);
    if (is_run) trial.runs.push_back(std::move(runs[i].trajectory));
    trial.failed_runs += !is_run;
  }
}

std::vector<Labelled> Gathering::Drive(int threads) {
  RunPrograms(threads);
  std::vector<SimulatedRun> runs(planned_.size());
  ForEach(planned_.size(), threads, [&](size_t i) { runs[i] = Simulate(planned_[i].run); });
  for (size_t i = 0; i < runs.size(); ++i) {
    RepeatedTrial& trial = trials_[planned_[i].trial].trial;
    if (runs[i].result.outcome == trial::Outcome::kReached) {
      // The same point of the body on both sides; as in the table, on the frames that saw the tag.
      trial.runs.push_back(trajectory::OffsetAlongHeading(
          trajectory::OnFramesOf(std::move(runs[i].result.trajectory),
                                 experiment_.candidate.grid_fps),
          experiment_.reference.tag_offset_m));
    } else {
      ++trial.failed_runs;
    }
  }
  return std::move(trials_);
}

}  // namespace

std::vector<GroupLikeness> MeasureSweepLikeness(Evaluator& evaluator, int threads) {
  const experiment::Experiment& experiment = evaluator.experiment();
  const bool is_planar = !experiment.gap.IsInSpace();  // weave and steering are
  if (!is_planar || !IsGridOverRepeatedLogs(experiment)) return {};
  Gathering gathering(evaluator);
  for (const experiment::Theta& theta : experiment::GridPoints(experiment.space.parameters)) {
    gathering.Add(theta);
  }
  const std::vector<Labelled> trials = gathering.Drive(threads);
  std::vector<std::string> levels;
  for (const Labelled& trial : trials) {
    if (std::find(levels.begin(), levels.end(), trial.level) == levels.end()) {
      levels.push_back(trial.level);
    }
  }
  levels.push_back("all");
  const bool is_matched = experiment.start == experiment::Start::kReference;
  std::vector<GroupLikeness> rows;
  for (const std::string& level : levels) {
    const bool is_all = &level == &levels.back();
    std::vector<RepeatedTrial> group;
    for (const Labelled& trial : trials) {
      if (is_all || trial.level == level) group.push_back(trial.trial);
    }
    std::mt19937_64 generator(experiment.seed);
    rows.push_back({level, MeasureDriveLikeness(group, is_matched, experiment.gap,
                                                experiment.likeness, generator)});
  }
  return rows;
}

}  // namespace rift::sweep
