#pragma once

#include <array>
#include <string>
#include <string_view>

#include "rift/statistics/bootstrap_options.hpp"
#include "rift/statistics/two_sample_options.hpp"

namespace rift::gap {

/// What is taken away from the simulated path before it is compared.
enum class Align {
  kNone,   ///< nothing: the paper's definition
  kStart,  ///< the offset of its first point
  kSe2,    ///< the planar rigid motion that fits it best to the real one (least squares)
  kSe3,    ///< the same in space
};

constexpr std::array<std::string_view, 4> EnumNames(Align) {
  return {"none", "start", "se2", "se3"};
}

/// The coordinates that arc length and distances are taken over.
enum class Dimension {
  kXy,   ///< the plane in which a robot drives: the paper's definition
  kXyz,  ///< space, for arms and drones: every pose needs its height
};

constexpr std::array<std::string_view, 2> EnumNames(Dimension) { return {"xy", "xyz"}; }

/// How the Sim-to-Real gap is measured; the defaults are section 3.1 of the paper.
struct GapOptions {
  int samples = 2000;
  double skip_start = 0.0;
  Dimension dimension = Dimension::kXy;
  Align align = Align::kNone;
  double threshold_m = 0.06;
  bool trim_standstill = false;
  double standstill_radius_m = 0.01;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("samples", self.samples, 2, 10'000'000,
          "evenly spaced values of u in [0, 1] (paper, section 3.1)");
    field("skip_start", self.skip_start, 0.0, 0.95,
          "share of the samples left out at the start; the published numbers leave out 0.1");
    field("dimension", self.dimension,
          "coordinates of arc length and distances: xy, or xyz for arms and drones (logs with z)");
    field("align", self.align,
          "what is removed before comparing: nothing, the start offset, the best rigid motion in "
          "the plane (se2, of xy) or in space (se3, of xyz)");
    field("threshold_m", self.threshold_m, 0.0, 1000.0,
          "a gap above this falsifies (paper, section 6.1)");
    field("trim_standstill", self.trim_standstill,
          "drop the samples logged before the robot left its place and after it came to rest");
    field("standstill_radius_m", self.standstill_radius_m, 0.0, 1.0,
          "within this distance of its first or last point the robot counts as standing");
  }
  /// Throws std::invalid_argument for a motion that is not of the dimension.
  void Check() const;

  bool IsInSpace() const { return dimension == Dimension::kXyz; }
};

/// When repeats of a setting decide: a setting is falsified when more than this share of all its
/// runs would fail, passed when fewer would.
struct VerdictOptions {
  double share = 0.1;
  double confidence = 0.95;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("share", self.share, 0.001, 0.999,
          "a setting is falsified when more than this share of its runs is shown to fail, passed "
          "when less is");
    field("confidence", self.confidence, 0.5, 0.999999,
          "of falsified and passed, however often the trials are looked at; among many settings "
          "this share of the decided ones is right");
  }
};

/// The definition in force in one line, to stand beside every number.
/// `tag_offset_m`: how far ahead of the tag the real path was taken.
std::string DefinitionText(const GapOptions& options, double tag_offset_m = 0.0);

/// How likeness is measured; the gap within it has options of its own.
struct LikenessOptions {
  int runs = 1;
  int points = 64;
  int shuffles = 999;
  int speed_stride = 3;
  double moving_mps = 0.1;
  double wavelength_min_m = 0.06;
  double longest_run = 1.5;
  statistics::BootstrapOptions bootstrap;
  statistics::TwoSampleOptions classifier;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field(
        "runs", self.runs, 1, 1000,
        "simulated runs of each real trial of a sweep: its own, and from the second on with seeds "
        "that no other trial has");
    field("points", self.points, 8, 10'000,
          "points along a path, for its weave, its spectrum, the mean path and the test");
    field("shuffles", self.shuffles, 19, 1'000'000, "shuffles of the two-sample test");
    field("speed_stride", self.speed_stride, 1, 1000, "frames over which a speed is taken");
    field("moving_mps", self.moving_mps, 0.0, 100.0, "slower than this counts as standing");
    field("wavelength_min_m", self.wavelength_min_m, 1e-4, 1e3,
          "shortest wavelength of the weave that is looked for");
    field(
        "longest_run", self.longest_run, 1.0, 1e6,
        "a run longer than this many times the longest real path of its setting passed a waypoint "
        "and circled: it counts as failed, as no log shows what became of such trials");
    field("bootstrap", self.bootstrap, "of the intervals over settings");
    field("classifier", self.classifier, "that is to tell simulated from real logs");
  }
};

}  // namespace rift::gap
