#include "rift/sessions/gap/measure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <random>
#include <stdexcept>
#include <utility>

#include "rift/files/files.hpp"
#include "rift/gap/doubts.hpp"
#include "rift/sweep/falsify/recorded_logs.hpp"
#include "rift/trajectory/log.hpp"

namespace rift::sessions {
namespace {

using trajectory::Format;
using Say = std::function<void(const std::string&)>;

/// What was mended, and why there may be no yaw errors.
void SayNotes(const trajectory::Log& log, const std::string& path, const std::string& flag,
              const Say& say) {
  for (const std::string& note : log.notes) say(fmt::format("note: {}: {}", path, note));
  for (const std::string& doubt : log.doubts) {
    say(fmt::format("warning: {}: {}", path, doubt));
  }
  if (log.line_without_yaw) {
    say(fmt::format("note: {}:{}: has no yaw: yaw errors are told where it is logged", path,
                    *log.line_without_yaw));
  }
  if (log.unknown_angles.empty()) return;
  say(fmt::format("note: {}: yaw errors are left out: {}: set {}", path, log.unknown_angles, flag));
}

/// Of a robot that stood nothing is left to compare.
void RefuseStanding(const trajectory::Trajectory& log, const std::string& path,
                    const gap::GapOptions& options) {
  if (!options.trim_standstill || !gap::IsStanding(log, options)) return;
  throw std::invalid_argument(fmt::format(
      "{}: never leaves --standstill-radius, {:g} m, so that all of it is standstill: leave "
      "--trim-standstill out, or name a smaller radius",
      path, options.standstill_radius_m));
}

bool IsNamed(const std::string& path, std::initializer_list<std::string_view> words) {
  const std::string name = std::filesystem::path(path).filename().string();
  return std::any_of(words.begin(), words.end(),
                     [&](std::string_view word) { return name.find(word) != name.npos; });
}
bool IsNamedSimulated(const std::string& path) {
  return IsNamed(path, {"sim", "webots", "gazebo", "mujoco"});
}
bool IsNamedReal(const std::string& path) {
  return IsNamed(path, {"real", "robot", "tracker", "mocap"});
}

/// The true path of a simulated run is held against its log on purpose.
void SayIfSwapped(const GapJob& job, const gap::GapResult& result, const Say& say) {
  const std::string& real = job.reals.front();
  const bool by_name = IsNamedReal(job.sim) && !IsNamedSimulated(job.sim) &&
                       IsNamedSimulated(real) && !IsNamedReal(real);
  const bool by_format =
      job.sides.sim_format == Format::kTracker || job.sides.real_format == Format::kWebots;
  const bool by_noise =
      !IsNamed(real, {"truth"}) && gap::LookSwapped(result.sim, result.reals.front());
  if (!by_name && !by_format && !by_noise) return;
  say(fmt::format(
      "warning: {} and {}: by their {} the two are swapped: the simulator's log comes first",
      job.sim, real,
      by_name     ? "names"
      : by_format ? "formats"
                  : "noise"));
}

void SayCopies(const gap::GapResult& result, const Say& say) {
  const std::vector<std::optional<size_t>> copy_of = gap::CopiesAmong(result.reals);
  for (size_t i = 0; i < copy_of.size(); ++i) {
    if (!copy_of[i]) continue;
    say(fmt::format("warning: {} has the positions of {}: they count as one repeat",
                    result.trials[i].path, result.trials[*copy_of[i]].path));
  }
}

void SayDoubts(const gap::GapResult& result, const Say& say) {
  for (size_t i = 0; i < result.reals.size(); ++i) {
    for (const std::string& doubt : gap::Doubts(result.sim, result.reals[i], result.options)) {
      const double threshold_m = result.options.threshold_m;
      const bool is_above = result.trials[i].comparison.gap_m > threshold_m;
      say(fmt::format("warning: SIM {} and REAL {}{}: {}", result.sim_path, result.trials[i].path,
                      is_above ? fmt::format(", whose gap is above {:g} m", threshold_m) : "",
                      doubt));
    }
  }
}

/// A simulator without chance repeats itself, and its spread is none: that counts as it is.
void SayCopiesOfRuns(const GapJob& job, const gap::GapResult& result,
                     const std::vector<trajectory::Trajectory>& sims, const Say& say) {
  std::vector<std::string> paths{result.sim_path};
  paths.insert(paths.end(), job.sim_repeats.begin(), job.sim_repeats.end());
  const std::vector<std::optional<size_t>> copy_of = gap::CopiesAmong(sims);
  for (size_t i = 0; i < sims.size(); ++i) {
    if (copy_of[i]) {
      say(
          fmt::format("warning: {} has the positions of {}: a file that was copied, or a simulator "
                      "without chance",
                      paths[i], paths[*copy_of[i]]));
    }
    for (size_t k = 0; i > 0 && k < result.reals.size(); ++k) {  // SIM itself is doubted already
      if (!gap::CopiesAmong(std::array{result.reals[k], sims[i]})[1]) continue;
      say(fmt::format("warning: --sim-repeats {} has the positions of REAL {}: no simulated run",
                      paths[i], result.trials[k].path));
    }
  }
}

/// Every simulated run is held against every real one that is no copy: nothing says that they
/// belong together.
gap::Likeness MeasureRepeats(const GapJob& job, const gap::GapResult& result, const Say& say) {
  gap::RepeatedSetting setting{.reals = gap::Distinct(result.reals), .sims = {{result.sim}}};
  for (const std::string& path : job.sim_repeats) {
    trajectory::Log sim = trajectory::ReadLog(files::ReadFile(path), path, job.SimLogs());
    SayNotes(sim, path, "--sim-format", say);
    RefuseStanding(sim.trajectory, path, job.options);
    setting.sims.front().push_back(std::move(sim.trajectory));
  }
  SayCopiesOfRuns(job, result, setting.sims.front(), say);
  std::mt19937_64 generator(job.seed);
  return gap::MeasureLikeness({&setting, 1}, job.options, job.likeness, generator);
}

/// What holds for both sides is not meant for the one that has a format. `side`: `--sim` or
/// `--real`.
trajectory::ReadOptions LogsOf(const LogSides& sides, Format format, const std::string& own_columns,
                               const std::string& own_units, const std::string& side,
                               bool in_space) {
  const bool is_dialect = format != Format::kAuto;
  const auto either = [&](const std::string& own, const std::string& both) {
    return own.empty() && !is_dialect ? both : own;
  };
  const bool is_of_both = own_columns.empty() && own_units.empty() && !is_dialect &&
                          !(sides.columns.empty() && sides.units.empty());
  return {format,
          either(own_columns, sides.columns),
          either(own_units, sides.units),
          is_of_both ? "--columns " : side + "-columns ",
          in_space,
          side + "-columns "};
}

/// What is said of both sides is to hold for one of them at least.
void RefuseUnused(const LogSides& sides) {
  const auto refuse = [&](const std::string& kind, const std::string& both, const std::string& sim,
                          const std::string& real) {
    const bool is_of_sim = sim.empty() && sides.sim_format == Format::kAuto;
    const bool is_of_real = real.empty() && sides.real_format == Format::kAuto;
    if (both.empty() || is_of_sim || is_of_real) return;
    throw std::invalid_argument(fmt::format(
        "--{0} '{1}' is of each side without a format or {0} of its own, and both have one: leave "
        "it out",
        kind, both));
  };
  refuse("columns", sides.columns, sides.sim_columns, sides.real_columns);
  refuse("units", sides.units, sides.sim_units, sides.real_units);
}

/// What is measured in the plane alone.
void CheckDimension(const GapJob& job) {
  job.options.Check();
  if (!job.options.IsInSpace()) return;
  if (job.tag_offset_m != 0.0) {
    throw std::invalid_argument(fmt::format(
        "--tag-offset is {:g}, which moves a path along its yaw in the plane, and --dimension is "
        "xyz: log the point that is to be compared, and leave --tag-offset out",
        job.tag_offset_m));
  }
  if (!job.sim_repeats.empty()) {
    throw std::invalid_argument(
        "--sim-repeats measures likeness, which is of paths in the plane, and --dimension is xyz: "
        "leave one of them out");
  }
}

}  // namespace

trajectory::ReadOptions LogSides::Sim(bool in_space) const {
  return LogsOf(*this, sim_format, sim_columns, sim_units, "--sim", in_space);
}

trajectory::ReadOptions LogSides::Real(bool in_space) const {
  return LogsOf(*this, real_format, real_columns, real_units, "--real", in_space);
}

void GapJob::Check() const {
  CheckDimension(*this);
  RefuseTwins(reals);
  trajectory::CheckColumns(SimLogs());
  trajectory::CheckColumns(RealLogs());
  RefuseUnused(sides);
  std::vector<std::string> sims = sim_repeats;
  sims.insert(sims.begin(), sim);
  RefuseTwins(sims);
}

void RefuseTwins(const std::vector<std::string>& logs) {
  for (auto log = logs.begin(); log != logs.end(); ++log) {
    const auto twin = std::find_if(
        logs.begin(), log, [&](const auto& other) { return files::IsSameFile(*log, other); });
    if (twin == log) continue;
    throw std::invalid_argument(fmt::format(
        "{} and {} are one log, and each repeat is a run of its own: name it once", *twin, *log));
  }
}

gap::GapResult MeasureGap(const GapJob& job, const Say& say) {
  gap::GapResult result{.options = job.options,
                        .tag_offset_m = job.tag_offset_m,
                        .sim_path = job.sim,
                        .judged_by = job.verdict};
  trajectory::Log sim = trajectory::ReadLog(files::ReadFile(job.sim), job.sim, job.SimLogs());
  SayNotes(sim, job.sim, "--sim-format", say);
  RefuseStanding(sim.trajectory, job.sim, job.options);
  result.sim = std::move(sim.trajectory);
  const sweep::LogOptions real_logs{job.RealLogs(), job.tag_offset_m, "--real-format"};
  for (const std::string& path : job.reals) {
    trajectory::Log real = sweep::ReadMovedLog(files::ReadFile(path), path, real_logs);
    SayNotes(real, path, "--real-format", say);
    RefuseStanding(real.trajectory, path, job.options);
    result.trials.push_back({path, gap::Compare(result.sim, real.trajectory, job.options)});
    result.reals.push_back(std::move(real.trajectory));
  }
  Judge(result);
  SayIfSwapped(job, result, say);
  SayCopies(result, say);
  SayDoubts(result, say);
  if (!job.sim_repeats.empty()) result.likeness = MeasureRepeats(job, result, say);
  return result;
}

}  // namespace rift::sessions
