#include "rift/statistics/rank_correlation.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "rift/statistics/descriptive.hpp"

namespace rift::statistics {
namespace {

std::vector<double> RanksOf(const std::vector<double>& values) {
  std::vector<size_t> order(values.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (size_t i = 0; i < order.size();) {
    size_t end = i;
    while (end < order.size() && values[order[end]] == values[order[i]]) ++end;
    for (size_t k = i; k < end; ++k) ranks[order[k]] = 0.5 * static_cast<double>(i + end - 1);
    i = end;
  }
  return ranks;
}

}  // namespace

double RankCorrelation(std::span<const double> a, std::span<const double> b) {
  assert(a.size() == b.size());
  std::vector<double> known_a, known_b;
  for (size_t i = 0; i < a.size(); ++i) {
    if (std::isnan(a[i]) || std::isnan(b[i])) continue;
    known_a.push_back(a[i]);
    known_b.push_back(b[i]);
  }
  const std::vector<double> ranks_a = RanksOf(known_a), ranks_b = RanksOf(known_b);
  const double mean = Mean(ranks_a);  // of both
  double ab = 0.0, aa = 0.0, bb = 0.0;
  for (size_t i = 0; i < ranks_a.size(); ++i) {
    const double da = ranks_a[i] - mean, db = ranks_b[i] - mean;
    ab += da * db, aa += da * da, bb += db * db;
  }
  const bool can_tell = ranks_a.size() >= 3 && aa > 0.0 && bb > 0.0;
  return can_tell ? ab / std::sqrt(aa * bb) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace rift::statistics
