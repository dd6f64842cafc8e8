#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "rift/experiment/parameter.hpp"
#include "rift/sweep/calibrate/options.hpp"
#include "rift/trajectory/log.hpp"
#include "rift/vision/calibration/options.hpp"
#include "rift/vision/camera/capture_options.hpp"
#include "rift/vision/tracking/tag_options.hpp"

namespace rift::experiment {

enum class Goal {
  kGrid,       ///< every combination of the levels
  kFalsify,    ///< where the gap is largest
  kCalibrate,  ///< the simulator that predicts the logs
};
constexpr std::array<std::string_view, 3> EnumNames(Goal) {
  return {"grid", "falsify", "calibrate"};
}

/// What a trial is judged by.
enum class Objective {
  kGap,       ///< between candidate and reference
  kOdometry,  ///< between the encoders and the camera of one run
};
constexpr std::array<std::string_view, 2> EnumNames(Objective) { return {"gap", "odometry"}; }

enum class ReferenceKind {
  kPath,     ///< the polyline through the waypoints, or the path of the program
  kNominal,  ///< a run of the candidate with the experiment's own values
  kLogs,
  kProgram,  ///< runs of somebody else's simulator
};
constexpr std::array<std::string_view, 4> EnumNames(ReferenceKind) {
  return {"path", "nominal", "logs", "program"};
}

enum class CandidateKind {
  kSimulation,
  kLogs,
  kProgram,  ///< somebody else's simulator
};
constexpr std::array<std::string_view, 3> EnumNames(CandidateKind) {
  return {"simulation", "logs", "program"};
}

/// Where a simulated trial begins.
enum class Start {
  kWaypoint,   ///< at the first waypoint
  kReference,  ///< where the reference log shows the robot standing
};
constexpr std::array<std::string_view, 2> EnumNames(Start) { return {"waypoint", "reference"}; }

/// A file name, or a template of one over the names of the parameters and {trial}. In a YAML file
/// it is relative to that file.
struct PathTemplate {
  std::string text;
};

/// A program and its arguments, never given to a shell; `{mu}` in an argument stands for the value
/// of that parameter. In a YAML file an argument that names a file beside that file is that file.
struct CommandLine {
  std::vector<std::string> words;
};

/// What the exit codes of a program say of its run: 0 is a run that arrived, any other than these a
/// fault.
struct ExitCodes {
  int timed_out = 10;
  int fell = 11;
  int left_arena = 12;
  int lost = 13;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("timed_out", self.timed_out, 1, 255, "the robot did not arrive in time");
    field("fell", self.fell, 1, 255, "the robot fell");
    field("left_arena", self.left_arena, 1, 255, "the robot left the arena");
    field("lost", self.lost, 1, 255, "the robot was seen no more");
  }
};

/// Which repeats of the reference there are: `trials: [1, 2, 3]`, or a count.
struct TrialList {
  std::vector<std::string> names{"1"};
};

/// What the candidate is compared with: the truth.
struct ReferenceOptions {
  ReferenceKind kind = ReferenceKind::kPath;
  PathTemplate path;
  TrialList trials;
  CommandLine run;
  bool persistent = false;
  ExitCodes exit_codes;
  trajectory::Format format = trajectory::Format::kAuto;
  std::string columns;
  std::string units;
  double tag_offset_m = 0.0;
  double grid_fps = 0.0;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("kind", self.kind,
          "waypoint path, a run of the candidate with nominal values, recorded logs, or runs of a "
          "program");
    field("path", self.path, "of the logs, such as real/{surface}_{trial}.csv");
    field("trials", self.trials, "repeats of every setting: their names, or how many");
    field("run", self.run, "as candidate.run, of the reference");
    field("persistent", self.persistent, "as candidate.persistent");
    field("exit_codes", self.exit_codes, "as candidate.exit_codes");
    field("format", self.format, "dialect of the logs");
    field("columns", self.columns,
          "of logs in no dialect: which column holds what, such as "
          "t=time,x=pose_x,y=pose_y,yaw=theta:deg (docs/logs.md)");
    field("units", self.units, "of logs in no dialect, where they are not m, s and rad: mm,ms,deg");
    field("tag_offset_m", self.tag_offset_m, -1.0, 1.0,
          "moves the logs forward along their yaw, from the tag to the point that the simulator "
          "logs, its axle (paper: 0.03)");
    field("grid_fps", self.grid_fps, 0.0, 1000.0,
          "puts time stamps back on the frames of a camera of this rate, where the log shows them "
          "(the authors' logs: 30); 0: as logged");
  }
};

