#pragma once

#include <functional>
#include <memory>
#include <string>

#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/run/slurm_shards.hpp"

namespace rift::sessions {

/// What a sweep will have done when it ends.
struct SweepSize {
  int most = 0;
  /// `most` settings at most, each of them with as many trials as it turns out to need: a search,
  /// or a grid that is repeated until it is decided.
  bool is_settings = false;
};

/// Told how far trials are, from their beginning to their end.
class TrialProgress {
 public:
  TrialProgress() = default;
  virtual ~TrialProgress() = default;
  TrialProgress(const TrialProgress&) = delete;
  TrialProgress& operator=(const TrialProgress&) = delete;

  virtual void Seen(const sweep::TrialRow& row, bool from_journal) = 0;
  /// A line for people, at once.
  virtual void Warn(const std::string& line) = 0;
  /// At least every 0.1 s.
  virtual void Tick() = 0;
  /// The same before the first trial: how far the runs are that settings are held against.
  virtual void Tick(const sweep::ReferenceProgress& references) = 0;
  /// How it ended: "done", "stopped". Not called where an error cut it short.
  virtual void End(const std::string& state) = 0;
};

/// False when the user asked for an end.
using GoOn = std::function<bool()>;

/// What the work on a sweep tells whoever started it, and asks.
struct SweepObserver {
  /// A note for people, one line.
  std::function<void(const std::string& line)> say;
  /// Trials begin.
  std::function<std::unique_ptr<TrialProgress>(const SweepSize& size)> begin;
  /// How far the shards on a cluster are; told when it changed.
  std::function<void(const sweep::ShardCounts& counts)> shards;
  /// As long as the answer lives, the user can ask for an end; at other times there is nothing that
  /// could be stopped cleanly.
  std::function<GoOn()> watch_for_stop;
};

}  // namespace rift::sessions
