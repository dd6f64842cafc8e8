#include "rift/sweep/calibrate/identification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <set>

#include "fitted_simulator.hpp"
#include "log_doubts.hpp"
#include "model.hpp"
#include "rift/experiment/parameter.hpp"
#include "rift/experiment/program_parameters.hpp"
#include "rift/statistics/random.hpp"
#include "rift/sweep/calibrate/short_horizon.hpp"
#include "rift/sweep/falsify/doubts.hpp"
#include "rift/sweep/falsify/result.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "rift/trajectory/frame_grid.hpp"

namespace rift::sweep {
namespace {

using trajectory::Trajectory;

constexpr int kRunsShown = 3;
// Runs that judge are none of those that were fitted with.
constexpr std::uint64_t kJudgeSeeds = 50'000;
constexpr std::uint64_t kSeedsOfStart = 100;  // the phases of a replay count up from there
constexpr std::uint64_t kStartStream = 80;
constexpr double kOffEnds = 0.1;  // of a range
constexpr size_t kMostShown = 4;  // parameters in a line of progress

/// A log with its setting; its place in the list gives its seeds.
struct Entry {
  experiment::Theta theta;
  CalibrationTrial trial;
  CalibrationLog log;
};

class Identifier {
 public:
  Identifier(Evaluator& evaluator, int jobs, const Say& say)
      : evaluator_(evaluator),
        experiment_(evaluator.experiment()),
        jobs_(jobs),
        say_(say),
        values_(StartValues()) {
    Load();
    if (IsProgram()) runs_ = std::make_unique<CandidateRuns>(evaluator, jobs);
  }

  CalibrationReport Run();

 private:
  bool IsProgram() const {
    return experiment_.candidate.kind == experiment::CandidateKind::kProgram;
  }
  std::vector<double> StartValues() const;
  void Load();
  void NoteDoubts(const Recording& real);
  void SayDoubtsOfLogs() const;
  bool IsHeldOut(const std::string& trial) const;
  std::optional<double> BeganOf(const Recording& real) const;
  std::vector<const Entry*> Side(bool held_out) const;
  SimulatedTrial TwinOf(const Entry& entry, const std::vector<double>& values,
                        std::uint64_t seed) const;
  TwinAt TwinsOf(const std::vector<const Entry*>& entries, std::uint64_t seed = 0) const;
  std::uint64_t SeedOf(const Entry& entry) const;
  TrialRequest RequestOf(const Entry& entry, std::uint64_t seed) const;
  std::vector<RepeatedTrial> DriveProgram(const std::vector<double>& values) const;
  std::string ProgressText(const CalibrationProgress& progress,
                           const std::vector<experiment::FreeParameter>& fitted) const;
  Calibration Fit(const std::vector<const Entry*>& fitted, int start) const;
  std::vector<RepeatedTrial> Drive(const std::vector<double>& values) const;
  void JudgePaths(CalibrationReport& report) const;
  void JudgeErrors(CalibrationReport& report) const;
  void Show(CalibrationReport& report, const std::vector<RepeatedTrial>& before,
            const std::vector<RepeatedTrial>& after) const;
  DriveLikeness LikenessOf(const std::vector<RepeatedTrial>& trials,
                           const std::vector<size_t>& chosen) const;

