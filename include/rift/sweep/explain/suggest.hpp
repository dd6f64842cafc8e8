#pragma once

#include <string>
#include <vector>

#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {

struct SuggestOptions {
  int experiments = 5;
  int repeats = 3;
  double least_gain = 0.01;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("experiments", self.experiments, 1, 1000, "how many are suggested");
    field("repeats", self.repeats, 1, 100, "trials of one experiment");
    field("least_gain", self.least_gain, 0.0, 1.0,
          "what a trial must take from the risk of a wrong call to be worth it");
  }
};

/// What the robot did at a suggested setting, of an earlier round of suggestions.
struct RobotTrials {
  experiment::Theta values;  ///< of the settable parameters, as suggested
  bool is_predicted_to_fail = false;
  int trials = 0;  ///< that tell
  int failures = 0;
};

/// What these trials say of each setting, all that were driven judged together.
std::vector<gap::RepeatVerdict> JudgeRobotTrials(const std::vector<RobotTrials>& robot,
                                                 const gap::VerdictOptions& options);

/// Trials on the robot at a setting that a person can set, and what they would decide: whether more
/// than VerdictOptions::share of the robot's runs fail there.
struct Suggestion {
  experiment::Theta values;           ///< of the settable parameters, in steps of a person
  int repeats = 0;                    ///< trials
  std::vector<int> rows;              ///< of the sweep within half a step, the distinct ones
  int failures = 0;                   ///< of these rows
  bool is_predicted_to_fail = false;  ///< more than that share of these rows fail
  double mean_loss_m = gap::kNotComputed;
  double fails_now = gap::kNotComputed;    ///< probability that more than that share fail
  double wrong_now = gap::kNotComputed;    ///< risk of calling it wrongly by that
  double wrong_after = gap::kNotComputed;  ///< the same, expected after the trials
  std::string sentence;
};

struct Suggestions {
  std::vector<int> settable;           ///< parameters that a person can set on the robot
  std::vector<Suggestion> list;        ///< the one that is best worth its trials first
  double trusted = gap::kNotComputed;  ///< probability that a prediction of the sweep holds
  std::string note;                    ///< why there are none or few, and what was left out
};

/// Experiments over the parameters that a person can set (experiment::IsSettable), rounded to the
/// steps of a person; the others are what they are on the robot. Only those are suggested of which
/// each trial takes `least_gain` from the risk of a wrong call, none twice and none that the sweep
/// saw to be the same run as another to the last bit. At least half of them are predicted failures
/// where there are such.
///
/// The risk: before any run the robot is as likely to fail at a setting as not, its share of
/// failing runs evenly within the side. Trials of the robot (rows of a sweep whose reference is
/// logs, and `robot`) count by their likelihood. A sweep without logs predicts; its prediction
/// holds with the probability (1 + predictions that `robot` bears out) / (2 + predictions that it
/// tells of), and else says nothing.
Suggestions SuggestExperiments(const SweepResult& result, const SuggestOptions& options = {},
                               const std::vector<RobotTrials>& robot = {});

/// Values of the settable parameters at a setting, in the steps of a person.
experiment::Theta SettableValues(const SweepResult& result, const std::vector<int>& settable,
                                 const experiment::Theta& theta);

}  // namespace rift::sweep
