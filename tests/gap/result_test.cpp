// Which real logs are copies of which, and the numbers of a result beside each other.
#include "rift/gap/result.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "support/inputs/paths.hpp"

namespace rift::gap {
namespace {

using trajectory::Trajectory;
using Copies = std::vector<std::optional<size_t>>;

/// A metre along x at this height, so far to the left.
Trajectory At(double left_m, double z_m = std::numeric_limits<double>::quiet_NaN()) {
  Trajectory path = test::Moved(test::StraightPath(1.0, 11), {0.0, left_m, 0.0});
  for (auto& pose : path.poses) pose.z_m = z_m;
  return path;
}

TEST_CASE("A copy of a copy that has strayed too far from the first log is another log") {
  // Each is 9 um from the one before: the third is a copy of the second, which is none itself.
  CHECK(CopiesAmong(std::vector{At(0.0), At(0.9e-5), At(1.8e-5)}) ==
        Copies{std::nullopt, 0, std::nullopt});
  CHECK(CopiesAmong(std::vector{At(0.0), At(0.9e-5), At(-0.9e-5), At(0.5)}) ==
        Copies{std::nullopt, 0, 0, std::nullopt});
  const std::vector<Trajectory> distinct =
      Distinct(std::vector{At(0.2), At(0.1), At(0.2), At(0.1), At(0.3)});
  REQUIRE(distinct.size() == 3);
  CHECK(distinct[0].poses[0].y_m == 0.2);
  CHECK(distinct[1].poses[0].y_m == 0.1);
  CHECK(distinct[2].poses[0].y_m == 0.3);
}

TEST_CASE("Logs at two heights are no copies, nor are one with heights and one without") {
  const auto is_copy = [](const Trajectory& a, const Trajectory& b) {
    return CopiesAmong(std::vector{a, b})[1].has_value();
  };
  CHECK(is_copy(At(0.0, 0.5), At(0.0, 0.5)));
  CHECK(is_copy(At(0.0, 0.5), At(0.0, 0.5 + 0.9e-5)));
  CHECK(is_copy(At(0.0, 0.5), At(0.0, 0.5 - 0.9e-5)));
  CHECK_FALSE(is_copy(At(0.0, 0.5), At(0.0, 0.5 + 1.1e-5)));
  CHECK_FALSE(is_copy(At(0.0, 0.5), At(0.0, 0.5 - 1.1e-5)));
  CHECK(is_copy(At(0.0), At(0.0)));
  CHECK_FALSE(is_copy(At(0.0), At(0.0, 0.0)));
  CHECK_FALSE(is_copy(At(0.0, 0.0), At(0.0)));
}

TEST_CASE("A verdict carries what it was judged by and how sure its bounds are") {
  const RepeatVerdict verdict = JudgeCounts(2, 7, {.share = 0.25, .confidence = 0.8});
  CHECK(verdict.above == 2);
  CHECK(verdict.repeats == 7);
  CHECK(verdict.confidence == 0.8);
  CHECK(verdict.settings == 1);
  CHECK(verdict.share_low < 2.0 / 7.0);
  CHECK(verdict.share_high > 2.0 / 7.0);
  // A higher confidence has wider bounds.
  const RepeatVerdict surer = JudgeCounts(2, 7, {.share = 0.25, .confidence = 0.99});
  CHECK(surer.share_low < verdict.share_low);
  CHECK(surer.share_high > verdict.share_high);
  // All runs that fail leave no room above, and none that does no room below.
  CHECK(JudgeCounts(5, 5, {}).share_high == 1.0);
  CHECK(JudgeCounts(0, 5, {}).share_low == 0.0);
}

}  // namespace
}  // namespace rift::gap
