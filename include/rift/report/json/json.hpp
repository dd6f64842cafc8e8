#pragma once

#include <nlohmann/json.hpp>

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rift/control/waypoint.hpp"
#include "rift/experiment/experiment.hpp"
#include "rift/experiment/options.hpp"
#include "rift/gap/likeness.hpp"
#include "rift/gap/result.hpp"
#include "rift/hardware/arming.hpp"
#include "rift/odometry/program_runs.hpp"
#include "rift/sweep/calibrate/identification.hpp"
#include "rift/sweep/calibrate/likeness.hpp"
#include "rift/sweep/explain/explanation.hpp"
#include "rift/sweep/explain/failure_probability.hpp"
#include "rift/sweep/explain/program_cells.hpp"
#include "rift/sweep/explain/shrink.hpp"
#include "rift/sweep/falsify/result.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"
#include "rift/sweep/falsify/trial_runner.hpp"
#include "rift/sweep/run/journal_summary.hpp"
#include "rift/sweep/run/slurm_shards.hpp"
#include "rift/trial/steering_check.hpp"
#include "rift/trial/trial.hpp"
#include "rift/vision/calibration/calibration.hpp"
#include "rift/vision/tracking/session_options.hpp"
#include "rift/vision/tracking/tag_tracker.hpp"
#include "rift/vision/tracking/track_run.hpp"