/// What is put to the test: the simulator.
struct CandidateOptions {
  CandidateKind kind = CandidateKind::kSimulation;
  PathTemplate path;
  CommandLine run;
  bool persistent = false;
  ExitCodes exit_codes;
  trajectory::Format format = trajectory::Format::kAuto;
  std::string columns;
  std::string units;
  double grid_fps = 0.0;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("kind", self.kind, "the simulator of rift, recorded logs, or a program");
    field("path", self.path, "of the logs, such as webots/{surface}.csv");
    field("run", self.run,
          "program and arguments, such as [python3, sim.py, --mu, \"{mu}\", --seed, \"{seed}\", "
          "--out, \"{out}\"]: it writes the trajectory to {out} (docs/programs.md)");
    field("persistent", self.persistent,
          "one process a worker, which reads a line of JSON for each trial and answers with one");
    field("exit_codes", self.exit_codes, "what its exit codes say of a run; 0: it arrived");
    field("format", self.format, "dialect of the logs");
    field("columns", self.columns, "as reference.columns, of the candidate's logs");
    field("units", self.units, "as reference.units, of the candidate's logs");
    field("grid_fps", self.grid_fps, 0.0, 1000.0,
          "as reference.grid_fps, of the candidate's logs, recorded or simulated");
  }
};

/// A parameter that may change, in its own unit.
struct FreeParameter {
  std::string key;
  double min = 0.0;
  double max = 1.0;
  double start = 0.5;
  std::string origin{};  ///< where it was written, for messages
  /// Of what is known beside the logs, as a normal distribution; sd 0: nothing.
  double prior_mean = 0.0;
  double prior_sd = 0.0;
};

/// `fit: {motor.mismatch: {min: -0.1, max: 0.1}, surfaces.{surface}.mu: {min: 0.1, max: 1}}`: keys
/// of the experiment, whose values are where the fit starts; {surface} stands for each level of
/// that parameter of the space. `{min: 0, max: 0.2, mean: 0.1, sd: 0.02}` has a prior.
struct FreeParameters {
  std::vector<FreeParameter> list;
};

/// Trials by name, as in reference.trials; there may be none.
struct HeldOutTrials {
  std::vector<std::string> names;
};

/// What `goal: calibrate` fits, and to which logs.
struct CalibrateOptions {
  FreeParameters fit;
  HeldOutTrials holdout;
  int starts = 1;
  int judge_runs = 20;
  int draws = 20;
  sweep::CalibrationOptions method;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("fit", self.fit,
          "parameters of the simulator to fit, their ranges and, as mean and sd, what is known of "
          "them beside the logs; {surface} in a key makes one for each surface of the space");
    field("holdout", self.holdout,
          "trials of reference.trials that the fit never sees and that judge it");
    field(
        "starts", self.starts, 1, 100,
        "fits, each with random numbers of its own: the first from the experiment's values, whose "
        "result counts, the others from values drawn within the ranges, which must agree with it");
    field("judge_runs", self.judge_runs, 2, 1000,
          "simulated runs of each trial, before and after the fit, that whole paths are judged by");
    field("draws", self.draws, 0, 1000,
          "draws from what the fit leaves open, which the robot's file holds as its ensemble; 0: "
          "none");
    field("method", self.method, "how it is fitted");
  }
};

/// The overhead camera as motion capture: the block `track` of an experiment.
struct TrackOptions {
  vision::CaptureOptions capture;
  vision::TagOptions tag;
  vision::CalibrationOptions calibration;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("capture", self.capture, "what is asked of the camera, and when it has failed");
    field("tag", self.tag, "the robot's tag, and when a sighting of it is believed");
    field("calibration", self.calibration, "when a calibration is good, usable or refused");
  }
};

}  // namespace rift::experiment
