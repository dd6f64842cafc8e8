#pragma once

#include <array>
#include <compare>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rift::experiment {

/// A value of a parameter, as the experiment writes it. Ordered by its text, so that values and
/// settings are keys of maps and sets.
struct ParameterValue {
  std::string text;              ///< canonical: "ground", "0.15"
  std::optional<double> number;  ///< set when it is one

  friend auto operator<=>(const ParameterValue&,
                          const ParameterValue&) = default;  // NOLINT(modernize-use-nullptr)
};

/// The same number, however it is written ("0.3", "0.30"), or the same word.
bool SameValue(const ParameterValue& a, const ParameterValue& b);

/// One setting: a value for each parameter of the space, in their order.
using Theta = std::vector<ParameterValue>;

/// An axis of the parameter space.
struct Parameter {
  std::string key;                     ///< as the experiment names it, "control.v_min"
  std::vector<ParameterValue> levels;  ///< of a grid axis; empty for a continuous one
  double min = 0.0;                    ///< of a continuous axis
  double max = 0.0;
  bool is_integer = false;      ///< of a range: whole numbers only
  bool is_logarithmic = false;  ///< of a range: even in the logarithm
  /// Whether a person can set it on the robot, and in which steps, where the space says so; else
  /// the schema does (settable.hpp).
  std::optional<bool> settable{};
  std::optional<double> step{};
  /// Of a program's parameter, which is no key of the experiment: its value at rest.
  std::optional<double> nominal{};
  std::string origin{};  ///< where it was written, for messages: "file:line:column"

  /// The last part of the key: the column in table.csv and the name in path templates.
  std::string Name() const;
  bool IsContinuous() const { return levels.empty(); }
  /// True for a grid axis of which some level is not a number.
  bool IsCategorical() const;
};

/// A number as a value; its text is yaml::NumberText, the shortest that reads back the same.
/// Throws std::invalid_argument unless it is finite.
ParameterValue NumberValue(double number);

/// A value of the parameter as a table or an experiment writes it: the level of that text, else a
/// number where the text is one and the parameter has no words, else a word.
ParameterValue ParseValue(const Parameter& parameter, const std::string& text);

/// The axes of the parameter space: `space: {control.v_min: [0.15, 0.20]}`.
struct Space {
  std::vector<Parameter> parameters;
};

/// The grid of the paper (section 5.1), for an experiment that names no space.
Space PaperSpace();

/// Throws std::invalid_argument for a continuous axis, and for more settings than a grid may have.
void CheckGrid(const std::vector<Parameter>& parameters);

/// Full factorial over the levels, the first parameter changing slowest. One empty setting for no
/// parameters. Throws what CheckGrid does.
std::vector<Theta> GridPoints(const std::vector<Parameter>& parameters);

/// Columns of table.csv behind those of the parameters; a parameter cannot be called so.
inline constexpr std::array<std::string_view, 20> kFixedColumns{
    "trial",       "gap_m",        "falsified",   "status",         "u",
    "exact_gap_m", "mean_error_m", "rms_error_m", "start_offset_m", "start_aligned_gap_m",
    "shape_gap_m", "length_ratio", "end_error_m", "way_gap_m",      "left_m",
    "reason",      "candidate",    "reference",   "seed",           "id"};

}  // namespace rift::experiment
