#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace rift::sweep {

/// What a journal tells about a sweep while it runs or afterwards.
struct JournalSummary {
  std::map<std::string, std::string> notes;
  std::map<std::string, int> trials_by_status;
  int falsified = 0;
  int damaged = 0;  ///< trials that do not fit their hash and are counted nowhere else
  std::optional<double> largest_gap_m;
  std::string largest_key;  ///< of the trial with that gap
};

/// Reads without writing. Throws std::invalid_argument when there is no journal, and
/// std::runtime_error as Journal does.
JournalSummary ReadJournal(const std::filesystem::path& file);

}  // namespace rift::sweep
