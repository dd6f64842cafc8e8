#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rift/experiment/parameter.hpp"
#include "rift/gap/comparison.hpp"
#include "rift/gap/options.hpp"
#include "rift/gap/result.hpp"
#include "rift/sweep/falsify/evidence.hpp"

namespace rift::sweep {

/// How a trial ended; every one that was asked for is a row.
enum class TrialStatus {
  kOk,
  kMissing,     ///< a log is not there
  kUnreadable,  ///< a log is there and breaks a rule
  kTimedOut,    ///< the simulated robot did not reach the end in time
  kFell,
  kLeftArena,
  kLost,         ///< motion capture saw it no more
  kFault,        ///< the simulation itself could not go on
  kInvalid,      ///< the setting breaks a rule of the experiment
  kNan,          ///< the simulation gave numbers that are none
  kHung,         ///< its process did not end in time
  kCrashed,      ///< its process died
  kOutOfMemory,  ///< its process wanted more than it may have
};

constexpr std::array<std::string_view, 13> EnumNames(TrialStatus) {
  return {"ok",    "missing", "unreadable", "timed_out", "fell",    "left_arena",   "lost",
          "fault", "invalid", "nan",        "hung",      "crashed", "out_of_memory"};
}

enum class DoubtAbout { kCandidate, kReference, kPair };
constexpr std::array<std::string_view, 3> EnumNames(DoubtAbout) {
  return {"candidate", "reference", "pair"};
}

/// Why a trial may tell nothing though it has a gap: a trajectory was probably read in a wrong way.
struct TrialDoubt {
  DoubtAbout about = DoubtAbout::kPair;
  std::string text;  ///< one line; of a pair the two are called SIM and REAL
};

/// One candidate trajectory against one reference trajectory.
struct TrialRow {
  experiment::Theta theta;            ///< one value for each parameter, in their order
  std::string trial;                  ///< which repeat of the reference
  std::optional<std::uint64_t> seed;  ///< of a simulated candidate
  TrialStatus status = TrialStatus::kOk;
  std::string reason;     ///< one line; empty when ok
  std::string candidate;  ///< file of the candidate trajectory
  std::string reference;
  gap::Comparison comparison;  ///< all NaN unless ok
  /// gap::WayGap_m; NaN where the task has no goal, or stopping short of it counts as any error.
  double way_gap_m = gap::kNotComputed;
  bool falsified = false;  ///< CountedGap_m() > threshold, or an end that counts as a failure
  /// Along the path from where a run that did not arrive ended to the last waypoint.
  double left_m = gap::kNotComputed;
  TrialEvidence evidence;
  std::vector<TrialDoubt> doubts;  ///< none unless ok
  /// Theta was drawn independently of all other rows, evenly over the space. Only such rows tell
  /// how often it fails; a grid and a search go where they like.
  bool is_random_draw = false;