namespace rift::report {

/// calibration.json: {name, confidence, fit, judged, errors, trials, missing}; the same report
/// gives the same bytes.
std::string CalibrationJson(const experiment::Experiment& experiment,
                            const sweep::CalibrationReport& report);

/// Loss, round trips, battery, which part of the budget is broken, and the keys of an experiment
/// that the measurement sets.
std::string PingJson(const hardware::PingResult& ping, const hardware::HardwareOptions& options);
std::string PingText(const hardware::PingResult& ping, const hardware::HardwareOptions& options);

/// Whether a run folder holds the whole run.
enum class RunState { kFinished, kInterrupted };
constexpr std::array<std::string_view, 2> EnumNames(RunState) {
  return {"finished", "interrupted"};
}

/// As a simulated run's, with protocol, link, latency by stage, and how the drive was stopped.
std::string DriveJson(const experiment::Experiment& experiment, const hardware::DriveRun& run,
                      RunState state = RunState::kFinished);
/// What stands in its place until the drive was closed, thus for ever when rift is killed.
std::string InterruptedDriveJson(const experiment::Experiment& experiment);
std::string DriveText(const experiment::Experiment& experiment, const hardware::DriveRun& run);
/// How a drive ended, in one line for people, of its summary.json.
std::string DriveEnding(const std::string& summary_json);
/// What its summary.json says of a drive; nothing where it does not, as of an interrupted drive.
std::optional<trial::Outcome> DriveOutcome(const std::string& summary_json);
/// What the robot spoke.
std::optional<hardware::Protocol> DriveProtocol(const std::string& summary_json);

/// One row a pose: when it went through each stage. Cells of stages never reached are empty.
std::string StagesCsv(const hardware::DriveRecord& evidence);
std::string StagesRow(const hardware::PoseStages& pose);

/// `rift gap --json`: {definition, trials, mean_gap_m, noise_floor_m, verdict, repeats, likeness}.
std::string GapJson(const gap::GapResult& result);

/// Columns real,u,error_m,yaw_error_rad,sim_x_m,sim_y_m,real_x_m,real_y_m; `real` counts from 1.
std::string ProfileCsv(const gap::GapResult& result);

/// {spread: {sim, real, ratio}, ...}; null where there is nothing to tell it by.
nlohmann::ordered_json LikenessJson(const gap::Likeness& likeness);
/// The same, and what only a controller's side can tell.
nlohmann::ordered_json LikenessJson(const sweep::DriveLikeness& likeness);
/// likeness.json: {level: the same}.
nlohmann::ordered_json LikenessJson(const std::vector<sweep::GroupLikeness>& groups);

/// `rift gap --odometry --json`: {definition, runs, cell, umbmark, calibration}.
std::string OdometryJson(const odometry::OdometryResult& result);

/// programs.json: {definition, cells: [{theta, deviation_m, spread_m, ..., trials}]}.
std::string ProgramsJson(const std::vector<experiment::Parameter>& parameters,
                         const std::vector<sweep::ProgramCell>& cells);

/// summary.json: {mean_gap_m, failures, n, not_ok, "by": {parameter: {value: the same}}, effects,
/// settings, ...}
std::string SummaryJson(const sweep::SweepResult& result);

/// How far a sweep is, of its journal, whether it is running, stopped or done, and its shards where
/// it is on a cluster.
std::string StatusJson(const sweep::JournalSummary& summary, const std::string& state,
                       const std::optional<sweep::ShardCounts>& shards = std::nullopt);
std::string StatusText(const sweep::JournalSummary& summary, const std::string& state,
                       const std::optional<sweep::ShardCounts>& shards = std::nullopt);

/// explanation.json, rows by their id in table.csv: {effects, sobol, parameters (inert and why),
/// anatomy, failures, failing_region, failure_probability, undecided, suggestions}.
std::string ExplanationJson(const sweep::SweepResult& result,
                            const sweep::Explanation& explanation);

/// shrunk.json: the failing row, what it shrank to, and its changes taken back one by one.
/// `folder` holds the table of these trials, for `rift simulate --replay`.
std::string ShrunkJson(const sweep::SweepResult& result, const sweep::ShrunkRow& shrunk,
                       const std::string& folder);

/// rare_event.json.
std::string RareEventJson(const sweep::RareEvent& event, const sweep::RareEventOptions& options);

/// One row a trial: a column for each parameter by its last name, then trial, gap_m, falsified,
/// status and further evidence; cells of what could not be computed are empty.
std::string TableCsv(const sweep::SweepResult& result);

/// Cells of one row of a table.csv by the names of their columns.
using TableRow = std::map<std::string, std::string>;

/// The first row of such a table.
TableRow FirstTableRow(const std::string& table_csv);
/// All rows. Throws std::invalid_argument, as those below, for a table that no sweep writes.
std::vector<TableRow> TableRows(const std::string& table_csv);

/// The row with this `id`. Throws std::invalid_argument, naming the table and the ids there are,
/// when there is none.
TableRow TableRowOf(const std::string& table_csv, const std::string& id, const std::string& name);

/// The id of the row that sweep::WorstTrial() of a table takes; `threshold_m` is that of its sweep.
/// Throws std::invalid_argument, naming the table, when it takes none.
std::string WorstIdOf(const std::string& table_csv, const std::string& name, double threshold_m);

/// The trial of a row of an experiment's table. Throws std::invalid_argument, naming the table,
/// where a parameter is missing.
sweep::TrialRequest RequestOf(const experiment::Experiment& experiment, const TableRow& row,
                              const std::string& name);

/// A setting as an object whose keys are the parameters' columns in table.csv:
/// {"surface": "ground", "v_min": 0.15}.
nlohmann::ordered_json ThetaJson(const std::vector<experiment::Parameter>& parameters,
                                 const experiment::Theta& theta);

/// What a tracking run was asked for, as far as its record says so.
struct TrackInputs {
  std::string camera;            ///< device, stream or pattern of pictures
  std::string calibration;       ///< file
  std::string calibration_hash;  ///< of its bytes
  vision::SessionOptions session;
};

/// What the log was made from and how it went: camera, calibration, frame of the poses, options,
/// rows, rates, misses, latency.
std::string TrackJson(const TrackInputs& inputs, const vision::CameraModel& camera,
                      const experiment::TrackOptions& options, const vision::TrackRun& run,
                      int rows);
std::string TrackText(const vision::TrackRun& run, int rows);
/// Sentences without full stops: why a tag of the family `asked_for` was never seen, although the
/// picture or its mirror image shows it, and what to do; which other tags the picture shows, with
/// the flags for them (`id_flag` and the id). None of a picture that shows no tag.
std::vector<std::string> UnseenLines(const vision::InsteadOfTag& instead,
                                     vision::TagFamily asked_for, const std::string& id_flag);

/// A log of sightings in the rift dialect: its nine columns (the target empty), then latency,
/// quality, state and the 6 x 6 covariance's upper triangle in the map's axes. A lost tag's row has
/// no pose.
std::string SightingsHeader();
std::string SightingRow(double t_s, const vision::Sighting& sighting);

/// The verdict of a calibration with its reasons, parameters and views.
std::string CalibrationText(const vision::Calibration& calibration);
/// The same in short, as comment lines for the head of the camera file.
std::string CalibrationComment(const vision::Calibration& calibration);

/// Waypoints made in the window as a waypoint file, which is an experiment as it is.
std::string WaypointsYaml(const std::vector<control::Waypoint>& waypoints);

/// What the summaries of a simulated and of a real trial have in common.
nlohmann::ordered_json WaypointsJson(const trial::TrialResult& result);
nlohmann::ordered_json LimitsJson(const trial::LimitCounts& limits);
nlohmann::ordered_json SteeringJson(const trial::SteeringCheck& check);

/// Its steering as the run showed it, and where it did not, as the experiment's keys say.
trial::SteeringCheck SteeringOf(const experiment::Experiment& experiment,
                                const sweep::SimulatedRun& run);
trial::SteeringCheck SteeringOf(const experiment::Experiment& experiment,
                                const hardware::DriveRun& run);
/// Why a run circled or did not arrive, which limits bound, and what to set, one line each; empty
/// for a run without causes.
std::vector<std::string> SteeringLines(const trial::SteeringCheck& check,
                                       const trial::LimitCounts& limits);

/// summary.json of a simulated trial: outcome, times, waypoints, which limits of the controller
/// were binding, seed and version.
std::string SimulationJson(const experiment::Experiment& experiment,
                           const sweep::SimulatedRun& run);
/// The same with a check whose proposals were tried.
std::string SimulationJson(const experiment::Experiment& experiment, const sweep::SimulatedRun& run,
                           const trial::SteeringCheck& check);

/// Columns t_s,power_left,power_right: every command as it was asked for.
std::string CommandsCsv(const trial::TrialResult& result);
std::string CommandsRow(const trial::SentCommand& command);

}  // namespace rift::report
