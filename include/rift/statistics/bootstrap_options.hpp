#pragma once

namespace rift::statistics {

/// How often groups are drawn anew, and how sure the interval is.
struct BootstrapOptions {
  int resamples = 1000;
  double confidence = 0.95;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("resamples", self.resamples, 20, 1'000'000,
          "draws of the settings, with replacement, behind the intervals");
    field("confidence", self.confidence, 0.5, 0.9999, "of the intervals");
  }
};

}  // namespace rift::statistics
