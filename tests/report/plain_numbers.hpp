#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "uneven_sweep.hpp"

/// Numbers about the rows of a sweep by plain loops, without a function of rift: what its documents
/// and its page are held against.
namespace rift::report::plain {

using nlohmann::json;
using Rows = std::vector<const sweep::TrialRow*>;
using Numbers = std::vector<double>;

/// Uneven, and a run that came out twice: it counts once where runs are counted as evidence.
inline sweep::SweepResult WithOneRunTwice() {
  sweep::SweepResult result = synthetic::Uneven();
  Numbers floors_m;
  for (const auto& setting : result.settings) floors_m.push_back(setting.noise_floor_m);
  sweep::TrialRow again = result.rows[16];
  again.trial = "9";
  result.rows.insert(result.rows.begin() + 17, again);
  sweep::Summarise(result);
  for (size_t i = 0; i < floors_m.size(); ++i) result.settings[i].noise_floor_m = floors_m[i];
  return result;
}

template <class Number>
double Real(Number n) {
  return static_cast<double>(n);
}

inline double MeanOf(const Numbers& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? NAN : sum / Real(values.size());
}

inline double SquaresOf(const Numbers& values) {
  double sum = 0.0;
  for (const double value : values) sum += std::pow(value - MeanOf(values), 2);
  return sum;
}

inline double SdOf(const Numbers& values) {
  return values.size() < 2 ? NAN : std::sqrt(SquaresOf(values) / (Real(values.size()) - 1.0));
}

/// Half of the 95 % interval of Student for a mean.
inline double HalfWidth(const Numbers& values) {
  static const std::map<size_t, double> kQuantile{{2, 12.706204736174698}, {3, 4.302652729749462},
                                                  {4, 3.182446305283708},  {5, 2.776445105197793},
                                                  {11, 2.228138851964938}, {12, 2.200985160091639}};
  const auto quantile = kQuantile.find(values.size());
  if (quantile == kQuantile.end()) return NAN;
  return quantile->second * SdOf(values) / std::sqrt(Real(values.size()));
}

inline bool IsOk(const sweep::TrialRow& row) { return row.status == sweep::TrialStatus::kOk; }

inline double LossOf(const sweep::TrialRow& row, double threshold_m) {
  if (IsOk(row)) return std::min(row.comparison.gap_m, row.way_gap_m);
  return row.falsified ? threshold_m + row.left_m : NAN;
}

inline Numbers GapsOf(const Rows& rows) {
  Numbers gaps_m;
  for (const auto* row : rows) {
    if (IsOk(*row)) gaps_m.push_back(row->comparison.gap_m);
  }
  return gaps_m;
}

/// Each path once.
inline Rows Distinct(const Rows& rows) {
  Rows distinct;
  std::set<std::uint64_t> paths;
  for (const auto* row : rows) {
    if (paths.insert(row->evidence.fingerprint).second) distinct.push_back(row);
  }
  return distinct;
}

inline Numbers LossesOf(const Rows& rows, double threshold_m) {
  Numbers losses_m;
  for (const auto* row : Distinct(rows)) {
    const double loss_m = LossOf(*row, threshold_m);
    if (!std::isnan(loss_m)) losses_m.push_back(loss_m);
  }
  return losses_m;
}

inline int CountFailing(const Rows& rows) {
  int n = 0;
  for (const auto* row : rows) n += row->falsified ? 1 : 0;
  return n;
}

inline int CountTold(const Rows& rows) {
  int n = 0;
  for (const auto* row : rows) n += row->falsified || IsOk(*row) ? 1 : 0;
  return n;
}

inline Rows All(const sweep::SweepResult& result) {
  Rows rows;
  for (const auto& row : result.rows) rows.push_back(&row);
  return rows;
}

/// By the texts of these parameters, in the order of their first rows.
inline std::vector<std::pair<std::string, Rows>> Grouped(const sweep::SweepResult& result,
                                                         const std::vector<size_t>& parameters) {
  std::vector<std::pair<std::string, Rows>> groups;
  for (const auto& row : result.rows) {
    std::string label;
    for (const size_t i : parameters) label += (label.empty() ? "" : ", ") + row.theta[i].text;
    if (parameters.size() > 1) label = "[" + label + "]";
    auto group = std::find_if(groups.begin(), groups.end(),
                              [&](const auto& one) { return one.first == label; });
    if (group == groups.end()) group = groups.insert(groups.end(), {label, {}});
    group->second.push_back(&row);
  }
  return groups;
}

/// null stands for what cannot be computed.
inline bool IsNumber(const json& found, double expected) {
  if (std::isnan(expected)) return found.is_null();
  return found.is_number() && found.get<double>() == Approx(expected).epsilon(1e-9).margin(1e-12);
}

#define CHECK_NUMBER(found, expected)                                         \
  do {                                                                        \
    INFO(#found << " is " << (found).dump() << ", not " << double(expected)); \
    CHECK(IsNumber(found, expected));                                         \
  } while (false)

}  // namespace rift::report::plain
