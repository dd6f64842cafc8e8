#pragma once

#include <optional>
#include <string>

#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/run/slurm_shards.hpp"

namespace rift::report {

/// How far the trials of a sweep are.
struct ProgressCounts {
  int most = 0;              ///< settings of a search, else trials
  bool is_settings = false;  ///< a search or a repeated grid
  int steps = 0;             ///< of `most`
  int done = 0;              ///< trials
  int from_journal = 0;
  int falsified = 0;
  int failed = 0;  ///< without a gap
  std::optional<double> largest_gap_m;
  double trials_per_s = 0.0;
  std::optional<double> left_s;
};

/// Texts for people are parts of a line, documents in JSON are one line each.
std::string ProgressBar(const ProgressCounts& counts);
std::string ProgressText(const ProgressCounts& counts);
std::string ProgressJson(const std::string& state, const ProgressCounts& counts);

/// The same before the first trial, of the runs that settings are held against.
std::string ReferencesText(const sweep::ReferenceProgress& references);
std::string ReferencesJson(const sweep::ReferenceProgress& references);

/// The same of shards on a cluster.
std::string ShardsText(const sweep::ShardCounts& shards);
std::string ShardsJson(const sweep::ShardCounts& shards);

}  // namespace rift::report
