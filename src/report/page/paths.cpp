#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "parts.hpp"
#include "rift/report/figures/setting_grid.hpp"
#include "rift/statistics/descriptive.hpp"
#include "rift/statistics/sample.hpp"
#include "rift/sweep/falsify/evidence.hpp"

namespace rift::report {
namespace {

using nlohmann::json;
using Path = std::vector<Eigen::Vector2f>;

constexpr float kUnit_m = 0.0002F;      ///< of the whole numbers that paths are written in
constexpr float kUnit_s = 0.001F;       ///< and their times
constexpr std::size_t kMostLines = 30;  ///< drawn behind the band of a view
constexpr std::size_t kLeastBand = 8;   ///< paths that a band takes
constexpr std::size_t kMostReferences = 9;
constexpr double kBandShare = 0.05;  ///< of the paths left out on either side

/// First point, then steps: "[-1411,-327,55,-3,...]".
json Steps(const Path& path_m) {
  json steps = json::array();
  long last_x = 0, last_y = 0;
  for (const Eigen::Vector2f& point_m : path_m) {
    const long x = std::lround(point_m.x() / kUnit_m), y = std::lround(point_m.y() / kUnit_m);
    steps.push_back(x - last_x);
    steps.push_back(y - last_y);
    last_x = x;
    last_y = y;
  }
  return steps;
}

/// The steps alone, from a first time of 0. Empty where a time is not known.
json TimeSteps(const std::vector<float>& times_s) {
  json steps = json::array();
  if (times_s.empty() || !std::isfinite(times_s.back())) return steps;
  long last = 0;
  for (std::size_t i = 1; i < times_s.size(); ++i) {
    const long now = std::lround(times_s[i] / kUnit_s);
    steps.push_back(now - last);
    last = now;
  }
  return steps;
}

Path MeanOf(const std::vector<const Path*>& paths) {
  Path mean(paths.front()->size(), Eigen::Vector2f::Zero());
  for (const Path* path : paths) {
    for (std::size_t i = 0; i < mean.size(); ++i) {
      mean[i] += (*path)[i] / static_cast<float>(paths.size());
    }
  }
  return mean;
}

/// The middle nine tenths of the paths sideways to the axis at equal u, as a polygon: up one side
/// and down the other.
Path BandAround(const Path& axis_m, const std::vector<const Path*>& paths) {
  Path left, right;
  const std::size_t last = axis_m.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    const Eigen::Vector2f along = axis_m[std::min(i + 1, last)] - axis_m[i == 0 ? 0 : i - 1];
    const float length_m = along.norm();
    if (!(length_m > 0.0F)) continue;
    const Eigen::Vector2f across(-along.y() / length_m, along.x() / length_m);
    std::vector<double> offsets_m;
    for (const Path* path : paths) offsets_m.push_back(across.dot((*path)[i] - axis_m[i]));
    const auto at = [&](double share) {
      return axis_m[i] + static_cast<float>(statistics::Quantile(offsets_m, share)) * across;
    };
    left.push_back(at(1.0 - kBandShare));
    right.push_back(at(kBandShare));
  }
  left.insert(left.end(), right.rbegin(), right.rend());
  return left;
}

class PathMaker {
 public:
  PathMaker(const sweep::SweepResult& result, const PageEvidence& evidence)
      : result_(result), evidence_(evidence), worst_(sweep::WorstRow(result)) {}

  const Path& PathOf(int row) const {
    const Path& kept = result_.rows[row].evidence.path_m;
    return kept.empty() && row == worst_ ? evidence_.worst_path_m : kept;
  }

