#include "rift/trajectory/frame_grid.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <tuple>

#include "rift/statistics/descriptive.hpp"
#include "rift/statistics/random.hpp"
#include "support/inputs/trials.hpp"
#include "support/pinned.hpp"

namespace rift::trajectory {
namespace {

/// A robot that waits, drives with a little weave, and stops once.
Eigen::Vector2d At(double t_s) {
  const double driven_s = std::max(0.0, t_s - 0.5) - std::clamp(t_s - 2.0, 0.0, 0.15);
  const double x_m = 0.3 * driven_s + 0.004 * std::sin(4.0 * driven_s);
  return {x_m, 0.01 * std::sin(20.0 * x_m)};
}

struct Made {
  Trajectory log;                  ///< stamped when the pose was found
  std::vector<double> captured_s;  ///< when each frame was taken
};

/// A loop of `loop_s` that takes the newest frame of a camera and stamps the pose 20 ms later.
Made Logged(double period_s, double loop_s, std::uint64_t seed, double duration_s = 5.0) {
  statistics::Random random(seed, 1);
  const double phase_s = period_s * random.Uniform();
  Made made;
  for (double now_s = 0.2; now_s < duration_s; now_s += loop_s + 0.003 * random.Normal()) {
    const double captured_s = phase_s + period_s * std::floor((now_s - phase_s) / period_s);
    if (!made.captured_s.empty() && captured_s <= made.captured_s.back()) continue;
    const Eigen::Vector2d p = At(captured_s);
    made.captured_s.push_back(captured_s);
    made.log.poses.push_back({.t_s = 7.0 + now_s + 0.02 + 0.001 * random.Normal(),
                              .x_m = p.x() + 3e-4 * random.Normal(),
                              .y_m = p.y() + 3e-4 * random.Normal()});
  }
  return made;
}

/// Scatter of what is added to the times of capture, which no constant delay changes.
double ErrorOf_s(const Trajectory& log, const std::vector<double>& captured_s) {
  std::vector<double> errors_s;
  for (size_t i = 0; i < captured_s.size(); ++i) {
    if (captured_s[i] < 0.7) continue;  // a robot at rest tells nothing of its frames
    errors_s.push_back(log.poses[i].t_s - captured_s[i]);
  }
  return statistics::StandardDeviation(errors_s);
}

TEST_CASE("Stamps go back to the frames they were taken on, whatever the loop and the camera") {
  for (const double period_s : {1.0 / 30.0, 1.001 / 30.0, 0.997 / 30.0}) {
    for (const double loop_s : {0.051, 0.058, 0.064}) {
      const Made made = Logged(period_s, loop_s, static_cast<size_t>(1e4 * loop_s));
      const OnFrames found = PutOnFrames(made.log, 30.0);
      INFO("period " << period_s << ", loop " << loop_s << ": " << found.grid.Text());
      CHECK(found.grid.is_found);
      CHECK(found.grid.period_s == Approx(period_s).epsilon(0.002));
      CHECK(ErrorOf_s(made.log, made.captured_s) > 0.008);
      CHECK(ErrorOf_s(found.trajectory, made.captured_s) < 0.0045);
      CHECK(found.grid.Smoother() > 2.0);
      CHECK(found.grid.outside_share < 0.2);
      CHECK(found.grid.outside_share >= 0.0);
    }
  }
}

TEST_CASE("The mean of the stamps stays, they rise, and nothing but them changes") {
  const Made made = Logged(1.0 / 30.0, 0.06, 3);
  const Trajectory after = PutOnFrames(made.log, 30.0).trajectory;
  double change_s = 0.0;
  for (size_t i = 0; i < after.poses.size(); ++i) {
    change_s += after.poses[i].t_s - made.log.poses[i].t_s;
    CHECK(after.poses[i].x_m == made.log.poses[i].x_m);
    CHECK(after.poses[i].Stamp_s() == made.log.poses[i].t_s);  // it is still known when it acted
    if (i > 0) CHECK(after.poses[i].t_s > after.poses[i - 1].t_s);
  }
  CHECK(change_s / static_cast<double>(after.poses.size()) == Approx(0.0).margin(1e-9));
}

TEST_CASE("Rows that are not of the newest frame are a share of all") {
  // Every third stamp is two frames late.
  Made made = Logged(1.0 / 30.0, 0.06, 3);
  for (size_t i = 0; i < made.log.poses.size(); i += 3) made.log.poses[i].t_s += 0.02;
  const OnFrames result = PutOnFrames(made.log, 30.0);
  CHECK(result.grid.outside_share > 0.05);
  CHECK(result.grid.outside_share < 0.6);
}

TEST_CASE("What was done to the stamps, or why nothing was, is told in one line") {
  CHECK(FrameGrid{
            .is_found = true, .period_s = 0.0333, .roughness_before = 0.6, .roughness_after = 0.2}
            .Text() ==
        "stamps put back on frames 33.30 ms apart: speeds from row to row are 3.0 times smoother");
  CHECK(FrameGrid{}.Text() ==
        "no frame grid is looked for in fewer than 12 rows in motion, in more than 100 s, or in so "
        "many rows and frames that it takes minutes: the stamps stay");
  CHECK(FrameGrid{.is_best = false, .roughness_before = 0.6, .roughness_after = 0.2}.Text() ==
        "no frame grid of this rate: one of a rate 10 % off explains the log better: the stamps "
        "stay");
  CHECK(FrameGrid{.is_best = true, .roughness_before = 0.6, .roughness_after = 0.5}.Text() ==
        "no frame grid: with one speeds would be 1.20 times smoother, and 1.5 is asked for: the "
        "stamps stay");
  const Made made = Logged(1.0 / 30.0, 0.06, 3);
  CHECK(OnFramesOf(made.log, 0.0).poses[9].t_s == made.log.poses[9].t_s);
  CHECK(OnFramesOf(made.log, 30.0).poses[9].t_s != made.log.poses[9].t_s);
  CHECK_THROWS_AS(PutOnFrames(made.log, 0.99), std::invalid_argument);
  CHECK_NOTHROW(PutOnFrames(made.log, 1.0));
  CHECK_NOTHROW(PutOnFrames(made.log, 1000.0));
  CHECK_THROWS_WITH(PutOnFrames(made.log, 1001.0),
                    "a frame grid of 1001 frames a second: must be within [1, 1000]");
}

TEST_CASE("A log without a grid keeps its stamps") {
  statistics::Random random(5, 1);
  Trajectory log;
  for (double t_s = 0.2; t_s < 5.0; t_s += 0.05 + 0.012 * random.Uniform()) {
    const Eigen::Vector2d p = At(t_s);
    log.poses.push_back(
        {.t_s = t_s, .x_m = p.x() + 3e-4 * random.Normal(), .y_m = p.y() + 3e-4 * random.Normal()});
  }
  const OnFrames result = PutOnFrames(log, 30.0);
  CHECK_FALSE(result.grid.is_found);
  CHECK(result.grid.Smoother() < 1.0);
  CHECK(result.grid.Text().find("no frame grid") == 0);
  for (size_t i = 0; i < log.poses.size(); ++i) {
    CHECK(result.trajectory.poses[i].t_s == log.poses[i].t_s);
    CHECK(result.trajectory.poses[i].Stamp_s() == log.poses[i].t_s);
  }
}

TEST_CASE("A grid of another rate, a robot at rest and a long log keep their stamps") {
  const Made made = Logged(1.0 / 25.0, 0.058, 6);
  INFO(PutOnFrames(made.log, 30.0).grid.outside_share);
  CHECK_FALSE(PutOnFrames(made.log, 30.0).grid.is_found);
  CHECK(PutOnFrames(made.log, 25.0).grid.is_found);
  Trajectory still = Logged(1.0 / 30.0, 0.058, 7, 0.6).log;
  CHECK_FALSE(PutOnFrames(still, 30.0).grid.is_found);
  CHECK(std::isnan(PutOnFrames(still, 30.0).grid.roughness_after));
  Trajectory late = made.log;
  late.poses.back().t_s += 200.0;
  CHECK(PutOnFrames(late, 25.0).grid.Text().find("more than 100 s") != std::string::npos);
  CHECK_THROWS_AS(PutOnFrames(made.log, 0.0), std::invalid_argument);
  CHECK_THROWS_AS(PutOnFrames(made.log, NAN), std::invalid_argument);
}

TEST_CASE("The authors' logs stand on 30 frames a second: speeds twice as smooth at least") {
  RIFT_SKIP_WITHOUT_TRIALS();
  for (const char* surface : {"ground", "cardboard", "parchment", "downhill", "bump"}) {
    std::vector<double> smoother, periods_s, outside;
    int found = 0;
    const auto logs = test::LogsOn(surface, Format::kTracker);
    for (const test::TrialLog& trial : logs) {
      const FrameGrid grid = PutOnFrames(trial.log, 30.0).grid;
      smoother.push_back(grid.Smoother());
      periods_s.push_back(grid.period_s);
      outside.push_back(grid.outside_share);
      found += grid.is_found;
    }
    INFO(surface << ": " << found << " of " << logs.size() << ", " << statistics::Median(smoother)
                 << " times smoother, period " << 1e3 * statistics::Median(periods_s)
                 << " ms, outside " << statistics::Median(outside));
    CHECK(found >= static_cast<int>(logs.size()) - 1);
    CHECK(statistics::Median(smoother) > 2.0);
    CHECK(statistics::Median(outside) < 0.25);
  }
}

/// At 0.3 m/s, on frames that are two and three apart in turns, stamped evenly, after `still` rows
/// at rest.
Trajectory TwoAndThree(int rows, int still = 0) {
  Trajectory log;
  for (int i = 0; i < rows + still; ++i) {
    const int moving = std::max(0, i - still);
    const int frame = 5 * (moving / 2) + 2 * (moving % 2);
    log.poses.push_back({.t_s = 4.0 + i / 12.0, .x_m = 0.3 * frame / 30.0, .y_m = 1.0});
  }
  return log;
}

TEST_CASE("Roughness is the second difference of speeds over the median, of rows in motion") {
  // Speeds are 0.8 and 1.2 of the mean, in turns: second differences are 0.8 of it.
  for (const int still : {0, 30}) {
    const OnFrames found = PutOnFrames(TwoAndThree(41, still), 30.0);
    CAPTURE(still);
    CHECK(found.grid.roughness_before == Approx(1.4826 * 0.8).epsilon(1e-4));
    CHECK(found.grid.roughness_after == Approx(0.0).margin(1e-6));
    CHECK(found.grid.outside_share == 0.0);
    CHECK(found.grid.is_found);
    CHECK(found.grid.is_best);
    CHECK(found.grid.period_s == Approx(1.0 / 30.0).epsilon(0.0021));
    const auto& poses = found.trajectory.poses;
    for (size_t i = static_cast<size_t>(still) + 2; i < poses.size(); ++i) {
      CHECK((poses[i].t_s - poses[i - 1].t_s) / (poses[i - 1].t_s - poses[i - 2].t_s) ==
            Approx(i % 2 == static_cast<size_t>(still) % 2 ? 1.5 : 1.0 / 1.5));
    }
  }
}

TEST_CASE("Frames of logs with noise, late rows and jumps are those that were approved") {
  std::string text;
  for (const auto& [loop_s, late_s, jump_m] : {std::tuple{0.058, 0.0, 0.0},
                                               {0.047, 0.02, 0.0},
                                               {0.064, -0.012, 0.03},
                                               {0.075, 0.03, 0.01}}) {
    Made made = Logged(1.0009 / 30.0, loop_s, static_cast<size_t>(1e4 * loop_s), 4.0);
    auto& poses = made.log.poses;
    for (size_t i = 4; i < poses.size(); i += 5) poses[i].t_s += late_s;
    for (size_t i = poses.size() / 2; i < poses.size(); ++i) poses[i].y_m += jump_m;
    const OnFrames found = PutOnFrames(made.log, 30.0);
    text += fmt::format(
        "every {} s: {} {} period {:.10f} rough {:.8f} then {:.8f} outside {:.6f}\n", loop_s,
        found.grid.is_found, found.grid.is_best, found.grid.period_s, found.grid.roughness_before,
        found.grid.roughness_after, found.grid.outside_share);
    for (size_t i = 0; i < poses.size(); i += 3) {
      text += fmt::format(" {:.6f}", found.trajectory.poses[i].t_s - poses[i].t_s);
    }
    text += "\n";
  }
  CHECK(test::DifferenceFromPinned("trajectory/frame_grid.txt", text) == "");
}

TEST_CASE("A grid is looked for in twelve steps in motion, and within a hundred seconds") {
  CHECK(std::isnan(PutOnFrames(TwoAndThree(12), 30.0).grid.roughness_before));
  CHECK(PutOnFrames(TwoAndThree(13), 30.0).grid.roughness_before > 0.0);
  CHECK(std::isnan(PutOnFrames(TwoAndThree(12, 20), 30.0).grid.roughness_before));
  for (const auto& [duration_s, is_looked_for] : {std::pair{99.9, true}, {100.1, false}}) {
    Trajectory log = TwoAndThree(21);
    log.poses.back().t_s = log.poses.front().t_s + duration_s;
    CHECK(std::isnan(PutOnFrames(log, 30.0).grid.roughness_before) != is_looked_for);
  }
}

TEST_CASE("No grid is looked for where rows and frames are so many that it takes minutes") {
  Trajectory log;
  for (int i = 0; i < 4000; ++i) log.poses.push_back({.t_s = 0.023 * i, .x_m = 0.007 * i});
  const FrameGrid grid = PutOnFrames(log, 1000.0).grid;
  CHECK(std::isnan(grid.roughness_before));
  CHECK(grid.Text().find("so many rows and frames that it takes minutes") != std::string::npos);
}

}  // namespace
}  // namespace rift::trajectory
