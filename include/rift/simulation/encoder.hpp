#pragma once

#include <cstdint>
#include <optional>

namespace rift::simulation {

struct EncoderOptions {
  bool reported = true;
  std::optional<double> counts_per_rev;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("reported", self.reported, "whether the robot sends its counts back");
    field("counts_per_rev", self.counts_per_rev, 1.0, 100'000.0,
          "counts for each turn of the wheel; none: 12 x gear ratio (358.3 at 30:1, Pololu "
          "0J86/6.4)");
  }
};

/// The count a quadrature encoder shows once its wheel has turned by `angle_rad` since the start:
/// the last whole edge passed, in either direction.
std::int64_t CountsAt(double angle_rad, double counts_per_rev);

}  // namespace rift::simulation
