#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rift/gap/comparison.hpp"
#include "rift/gap/options.hpp"
#include "rift/gap/verdict.hpp"
#include "rift/sweep/evidence.hpp"

namespace rift::sweep {

/// A value of a parameter, as the experiment writes it.
struct ParameterValue {
  std::string text;              ///< canonical: "ground", "0.15"
  std::optional<double> number;  ///< set when it is one

  friend bool operator==(const ParameterValue&, const ParameterValue&) = default;
};

/// An axis of the parameter space.
struct Parameter {
  std::string key;                     ///< as the experiment names it, "control.v_min"
  std::vector<ParameterValue> levels;  ///< of a grid axis; empty for a continuous one
  double min = 0.0;                    ///< of a continuous axis
  double max = 0.0;
  std::string origin{};  ///< where it was written, for messages: "file:line:column"

  /// The last part of the key: the column in table.csv and the name in path templates.
  std::string Name() const;
  bool IsContinuous() const { return levels.empty(); }
  /// True for a grid axis of which some level is not a number.
  bool IsCategorical() const;
};

/// Columns of table.csv behind those of the parameters; a parameter cannot be called so.
inline constexpr std::array<std::string_view, 16> kFixedColumns{
    "trial",       "gap_m",        "falsified",   "status",         "u",
    "exact_gap_m", "mean_error_m", "rms_error_m", "start_offset_m", "start_aligned_gap_m",
    "shape_gap_m", "length_ratio", "end_error_m", "reason",         "candidate",
    "reference"};

/// How a trial ended; every one that was asked for is a row.
enum class TrialStatus {
  kOk,
  kMissing,     ///< a log is not there
  kUnreadable,  ///< a log is there and breaks a rule
  kTimedOut,    ///< the simulated robot did not reach the end in time
  kFell,
  kLeftArena,
  kLost,   ///< motion capture saw it no more
  kFault,  ///< the simulation itself could not go on
};

constexpr std::array<std::string_view, 8> EnumNames(TrialStatus) {
  return {"ok", "missing", "unreadable", "timed_out", "fell", "left_arena", "lost", "fault"};
}

/// One candidate trajectory against one reference trajectory.
struct TrialRow {
  std::vector<ParameterValue> theta;  ///< one value for each parameter, in their order
  std::string trial;                  ///< which repeat of the reference
  TrialStatus status = TrialStatus::kOk;
  std::string reason;     ///< one line; empty when ok
  std::string candidate;  ///< file of the candidate trajectory
  std::string reference;
  gap::Comparison comparison;  ///< all NaN unless ok
  bool falsified = false;      ///< gap_m > threshold
  TrialEvidence evidence;
  /// Theta was drawn independently of all other rows, evenly over the space. Only such rows tell
  /// how often it fails; a grid and a search go where they like.
  bool is_random_draw = false;

  bool IsOk() const { return status == TrialStatus::kOk; }
};

/// All repeats of one setting.
struct SettingResult {
  std::vector<ParameterValue> theta;
  std::vector<int> rows;  ///< indices into SweepResult::rows
  double mean_gap_m = gap::kNotComputed;
  gap::RepeatVerdict verdict;
  double noise_floor_m = gap::kNotComputed;  ///< mean gap between its real trials; NaN below two
};

/// The rows that share one value of a parameter (or of a combination of parameters).
struct LevelSummary {
  std::string level;  ///< "ground", "0.15"; "[0.15, 0.30]" for a combination
  int n = 0;          ///< trials with a gap
  int failures = 0;   ///< of them, above the threshold
  int not_ok = 0;     ///< trials without a gap
  double mean_gap_m = gap::kNotComputed;
  double sd_gap_m = gap::kNotComputed;  ///< NaN below two
};

/// One-way analysis of variance of the gap over the values of one parameter.
struct Effect {
  std::string parameter;  ///< its name
  std::vector<LevelSummary> levels;
  double f = gap::kNotComputed;  ///< NaN where the data do not allow one
  double df_between = 0.0;
  double df_within = 0.0;
  double p = gap::kNotComputed;
  double eta_squared = gap::kNotComputed;    ///< share of the variance it explains
  double omega_squared = gap::kNotComputed;  ///< the same, less what chance would explain
  bool detected = false;                     ///< p < 0.05
  /// One sentence: "effect found (F = ..., p = ...)" or "no effect found (p = ...)".
  std::string sentence;
};

/// Everything a sweep found out.
struct SweepResult {
  std::string name;            ///< of the experiment
  std::string candidate_kind;  ///< "logs", "simulation"
  std::string reference_kind;  ///< "logs", "nominal", "path"
  gap::GapOptions gap;
  double tag_offset_m = 0.0;  ///< how far ahead of the tag the reference logs were taken
  std::vector<Parameter> parameters;
  std::vector<TrialRow> rows;
  std::vector<SettingResult> settings;
  std::vector<Effect> effects;  ///< one for each parameter with more than one value
  LevelSummary all;
};

}  // namespace rift::sweep
