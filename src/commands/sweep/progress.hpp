#pragma once

#include <chrono>
#include <optional>
#include <set>
#include <string>

#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::commands {

enum class ProgressStyle { kQuiet, kBar, kLines, kJson };

/// A bar for a terminal, lines for anything else.
ProgressStyle StyleFor(bool quiet, bool json);

/// What a sweep will have done when it ends.
struct SweepSize {
  int most = 0;
  /// A search: `most` settings at most, each of them with as many trials as it turns out to need.
  bool is_settings = false;
};

/// How far a sweep is, on stderr: what is done and to be done, trials a second, the time left, the
/// largest gap so far, failures.
class SweepProgress {
 public:
  SweepProgress(ProgressStyle style, const SweepSize& size);
  /// Ends the line of a bar that an error cut short.
  ~SweepProgress();
  SweepProgress(const SweepProgress&) = delete;
  SweepProgress& operator=(const SweepProgress&) = delete;

  void Seen(const sweep::TrialRow& row, bool from_journal);
  /// A line of its own, whatever the style.
  void Warn(const std::string& line) const;
  /// Prints when it is time to; cheap otherwise.
  void Tick();
  /// The same before the first trial: how far the runs are that settings are held against.
  void Tick(const sweep::ReferenceProgress& references);
  /// The last word, with how it ended: "done", "stopped".
  void End(const std::string& state);

 private:
  using Clock = std::chrono::steady_clock;

  int Steps() const;
  double Elapsed_s() const;
  double Rate() const;
  std::optional<double> Left_s() const;
  std::string Text() const;
  void Print(const std::string& state);
  bool IsTime();

  ProgressStyle style_;
  SweepSize size_;
  std::set<experiment::Theta> settings_;  ///< of a search, those seen
  int steps_from_journal_ = 0;
  bool is_over_ = false;
  bool has_spoken_ = false;
  int done_ = 0;
  int from_journal_ = 0;
  int falsified_ = 0;
  int failed_ = 0;
  std::optional<double> largest_gap_m_;
  Clock::time_point begun_ = Clock::now();
  Clock::time_point printed_ = begun_;
};

}  // namespace rift::commands
