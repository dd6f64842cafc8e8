#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "rift/control/controller.hpp"
#include "rift/control/options.hpp"
#include "rift/control/program.hpp"
#include "rift/control/waypoint.hpp"
#include "rift/experiment/ensemble.hpp"
#include "rift/experiment/options.hpp"
#include "rift/experiment/space_yaml.hpp"
#include "rift/gap/options.hpp"
#include "rift/hardware/options.hpp"
#include "rift/simulation/options.hpp"
#include "rift/sweep/falsify/options.hpp"
#include "rift/sweep/run/options.hpp"
#include "rift/trial/options.hpp"
#include "rift/twin/options.hpp"
#include "rift/yaml/load.hpp"

namespace rift::experiment {

/// Everything that a run depends on: the whole schema. The defaults stand in the Options structs
/// of the rooms, and every key is optional: the authors' waypoint file is an experiment.
struct Experiment {
  std::string name;
  std::vector<control::Waypoint> waypoints;
  control::ProgramOptions program;
  Goal goal = Goal::kGrid;
  Objective objective = Objective::kGap;
  Space space;
  sweep::SearchPlan search;
  sweep::FalsifyOptions falsify;
  sweep::RunOptions run;
  CandidateOptions candidate;
  Start start = Start::kWaypoint;
  ReferenceOptions reference;
  gap::GapOptions gap;
  gap::LikenessOptions likeness;
  std::uint64_t seed = 1;
  control::NavigatorOptions control;
  trial::TrialOptions trial;
  simulation::SimulationOptions simulation;
  Ensemble ensemble;
  hardware::HardwareOptions hardware;
  TrackOptions track;
  twin::TwinOptions twin;
  CalibrateOptions calibrate;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("name", self.name, "what reports call it; by default the name of the file");
    field("waypoints", self.waypoints, "the task: name, x, y, heading (of the first), stop");
    field("program", self.program,
          "in place of the waypoints after the first: segments driven without looking");
    field("goal", self.goal,
          "what a sweep is for: visit every combination, look for failures, or fit the simulator");
    field(
        "objective", self.objective,
        "what a trial is judged by: the gap to the reference, or that of the robot's own odometry "
        "to the camera");
    field("space", self.space,
          "the parameters to vary: a list of values, or a range to search; {} with rift's own "
          "simulator: the paper's grid, 5 surfaces x 2 v_min x 3 v_max");
    field("search", self.search, "how a sweep that is no grid looks for its goal");
    field("falsify", self.falsify, "what counts as a failure, and how sure it must be");
    field("calibrate", self.calibrate, "what is fitted to which logs");
    field("run", self.run, "what a trial may cost; no part of what it computes");
    field("candidate", self.candidate, "the simulator: what is put to the test");
    field("start", self.start, "where a simulated trial begins: first waypoint, or as its log");
    field("reference", self.reference, "the robot: what it is compared with");
    field("gap", self.gap, "how the gap is measured");
    field("likeness", self.likeness,
          "how repeats of simulator and robot are held against each other");
    field("seed", self.seed, "of all random numbers; trial i of a setting uses seed + i - 1");
    field("control", self.control, "the waypoint controller, the same for robot and simulator");
    field("trial", self.trial, "the trial loop: rates, time limits, when a trial has failed");
    field("simulation", self.simulation, "the simulated robot, its radio, its camera, the floor");
    field("ensemble", self.ensemble,
          "draws from what a fit left open, one for each simulated run (rift sweep --write-robot)");
    field("hardware", self.hardware, "the real robot: its line, when it is stopped, its link");
    field("track", self.track, "the overhead camera: what it is asked for, the tag, calibration");
    field("twin", self.twin, "the simulated robot in real time, behind a port and a camera");
  }
};

/// Defaults < file (with what it includes) < overrides (`a.b=c`), checked; paths absolute.
/// Throws Error with file:line:column, the key, its value and the rule.
Experiment LoadExperiment(const std::string& path, const std::vector<std::string>& overrides,
                          const yaml::FileReader& read);

/// The experiment with the parameters of its space at one setting. Throws Error, naming where the
/// parameter was written, when a value breaks a rule.
Experiment ExperimentAt(const Experiment& experiment, const std::vector<ParameterValue>& theta);

/// What the robot is to do: the waypoints, or the program from the first of them on (from the
/// origin where there is none), for the robot of hardware.odometry.drive. Throws
/// std::invalid_argument when that is no task, or takes longer than trial.timeout_s.
control::Task TaskOf(const Experiment& experiment);

/// The experiment's own values of its space's parameters.
Theta NominalTheta(const Experiment& experiment);

/// The experiment as a simulated run of this seed has it: with the values of its draw where the
/// space does not set them, and without an ensemble.
Experiment DrawnAt(const Experiment& experiment, std::uint64_t seed);

/// The experiment with its free parameters (calibrate.fit) at these values, in their order, and
/// without an ensemble. Throws Error, naming where the parameter was written, when a value breaks a
/// rule.
Experiment CalibratedAt(const Experiment& experiment, const std::vector<double>& values);

/// Whether the free parameters break no rule at these values, at each of these settings.
bool KeepsRules(const Experiment& experiment, const std::vector<double>& values,
                const std::vector<Theta>& settings = {});

/// Every key of an experiment with type, default and meaning, a paragraph each.
std::string DescribeKeys();

/// Every value of the resolved experiment under its dotted key, as one line of YAML.
std::map<std::string, std::string> FlatValues(const Experiment& experiment);

/// The resolved experiment as YAML; loading it gives the same experiment.
std::string WriteExperiment(const Experiment& experiment);

}  // namespace rift::experiment
