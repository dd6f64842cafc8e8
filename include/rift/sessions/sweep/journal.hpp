#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "rift/experiment/experiment.hpp"
#include "rift/sweep/run/journal.hpp"
#include "rift/sweep/run/journal_summary.hpp"
#include "rift/sweep/run/slurm_shards.hpp"

namespace rift::sessions {

/// In the folder of a sweep.
inline constexpr const char* kJournalName = "journal.sqlite";

/// Whether trials are computed, and kept in a journal. Logs held against logs or a path are read
/// anew each time.
bool IsComputed(const experiment::Experiment& experiment);

/// What the rows of an experiment's journal are made from.
sweep::Facts FactsOf(const experiment::Experiment& experiment);

/// How far the sweep in a folder is.
struct SweepStatus {
  sweep::JournalSummary summary;
  std::string state;  ///< running, stopped (or killed), done
  std::optional<sweep::ShardCounts> shards;
};

/// Throws std::invalid_argument when there is no journal of a sweep.
SweepStatus ReadStatus(const std::filesystem::path& folder);

}  // namespace rift::sessions
