#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

#include "rift/report/figures/options.hpp"
#include "rift/sweep/explain/explanation.hpp"
#include "rift/sweep/explain/program_cells.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::report {

/// The report of a sweep as one HTML page that needs nothing else: no network, no second file.
/// First screen: one sentence, the paths, where it fails, and why, how sure, what next. Then the
/// details in the order of these questions, tables that sort, and the figures. A filter (a value of
/// a parameter, or a setting) that sentence, pictures, charts and tables follow.
std::string RenderPage(const sweep::SweepResult& result, const ReportOptions& options = {});

/// A path that candidates are drawn against, as sweep::EvenPath gives it.
struct ReferencePath {
  std::string name;  ///< "robot, trial 2"
  std::vector<Eigen::Vector2f> path_m;
  std::vector<float> times_s = {};  ///< sweep::EvenTimes_s; empty: not at hand
};

struct PagePoint {
  std::string name;
  Eigen::Vector2d p_in_world_m;
};

/// One of the figure files.
struct PageFigure {
  std::string title;
  std::string svg;
};

/// What the page shows and the result does not hold.
struct PageEvidence {
  std::vector<ReferencePath> references;      ///< each once
  std::vector<int> reference_of_row;          ///< index into them; -1, or too short: not at hand
  std::vector<Eigen::Vector2f> worst_path_m;  ///< of WorstRow, where its row has none
  std::vector<PagePoint> waypoints;
  std::vector<PageFigure> figures;
  /// Of `rift gap`, behind the two logs of a row, so that it comes out as in the table; where the
  /// candidates are simulated, `rift simulate --replay` drives a row again.
  std::string gap_flags;
  std::vector<sweep::ProgramCell> programs;  ///< of a grid over a program
  /// Of a sweep that still runs: "340 of 960 trials"; the page asks for itself again.
  std::string running;
};

/// The same with an explanation at hand.
std::string RenderPage(const sweep::SweepResult& result, const sweep::Explanation& explanation,
                       const PageEvidence& evidence, const ReportOptions& options = {});

}  // namespace rift::report