  Evaluator& evaluator_;
  const experiment::Experiment& experiment_;
  int jobs_;
  const Say& say_;
  std::vector<Entry> entries_;
  std::vector<std::string> missing_;
  std::vector<double> values_;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  std::set<std::string> doubted_;        ///< kinds of doubts about the logs
  std::unique_ptr<CandidateRuns> runs_;  ///< of a program
};

std::vector<double> Identifier::StartValues() const {
  std::vector<double> values;
  for (const experiment::FreeParameter& free : experiment_.calibrate.fit.list) {
    values.push_back(free.start);
  }
  return values;
}

bool Identifier::IsHeldOut(const std::string& trial) const {
  const std::vector<std::string>& held = experiment_.calibrate.holdout.names;
  return std::find(held.begin(), held.end(), trial) != held.end();
}

void Identifier::Load() {
  const std::vector<experiment::Parameter>& parameters = experiment_.space.parameters;
  for (const experiment::Theta& theta : experiment::GridPoints(parameters)) {
    for (const TrialRequest& request : TrialsAt(experiment_, theta)) {
      Recording real = evaluator_.Reference(request);
      if (real.status == TrialStatus::kOk && !real.trajectory.HasYaw() && !IsProgram()) {
        real.status = TrialStatus::kUnreadable;
        real.reason = "its yaw is needed: set reference.format";
      }
      if (real.status != TrialStatus::kOk) {
        missing_.push_back(fmt::format("{}: {}", real.source, real.reason));
        continue;
      }
      NoteDoubts(real);
      entries_.push_back({theta,
                          {.level = MainLevel(parameters, theta),
                           .trial = request.trial,
                           .source = real.source,
                           .is_held_out = IsHeldOut(request.trial)},
                          {.name = real.source,
                           .setting = SettingKey(parameters, theta),
                           .log = real.trajectory,
                           .group = MainLevel(parameters, theta),
                           .drives_grid_fps = experiment_.candidate.grid_fps,
                           .began_s = BeganOf(real)}});
    }
  }
  SayDoubtsOfLogs();
  if (Side(false).size() >= 2) return;
  throw std::invalid_argument(fmt::format("{}: a fit needs at least 2 logs, and there are {}{}",
                                          evaluator_.experiment_file(), Side(false).size(),
                                          missing_.empty() ? "" : "; " + missing_.front()));
}

/// A program of powers runs by the clock of its trial; a drive to waypoints by what it sees.
std::optional<double> Identifier::BeganOf(const Recording& real) const {
  if (experiment_.program.segments.empty()) return std::nullopt;
  const std::optional<double> began_s = evaluator_.TrialBegan_s(real.source);
  if (!began_s) return std::nullopt;
  const std::vector<trajectory::StampedPose>& poses = real.trajectory.poses;
  constexpr double kApart_s = 2.0;  // a robot is seen when its trial begins
  if (std::abs(*began_s - poses.front().t_s) <= kApart_s && *began_s < poses.back().t_s) {
    return began_s;
  }
  throw std::invalid_argument(
      fmt::format("{}: its first row is at {:g} s, and commands.csv beside it begins at {:g} s: "
                  "they are not of "
                  "one drive",
                  real.source, poses.front().t_s, *began_s));
}

/// Each kind once: a mistake in units is in every log.
void Identifier::NoteDoubts(const Recording& real) {
  for (const std::string& doubt : real.doubts) {
    const TrialDoubt one{DoubtAbout::kReference, doubt};
    if (doubted_.insert(KindOf(one)).second) {
      say_(fmt::format("warning: {}: {}", real.source, doubt));
    }
  }
}

/// How near a program comes to its waypoints is its own.
void Identifier::SayDoubtsOfLogs() const {
  std::vector<LogOfTask> logs;
  for (const Entry& entry : entries_) {
    LogOfTask& one = logs.emplace_back(LogOfTask{.source = entry.log.name, .log = &entry.log.log});
    one.group = entry.log.group;
    if (IsProgram()) continue;
    one.way_ratio = WayRatio(TwinOf(entry, StartValues(), 0), entry.log.log, entry.log.began_s);
    const experiment::Experiment at = experiment::ExperimentAt(experiment_, entry.theta);
    one.waypoints = at.waypoints;
    one.reach_radius_m = at.control.reach_radius_m;
  }
  for (const std::string& doubt : DoubtsOfLogs(logs)) say_("warning: " + doubt);
}

std::vector<const Entry*> Identifier::Side(bool held_out) const {
  std::vector<const Entry*> side;
  for (const Entry& entry : entries_) {
    if (entry.trial.is_held_out == held_out) side.push_back(&entry);
  }
  return side;
}

SimulatedTrial Identifier::TwinOf(const Entry& entry, const std::vector<double>& values,
                                  std::uint64_t seed) const {
  const experiment::Experiment at =
      experiment::ExperimentAt(experiment::CalibratedAt(experiment_, values), entry.theta);
  const geometry::Pose2 start = StartFromLog(entry.log.log, 0.0, at.simulation.mocap);
  return evaluator_.TrialOf(at, start, SeedOf(entry) + seed);
}

std::uint64_t Identifier::SeedOf(const Entry& entry) const {
  return experiment_.seed + static_cast<std::uint64_t>(&entry - entries_.data()) * kSeedsOfLog;
}

/// A run of the program in the place of a log, its fitted values to be added.
TrialRequest Identifier::RequestOf(const Entry& entry, std::uint64_t seed) const {
  return {.theta = entry.theta, .trial = entry.trial.trial, .seed = SeedOf(entry) + seed};
}

TwinAt Identifier::TwinsOf(const std::vector<const Entry*>& entries, std::uint64_t seed) const {
  return [this, entries, seed](size_t log, const std::vector<double>& values) {
    return TwinOf(*entries[log], values, seed);
  };
}

std::vector<CalibrationLog> LogsOf(const std::vector<const Entry*>& entries) {
  std::vector<CalibrationLog> logs;
  for (const Entry* entry : entries) logs.push_back(entry->log);
  return logs;
}

/// No simulated log makes a detour that the likeness would leave out.
std::vector<CalibrationLog> LogsToFit(const std::vector<const Entry*>& entries,
                                      double longest_run) {
  std::vector<CalibrationLog> logs = LogsOf(entries);
  const auto longest_m = LongestBySetting_m(logs, &CalibrationLog::log);
  for (CalibrationLog& log : logs) log.longest_m = longest_run * longest_m.at(log.setting);
  return logs;
}

std::vector<RepeatedTrial> Identifier::Drive(const std::vector<double>& values) const {
  if (IsProgram()) return DriveProgram(values);
  std::vector<RepeatedTrial> trials;
  for (const Entry& entry : entries_) {
    SimulatedTrial twin = TwinOf(entry, values, kJudgeSeeds);
    RepeatedTrial trial{.setting = entry.log.setting,
                        .real = entry.log.log,
                        .waypoints = twin.task.waypoints,
                        .control = twin.control};
    for (int run = 0; run < experiment_.calibrate.judge_runs; ++run, ++twin.seed) {
      SimulatedRun driven = Simulate(twin);
      if (driven.result.outcome == trial::Outcome::kReached) {
        trial.runs.push_back(trajectory::OnFramesOf(std::move(driven.result.trajectory),
                                                    experiment_.candidate.grid_fps));
      } else {
        ++trial.failed_runs;
      }
    }
    trials.push_back(std::move(trial));
  }
  return WithoutDetours(std::move(trials), experiment_.likeness.longest_run);
}

/// What tells a loop delay, the controller, is the program's own.
std::vector<RepeatedTrial> Identifier::DriveProgram(const std::vector<double>& values) const {
  const int judge_runs = experiment_.calibrate.judge_runs;
  std::vector<TrialRequest> requests;
  for (const Entry& entry : entries_) {
    for (int run = 0; run < judge_runs; ++run) {
      requests.push_back(RequestOf(entry, kJudgeSeeds + static_cast<std::uint64_t>(run)));
      requests.back().theta = experiment::WithFitted(entry.theta, values);
    }
  }
  std::vector<Recording> driven = runs_->Run(requests);
  std::vector<RepeatedTrial> trials;
  for (size_t i = 0; i < driven.size(); ++i) {
    const Entry& entry = entries_[i / static_cast<size_t>(judge_runs)];
    if (i % static_cast<size_t>(judge_runs) == 0) {
      trials.push_back({.setting = entry.log.setting, .real = entry.log.log});
    }
    if (driven[i].status == TrialStatus::kOk && HasPath(driven[i])) {
      trials.back().runs.push_back(std::move(driven[i].trajectory));
    } else {
      ++trials.back().failed_runs;
    }
  }
  return WithoutDetours(std::move(trials), experiment_.likeness.longest_run);
}

DriveLikeness Identifier::LikenessOf(const std::vector<RepeatedTrial>& trials,
                                     const std::vector<size_t>& chosen) const {
  std::vector<RepeatedTrial> group;
  for (const size_t i : chosen) {
    group.push_back(trials[i]);
    for (size_t k = 0; k < trials.size(); ++k) {
      const bool is_chosen = std::find(chosen.begin(), chosen.end(), k) != chosen.end();
      if (is_chosen || trials[k].setting != trials[i].setting) continue;
      group.back().other_reals.push_back(trials[k].real);
    }
  }
  std::mt19937_64 generator(experiment_.seed);
  return MeasureDriveLikeness(group, true, experiment_.gap, experiment_.likeness, generator);
}

void Identifier::JudgePaths(CalibrationReport& report) const {
  const std::vector<RepeatedTrial> before = Drive(StartValues()), after = Drive(report.values);
  const auto mean_path_gap_m = [this](const RepeatedTrial& trial) {
    return gap::MeanPathGap_m(trial.real, trial.runs, experiment_.gap, experiment_.likeness);
  };
  std::vector<std::string> levels;
  for (size_t i = 0; i < entries_.size(); ++i) {
    CalibrationTrial trial = entries_[i].trial;
    trial.gap_before_m = mean_path_gap_m(before[i]);
    trial.gap_after_m = mean_path_gap_m(after[i]);
    report.trials.push_back(trial);
    if (std::find(levels.begin(), levels.end(), trial.level) == levels.end()) {
      levels.push_back(trial.level);
    }
  }
  if (levels.size() > 1 || levels.front().empty()) levels.push_back("all");
  if (levels.front().empty()) levels.erase(levels.begin());
  for (const std::string& level : levels) {
    for (const char* side : {"fitted", "held out", "both"}) {
      std::vector<size_t> chosen;
      for (size_t i = 0; i < entries_.size(); ++i) {
        const bool is_side = side[0] == 'b' || entries_[i].trial.is_held_out == (side[0] == 'h');
        if (is_side && (level == "all" || entries_[i].trial.level == level)) chosen.push_back(i);
      }
      const bool is_double = side[0] == 'b' && experiment_.calibrate.holdout.names.empty();
      if (chosen.empty() || is_double) continue;
      report.judged.push_back({level, side, LikenessOf(before, chosen), LikenessOf(after, chosen)});
    }
  }
  Show(report, before, after);
}

void Identifier::Show(CalibrationReport& report, const std::vector<RepeatedTrial>& before,
                      const std::vector<RepeatedTrial>& after) const {
  const bool held_out = !Side(true).empty();
  std::vector<size_t> order;
  for (size_t i = 0; i < report.trials.size(); ++i) {
    const bool is_told = !std::isnan(report.trials[i].gap_after_m);
    if (report.trials[i].is_held_out == held_out && is_told) order.push_back(i);
  }
  if (order.empty()) return;
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return report.trials[a].gap_after_m < report.trials[b].gap_after_m;
  });
  report.shown = order[order.size() / 2];
  report.shown_real = entries_[report.shown].log.log;
  const auto first = [](const std::vector<Trajectory>& runs) {
    const size_t count = std::min<size_t>(kRunsShown, runs.size());
    return std::vector<Trajectory>(runs.begin(), runs.begin() + static_cast<std::ptrdiff_t>(count));
  };
  report.shown_before = first(before[report.shown].runs);
  report.shown_after = first(after[report.shown].runs);
}

