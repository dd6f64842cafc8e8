#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "rift/sweep/result.hpp"
#include "rift/trajectory/log.hpp"

namespace rift::sweep {

enum class Goal { kGrid };
constexpr std::array<std::string_view, 1> EnumNames(Goal) { return {"grid"}; }

enum class ReferenceKind { kLogs };
constexpr std::array<std::string_view, 1> EnumNames(ReferenceKind) { return {"logs"}; }

enum class CandidateKind { kLogs };
constexpr std::array<std::string_view, 1> EnumNames(CandidateKind) { return {"logs"}; }

/// A file name, or a template of one over the names of the parameters and {trial}. In a YAML file
/// it is relative to that file.
struct PathTemplate {
  std::string text;
};

/// Which repeats of the reference there are: `trials: [1, 2, 3]`, or a count.
struct TrialList {
  std::vector<std::string> names{"1"};
};

/// The axes of the parameter space: `space: {control.v_min: [0.15, 0.20]}`.
struct Space {
  std::vector<Parameter> parameters;
};

/// What the candidate is compared with: the truth.
struct ReferenceOptions {
  ReferenceKind kind = ReferenceKind::kLogs;
  PathTemplate path;
  TrialList trials;
  trajectory::Format format = trajectory::Format::kAuto;
  double tag_offset_m = 0.0;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("kind", self.kind, "where the reference trajectories come from");
    field("path", self.path, "of the logs, such as real/{surface}_{trial}.csv");
    field("trials", self.trials, "repeats of every setting: their names, or how many");
    field("format", self.format, "dialect of the logs");
    field("tag_offset_m", self.tag_offset_m, -1.0, 1.0,
          "moves the logs forward along their yaw, from the tag to the robot's front (paper: 0.03)");
  }
};

/// What is put to the test: the simulator.
struct CandidateOptions {
  CandidateKind kind = CandidateKind::kLogs;
  PathTemplate path;
  trajectory::Format format = trajectory::Format::kAuto;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("kind", self.kind, "where the candidate trajectories come from");
    field("path", self.path, "of the logs, such as webots/{surface}.csv");
    field("format", self.format, "dialect of the logs");
  }
};

}  // namespace rift::sweep
