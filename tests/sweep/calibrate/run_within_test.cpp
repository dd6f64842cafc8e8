#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "rift/sweep/calibrate/likeness.hpp"
#include "sweep/calibrate/model.hpp"

namespace rift::sweep {
namespace {

double LengthWithin_m(double longest_m, const SimulatedTrial& twin) {
  return LengthByStrides_m(RunWithin(longest_m, twin));
}

TEST_CASE("A simulated log that makes a detour is driven again, and the last try stands") {
  SimulatedTrial twin{.task =
                          std::vector<control::Waypoint>{{.name = "a", .x_m = 0.0, .y_m = 0.0},
                                                         {.name = "b", .x_m = 0.4, .y_m = 0.0},
                                                         {.name = "c", .x_m = 0.4, .y_m = 0.4}}};
  const double first_m = LengthWithin_m(std::numeric_limits<double>::infinity(), twin);
  CHECK(LengthByStrides_m(Simulate(twin).result.trajectory) == first_m);
  const double last_m = LengthWithin_m(0.0, twin);
  CHECK(last_m != first_m);
  SimulatedTrial tenth = twin;
  tenth.seed += 9'000'000;
  CHECK(LengthByStrides_m(Simulate(tenth).result.trajectory) == last_m);
  CHECK(LengthWithin_m(first_m, twin) == first_m);  // as long as it may be

  const double limit_m = std::nextafter(first_m, 0.0);
  const double again_m = LengthWithin_m(limit_m, twin);
  CHECK(again_m != first_m);
  CHECK((again_m <= limit_m || again_m == last_m));
  CHECK(LengthWithin_m(again_m, twin) <= again_m);
}

}  // namespace
}  // namespace rift::sweep