void Identifier::JudgeErrors(CalibrationReport& report) const {
  if (IsProgram()) return;  // nobody can ask it for the next frames of a log
  for (const bool held_out : {false, true}) {
    const std::vector<const Entry*> side = Side(held_out);
    if (side.empty()) continue;
    const auto structure = [&](const std::vector<double>& values) {
      return StructureOfErrors(LogsOf(side), TwinsOf(side), values,
                               experiment_.calibrate.method.horizon);
    };
    report.errors.push_back(
        {held_out ? "held out" : "fitted", structure(StartValues()), structure(report.values)});
  }
}

/// "0:12 descent, step 2 of at most 40: delay_s 0.0812, mu 0.271".
std::string Identifier::ProgressText(const CalibrationProgress& progress,
                                     const std::vector<experiment::FreeParameter>& fitted) const {
  const auto elapsed = std::chrono::steady_clock::now() - began_;
  const auto whole_s = std::chrono::duration_cast<std::chrono::seconds>(elapsed).count();
  std::string text = fmt::format("{}:{:02} ", whole_s / 60, whole_s % 60);
  switch (progress.part) {
    case CalibrationProgress::Part::kMotions:
      text += fmt::format("descent by motions, step {} of at most", progress.step);
      break;
    case CalibrationProgress::Part::kDescent:
      text += fmt::format("descent, step {} of at most", progress.step);
      break;
    case CalibrationProgress::Part::kCorrection:
      text += fmt::format("correction by simulated logs {} of", progress.step);
      break;
    case CalibrationProgress::Part::kFeatures:
      text += fmt::format("features of whole drives, round {} of", progress.step);
      break;
  }
  text += fmt::format(" {}:", progress.most);
  for (size_t i = 0; i < std::min(fitted.size(), kMostShown); ++i) {
    const std::string& key = fitted[i].key;
    text += fmt::format("{} {} {:.4g}", i == 0 ? "" : ",", key.substr(key.rfind('.') + 1),
                        progress.values[i]);
  }
  return text + (fitted.size() > kMostShown ? ", ..." : "");
}

