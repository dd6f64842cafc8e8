#pragma once

#include <chrono>
#include <optional>
#include <set>
#include <string>

#include "rift/report/json/progress.hpp"
#include "rift/sessions/sweep/observer.hpp"

namespace rift::commands {

enum class ProgressStyle { kQuiet, kBar, kLines, kJson };

/// A bar for a terminal, lines for anything else.
ProgressStyle StyleFor(bool quiet, bool json);

/// Who is told of a sweep at a terminal: notes and progress on stderr, Ctrl-C asks for an end.
sessions::SweepObserver ObserverFor(ProgressStyle style);

/// How far a sweep is, on stderr: what is done and to be done, trials a second, the time left, the
/// largest gap so far, failures.
class SweepProgress final : public sessions::TrialProgress {
 public:
  SweepProgress(ProgressStyle style, const sessions::SweepSize& size);
  /// Ends the line of a bar that an error cut short.
  ~SweepProgress() override;

  void Seen(const sweep::TrialRow& row, bool from_journal) override;
  /// A line of its own, whatever the style.
  void Warn(const std::string& line) override;
  /// Prints when it is time to; cheap otherwise.
  void Tick() override;
  void Tick(const sweep::ReferenceProgress& references) override;
  void End(const std::string& state) override;

 private:
  using Clock = std::chrono::steady_clock;

  /// With the rate and the time left as they are now.
  report::ProgressCounts Counts() const;
  void Print(const std::string& state);
  bool IsTime();

  ProgressStyle style_;
  report::ProgressCounts counts_;
  std::set<experiment::Theta> settings_;  ///< of a search, those seen
  int steps_from_journal_ = 0;
  bool is_over_ = false;
  bool has_spoken_ = false;
  Clock::time_point begun_ = Clock::now();
  Clock::time_point printed_ = begun_;
};

}  // namespace rift::commands
