#include "rift/statistics/sequential.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

namespace rift::statistics {
namespace {

struct Alternative {
  double odds;    ///< over the odds of the bound
  double weight;  ///< they sum to 1
};

constexpr std::array<Alternative, 5> kAlternatives{
    {{2.0, 0.375}, {3.5, 0.25}, {7.0, 0.125}, {20.0, 0.125}, {100.0, 0.125}}};

/// Of a share r times the odds of the bound b the likelihood ratio is r^k / (1 + (r - 1) b)^n.
double EvidenceAbove(int successes, int trials, double bound) {
  std::array<double, kAlternatives.size()> logs{};
  for (size_t i = 0; i < logs.size(); ++i) {
    const auto [odds, weight] = kAlternatives[i];
    logs[i] =
        std::log(weight) + successes * std::log(odds) - trials * std::log1p((odds - 1.0) * bound);
  }
  const double largest = *std::max_element(logs.begin(), logs.end());
  double sum = 0.0;
  for (const double log : logs) sum += std::exp(log - largest);
  return largest + std::log(sum);
}

/// The largest bound that the evidence excludes; it falls with the bound.
double LowerEnd(int successes, int trials, double needed) {
  if (successes == 0) return 0.0;
  double low = 0.0, high = 1.0;
  while (high - low > 1e-12) {
    const double middle = 0.5 * (low + high);
    (EvidenceAbove(successes, trials, middle) >= needed ? low : high) = middle;
  }
  return low;
}

}  // namespace

ShareEvidence EvidenceOnShare(int successes, int trials, double bound) {
  if (successes < 0 || successes > trials) {
    throw std::invalid_argument("a share: successes must lie between 0 and the trials");
  }
  if (!(bound > 0.0 && bound < 1.0)) {
    throw std::invalid_argument("a share: the bound must lie between 0 and 1");
  }
  return {EvidenceAbove(successes, trials, bound),
          EvidenceAbove(trials - successes, trials, 1.0 - bound)};
}

Interval AnytimeInterval(int successes, int trials, double confidence) {
  if (successes < 0 || successes > trials) {
    throw std::invalid_argument("a share: successes must lie between 0 and the trials");
  }
  if (!(confidence > 0.0 && confidence < 1.0)) {
    throw std::invalid_argument("a share: the confidence must lie between 0 and 1");
  }
  const double needed = NeededEvidence(1, 1, 1.0 - confidence);
  return {LowerEnd(successes, trials, needed), 1.0 - LowerEnd(trials - successes, trials, needed)};
}

double NeededEvidence(int hypotheses, int discoveries, double alpha) {
  return std::log(hypotheses / (alpha * discoveries));
}

int CountDiscoveries(std::vector<double> evidence, int hypotheses, double alpha) {
  std::sort(evidence.begin(), evidence.end(), std::greater<>());
  for (int k = static_cast<int>(evidence.size()); k > 0; --k) {
    if (evidence[k - 1] >= NeededEvidence(hypotheses, k, alpha)) return k;
  }
  return 0;
}

}  // namespace rift::statistics