/// Start 0 is the experiment's; the others are drawn, off the ends of the ranges.
Calibration Identifier::Fit(const std::vector<const Entry*>& fitted, int start) const {
  std::vector<experiment::FreeParameter> parameters = experiment_.calibrate.fit.list;
  statistics::Random random(experiment_.seed, kStartStream + static_cast<std::uint64_t>(start));
  for (experiment::FreeParameter& p : parameters) {
    const double share = kOffEnds + (1.0 - 2.0 * kOffEnds) * random.Uniform();
    if (start > 0) p.start = p.min + share * (p.max - p.min);
  }
  std::mt19937_64 generator(experiment_.seed + static_cast<std::uint64_t>(start));
  const std::vector<CalibrationLog> logs = LogsToFit(fitted, experiment_.likeness.longest_run);
  const std::uint64_t seed = static_cast<std::uint64_t>(start) * kSeedsOfStart;
  const CalibrationOptions& method = experiment_.calibrate.method;
  const auto on_step = [&](const CalibrationProgress& progress) {
    say_(ProgressText(progress, parameters));
  };
  if (!IsProgram()) {
    std::vector<experiment::Theta> settings;
    for (const Entry& entry : entries_) {
      if (settings.empty() || settings.back() != entry.theta) settings.push_back(entry.theta);
    }
    const auto is_allowed = [&](const std::vector<double>& values) {
      return experiment::KeepsRules(experiment_, values, settings);
    };
    return Calibrate(parameters, logs, TwinsOf(fitted, seed), method, generator, jobs_, on_step,
                     is_allowed);
  }
  std::vector<TrialRequest> requests;
  for (const Entry* entry : fitted) requests.push_back(RequestOf(*entry, seed));
  ProgramTwins program(*runs_, std::move(requests), experiment_, evaluator_.experiment_file(),
                       say_);
  return Calibrate(parameters, logs, program, OfWholeRuns(method), generator, on_step);
}

