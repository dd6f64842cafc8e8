#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "rift/gap/result.hpp"
#include "rift/trajectory/read_options.hpp"

namespace rift::sessions {

/// Logs of a simulator and of its robot that are to be held together.
struct GapJob {
  std::string sim;
  std::vector<std::string> reals;        ///< one a repeat
  std::vector<std::string> sim_repeats;  ///< further runs of the simulator, for the likeness
  trajectory::ReadOptions sim_logs, real_logs;
  double tag_offset_m = 0.0;  ///< the real paths are moved so far forward along their yaw
  gap::GapOptions options;
  gap::VerdictOptions verdict;
  gap::LikenessOptions likeness;
  std::uint64_t seed = 1;  ///< of the likeness
};

/// Throws std::invalid_argument when a log is named twice: it would pass for a repeat.
void RefuseTwins(const std::vector<std::string>& logs);

/// Reads and compares the logs. Tells `say` what was mended in them, what makes them doubtful and
/// when the two sides look swapped, one line each. Throws std::invalid_argument for logs that break
/// a rule.
gap::GapResult MeasureGap(const GapJob& job, const std::function<void(const std::string&)>& say);

}  // namespace rift::sessions
