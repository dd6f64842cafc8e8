#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <vector>

#include "rift/gap/comparison.hpp"
#include "rift/report/json/json.hpp"
#include "rift/statistics/descriptive.hpp"
#include "support/inputs/paths.hpp"

namespace rift::commands {
namespace {

/// 1, 2, ..., 10: the p95 is 9.55, and was 9, 10 or 9.55 when every room had its own.
std::vector<double> OneToTen() { return {7.0, 1.0, 10.0, 4.0, 9.0, 2.0, 6.0, 3.0, 8.0, 5.0}; }

constexpr double kMedian = 5.5, kP95 = 9.55;

TEST_CASE("Quantiles of one list are the same number in gap and track and drive") {
  // The ten errors between two straight paths that part at an angle are 0, 1, ..., 9 ninths.
  const trajectory::Trajectory ahead = test::StraightPath(1.0, 10);
  const gap::Comparison parting =
      gap::Compare(ahead, test::Moved(ahead, {0.0, 0.0, 0.1}), {.samples = 10});
  CHECK(parting.median_error_m == Approx(0.5 * parting.gap_m));
  CHECK(parting.p95_error_m == Approx(0.95 * parting.gap_m));

  vision::TrackRun track;
  track.latencies_s = OneToTen();
  const std::string text = report::TrackText(track, 10);
  CHECK_THAT(text, Catch::Contains("p50 5500 ms, p95 9550 ms"));

  hardware::DriveRun drive;
  for (const double latency_s : OneToTen()) {
    hardware::PoseStages stages;
    stages.captured_s = 100.0;
    stages.written_s = 100.0 + latency_s;
    drive.evidence.poses.push_back(stages);
  }
  CHECK_THAT(report::DriveText({}, drive), Catch::Contains("p50 5500.0 ms, p95 9550.0"));
  const auto json = nlohmann::json::parse(report::DriveJson({}, drive));
  CHECK(json["latency"]["capture_to_command"]["p95_s"] == Approx(kP95));

  CHECK(statistics::Median(OneToTen()) == Approx(kMedian));
  CHECK(statistics::Quantile(OneToTen(), 0.95) == Approx(kP95));
}

}  // namespace
}  // namespace rift::commands
