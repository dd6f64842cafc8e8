#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rift/sweep/falsify/result.hpp"
#include "rift/sweep/run/journal.hpp"
#include "rift/sweep/run/options.hpp"
#include "rift/sweep/run/worker_pool.hpp"

namespace rift::sweep {

/// A trial to be run.
struct TrialRequest {
  experiment::Theta theta;
  std::string trial;                  ///< which repeat of the reference
  std::optional<std::uint64_t> seed;  ///< of a simulated candidate
  bool is_random_draw = false;        ///< see TrialRow
};

/// The trial of a row, to be run again; and a row without findings, of a trial to be run.
TrialRequest RequestOf(const TrialRow& row);
TrialRow RowFor(TrialRequest request);

/// Computes one trial. What it throws as std::exception makes the row a fault, but for
/// MachineTrouble, which ends the batch.
using Evaluate = std::function<TrialRow(const TrialRequest&)>;

/// Rows in the order of the requests; nothing when the sweep was told to stop.
using RunTrials = std::function<std::optional<std::vector<TrialRow>>(std::vector<TrialRequest>)>;

/// The same for a caller with nothing to keep when it is told to stop: throws then.
using RunAllTrials = std::function<std::vector<TrialRow>(std::vector<TrialRequest>)>;

/// What whoever watches a sweep is told, and asked.
struct Watch {
  /// Each row when it is there, in any order.
  std::function<void(const TrialRow&, bool from_journal)> seen = [](const TrialRow&, bool) {};
  /// Asked at least every 0.1 s; false stops the sweep.
  std::function<bool()> go_on = [] { return true; };
  /// Asked for the names of both sides of a row whose process ended before it could name them.
  std::function<void(TrialRow&)> name_sides = [](TrialRow& row) { row.candidate = "simulation"; };
};

/// In this process, one after the other: for trials that cannot do harm.
RunTrials RunHere(Evaluate evaluate, Watch watch);

/// Trials in worker processes, each at most once: what the journal holds is not computed again. A
/// trial that takes its process with it is a row with its status. The rows depend on the requests
/// alone, not on the number of workers.
class TrialRunner {
 public:
  /// Later trials keep no TrialEvidence::path_m: no page shows more, and memory stays bounded.
  static constexpr size_t kMostPaths = 5000;

  /// A text for everything that a request's trial depends on beside the facts of the journal.
  using KeyOf = std::function<std::string(const TrialRequest&)>;

  /// `journal` may be nullptr.
  TrialRunner(Evaluate evaluate, KeyOf key_of, Journal* journal, int workers,
              const RunOptions& options, Watch watch, size_t most_paths = kMostPaths);

  std::optional<std::vector<TrialRow>> Run(std::vector<TrialRequest> requests);
  /// True when the journal holds every one of them.
  bool HasAll(const std::vector<TrialRequest>& requests);
  /// Those that the journal does not hold, by their index, ascending.
  std::vector<size_t> Missing(const std::vector<TrialRequest>& requests);
  /// How many of the next trials keep their path.
  size_t PathsLeft() const { return most_paths_ - std::min(run_, most_paths_); }

 private:
  TrialRow Finish(TrialRequest request, const JobResult& result, bool keeps_path);

  KeyOf key_of_;
  Journal* journal_;
  Watch watch_;
  WorkerPool pool_;
  size_t most_paths_;
  size_t run_ = 0;  ///< trials of earlier calls
};

/// A request as bytes for a worker.
std::string EncodeRequest(const TrialRequest& request);
TrialRequest DecodeRequest(std::string_view bytes);

/// What a trial found out, as bytes: everything of a row but what its request said already.
std::string EncodeFindings(const TrialRow& row);
/// Throws std::runtime_error for bytes of another layout.
void DecodeFindings(std::string_view bytes, TrialRow& row);

}  // namespace rift::sweep
