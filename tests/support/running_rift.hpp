#pragma once

#include <sys/types.h>

#include <random>
#include <string>
#include <vector>

#include "support/process.hpp"

namespace rift::test {

/// The rift binary at work, to be killed or waited for.
class RunningRift {
 public:
  explicit RunningRift(const std::vector<std::string>& arguments);
  /// Kills it when it still runs.
  ~RunningRift();
  RunningRift(const RunningRift&) = delete;
  RunningRift& operator=(const RunningRift&) = delete;

  void Signal(int signal) const;
  /// Signals one of its worker processes at random, but not `spared`; 0 when there is none.
  pid_t SignalWorker(int signal, std::mt19937_64& generator, pid_t spared = 0) const;
  bool IsRunning();
  ProcessResult Wait();

 private:
  TemporaryFolder folder_;
  pid_t pid_ = -1;
  int status_ = 0;
  bool is_over_ = false;
};

/// Runs one sweep with a `kill -9` after every random while, of the whole process and of single
/// workers in turn, `kills` times; then to its end. Every start is the same command.
struct KilledSweep {
  int coordinator_kills = 0;
  int worker_kills = 0;
  int starts = 0;
  ProcessResult last;
};
KilledSweep SweepUnderFire(const std::vector<std::string>& arguments, int kills,
                           double longest_pause_s, std::mt19937_64& generator);

}  // namespace rift::test
