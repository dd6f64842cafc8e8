#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/falsify/trial_runner.hpp"
#include "rift/sweep/run/worker_pool.hpp"

namespace rift::sweep {

/// Runs of a program that is the candidate, for whoever wants its trajectories and no gap: in
/// worker processes with the limits of RunOptions, as the trials of a sweep. What a run gives
/// depends on its request alone, not on the number of workers.
class CandidateRuns {
 public:
  /// The evaluator must outlive it.
  CandidateRuns(Evaluator& evaluator, int workers);

  /// One recording for each request, in their order. A run that hung, crashed or took too much
  /// memory has that as its status.
  std::vector<Recording> Run(const std::vector<TrialRequest>& requests);

 private:
  WorkerPool pool_;
};

/// A trial of a program with the run that it judged, and what that was held against.
struct ProgramTrial {
  TrialRow row;
  Recording candidate, reference;  ///< without a path where its process was given up
};

/// One trial, its program run once, in a worker process as it is in a sweep: what hangs or crashes
/// there is such a row here. Throws MachineTrouble as WorkerPool does.
ProgramTrial RunProgramTrial(Evaluator& evaluator, const TrialRequest& request);

/// A recording as bytes for another process.
std::string EncodeRecording(const Recording& recording);
/// Throws std::runtime_error for bytes of another layout.
Recording DecodeRecording(std::string_view bytes);

}  // namespace rift::sweep
