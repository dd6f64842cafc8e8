#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "rift/experiment/parameter.hpp"
#include "rift/trajectory/log.hpp"

namespace rift::experiment {

enum class Goal {
  kGrid,       ///< every combination of the levels
  kFalsify,    ///< where the gap is largest
  kCalibrate,  ///< the simulator that predicts the logs
};
constexpr std::array<std::string_view, 3> EnumNames(Goal) {
  return {"grid", "falsify", "calibrate"};
}

enum class ReferenceKind {
  kPath,     ///< the polyline through the waypoints
  kNominal,  ///< a simulated run with the experiment's own values
  kLogs,
};
constexpr std::array<std::string_view, 3> EnumNames(ReferenceKind) {
  return {"path", "nominal", "logs"};
}

enum class CandidateKind { kSimulation, kLogs };
constexpr std::array<std::string_view, 2> EnumNames(CandidateKind) {
  return {"simulation", "logs"};
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

/// Which repeats of the reference there are: `trials: [1, 2, 3]`, or a count.
struct TrialList {
  std::vector<std::string> names{"1"};
};

/// What the candidate is compared with: the truth.
struct ReferenceOptions {
  ReferenceKind kind = ReferenceKind::kPath;
  PathTemplate path;
  TrialList trials;
  trajectory::Format format = trajectory::Format::kAuto;
  double tag_offset_m = 0.0;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("kind", self.kind, "waypoint path, a run with nominal values, or recorded logs");
    field("path", self.path, "of the logs, such as real/{surface}_{trial}.csv");
    field("trials", self.trials, "repeats of every setting: their names, or how many");
    field("format", self.format, "dialect of the logs");
    field(
        "tag_offset_m", self.tag_offset_m, -1.0, 1.0,
        "moves the logs forward along their yaw, from the tag to the robot's front (paper: 0.03)");
  }
};

/// What is put to the test: the simulator.
struct CandidateOptions {
  CandidateKind kind = CandidateKind::kSimulation;
  PathTemplate path;
  trajectory::Format format = trajectory::Format::kAuto;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("kind", self.kind, "the simulator of rift, or recorded logs");
    field("path", self.path, "of the logs, such as webots/{surface}.csv");
    field("format", self.format, "dialect of the logs");
  }
};

}  // namespace rift::experiment
