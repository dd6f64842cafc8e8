#include "rift/sweep/explain/clusters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "rift/statistics/sample.hpp"

namespace rift::sweep {
namespace {

using Features = Eigen::VectorXd;

/// Errors along the path side by side, in metres: failures are alike when the robot goes astray in
/// the same direction at the same place by as much.
Features FeaturesOf(const TrialRow& row) {
  const std::vector<Eigen::Vector2d>& errors_m = row.evidence.errors_m;
  Features features(2 * static_cast<Eigen::Index>(errors_m.size()));
  for (size_t i = 0; i < errors_m.size(); ++i) features.segment<2>(2 * i) = errors_m[i];
  return features;
}

size_t Nearest(const std::vector<Features>& centres, const Features& point) {
  size_t nearest = 0;
  for (size_t i = 1; i < centres.size(); ++i) {
    if ((centres[i] - point).squaredNorm() < (centres[nearest] - point).squaredNorm()) nearest = i;
  }
  return nearest;
}

/// The mean first, then always the point farthest from all centres so far: no chance involved.
std::vector<Features> FarthestFirst(const std::vector<Features>& points, int k) {
  Features mean = Features::Zero(points.front().size());
  for (const Features& point : points) mean += point / static_cast<double>(points.size());
  std::vector<Features> centres{mean};
  while (static_cast<int>(centres.size()) < k + 1) {
    const auto distance = [&](const Features& point) {
      double least = std::numeric_limits<double>::infinity();
      const size_t from = centres.size() > 1 ? 1 : 0;
      for (size_t i = from; i < centres.size(); ++i) {
        least = std::min(least, (centres[i] - point).squaredNorm());
      }
      return least;
    };
    centres.push_back(
        *std::max_element(points.begin(), points.end(),
                          [&](const auto& a, const auto& b) { return distance(a) < distance(b); }));
  }
  centres.erase(centres.begin());
  return centres;
}

/// Lloyd's k-means; a centre that nothing belongs to stays where it is.
std::vector<Features> Centres(const std::vector<Features>& points, int k) {
  constexpr int kMostRounds = 50;
  std::vector<Features> centres = FarthestFirst(points, k);
  for (int round = 0; round < kMostRounds; ++round) {
    std::vector<Features> sums(k, Features::Zero(points.front().size()));
    std::vector<double> counts(k, 0.0);
    for (const Features& point : points) {
      const size_t nearest = Nearest(centres, point);
      sums[nearest] += point;
      counts[nearest] += 1.0;
    }
    double moved = 0.0;
    for (int i = 0; i < k; ++i) {
      if (counts[i] == 0.0) continue;
      moved = std::max(moved, (centres[i] - sums[i] / counts[i]).norm());
      centres[i] = sums[i] / counts[i];
    }
    if (moved < 1e-9) break;
  }
  return centres;
}

/// Mean over the points of (b - a) / max(a, b): a, the mean distance to its own cluster; b, to the
/// next one. A point alone counts 0.
double Silhouette(const std::vector<Features>& points, const std::vector<Features>& centres) {
  const size_t k = centres.size();
  std::vector<size_t> cluster;
  std::vector<double> sizes(k, 0.0);
  for (const Features& point : points) {
    cluster.push_back(Nearest(centres, point));
    sizes[cluster.back()] += 1.0;
  }
  double sum = 0.0;
  for (size_t i = 0; i < points.size(); ++i) {
    if (sizes[cluster[i]] < 2.0) continue;
    std::vector<double> distance(k, 0.0);
    for (size_t j = 0; j < points.size(); ++j) {
      distance[cluster[j]] += (points[i] - points[j]).norm();
    }
    const double own = distance[cluster[i]] / (sizes[cluster[i]] - 1.0);
    double next = std::numeric_limits<double>::infinity();
    for (size_t c = 0; c < k; ++c) {
      if (c != cluster[i] && sizes[c] > 0.0) next = std::min(next, distance[c] / sizes[c]);
    }
    const double larger = std::max(own, next);
    if (std::isfinite(next) && larger > 0.0) sum += (next - own) / larger;
  }
  return sum / static_cast<double>(points.size());
}

std::vector<Features> BestCentres(const std::vector<Features>& points,
                                  const ClusterOptions& options) {
  std::vector<Features> some;
  const auto most_compared = static_cast<size_t>(options.most_compared);
  for (const size_t i : statistics::SampleInOrder(points.size(), most_compared)) {
    some.push_back(points[i]);
  }
  std::vector<Features> best = Centres(some, 1);
  double best_silhouette = options.least_silhouette;
  const int most = std::min(options.most_clusters, static_cast<int>(some.size()) - 1);
  for (int k = 2; k <= most; ++k) {
    std::vector<Features> centres = Centres(some, k);
    const double silhouette = Silhouette(some, centres);
    if (silhouette <= best_silhouette) continue;
    best_silhouette = silhouette;
    best = std::move(centres);
  }
  return best;
}

/// The values that stand out among these rows: in most of them, and more often than in the table.
std::string WhereOf(const SweepResult& result, const std::vector<int>& rows) {
  constexpr double kMostly = 0.6, kLift = 1.25;
  std::string text;
  for (size_t p = 0; p < result.parameters.size(); ++p) {
    if (!HasLevels(result.parameters[p])) continue;  // repeats of a draw would share its value
    std::map<experiment::ParameterValue, int> here, everywhere;
    for (const int row : rows) ++here[result.rows[row].theta[p]];
    for (const TrialRow& row : result.rows) ++everywhere[row.theta[p]];
    for (const auto& [level, n] : here) {
      const double share = static_cast<double>(n) / static_cast<double>(rows.size());
      const double usual =
          static_cast<double>(everywhere[level]) / static_cast<double>(result.rows.size());
      if (share < kMostly || share < kLift * usual) continue;
      text += fmt::format("{}{} {} ({} of {})", text.empty() ? "" : ", ",
                          result.parameters[p].Name(), level.text, n, rows.size());
    }
  }
  return text.empty() ? "at no particular value of a parameter" : "mostly at " + text;
}

void Describe(const SweepResult& result, FailureCluster& cluster) {
  const double n = static_cast<double>(cluster.rows.size());
  const std::string where = WhereOf(result, cluster.rows);
  if (cluster.status != TrialStatus::kOk) {
    cluster.sentence =
        fmt::format("{} ended as '{}', {}", cluster.rows.size(),
                    EnumNames(cluster.status)[static_cast<int>(cluster.status)], where);
    return;
  }
  cluster.mean_gap_m = cluster.mean_u = 0.0;
  for (const int row : cluster.rows) {
    const TrialRow& trial = result.rows[row];
    cluster.mean_gap_m += trial.comparison.gap_m / n;
    cluster.mean_u += trial.comparison.gap_u / n;
    if (!trial.evidence.errors_m.empty()) cluster.end_error_m += trial.evidence.errors_m.back() / n;
  }
  cluster.sentence = fmt::format(
      "{} with a mean gap of {:.3f} m at u = {:.2f}; at the end the reference lies {:+.3f} m in x "
      "and {:+.3f} m in y from the candidate; {}",
      cluster.rows.size(), cluster.mean_gap_m, cluster.mean_u, cluster.end_error_m.x(),
      cluster.end_error_m.y(), where);
}

std::vector<FailureCluster> ByPath(const SweepResult& result, const ClusterOptions& options) {
  std::vector<int> rows;
  std::vector<Features> points;
  for (size_t i = 0; i < result.rows.size(); ++i) {
    const TrialRow& row = result.rows[i];
    if (!row.IsOk() || !row.falsified || row.evidence.errors_m.empty()) continue;
    rows.push_back(static_cast<int>(i));
    points.push_back(FeaturesOf(row));
  }
  if (rows.empty()) return {};
  const std::vector<Features> centres = BestCentres(points, options);
  std::vector<std::vector<std::pair<double, int>>> members(centres.size());
  for (size_t i = 0; i < points.size(); ++i) {
    const size_t nearest = Nearest(centres, points[i]);
    members[nearest].emplace_back((points[i] - centres[nearest]).squaredNorm(), rows[i]);
  }
  std::vector<FailureCluster> clusters;
  for (auto& some : members) {
    if (some.empty()) continue;
    std::sort(some.begin(), some.end());
    FailureCluster cluster;
    for (const auto& [distance, row] : some) cluster.rows.push_back(row);
    clusters.push_back(std::move(cluster));
  }
  return clusters;
}

std::vector<FailureCluster> ByStatus(const SweepResult& result) {
  std::map<TrialStatus, FailureCluster> by_status;
  for (size_t i = 0; i < result.rows.size(); ++i) {
    const TrialStatus status = result.rows[i].status;
    if (status == TrialStatus::kOk || !result.rows[i].falsified) continue;
    by_status[status].status = status;
    by_status[status].rows.push_back(static_cast<int>(i));
  }
  std::vector<FailureCluster> clusters;
  for (auto& [status, cluster] : by_status) clusters.push_back(std::move(cluster));
  return clusters;
}

}  // namespace

std::vector<FailureCluster> ClusterFailures(const SweepResult& result,
                                            const ClusterOptions& options) {
  std::vector<FailureCluster> clusters = ByPath(result, options);
  for (FailureCluster& cluster : ByStatus(result)) clusters.push_back(std::move(cluster));
  std::stable_sort(clusters.begin(), clusters.end(),
                   [](const auto& a, const auto& b) { return a.rows.size() > b.rows.size(); });
  for (FailureCluster& cluster : clusters) Describe(result, cluster);
  return clusters;
}

}  // namespace rift::sweep