  bool IsOk() const { return status == TrialStatus::kOk; }
  /// It fails or it does not; a missing log or a crash tells neither.
  bool Tells() const { return IsOk() || falsified; }
  /// What is held against the threshold: how short of the goal a run may stop is a tolerance of
  /// the task and no failure of a simulator.
  double CountedGap_m() const { return std::fmin(comparison.gap_m, way_gap_m); }
};

/// What a trial costs: its counted gap; of a failure without a gap the threshold and how far the
/// robot still had to go, so that one that never starts is worse than one that stops just before
/// the end. NaN of a trial that does not tell.
double Loss_m(const TrialRow& row, double threshold_m);

/// All repeats of one setting.
struct SettingResult {
  experiment::Theta theta;
  std::vector<int> rows;  ///< indices into SweepResult::rows
  double mean_gap_m = gap::kNotComputed;
  double mean_loss_m = gap::kNotComputed;  ///< of the distinct trials that tell
  statistics::Interval loss_m{gap::kNotComputed, gap::kNotComputed};  ///< 95 % for it (Student)
  gap::RepeatVerdict verdict;
  double noise_floor_m = gap::kNotComputed;  ///< mean gap between its real trials; NaN below two
};

/// The rows that share one value of a parameter (or of a combination of parameters).
struct LevelSummary {
  std::string level;  ///< "ground", "0.15"; "[0.15, 0.30]" for a combination
  int n = 0;          ///< trials with a gap
  int failures = 0;   ///< trials that fail, some of them without a gap
  int told = 0;       ///< trials that fail or do not
  int not_ok = 0;     ///< trials without a gap
  double mean_gap_m = gap::kNotComputed;
  double sd_gap_m = gap::kNotComputed;  ///< NaN below two
};

/// One-way analysis of variance of the loss over the values of one parameter, as in the paper: for
/// the record. What is said of a parameter comes from sweep/explain (Effects).
struct Anova {
  std::string parameter;  ///< its name
  std::vector<LevelSummary> levels;
  double f = gap::kNotComputed;  ///< NaN where the data do not allow one
  double df_between = 0.0;
  double df_within = 0.0;
  double p = gap::kNotComputed;
  double eta_squared = gap::kNotComputed;    ///< share of the variance it explains
  double omega_squared = gap::kNotComputed;  ///< the same, less what chance would explain
};

/// How a search for failures ended.
struct Falsification {
  std::string strategy;
  gap::Verdict verdict = gap::Verdict::kNotSeenToFail;  ///< of the whole search
  int evaluations = 0;                                  ///< settings tried
  int budget = 0;
  std::optional<int> first_evaluation;  ///< the first falsified setting, counted from 1
  std::optional<int> worst_setting;     ///< index into settings: the falsified one, else the worst
  std::string ended;                    ///< why: "the first falsified setting", "the budget"
};

/// A reference seed at which the nominal run failed, and the one that took its place.
struct ReplacedReference {
  std::uint64_t seed = 0;
  std::uint64_t used = 0;
  std::string reason;
};

/// A doubt that trials share, whatever its numbers.
struct SweepDoubt {
  TrialDoubt first;  ///< as the first of them has it
  int trials = 0;
  int row = 0;  ///< of the first
};

/// Everything a sweep found out.
struct SweepResult {
  std::string name;            ///< of the experiment
  std::string candidate_kind;  ///< "logs", "simulation"
  std::string reference_kind;  ///< "logs", "nominal", "path"
  gap::GapOptions gap;
  gap::VerdictOptions judged_by;
  int judged_settings = 0;           ///< settings that are judged together; 0: those there are
  bool chance_repeats_runs = false;  ///< see ChanceAmongRuns
  double tag_offset_m = 0.0;         ///< how far ahead of the tag the reference logs were taken
  std::vector<experiment::Parameter> parameters;
  std::vector<TrialRow> rows;
  std::vector<SettingResult> settings;
  std::vector<Anova> anova;  ///< one for each parameter with a list of several values
  LevelSummary all;
  std::optional<Falsification> falsification;  ///< of a search
  std::vector<ReplacedReference> replaced;     ///< of nominal references
  std::vector<SweepDoubt> doubts;              ///< see DoubtsOf

  int Count(gap::Verdict verdict) const;  ///< settings
};

/// The two sides of figures 7, 8, 10 and 13: the first categorical parameter (else the first)
/// and the combination of all others.
struct FactorSplit {
  int main_factor = 0;
  std::vector<int> others;  ///< indices of the other parameters; empty for one axis
  std::string others_name;  ///< "[v_min, v_max]"
};

/// Throws std::invalid_argument for a space without parameters.
FactorSplit SplitFactors(const std::vector<experiment::Parameter>& parameters);

/// Of a range: more whole numbers are told as a continuous range is.
inline constexpr int kMostWholeLevels = 12;

/// A list, or a range of few whole numbers: settings share its values, each of which can be told.
bool HasLevels(const experiment::Parameter& parameter);

/// "63", and near 0 and 100 with two digits or more, since rare is not never: "0.33", "99.67".
std::string PercentDigits(double share);
/// The same with its unit: "63 %".
std::string PercentText(double share);

/// The value for people: one drawn from a range has 17 digits, which nobody reads; table.csv has
/// them.
std::string ShortText(const experiment::Parameter& parameter,
                      const experiment::ParameterValue& value);

/// "surface parchment, v_min 0.15", by the parameters' last names and for people as well.
std::string SettingText(const std::vector<experiment::Parameter>& parameters,
                        const experiment::Theta& theta);

/// "0.15" for one parameter, "[0.15, 0.30]" for several, of which those with a comma or a quote are
/// quoted as in CSV: two combinations have two labels.
std::string CombinationLabel(const experiment::Theta& theta, const std::vector<int>& parameters);

/// The value of the main factor; empty in a space without parameters.
std::string MainLevel(const std::vector<experiment::Parameter>& parameters,
                      const experiment::Theta& theta);

/// Rows grouped by the combination of the named parameters' values, in the order of first rows.
std::vector<LevelSummary> SummariseBy(const SweepResult& result,
                                      const std::vector<int>& parameters);

/// Fills in everything of a result that follows from its parameters and rows: the settings with
/// their verdicts, the analyses of variance and the summary of all rows. Settings stand in
/// the order of their first rows; their noise floor is left alone, and so is chance that repeats
/// runs, once it was seen: a part of a sweep keeps it from the whole.
void Summarise(SweepResult& result);

/// Error rate of the F test that SmallestDetectable plans for.
inline constexpr double kSignificance = 0.05;

/// The worst setting first: by the share of its trials that fail, of those that tell, and among
/// equal shares by the mean loss. One of which no trial tells stands below those that fail and
/// above those that do not.
std::vector<const SettingResult*> WorstSettings(const SweepResult& result);

/// Index of the row with the largest gap; empty when no trial has one.
std::optional<int> WorstRow(const SweepResult& result);

}  // namespace rift::sweep
