#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {

/// Looks for a simulator whose chance picks one of a few fixed runs. Repeats of a setting that are
/// the same to the last bit then tell nothing of chance: they may be draws that came out alike. It
/// is seen when a setting's repeats part, and one of their runs (path and how it ended) was driven
/// with another seed as well, there or at another setting. Noise that moves a path by however
/// little never drives one twice.
class ChanceAmongRuns {
 public:
  /// Trials of one setting, all that there are so far. Those without a seed or a path, or that do
  /// not tell, are passed over.
  void Note(const std::vector<const TrialRow*>& trials);
  bool IsSeen() const { return is_seen_; }

 private:
  using Run = std::pair<std::uint64_t, TrialStatus>;
  struct Use {
    std::uint64_t seed = 0;
    bool has_other_seed = false;
    bool is_of_parted = false;
  };
  std::map<Run, Use> uses_;
  bool is_seen_ = false;
};

}  // namespace rift::sweep
