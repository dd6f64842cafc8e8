// What a drive and a ping say of what was measured and what was not.

#include <catch2/catch.hpp>

#include "rift/report/json/json.hpp"
#include "rift/report/text/text.hpp"

namespace rift::report {
namespace {

using Catch::Contains;

hardware::DriveRun RunOf(const std::optional<hardware::LoopDelay>& delay) {
  hardware::DriveRun run;
  run.evidence.poses.push_back({.captured_s = 1.0, .written_s = 1.004});
  if (delay) run.latency = hardware::LatencyResult{*delay};
  return run;
}

TEST_CASE("A time from capture is claimed only where the camera's own delay was measured") {
  CHECK_THAT(DriveText({}, RunOf(hardware::LoopDelay{.camera_s = 0.03, .total_s = 0.1})),
             Contains("\ncapture to command p50 4.0 ms, p95 4.0, p99 4.0\n"));
  CHECK_THAT(
      DriveText({}, RunOf(hardware::LoopDelay{.total_s = 0.1, .camera_most_s = 0.09})),
      Contains("\ntime stamp to command p50 4.0 ms, p95 4.0, p99 4.0; the stamps may be up to 90 "
               "ms late\n"));
  CHECK_THAT(DriveText({}, RunOf({})),
             Contains("\ntime stamp to command p50 4.0 ms, p95 4.0, p99 4.0; how late the stamps "
                      "are was not measured\n"));
}

TEST_CASE("What makes up for a loop delay is told with the robot that it has to predict") {
  const hardware::DriveRun run = RunOf(hardware::LoopDelay{.total_s = 0.1});
  experiment::Experiment experiment;
  experiment.hardware.odometry.drive = {0.035, 0.141, 25.1};
  CHECK_THAT(DriveText(experiment, run),
             Contains("to make up for it: --set control.latency.delay_s=0.100 --set "
                      "control.latency.drive.wheel_radius_m=0.035 --set "
                      "control.latency.drive.track_m=0.141 --set "
                      "control.latency.drive.full_power_speed_rad_s=25.1\n"));
  experiment.control.latency.drive = {0.035, 0.083, 25.1};
  CHECK_THAT(DriveText(experiment, run), Contains("control.latency.delay_s=0.100 --set "
                                                  "control.latency.drive.track_m=0.141\n"));
  experiment.control.latency.drive.track_m = 0.141;
  CHECK_THAT(DriveText(experiment, run), Contains("control.latency.delay_s=0.100\n"));
}

TEST_CASE("A ping sets the simulated link without the bytes that its baud adds, in both outputs") {
  const hardware::PingResult ping{hardware::Protocol::kFramed, 100, 98, 0.02, 1, 0.068};
  hardware::HardwareOptions options;
  // 26 bytes of ten bits there and back at 9600 baud: 27 ms of the 68.
  CHECK_THAT(PingText(ping, options),
             Contains("for the experiment: --set hardware.stopping.delay_s=0.034 --set "
                      "simulation.link.delay_s=0.020 --set simulation.link.line_loss=0.020 --set "
                      "simulation.link.poll_s=0 --set simulation.link.uart_bytes=512 --set "
                      "simulation.link.watchdog_s=0.300\n"));
  const auto set = nlohmann::json::parse(PingJson(ping, options))["set"];
  CHECK(set.size() == 6);
  CHECK(set["hardware.stopping.delay_s"] == 0.034);
  CHECK(set["simulation.link.delay_s"].get<double>() == Approx(0.034 - 130.0 / 9600.0));
  CHECK(set["simulation.link.line_loss"] == 0.02);
  // It answered, so it has src/firmware.
  CHECK(set["simulation.link.poll_s"] == 0);
  CHECK(set["simulation.link.uart_bytes"] == 512);
  CHECK(set["simulation.link.watchdog_s"] == 0.3);
}

TEST_CASE("Of a robot that was not asked a ping does not say that it did not answer") {
  const hardware::PingResult ping{.protocol = hardware::Protocol::kPlain};
  hardware::HardwareOptions options;
  options.line.hello_s = 3.5;
  CHECK_THAT(PingText(ping, options), Contains("did not answer within 3.5 s"));
  options.line.protocol = hardware::Protocol::kPlain;
  CHECK_THAT(PingText(ping, options), !Contains("answer within") && Contains("cannot be asked"));
}

TEST_CASE("A summary tells outcome and protocol of its drive, and nothing that it does not know") {
  hardware::DriveRun run;
  run.trial.outcome = trial::Outcome::kTimedOut;
  run.ping.protocol = hardware::Protocol::kFramed;
  const std::string summary = DriveJson({}, run);
  CHECK(DriveOutcome(summary) == trial::Outcome::kTimedOut);
  CHECK(DriveProtocol(summary) == hardware::Protocol::kFramed);
  for (const std::string& other : {InterruptedDriveJson({}), std::string("[]"), std::string("{")}) {
    CAPTURE(other);
    CHECK_FALSE(DriveOutcome(other));
    CHECK_FALSE(DriveProtocol(other));
  }
}

TEST_CASE("A waypoint without a name that was reached is told by its place in the task") {
  sweep::SimulatedRun run;
  run.result.visits = {{"turn", 1.25, 0.0}, {"", 2.5, 0.0}, {"", {}, 0.3}};
  CHECK_THAT(SimulationText({}, run),
             Contains("\nturn reached at 1.25 s\nwaypoints[2] reached at 2.50 s\nv_max"));
}

TEST_CASE("A run that nothing held back names v_max, and that of a program does not") {
  experiment::Experiment experiment;
  experiment.control.v_max = 0.3;
  sweep::SimulatedRun run;
  run.result.limits.largest_raw_v = 0.25;
  CHECK_THAT(SimulationText(experiment, run),
             Contains("v_max (0.3) never bound: the largest speed asked for was 0.250"));
  experiment.program.segments = {{.straight_m = 0.5}};
  CHECK_THAT(SimulationText(experiment, run), !Contains("v_max"));
}

}  // namespace
}  // namespace rift::report
