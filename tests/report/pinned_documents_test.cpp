// Documents and terminal texts beside those that were approved (tests/pinned), made of values of
// which no two are alike, so that no field can stand for another.

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <random>

#include "rift/gap/result.hpp"
#include "rift/report/figures/figures.hpp"
#include "rift/report/json/fields.hpp"
#include "rift/report/json/json.hpp"
#include "rift/report/json/precision.hpp"
#include "rift/report/text/text.hpp"
#include "rift/sweep/calibrate/drive_features.hpp"
#include "support/pinned.hpp"
#include "synthetic_sweep.hpp"

namespace rift::report {
namespace {

using test::DifferenceFromPinned;

/// 0.1037, 0.1274, 0.1511, ...: each call another number.
class Numbers {
 public:
  double operator()() { return 0.08 + 0.0237 * ++count_; }
  statistics::Interval Interval() {
    const double low = (*this)();
    return {low, low + 0.5};
  }
  int Count() { return ++count_ + 2; }

 private:
  int count_ = 0;
};

gap::Likeness PathLikeness(Numbers& next) {
  const auto both = [&] { return gap::BothSides{next(), next(), next.Interval()}; };
  gap::Likeness path{.reals = static_cast<size_t>(next.Count()),
                     .sims = static_cast<size_t>(next.Count())};
  path.spread_m = both();
  path.weave_m = both();
  path.speed_mps = both();
  path.wavelength_m = both();
  for (double* value : {&path.mean_gap_m, &path.mean_path_gap_m, &path.energy_m, &path.energy_p,
                        &path.inside_share, &path.inside_expected}) {
    *value = next();
  }
  return path;
}

statistics::TwoSampleTest Test(Numbers& next) {
  statistics::TwoSampleTest test;
  test.first = static_cast<size_t>(next.Count());
  test.second = static_cast<size_t>(next.Count());
  test.groups = static_cast<size_t>(next.Count());
  test.accuracy = next();
  test.accuracy_interval = next.Interval();
  test.p = next();
  const size_t features = sweep::DriveFeatures().size();
  for (const size_t feature : {features - 1, size_t{0}, size_t{2}}) {
    const double low = feature == 2 ? 0.5 : 0.51;
    test.features.push_back({feature, next(), {low, low + 0.3}, next()});
  }
  return test;
}

sweep::DriveLikeness Drives(Numbers& next) {
  const auto both = [&] { return gap::BothSides{next(), next()}; };
  sweep::DriveLikeness likeness;
  likeness.path = PathLikeness(next);
  likeness.loop_delay_s = both();
  likeness.loop_r2 = both();
  likeness.steering_gain_rad_s = both();
  likeness.runs = next.Count();
  likeness.circled_runs = next.Count();
  likeness.failed_runs = next.Count();
  likeness.prediction = {static_cast<size_t>(next.Count()), next(), next(), next(),
                         next.Interval()};
  likeness.ranks = {static_cast<size_t>(next.Count()), next(), next.Interval(), next(),
                    next.Interval()};
  likeness.told_apart = {Test(next), Test(next), {}};
  for (size_t i = 0; i < sweep::DriveFeatures().size(); ++i) {
    likeness.told_apart.features.push_back({both(), both()});
  }
  return likeness;
}

TEST_CASE("Likeness is told field by field as it was approved") {
  Numbers next;
  std::vector<sweep::GroupLikeness> groups{{"ground", Drives(next)}, {"all", Drives(next)}};
  groups.push_back({"nothing is known", {}});
  std::string text = LikenessText(groups) + Dump(LikenessJson(groups));
  text += LikenessText(groups[0].likeness.path) + LikenessText(gap::Likeness{});
  groups.resize(2);
  CHECK(DifferenceFromPinned("report/likeness.txt", text + LikenessText(groups)) == "");
}

sweep::ErrorStructure Structure(Numbers& next) {
  return {static_cast<size_t>(next.Count()),
          next(),
          next(),
          next(),
          next(),
          next(),
          next(),
          next(),
          next(),
          next(),
          next(),
          next(),
          next()};
}

sweep::CalibrationReport Calibrated(Numbers& next) {
  sweep::CalibrationReport report;
  sweep::Calibration& fit = report.calibration;
  const char* keys[] = {"simulation.link.delay_s", "simulation.motor.left_gain",
                        "simulation.motor.right_gain", "simulation.terrain.friction"};
  for (int i = 0; i < 4; ++i) {
    sweep::CalibratedParameter p;
    p.parameter.key = keys[i];
    p.parameter.start = next();
    p.parameter.min = next();
    p.parameter.max = next() + 2.0;
    p.parameter.prior_mean = next();
    p.parameter.prior_sd = i == 1 ? 0.4 : 0.0;
    p.value = next();
    p.low = next();
    p.high = next();
    p.has_effect = i != 2;
    p.is_at_bound = i >= 2;
    p.is_identified = i == 0;
    p.is_from_prior = i == 1;
    fit.parameters.push_back(p);
    report.values.push_back(p.value);
    report.agreement.push_back({{next(), next(), next()}, next(), i % 2 == 0});
  }
  fit.correlation.resize(4, 4);
  fit.correlation << 1, 0.71, -0.2, 0.1, 0.71, 1, -0.93, 0.69, -0.2, -0.93, 1, NAN, 0.1, 0.69, NAN,
      1;
  fit.loss_before = 2.5;
  fit.loss_after = 1.25;
  fit.steps = 9;
  fit.trials_simulated = 321;
  report.trials = {{"ground", "1", "real/a.csv", false, next(), next()},
                   {"ice", "2", "real/b.csv", true, next(), gap::kNotComputed},
                   {"ice", "3", "real/c.csv", true, next(), next()}};
  report.missing = {"real/d.csv is not there"};
  report.judged = {{"ground", "fitted", Drives(next), Drives(next)},
                   {"all", "held out", Drives(next), Drives(next)}};
  report.errors = {{"fitted", Structure(next), Structure(next)},
                   {"held out", Structure(next), Structure(next)}};
  report.shown = 1;
  report.shown_real = synthetic::Path(0.1);
  report.shown_before = {synthetic::Path(0.02), synthetic::Path(0.03)};
  report.shown_after = {synthetic::Path(0.08)};
  return report;
}

TEST_CASE("A calibration is told and drawn as it was approved") {
  Numbers next;
  sweep::CalibrationReport report = Calibrated(next);
  experiment::Experiment experiment;
  experiment.name = "calibrated";
  experiment.calibrate.method.confidence = 0.9;
  std::string text = CalibrationText(report) + CalibrationJson(experiment, report);
  report.calibration.has_converged = true;
  report.agreement.clear();
  text += CalibrationText(report);
  for (sweep::CalibratedParameter& p : report.calibration.parameters) {
    for (int flags = 0; flags < 16; ++flags) {
      p.has_effect = (flags & 1) == 0;
      p.is_at_bound = (flags & 2) != 0;
      p.is_identified = (flags & 4) == 0;
      p.is_from_prior = (flags & 8) != 0;
      if (&p == &report.calibration.parameters[0]) text += fmt::format("{} {}\n", flags, FlagOf(p));
    }
  }
  const std::optional<Figure> figure = CalibrationFigure("calibrated", report);
  REQUIRE(figure);
  text += figure->title + "\n" + figure->plot;
  const char* keys[] = {"simulation.link.delay_s", "simulation.motor.mismatch",
                        "simulation.motor.lag_s", "simulation.motor.dead_band"};
  for (size_t i = 0; i < 4; ++i) {
    experiment.calibrate.fit.list.push_back({.key = keys[i]});
    report.calibration.parameters[i].parameter.key = keys[i];
  }
  report.calibration.parameters[2].has_effect = false;
  report.calibration.parameters[2].is_from_prior = false;
  experiment.trial.timeout_s += 1.5;
  report.values = {0.03, 0.04, 0.17, 0.055};
  text += RobotYaml(experiment, report, "abc1  logs/a/real1.csv\nno two words\nabc2  real2.csv\n",
                    "/somewhere/fit.yaml");
  CHECK(DifferenceFromPinned("report/calibration.txt", text) == "");

  sweep::CalibratedParameter& untold = report.calibration.parameters[2];
  untold.value = untold.parameter.start;
  CHECK_THAT(RobotYaml(experiment, report, "", "fit.yaml"),
             Catch::Contains("lag_s: 0.17  # kept: the logs do not depend on it\n"));

  experiment.calibrate.method.features = {.rounds = 3, .draws = 250};
  const std::string by_features = RobotYaml(experiment, report, "", "fit.yaml");
  CHECK_THAT(by_features,
             Catch::Contains("then features of whole drives,\n# 3 rounds of 250 draws; "
                             "intervals: posterior.\n"));
  CHECK_THAT(by_features, !Catch::Contains("bootstrap"));
}

/// A path that no motion and no exchange of its axes maps onto itself.
trajectory::Trajectory Crooked(double amplitude_m, double shift_m) {
  trajectory::Trajectory path;
  for (int i = 0; i <= 60; ++i) {
    const double u = i / 60.0;
    trajectory::StampedPose pose;
    pose.t_s = 0.1 * i + 0.02 * i * u;
    pose.x_m = 1.7 * u + shift_m;
    pose.y_m = amplitude_m * std::sin(5.0 * u) + 0.3 * u * u - 0.5 * shift_m;
    pose.yaw_rad = std::atan2(5.0 * amplitude_m * std::cos(5.0 * u) + 0.6 * u, 1.7);
    pose.target_x_m = i < 20 ? 0.6 : 1.7;
    pose.target_y_m = i < 20 ? 0.1 : 0.4;
    path.poses.push_back(pose);
  }
  return path;
}

TEST_CASE("A gap between two crooked logs is told and drawn as it was approved") {
  gap::GapResult result;
  result.options = {.samples = 40, .skip_start = 0.1, .threshold_m = 0.05};
  result.tag_offset_m = 0.025;
  result.sim_path = "sim/a.csv";
  result.sim = Crooked(0.2, 0.0);
  for (const double amplitude_m : {0.23, 0.29, 0.21}) {
    result.reals.push_back(Crooked(amplitude_m, 0.03));
    result.trials.push_back({fmt::format("real/{}.csv", result.reals.size()),
                             gap::Compare(result.sim, result.reals.back(), result.options)});
  }
  result.trials[1].comparison.max_yaw_error_rad = gap::kNotComputed;
  gap::Judge(result);
  std::string text = GapText(result) + GapJson(result) + ProfileCsv(result);
  Numbers next;
  result.likeness = PathLikeness(next);
  text += GapText(result) + GapJson(result);
  text += GapFigure(result).plot;
  std::vector<ComparedPair> pairs;
  for (size_t i = 0; i < 2; ++i) {
    pairs.push_back(
        ComparePair("sim", result.sim, result.trials[i].path, result.reals[i], result.options));
  }
  for (const Figure& figure : GapFigures(pairs, result.options)) {
    text += fmt::format("{} {} {}\n{}\n", figure.name, figure.title, figure.height_px, figure.plot);
  }
  result.trials.resize(1);
  result.reals.resize(1);
  gap::Judge(result);
  CHECK(DifferenceFromPinned("report/gap.txt", text + GapText(result)) == "");
}

TEST_CASE("A simulated trial is drawn with the data, axes and units approved") {
  SimulatedTrial trial;
  trial.name = "crooked & bent";
  trial.truth = Crooked(0.2, 0.0);
  for (size_t i = 0; i < trial.truth.poses.size(); ++i) {
    trial.truth.poses[i].z_m = 0.1 + 0.003 * static_cast<double>(i % 7);
  }
  trial.logged = Crooked(0.21, 0.03);
  std::vector<double> left, right;
  for (size_t i = 0; i < trial.logged.poses.size(); ++i) {
    left.push_back(0.2 + 0.001 * static_cast<double>(i));
    right.push_back(0.4 - 0.002 * static_cast<double>(i));
  }
  trial.logged.channels = {{"power_left", left}, {"power_right", right}};
  trial.waypoints = {{"start", {0.0, 0.1}}, {"goal", {1.7, 0.4}}};
  trial.areas = {{"slope", 0.1, 0.9, -0.3, 0.5}, {"elsewhere", 5.0, 6.0, 5.0, 6.5}};
  trial.ground_xz_m = {{-0.05, 0.2}, {0.4, 0.184}, {1.9, 0.059}};
  const Figure figure = SimulationFigure(trial);
  CHECK(DifferenceFromPinned("report/simulation_figure.txt",
                             fmt::format("{} {} {} x {}\n{}", figure.name, figure.title,
                                         figure.width_px, figure.height_px, figure.plot)) == "");
}

odometry::RunMeasures Run(Numbers& next) {
  odometry::RunMeasures run;
  for (double* value : {&run.length_m, &run.deviation_m, &run.largest_deviation_m, &run.end_error_m,
                        &run.drift_per_m, &run.odometry_gap_m, &run.yaw_drift_rad, &run.slip_left,
                        &run.slip_right}) {
    *value = next();
  }
  run.slip = {{0.25, next(), next()}, {0.75, next(), next()}};
  return run;
}

odometry::CellMeasures Cell(Numbers& next, size_t moved) {
  odometry::CellMeasures cell{.runs = 5, .moved = moved};
  cell.deviation_interval_m = next.Interval();
  for (double* value : {&cell.deviation_m, &cell.spread_m, &cell.drift_per_m, &cell.odometry_gap_m,
                        &cell.slip_left, &cell.slip_right}) {
    *value = next();
  }
  cell.slip = {{0.25, next(), next()}, {0.75, next(), next()}};
  return cell;
}

TEST_CASE("Odometry and programs are told field by field as they were approved") {
  Numbers next;
  odometry::OdometryResult result;
  result.runs = {{"a", Run(next)}, {"b", Run(next)}, {"still", {.did_move = false}}};
  result.runs.push_back({"bare", {.length_m = 0.7}});
  result.cell = Cell(next, 3);
  result.umbmark = odometry::Umbmark{2, 3, {next(), -next()}, {-next(), next()}, next()};
  odometry::OdometryCalibration found;
  found.wheel_radius_m = {next(), next.Interval(), true};
  found.right_over_left = {next(), next.Interval(), true};
  found.track_m = {next(), next.Interval(), true};
  found.tag_ahead_m = {next(), next.Interval(), false};
  found.noise_m = next();
  found.noise_yaw_rad = next();
  found.runs = 4;
  found.windows = 37;
  result.calibration = found;
  result.confidence = 0.9;
  std::string text = OdometryText(result) + OdometryJson(result);
  result.calibration->track_m.is_told = false;
  result.cell->moved = 0;
  result.umbmark.reset();
  text += OdometryText(result);
  result.calibration.reset();
  result.cell.reset();
  text += OdometryJson(result);
  const sweep::SweepResult grid = synthetic::Grid();
  std::vector<sweep::ProgramCell> cells;
  for (const size_t row : {0, 2, 4, 8, 10}) {
    cells.push_back({grid.rows[row].theta, Cell(next, row == 8 ? 1 : 4), {Run(next)}, {}});
  }
  cells.back().lost = {"no log"};
  cells[1].measures = {};
  text += ProgramText(grid.parameters, cells) + ProgramsJson(grid.parameters, cells);
  CHECK(DifferenceFromPinned("report/odometry.txt", text) == "");
}

hardware::DriveRun Driven(Numbers& next) {
  hardware::DriveRun run;
  run.has_begun = true;
  hardware::PingResult& ping = run.ping;
  ping = {hardware::Protocol::kFramed, 200, 187, 0.065, 4, 0.031, 0.052, 0.067, 0.081, 0.006, 5.21};
  run.latency = hardware::LatencyResult{{next(), next(), next(), next(), next()}, next(), next()};
  run.camera_latency_s = next();
  run.stopping_distance_m = next();
  trial::TrialResult& result = run.trial;
  result.outcome = trial::Outcome::kTimedOut;
  result.reason = "not at the goal in time";
  result.start_s = 1.5;
  result.driving_s = 2.0;
  result.end_s = 9.25;
  result.visits = {{"b", 4.5, 0.012}, {"c", {}, 0.31}, {"d", {}, {}}};
  result.trajectory = Crooked(0.2, 0.0);
  result.commands = {{1.75, {0.25, -0.5}}, {2.0, {0.75, 0.125}}};
  result.poses_refused = 3;
  result.poses_believed = result.trajectory.poses.size();
  result.stale_decisions = 5;
  result.limits.decisions = 77;
  result.limits.largest_raw_v = next();
  result.limits.largest_raw_w = next();
  size_t count = 20;
  trial::LimitCounts::Fields(result.limits, [&](const char*, size_t& n) { n = ++count; });
  run.evidence.stop = hardware::DriveStop{hardware::StopReason::kTagLost, "the tag was lost", 8.5};
  run.evidence.sent = 400;
  run.evidence.answered = 390;
  run.evidence.rejected_by_robot = 2;
  for (int i = 0; i < 30; ++i) {
    const double t_s = 0.05 * i;
    run.evidence.poses.push_back({t_s, t_s + 0.020 + 0.0001 * i * i, t_s + 0.03 + 0.0002 * i * i,
                                  t_s + 0.05 + 0.0003 * i * i, t_s + 0.056 + 0.0005 * i * i,
                                  t_s + 0.06 + 0.0007 * i * i, i < 20 ? t_s + 0.09 : -1.0});
  }
  return run;
}

TEST_CASE("Drives and pings are told field by field as they were approved") {
  Numbers next;
  hardware::DriveRun run = Driven(next);
  experiment::Experiment experiment;
  experiment.name = "driven";
  experiment.waypoints = {{.name = "start", .heading_deg = 0.0},
                          {.name = "a", .x_m = 0.2},
                          {.name = "b", .x_m = 0.4},
                          {.name = "c", .x_m = 0.6, .stop = true}};
  experiment.hardware.ping.max_loss = 0.05;
  experiment.control.v_max = 0.7;
  std::string text = DriveJson(experiment, run) + StagesCsv(run.evidence) + CommandsCsv(run.trial);
  for (const std::optional<bool>& acknowledged : {std::optional<bool>(), {true}, {false}}) {
    run.evidence.stop_acknowledged = acknowledged;
    run.dry_run = acknowledged.has_value();
    text += DriveText(experiment, run);
  }
  text += PingText(run.ping, experiment.hardware) + PingJson(run.ping, experiment.hardware);
  run.ping = {.protocol = hardware::Protocol::kPlain};
  text += PingText(run.ping, experiment.hardware) + PingJson(run.ping, experiment.hardware);
  text += InterruptedDriveJson(experiment);
  text += DriveEnding(DriveJson(experiment, run)) + "\n";
  text += DriveEnding(InterruptedDriveJson(experiment)) + "\n" + DriveEnding("[]") + "\n";
  const sweep::SimulatedRun simulated{run.trial, Crooked(0.3, 0.0), {}};
  text += SimulationText(experiment, simulated) + SimulationJson(experiment, simulated);
  run.evidence = {};
  run.latency.reset();
  run.camera_latency_s.reset();
  text += DriveJson(experiment, run, RunState::kInterrupted) + DriveText(experiment, run);
  sweep::SimulatedRun unlimited = simulated;
  unlimited.result.limits.v_max = 0;
  text += SimulationText(experiment, unlimited);
  CHECK(DifferenceFromPinned("report/drive.txt", text) == "");
}

TEST_CASE("Misses of one tag are of the pictures, and of several of all looks for them") {
  vision::TrackRun run;
  run.frames = 10;
  run.misses = {0, 3, 0, 5};
  const auto text = [&run](int states_of_first) {
    run.states = {states_of_first, 0, 0, 8};
    return TrackText(run, 1);
  };
  CHECK(text(12).find("10 pictures, a tag of several missed 8 of 20 times (3 ") !=
        std::string::npos);
  CHECK(text(3).find("10 pictures, a tag of several missed 8 of 11 times (3 ") !=
        std::string::npos);
  CHECK(text(2).find("10 pictures, 8 without the tag (3 ") != std::string::npos);
}

TEST_CASE("Tracking, precision and a sweep's status are told as they were approved") {
  vision::TrackRun run;
  run.state = vision::CameraState::kEnded;
  run.reason = "the last picture was read";
  run.status = {vision::CameraState::kEnded, "", 29.5, 0.03, 120, 7, 5, 2};
  run.frames = 113;
  run.misses = {0, 3, 0, 4, 5, 0, 1, 2};
  run.states = {60, 20, 10, 8};
  run.repeated = 1;
  run.most_tags_of_this_id = 2;
  run.zero_s = 1000.5;
  run.first_t_s = 0.25;
  run.last_t_s = 4.75;
  for (int i = 1; i <= 40; ++i) {
    run.latencies_s.push_back(0.02 + 0.0001 * i * i);
    run.costs_s.push_back(0.001 + 0.00002 * i * i);
  }
  run.moved_m = 0.0042;
  vision::CameraModel camera{.name = "c", .width_px = 640, .height_px = 480};
  const TrackInputs inputs{"cam.mp4", "camera.yaml", "abcd", {}};
  std::string text = TrackText(run, 91) + TrackJson(inputs, camera, {}, run, 91);
  camera.world = vision::WorldFrame{.residual_m = 0.0013, .origin = "4 reference tags"};
  run.misses = {};
  run.status.skipped = run.status.reconnects = 0;
  run.is_recording = true;
  run.latencies_s.clear();
  run.moved_m.reset();
  text += TrackText(run, 1) + TrackJson(inputs, camera, {}, run, 1);
  run.frames = 0;
  text += TrackText(run, 0);

  vision::Sighting sighting{.tag_id = 3, .frame_index = 17, .captured_s = 2.5};
  sighting.map_from_tag.translation() = Eigen::Vector3d(0.25, -0.5, 0.75);
  sighting.map_from_tag.linear() = (Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()) *
                                    Eigen::AngleAxisd(-0.2, Eigen::Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()))
                                       .toRotationMatrix();
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 6; ++k) sighting.covariance(i, k) = 0.01 * (10 * i + k);
  }
  sighting.hamming = 1;
  sighting.decision_margin = 41.0;
  sighting.edge_px = 0.11;
  sighting.reprojection_px = 0.12;
  sighting.other_reprojection_px = 0.93;
  sighting.tags_of_this_id = 2;
  sighting.latency_s = 0.034;
  text += SightingsHeader();
  for (int state = 0; state < 4; ++state) {
    sighting.state = static_cast<vision::TrackState>(state);
    sighting.is_on_floor = state == 2;
    text += SightingRow(1.5 + state, sighting);
  }

  vision::PrecisionMap map{.columns = 3, .rows = 2, .least_side_px = 19.0};
  for (int i = 0; i < 6; ++i) {
    vision::PrecisionPlace place;
    place.at_px = {100.0 * (i % 3), 77.0 * (i / 3)};
    if (i != 4) place.floor_m = Eigen::Vector2d(0.3 * (i % 3) - 0.2, 0.7 - 0.4 * (i / 3));
    place.side_px = 20.0 + i;
    place.views = 8;
    place.found = i == 1 ? 5 : 8;
    for (int k = 1; k <= 8; ++k) {
      place.off_m.push_back(0.0001 * k * (i + 1));
      place.yaw_off_rad.push_back(0.002 * k * k);
    }
    place.shift_by_height = 0.2 + 0.03 * i;
    if (i != 2) place.least_size_m = 0.02 + 0.003 * i;
    map.places.push_back(place);
  }
  text += PrecisionText(map, {}) + PrecisionJson(map, {}, {});
  text += PrecisionText({.columns = 1, .rows = 1, .places = {vision::PrecisionPlace{}}}, {});

  sweep::JournalSummary summary;
  summary.notes = {
      {"name", "night"}, {"most_trials", "90"}, {"most_settings", "30"}, {"elapsed_s", "12.5"}};
  summary.trials_by_status = {{"ok", 41}, {"fell", 3}, {"hung", 1}};
  summary.falsified = 6;
  summary.damaged = 2;
  summary.largest_gap_m = 0.0813;
  summary.largest_key = "v=0.2";
  text += StatusText(summary, "running") + StatusJson(summary, "running");
  summary.notes.erase("most_settings");
  summary.largest_gap_m.reset();
  summary.damaged = 0;
  text += StatusText(summary, "done") + StatusJson(summary, "done");
  CHECK(DifferenceFromPinned("report/tracking.txt", text) == "");
}

}  // namespace
}  // namespace rift::report
