#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "rift/gap/result.hpp"
#include "rift/trajectory/read_options.hpp"

namespace rift::sessions {

/// How the logs are written, as a person says it of both sides and of each.
struct LogSides {
  trajectory::Format sim_format = trajectory::Format::kAuto;
  trajectory::Format real_format = trajectory::Format::kAuto;
  /// See trajectory::ReadOptions; those of both sides hold for each that has no format.
  std::string columns, units;
  std::string sim_columns, sim_units, real_columns, real_units;

  /// How the logs of a side are read.
  trajectory::ReadOptions Sim(bool in_space) const;
  trajectory::ReadOptions Real(bool in_space) const;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    constexpr auto kColumns = "t=NAME,x=NAME,y=NAME,yaw=NAME:deg";
    constexpr auto kUnits = "mm,ms,deg";
    field("sim_format", self.sim_format, "dialect of SIM");
    field("real_format", self.real_format, "dialect of REAL");
    field("columns", self.columns, kColumns,
          "which columns of the logs hold what (docs/logs.md), for each side without a format");
    field("units", self.units, kUnits, "the units of such logs, where they are not m, s and rad");
    field("sim_columns", self.sim_columns, kColumns, "the same for SIM alone");
    field("sim_units", self.sim_units, kUnits, "the same for SIM alone");
    field("real_columns", self.real_columns, kColumns, "the same for REAL alone");
    field("real_units", self.real_units, kUnits, "the same for REAL alone");
  }
};

/// Logs of a simulator and of its robot that are to be held together.
struct GapJob {
  std::string sim;
  std::vector<std::string> reals;        ///< one a repeat
  std::vector<std::string> sim_repeats;  ///< further runs of the simulator, for the likeness
  LogSides sides;
  double tag_offset_m = 0.0;  ///< the real paths are moved so far forward along their yaw
  gap::GapOptions options;
  gap::VerdictOptions verdict;
  gap::LikenessOptions likeness;
  std::uint64_t seed = 1;  ///< of the likeness

  /// Throws std::invalid_argument, before a log is read, for what cannot be measured in space, a
  /// log that is named twice, and columns or units that break a rule or hold for neither side.
  void Check() const;
  trajectory::ReadOptions SimLogs() const { return sides.Sim(options.IsInSpace()); }
  trajectory::ReadOptions RealLogs() const { return sides.Real(options.IsInSpace()); }

  /// Calls field for everything but the logs: (key, member, min, max, help) for numbers, (key,
  /// member, help) for choices, (key, member, what the value is called, help) for words.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    gap::GapOptions::Fields(self.options, field);
    gap::VerdictOptions::Fields(self.verdict, field);
    field("tag_offset_m", self.tag_offset_m, -1.0, 1.0,
          "moves the real path forward along its yaw, from the tag to the point that the simulator "
          "logs, its axle (paper: 0.03)");
    LogSides::Fields(self.sides, field);
    field("sim_repeats", self.sim_repeats, "SIM...",
          "further runs of the simulator: adds how like the robot they are");
  }
};

/// Throws std::invalid_argument when a log is named twice: it would pass for a repeat.
void RefuseTwins(const std::vector<std::string>& logs);

/// Reads and compares the logs. Tells `say` what was mended in them, what makes them doubtful and
/// when the two sides look swapped, one line each. Throws std::invalid_argument for logs that break
/// a rule.
gap::GapResult MeasureGap(const GapJob& job, const std::function<void(const std::string&)>& say);

}  // namespace rift::sessions
