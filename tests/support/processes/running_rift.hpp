#pragma once

#include <sys/types.h>

#include <functional>
#include <random>
#include <string>
#include <vector>

#include "support/processes/process.hpp"

namespace rift::test {

/// The rift binary at work, to be watched, signalled and waited for. What waits for it gives up
/// after kGiveUp (until.hpp): it kills the process and throws std::runtime_error with what was
/// waited for and what the process printed.
class RunningRift {
 public:
  /// `redirection` is what a shell is told of its streams, such as `>&-`; none: stdin is /dev/null.
  explicit RunningRift(const std::vector<std::string>& arguments,
                       const std::string& redirection = "");
  /// Kills it when it still runs.
  ~RunningRift();
  RunningRift(const RunningRift&) = delete;
  RunningRift& operator=(const RunningRift&) = delete;

  void Signal(int signal) const;
  /// Stops the process (SIGSTOP) and returns when it stands still; false when it has ended.
  bool Freeze();
  void Thaw() const;
  /// Its worker processes. Gnuplot, which draws the figures, is a child as well and none of them.
  std::vector<pid_t> Workers() const;
  bool IsRunning();
  /// What it has printed so far.
  std::string Out() const;
  std::string Err() const;

  /// Waits until `is_so()`. Throws as well when the process ends before.
  void WaitUntil(const std::string& what, const std::function<bool()>& is_so);
  /// Waits for its end.
  ProcessResult Wait();

 private:
  [[noreturn]] void GiveUp(const std::string& what);

  TemporaryFolder folder_;
  std::string command_;
  pid_t pid_ = -1;
  int status_ = 0;
  bool is_over_ = false;
};

/// Runs one sweep and kills it in the middle (`kill -9`), `kills` times at most; then to its end.
/// Every start is the same command. In turn are killed: the process while its workers are at work,
/// one of the workers, and the process when it has committed trials of its own. A sweep that ends
/// before is not killed.
struct KilledSweep {
  int coordinator_kills = 0;
  int worker_kills = 0;
  int starts = 0;
  int resumed_starts = 0;  ///< of those, with trials of an earlier one in the journal
  ProcessResult last;
};
KilledSweep SweepUnderFire(const std::vector<std::string>& arguments, int kills,
                           const std::function<int()>& committed_trials,
                           std::mt19937_64& generator);

}  // namespace rift::test