  json ViewPaths(const PageView& view) {
    std::vector<int> drawable;
    std::vector<const Path*> arrived;
    for (const int row : view.rows) {
      if (PathOf(row).empty()) continue;
      drawable.push_back(row);
      if (result_.rows[row].IsOk()) arrived.push_back(&PathOf(row));
    }
    json paths = {{"references", References(view)}, {"lines", json::array()}};
    for (const std::size_t i : statistics::SampleInOrder(drawable.size(), kMostLines)) {
      paths["lines"].push_back(Show(drawable[i]));
    }
    paths["drawn_of"] = drawable.size();
    if (const std::optional<int> worst = WorstRow(*view.part)) {
      const int row = view.rows[*worst];
      if (!PathOf(row).empty()) paths["worst"] = Show(row);
    }
    if (arrived.size() >= kLeastBand && !axis_.empty()) {
      paths["band"] = Steps(BandAround(axis_, arrived));
      paths["band_of"] = arrived.size();
    }
    return paths;
  }

  /// The number of the row in table.csv; its path is written.
  int Show(int row) {
    shown_.insert(row);
    return row + 1;
  }

  json Rows() const {
    json rows = json::object();
    for (const int index : shown_) {
      const sweep::TrialRow& row = result_.rows[index];
      if (PathOf(index).empty()) continue;
      const std::string end =
          row.IsOk() ? fmt::format("gap {:.4f} m", row.comparison.gap_m)
                     : fmt::format("did not arrive ({})",
                                   EnumNames(row.status)[static_cast<int>(row.status)]);
      rows[std::to_string(index + 1)] = {
          {"d", Steps(PathOf(index))},
          {"t", TimeSteps(row.evidence.path_times_s)},
          {"fails", row.falsified},
          {"reference", ReferenceOf(index)},
          {"u", Value(row.IsOk() ? std::round(1e4 * row.comparison.gap_u) / 1e4 : NAN)},
          {"text",
           fmt::format("{}, trial {}: {}", SettingLabel(result_, row.theta), row.trial, end)}};
    }
    return rows;
  }

 private:
  int ReferenceOf(int row) const {
    const std::vector<int>& of_row = evidence_.reference_of_row;
    return row < static_cast<int>(of_row.size()) ? of_row[row] : -1;
  }

  /// Indices of the references that the view's trials are held against; sets the axis of a band.
  /// Where only one is at hand it stands for all.
  json References(const PageView& view) {
    std::set<int> used;
    for (const int row : view.rows) {
      if (ReferenceOf(row) >= 0) used.insert(ReferenceOf(row));
    }
    if (used.empty() && evidence_.references.size() == 1) used.insert(0);
    std::vector<const Path*> paths;
    json shown = json::array();
    for (const int index : used) {
      paths.push_back(&evidence_.references[index].path_m);
      if (shown.size() < kMostReferences) shown.push_back(index);
    }
    axis_ = paths.empty() ? Path{} : MeanOf(paths);
    return shown;
  }

  const sweep::SweepResult& result_;
  const PageEvidence& evidence_;
  std::optional<int> worst_;
  Path axis_;
  std::set<int> shown_;
};

}  // namespace

nlohmann::json PagePaths(const sweep::SweepResult& result, const PageEvidence& evidence,
                         const std::vector<PageView>& views, const ReportOptions& options) {
  PathMaker maker(result, evidence);
  json paths = {{"unit_m", Value(0.0002)}, {"unit_s", Value(0.001)}, {"views", json::array()}};
  for (const PageView& view : views) paths["views"].push_back(maker.ViewPaths(view));
  for (const sweep::TrialRow* row : RowsToShow(result, options.table_rows)) {
    maker.Show(static_cast<int>(row - result.rows.data()));
  }
  paths["rows"] = maker.Rows();
  paths["references"] = json::array();
  for (const ReferencePath& reference : evidence.references) {
    paths["references"].push_back({{"name", reference.name},
                                   {"d", Steps(reference.path_m)},
                                   {"t", TimeSteps(reference.times_s)}});
  }
  paths["waypoints"] = json::array();
  for (const PagePoint& point : evidence.waypoints) {
    paths["waypoints"].push_back(
        {{"name", point.name}, {"x", point.p_in_world_m.x()}, {"y", point.p_in_world_m.y()}});
  }
  paths["threshold_m"] = result.gap.threshold_m;
  return paths;
}

}  // namespace rift::report
