#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>

#include "rift/gap/comparison.hpp"
#include "rift/trajectory/log.hpp"
#include "support/inputs/paths.hpp"

namespace rift::gap {
namespace {

using trajectory::Format;
using trajectory::Trajectory;

bool IsDistance(double value_m) { return std::isfinite(value_m) && value_m >= 0.0; }

/// True when it was read and compared; the gap is then a distance.
bool Compares(const std::string& text, Format format, const Trajectory& real,
              const GapOptions& options) {
  try {
    const Trajectory sim = trajectory::ReadLog(text, "log", format).trajectory;
    const Comparison result = Compare(sim, real, options);
    REQUIRE(IsDistance(result.gap_m));
    REQUIRE(result.exact_gap_m >= result.gap_m * (1.0 - 1e-9));
    for (const double value_m :
         {result.exact_gap_m, result.mean_error_m, result.rms_error_m, result.p95_error_m,
          result.start_aligned_gap_m, result.shape_gap_m, result.hausdorff_m, result.frechet_m,
          result.dtw_m, result.equal_time_m, result.start_offset_m, result.end_error_m}) {
      REQUIRE(IsDistance(value_m));
    }
    return true;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

TEST_CASE("The gap of a damaged log is a distance or refused") {
  std::mt19937_64 generator(12);
  const Trajectory real = test::RandomPath(generator, 40), sim = test::RandomPath(generator, 30);
  const std::string rift = trajectory::WriteRift(sim), tum = trajectory::WriteTum(sim);
  const std::string authors =
      "t,x,y,z,roll,pitch,yaw,desired_x,desired_y" + rift.substr(rift.find('\n'));
  const std::pair<const std::string&, Format> logs[] = {{rift, Format::kRift},
                                                        {tum, Format::kTum},
                                                        {authors, Format::kTracker},
                                                        {authors, Format::kWebots},
                                                        {authors, Format::kAuto}};
  for (const auto& [text, format] : logs) {
    int compared = 0;
    for (int i = 0; i < 600; ++i) {
      GapOptions options;
      options.samples = 200;
      options.align = static_cast<Align>(i % 3);
      options.skip_start = i % 2 == 0 ? 0.0 : 0.1;
      options.trim_standstill = i % 5 == 0;
      compared += Compares(test::Damaged(text, generator), format, real, options);
    }
    CHECK(compared > 30);
    CHECK(compared < 590);
  }
}

}  // namespace
}  // namespace rift::gap
