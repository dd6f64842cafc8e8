#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "rift/sweep/result.hpp"

namespace rift::commands {

enum class ProgressStyle { kQuiet, kBar, kLines, kJson };

/// A bar for a terminal, lines for anything else.
ProgressStyle StyleFor(bool quiet, bool json);

/// How far a sweep is, on stderr: trials done and to be done, their rate, the time left, the
/// largest gap so far, failures.
class SweepProgress {
 public:
  /// `most` is how many trials there will be; with `is_limit` at most.
  SweepProgress(ProgressStyle style, int most, bool is_limit);
  /// Ends the line of a bar that an error cut short.
  ~SweepProgress();
  SweepProgress(const SweepProgress&) = delete;
  SweepProgress& operator=(const SweepProgress&) = delete;

  void Seen(const sweep::TrialRow& row, bool from_journal);
  /// Prints when it is time to; cheap otherwise.
  void Tick();
  /// The last word, with how it ended: "done", "stopped".
  void End(const std::string& state);

 private:
  using Clock = std::chrono::steady_clock;

  double Rate() const;
  std::optional<double> Left_s() const;
  std::string Text() const;
  void Print(const std::string& state);

  ProgressStyle style_;
  int most_;
  bool is_limit_;
  bool is_over_ = false;
  int done_ = 0;
  int from_journal_ = 0;
  int falsified_ = 0;
  int failed_ = 0;
  std::optional<double> largest_gap_m_;
  Clock::time_point begun_ = Clock::now();
  Clock::time_point printed_ = begun_;
};

}  // namespace rift::commands
