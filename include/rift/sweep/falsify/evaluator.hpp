#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "rift/experiment/experiment.hpp"
#include "rift/sweep/falsify/recorded_logs.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"
#include "rift/sweep/falsify/trial_runner.hpp"

namespace rift::sweep {

class ProgramSide;

/// One run of the candidate as the camera and its wheels saw it.
struct CandidateRun {
  Recording camera;
  std::vector<odometry::EncoderReading> encoders;  ///< none where there are none
};

/// How far the runs that settings are held against are known before the first trial.
struct ReferenceProgress {
  int arrived = 0;
  int seeds = 0;         ///< that trials of one setting count up from the experiment's
  int others_tried = 0;  ///< in the place of seeds whose run did not arrive
  std::string last_failure{};
};

/// Who waits for them.
struct ReferenceWatch {
  int workers = 1;
  /// Asked at least every 0.1 s; false stops.
  std::function<bool(const ReferenceProgress&)> go_on = [](const ReferenceProgress&) {
    return true;
  };
};

/// The evaluator of an experiment: one trial at one setting, theta -> gap. Grid, search, shrinking,
/// rare events, suggestions, calibration and replay all ask it. Trajectories come from where the
/// experiment says: logs, simulated runs, runs of a program, the waypoint path.
class Evaluator {
 public:
  /// Throws std::invalid_argument, naming `experiment_file`, when the experiment lacks what its
  /// kinds of candidate and reference need. The experiment must outlive the evaluator.
  Evaluator(const experiment::Experiment& experiment, std::string experiment_file, Inputs inputs);

  /// One trial as its row. A setting that breaks a rule of the experiment is a row that says so.
  /// Where the nominal run of its seed fails, another seed takes its place for both sides: the row
  /// names the one that was used.
  TrialRow Evaluate(const TrialRequest& request);
  /// A drive of the real robot at a setting as a row, from its log (rift's format) and how it
  /// ended: held against the reference of the request, or, where references are logs, the reference
  /// of a simulated run that starts where it stood. Throws std::invalid_argument for objective:
  /// odometry.
  TrialRow EvaluateDriven(const TrialRequest& request, const std::string& path,
                          trial::Outcome outcome);
  Recording Reference(const TrialRequest& request);
  /// Runs the nominal trial of the seeds that trials of one setting count up from the experiment's,
  /// in worker processes, before the first trial: which of them did not arrive, and what took their
  /// place. Empty for references that are no runs; nothing when it was told to stop. Throws
  /// std::invalid_argument when the nominal run never arrives, and at the first that ends in a way
  /// that no seed mends (fault, crash, hang, no log): nothing can be compared with it.
  std::optional<std::vector<ReplacedReference>> CheckReferences(const ReferenceWatch& watch = {});
  /// Candidate and reference of a row as Evaluate would name them: of one that ended before it
  /// could.
  void NameSides(TrialRow& row) const;
  /// May start where the reference did.
  Recording Candidate(const TrialRequest& request, const Recording& reference);
  /// The same with its encoders: those of a log lie beside it in encoders.csv.
  CandidateRun RunOf(const TrialRequest& request, const Recording& reference);
  /// What the task of a setting looks like when it is kept exactly.
  trajectory::Trajectory IdealPathAt(const experiment::Theta& theta) const;
  /// The simulated trial of a request; throws yaml::Error when the setting breaks a rule.
  SimulatedTrial TrialFor(const TrialRequest& request, const Recording& reference) const;
  /// The simulated trial of an experiment: where `TrialOf` takes its files from is the evaluator's.
  SimulatedTrial TrialOf(const experiment::Experiment& experiment, const geometry::Pose2& start,
                         std::uint64_t seed) const;
  /// How far the references of a setting are apart: gap::NoiseFloor_m. NaN without repeats. Nominal
  /// runs are simulated in a process of their own, until `go_on` (asked every 0.1 s) says no.
  double NoiseFloor_m(
      const experiment::Theta& theta, const std::function<bool()>& go_on = [] { return true; });

  /// Reads every log that some setting names, so that worker processes find them loaded. False when
  /// `go_on`, asked before each log, says no.
  bool LoadLogs(const std::function<bool()>& go_on = [] { return true; });
  /// Everything that a trial depends on beside the experiment itself, as one line: the journal's
  /// key.
  std::string KeyOf(const TrialRequest& request);
  /// Fingerprints of every log that was read, of programs' files, and of pictures of heightfields
  /// that a key was made of.
  std::string InputsText() const;
  /// When the trial behind a log of a drive or a simulated run began, on the clock of the log: the
  /// first row of commands.csv beside it; nothing where there is no such file.
  std::optional<double> TrialBegan_s(const std::string& log) const;

  const experiment::Experiment& experiment() const { return experiment_; }
  const std::string& experiment_file() const { return experiment_file_; }

 private:
  std::vector<odometry::EncoderReading> EncodersBeside(const std::string& log) const;
  std::string Filled(const experiment::PathTemplate& path, const TrialRequest& request) const;
  void CheckTask() const;
  bool LoadLogsOf(const experiment::PathTemplate& path, const char* key,
                  const std::function<bool()>& go_on, RecordedLogs& logs) const;
  /// Of the heightfields that a trial at this setting is driven on.
  std::set<std::string> PicturesOf(const TrialRequest& request) const;
  const std::string& PictureHash(const std::string& path);
  std::string ReferencePath(const TrialRequest& request) const;
  TrialRow EvaluateOdometry(const TrialRequest& request);
  const Recording& Nominal(std::uint64_t seed);
  std::uint64_t SeedWithReference(std::uint64_t seed);
  std::string PathName() const;
  int NominalSeeds() const;
  double NominalNoiseFloor_m(const std::function<bool()>& go_on);

  const experiment::Experiment& experiment_;
  std::string experiment_file_;
  Inputs inputs_;
  RecordedLogs candidate_logs_;
  RecordedLogs reference_logs_;
  std::shared_ptr<ProgramSide> candidate_program_;  ///< where that side is a program
  std::shared_ptr<ProgramSide> reference_program_;
  std::map<std::string, std::string> picture_hashes_;  ///< by path; empty: not there
  bool may_have_pictures_ = false;                     ///< at some setting
  std::map<std::uint64_t, Recording> nominal_runs_;    ///< by seed
  std::map<std::uint64_t, std::uint64_t> used_;   ///< seeds with a reference, by those asked for
  std::map<std::string, double> noise_floors_m_;  ///< by the references' sources
};

}  // namespace rift::sweep
