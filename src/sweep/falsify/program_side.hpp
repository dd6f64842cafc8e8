#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "rift/experiment/experiment.hpp"
#include "rift/sweep/falsify/recorded_logs.hpp"
#include "rift/sweep/falsify/trial_runner.hpp"
#include "rift/sweep/run/external_program.hpp"

namespace rift::sweep {

/// What one side of an experiment says of its program.
struct ProgramOptions {
  std::string key;  ///< "candidate", "reference"
  experiment::CommandLine run;
  bool persistent = false;
  experiment::ExitCodes exit_codes;
  LogOptions log;
};

/// Runs of somebody else's simulator.
class ProgramSide {
 public:
  /// Throws std::invalid_argument when its arguments cannot be filled in. The experiment must
  /// outlive it.
  ProgramSide(const experiment::Experiment& experiment, ProgramOptions options,
              const Inputs& inputs);
  ~ProgramSide();

  /// One run: its log, or why there is none. A run whose process crashes is tried again as often
  /// as run.retries says.
  Recording Run(const TrialRequest& request);
  /// `hash  path` of the files among the arguments, a line each.
  const std::string& HashesText() const { return hashes_; }

 private:
  Recording RunOnce(const TrialRequest& request);
  Recording RunSpawned(const TrialRequest& request);
  Recording RunPersistent(const TrialRequest& request);
  /// A process of the persistent program that has nothing left of an earlier trial.
  ExternalProgram& ProgramFor(const TrialRequest& request);
  /// Of the persistent program, which did not answer.
  Recording EndedInTrial();
  void TakeAnswer(const nlohmann::ordered_json& answer, Recording& recording) const;
  ProgramStart StartOf(const TrialRequest& request, const std::string& folder) const;
  void ReadLog(const std::string& text, Recording& recording) const;
  void ReadLogFile(const std::string& folder, Recording& recording) const;
  /// Throws MachineTrouble when the program was never started.
  void TakeExit(const ExternalProgram::Exit& exit, const std::string& words,
                Recording& recording) const;
  double DistanceLeft_m(const trajectory::Trajectory& path) const;

  const experiment::Experiment& experiment_;
  std::vector<experiment::Parameter> parameters_;
  ProgramOptions options_;
  Inputs inputs_;
  std::string hashes_;
  std::unique_ptr<ExternalProgram> program_;  ///< a persistent one
};

/// Nothing where the side is of another kind.
std::unique_ptr<ProgramSide> CandidateProgram(const experiment::Experiment& experiment,
                                              LogOptions log, const Inputs& inputs);
std::unique_ptr<ProgramSide> ReferenceProgram(const experiment::Experiment& experiment,
                                              LogOptions log, const Inputs& inputs);

}  // namespace rift::sweep
