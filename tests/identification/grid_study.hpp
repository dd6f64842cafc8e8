#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rift/control/waypoint.hpp"
#include "rift/hardware/options.hpp"
#include "rift/simulation/options.hpp"
#include "rift/trial/loop_delay.hpp"
#include "rift/trial/trial.hpp"
#include "support/inputs/trials.hpp"
#include "support/tree.hpp"

namespace rift::test {

/// What a study of the paper's grid needs of an experiment.
struct GridStudy {
  std::vector<control::Waypoint> waypoints;
  control::NavigatorOptions control;
  trial::TrialOptions trial;
  simulation::SimulationOptions simulation;
  hardware::HardwareOptions hardware;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("waypoints", self.waypoints, "the task");
    field("control", self.control, "the controller");
    field("trial", self.trial, "the loop");
    field("simulation", self.simulation, "the simulated robot");
    field("hardware", self.hardware, "of no matter here");
  }
};

inline const std::string kAuthorsRobot = SourceDir() + "/configs/robots/3pi_2040.yaml";

/// The paper's waypoints and a robot file (none: the defaults, which are facts alone), with
/// overrides "a.b=c".
GridStudy LoadGridStudy(const std::string& robot = kAuthorsRobot,
                        const std::vector<std::string>& overrides = {});

/// How a logged path looks, whoever drove it; NaN where a log cannot tell.
struct PathTraits {
  double speed_mps = 0.0;        ///< median over three frames, of those faster than 0.1 m/s
  double weave_m = 0.0;          ///< RMS residual of y on a straight line, evenly by arc length
  double yaw_scatter_rad = 0.0;  ///< standard deviation of the yaw, evenly by arc length
  double length_m = 0.0;         ///< evenly by 20 mm, so that jitter adds little
  double first_motion_s = 0.0;   ///< from the first row to 10 mm away from the start
  trial::LoopDelay delay;
};

PathTraits TraitsOf(const trajectory::Trajectory& log,
                    const std::vector<control::Waypoint>& waypoints,
                    const control::NavigatorOptions& control);

/// One real trial and its simulated twins, one for each seed.
struct GridPair {
  TrialPair files;
  control::NavigatorOptions control;
  trajectory::Trajectory real;
  PathTraits real_traits;
  std::vector<trial::TrialResult> runs;
  std::vector<PathTraits> run_traits;
  std::vector<double> gaps_m;  ///< tag against tag, the first tenth left out
};

/// The first tenth left out, as in the published numbers; everything else as in the paper.
double GapBetween(const trajectory::Trajectory& a, const trajectory::Trajectory& b);

/// The 48 real trials with nothing simulated yet.
std::vector<GridPair> LoadGrid(const GridStudy& study);
/// Starts the robot where each real trial started and drives it once for each seed from 1 on.
void Simulate(const GridStudy& study, int seeds, std::vector<GridPair>& pairs);

/// A group of pairs in one line; all but the counts are of the runs that reached the end, as all
/// real trials did.
struct GridSummary {
  size_t runs = 0;
  size_t reached = 0;
  size_t missed = 0;   ///< runs that did not come within the reach of a waypoint
  size_t circled = 0;  ///< runs half as long again as the longest real path
  double gap_m = 0.0;
  double speed_ratio = 0.0;  ///< simulated over real, of the medians
  double real_delay_s = 0.0, delay_s = 0.0;
  double real_gain = 0.0, gain = 0.0;
  double real_r2 = 0.0, r2 = 0.0;
  double real_weave_m = 0.0, weave_m = 0.0;
  double real_yaw_rad = 0.0, yaw_rad = 0.0;
  double real_length_m = 0.0, length_m = 0.0;
  double real_first_motion_s = 0.0, first_motion_s = 0.0;
  double real_spread_m = 0.0, spread_m = 0.0;  ///< mean gap between repeats of one setting
};

/// Of the pairs of a surface ("ground") or of a v_min ("0.15"), or of all when `group` is empty.
GridSummary Summarise(const std::vector<GridPair>& pairs, const std::string& group);

}  // namespace rift::test