CalibrationReport Identifier::Run() {
  const std::vector<const Entry*> fitted = Side(false);
  for (const std::string& why : missing_) say_("note: left out: " + why);
  say_(fmt::format("fitting {} parameters to {} logs; {} held out", values_.size(), fitted.size(),
                   entries_.size() - fitted.size()));
  if (IsProgram()) {
    say_(
        "note: a program is fitted and judged by whole runs: closeness, weave, spread and speed; "
        "next frames, loop delay and the structure of errors are of rift's own simulator");
  }
  CalibrationReport report;
  std::vector<Calibration> fits;
  for (int start = 0; start < experiment_.calibrate.starts; ++start) {
    if (start > 0) say_(fmt::format("start {} of {}", start + 1, experiment_.calibrate.starts));
    fits.push_back(Fit(fitted, start));
  }
  report.calibration = fits.front();
  report.agreement = AgreementOf(fits);
  for (const CalibratedParameter& parameter : report.calibration.parameters) {
    report.values.push_back(parameter.value);
  }
  report.missing = missing_;
  say_(fmt::format("judging with {} runs of each log", experiment_.calibrate.judge_runs));
  JudgePaths(report);
  JudgeErrors(report);
  return report;
}

}  // namespace

CalibrationReport Identify(Evaluator& evaluator, int jobs, const Say& say) {
  return Identifier(evaluator, jobs, say).Run();
}

}  // namespace rift::sweep
