#pragma once

namespace rift::sweep {

struct ShortHorizonOptions {
  int most_frames = 5;
  int phases = 16;
  double moved_m = 0.02;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("most_frames", self.most_frames, 1, 100,
          "motions over 1 to this many frames are predicted; less than the loop delay, so that the "
          "log alone decides what the robot was told");
    field("phases", self.phases, 1, 1000,
          "replays of a log, each with another phase of the robot's listener, whose mean is the "
          "prediction, weighted by how likely the log is with each");
    field("moved_m", self.moved_m, 0.0, 10.0,
          "a log counts from where the robot is this far from its start");
  }
};

/// The last part of a fit: what whole runs are like, as a function of the parameters.
struct FeatureFitOptions {
  int rounds = 0;
  int draws = 300;
  int last_draws = 0;
  double failures = 1.0;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("rounds", self.rounds, 0, 20,
          "how often values are drawn about the estimate, each log driven once at each draw, and "
          "the features of the drives regressed on the values; the estimate goes to where they are "
          "those of the logs; 0: the fit ends with the motions");
    field("draws", self.draws, 50, 100'000, "draws of the values in a round");
    field("last_draws", self.last_draws, 0, 100'000,
          "of the last round, where they are more: what starts disagree by falls with their root");
    field(
        "failures", self.failures, 0.0, 1000.0,
        "weight of drives that do not arrive, or on a detour, which no log of the fit is; 1: that "
        "of so many logs (-2 log of the share that arrives), as if none had been driven again");
  }
};

/// How a simulator is fitted to logs.
struct CalibrationOptions {
  ShortHorizonOptions horizon;
  FeatureFitOptions features;
  int runs = 4;
  double likeness_weight = 4.0;
  int iterations = 12;
  double first_step = 0.2;
  double step = 0.1;
  int corrections = 2;
  int simulated_logs = 24;
  double outlier_sd = 3.0;
  int resamples = 1000;
  double confidence = 0.95;
  double identified_share = 0.25;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("horizon", self.horizon, "prediction of the next frames from the logged ones");
    field("features", self.features, "fit by what tells simulated logs from real ones");
    field("runs", self.runs, 0, 1000,
          "whole simulated runs of each log, for weave, spread, speed, loop delay and steering "
          "gain; 0: the next frames alone decide");
    field("likeness_weight", self.likeness_weight, 0.0, 1e6,
          "how much weave, spread, speed, loop delay and steering gain of a run count beside one "
          "predicted motion");
    field("iterations", self.iterations, 1, 1000, "most steps of the fit (Levenberg-Marquardt)");
    field("first_step", self.first_step, 1e-6, 0.5,
          "change of a parameter that its effect is read from at first, as a share of its range: "
          "long, to see past the leaps that a polled link makes");
    field("step", self.step, 1e-6, 0.5, "the same at the end");
    field(
        "corrections", self.corrections, 0, 100,
        "steps after the fit, to where the logs look like those the simulator makes itself; 0: the "
        "least errors, whose delay and mismatch are biased");
    field("simulated_logs", self.simulated_logs, 0, 10'000,
          "simulated logs in them at least: every real one is repeated equally often");
    field("outlier_sd", self.outlier_sd, 1.0, 1e6,
          "errors beyond this many standard deviations count in proportion (Huber 1964)");
    field("resamples", self.resamples, 20, 1'000'000,
          "draws of the logs, with replacement, behind the intervals (bootstrap)");
    field("confidence", self.confidence, 0.5, 0.9999, "of the intervals");
    field("identified_share", self.identified_share, 0.001, 1.0,
          "an interval that reaches further than this share of the range to either side says that "
          "the logs do not tell the parameter");
  }
};

}  // namespace rift::sweep
