#include "rift/report/figures/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "rift/sweep/falsify/result.hpp"
#include "sweep_plots.hpp"

namespace rift::report {
namespace {

constexpr int kMostSeries = 12;

/// Of a figure's file name; with what is before and behind it below the 255 of file systems.
constexpr std::size_t kMostFilePartBytes = 80;

// Parameter names become parts of file names.
std::string FilePart(const std::string& name) {
  std::string part;
  for (const char c : name) {
    const bool word = std::isalnum(static_cast<unsigned char>(c)) || c == '-';
    if (word) part += c;
    if (!word && !part.empty() && part.back() != '_') part += '_';
  }
  part.resize(std::min(part.size(), kMostFilePartBytes));
  while (!part.empty() && part.back() == '_') part.pop_back();
  return part.empty() ? "parameter" : part;
}

std::string WhyNoGrid(const sweep::SweepResult& result) {
  for (const experiment::Parameter& parameter : result.parameters) {
    if (sweep::HasLevels(parameter)) continue;
    if (!parameter.is_integer) {
      return fmt::format("{} is continuous, so no two settings share a value of it",
                         parameter.Name());
    }
    return fmt::format("{} has more than {} whole numbers: see the figure over it",
                       parameter.Name(), sweep::kMostWholeLevels);
  }
  return "";
}

class FigureMaker {
 public:
  FigureMaker(const sweep::SweepResult& result, const ReportOptions& options)
      : result_(result), options_(options), grid_(LayOut(result)) {
    split_ = sweep::SplitFactors(result.parameters);
    no_grid_ = WhyNoGrid(result);
    main_is_range_ = !sweep::HasLevels(result.parameters[split_.main_factor]);
  }

  void BySetting() {
    const std::string name = "fig07_gap_by_setting";
    const int bars = grid_.CellCount(), series = static_cast<int>(grid_.others.size());
    if (!no_grid_.empty()) return Omit(name, no_grid_);
    if (grid_.others_name.empty()) return Omit(name, "one parameter only: figure 11 shows it");
    if (series > kMostSeries || bars > options_.max_bars) {
      return Omit(name, fmt::format("{} bars in {} colours cannot be told apart: see figure 10",
                                    bars, series));
    }
    Keep(GapBySettingFigure(result_, grid_, options_));
  }

  void ByTrial() { Keep(GapByTrialFigure(result_, options_)); }

  void AlongPath(const std::optional<ComparedPair>& worst) {
    if (!worst)
      return Omit("fig09_error_along_path", "the paths of the worst trial are not at hand");
    Keep(ErrorFigure({*worst}, result_.gap, options_));
  }

  void HeatMap() {
    const std::string name = "fig10_gap_heat_map";
    if (!no_grid_.empty()) return Omit(name, no_grid_);
    if (grid_.others_name.empty()) return Omit(name, "one parameter only: figure 11 shows it");
    if (grid_.CellCount() > options_.max_cells) {
      return Omit(name, fmt::format("{} cells are too many to read", grid_.CellCount()));
    }
    Keep(HeatMapFigure(result_, grid_, options_));
  }

  void ByMainFactor() {
    const std::string mean = "fig11_gap_by_" + FilePart(grid_.main_name);
    const std::string failures = "fig12_failures_by_" + FilePart(grid_.main_name);
    const std::string reason = WhyNoBars(grid_.mains, main_is_range_);
    if (!reason.empty()) {
      Omit(mean, reason);
      return Omit(failures, reason);
    }
    Keep(MeanByLevelFigure(mean, grid_.main_name, grid_.mains, result_.gap.threshold_m, options_));
    Keep(FailuresByLevelFigure(failures, grid_.main_name, grid_.mains, options_));
  }

  void ByOtherFactors() {
    const bool is_nameable =
        !grid_.others_name.empty() && grid_.others_name.size() <= kMostFilePartBytes;
    const std::string name =
        "fig13_failures_by_" + (is_nameable ? FilePart(grid_.others_name) : "other_parameters");
    if (grid_.others_name.empty()) return Omit(name, "there is one parameter only");
    const std::string reason = WhyNoBars(grid_.others, !no_grid_.empty());
    if (!reason.empty()) return Omit(name, reason);
    Keep(FailuresByLevelFigure(name, grid_.others_name, grid_.others, options_));
  }

  void OverContinuousAxes() {
    for (std::size_t i = 0; i < result_.parameters.size(); ++i) {
      const experiment::Parameter& parameter = result_.parameters[i];
      if (!parameter.IsContinuous()) continue;
      Keep(GapOverParameterFigure("gap_over_" + FilePart(parameter.Name()), result_,
                                  static_cast<int>(i), options_));
    }
  }

  SweepFigureSet Take() { return std::move(set_); }

 private:
  /// Names of parameters that differ in other letters alone make one name of a file: the next of
  /// them are numbered.
  void Keep(Figure figure) {
    const std::string name = figure.name;
    for (int n = 2; !names_.insert(figure.name).second; ++n) {
      figure.name = fmt::format("{}_{}", name, n);
    }
    set_.figures.push_back(std::move(figure));
  }
  void Omit(const std::string& name, const std::string& reason) {
    set_.omitted.push_back({name, reason});
  }
  std::string WhyNoBars(const std::vector<sweep::LevelSummary>& levels, bool is_range) const {
    if (is_range) return no_grid_;
    if (static_cast<int>(levels.size()) <= options_.max_bars) return "";
    return fmt::format("{} bars are too many to read", levels.size());
  }

  const sweep::SweepResult& result_;
  const ReportOptions& options_;
  SettingGrid grid_;
  sweep::FactorSplit split_;
  std::string no_grid_;
  bool main_is_range_ = false;
  SweepFigureSet set_;
  std::set<std::string> names_;  ///< of the figures kept
};

SweepFigureSet NothingToDraw(const std::string& reason) {
  SweepFigureSet set;
  for (const char* name :
       {"fig07_gap_by_setting", "fig08_gap_by_trial", "fig09_error_along_path",
        "fig10_gap_heat_map", "fig11_mean_gap", "fig12_failures", "fig13_failures"}) {
    set.omitted.push_back({name, reason});
  }
  return set;
}

}  // namespace

SweepFigureSet SweepFigures(const sweep::SweepResult& result,
                            const std::optional<ComparedPair>& worst,
                            const ReportOptions& options) {
  if (!WorstRow(result)) return NothingToDraw("no trial has a gap");
  if (result.parameters.empty()) return NothingToDraw("the sweep has no parameters");
  FigureMaker maker(result, options);
  maker.BySetting();
  maker.ByTrial();
  maker.AlongPath(worst);
  maker.HeatMap();
  maker.ByMainFactor();
  maker.ByOtherFactors();
  maker.OverContinuousAxes();
  return maker.Take();
}

}  // namespace rift::report
