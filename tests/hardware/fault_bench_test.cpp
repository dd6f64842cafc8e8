#include <catch2/catch.hpp>
#include <random>

#include "bench.hpp"
#include "rift/trial/trial.hpp"
#include "support/inputs/paper_waypoints.hpp"

namespace rift::hardware {
namespace {

constexpr control::WheelPower kForward{0.3, 0.28};
constexpr double kPeriod_s = 0.02;

/// One turn of a control loop that only ever wants to drive on.
void DriveOn(RealRobot& robot, double duration_s, Bench& bench) {
  for (const double end_s = bench.Now_s() + duration_s; bench.Now_s() < end_s;) {
    robot.Sense();
    robot.Command(kForward);
    robot.Advance(kPeriod_s);
  }
}

/// A robot that has driven at full tilt for a while when the fault comes.
struct Scene {
  explicit Scene(const HardwareOptions& hardware = {})
      : robot(bench, bench, bench, {hardware, Protocol::kFramed, false}) {
    robot.AddStopper([this]() -> std::optional<std::pair<StopReason, std::string>> {
      if (throws) throw std::runtime_error("the tracker broke");
      return stopper;
    });
    for (int i = 0; i < 20; ++i) robot.Advance(kPeriod_s);
    robot.Arm();
    DriveOn(robot, 0.6, bench);
    REQUIRE(bench.listener->Motors() == MilliPower{300, 280});
  }

  Bench bench;
  std::optional<std::pair<StopReason, std::string>> stopper;
  bool throws = false;
  RealRobot robot;
};

/// Seconds from the strike until the motors are off for good, while the controller goes on wanting
/// to drive.
double TimeToZero(Scene& scene, const std::function<void()>& strike,
                  const std::function<void()>& turn) {
  const double struck_s = scene.bench.Now_s();
  strike();
  while (scene.bench.Now_s() < struck_s + 2.5) turn();
  return std::max(0.0, scene.bench.LastMoving_s() - struck_s);
}

struct Fault {
  const char* name;
  std::optional<StopReason> reason;  ///< none: the host knows nothing of it
  double within_s;
  std::function<void(Scene&)> strike;
  bool host_runs = true;
};

// 34 ms for the line to be free again and the bytes on it, 20 ms of radio, 20 ms of control period.
constexpr double kSend_s = 0.08;

const std::vector<Fault> kFaults{
    {"frozen camera", StopReason::kPoseStale, 0.15 + kSend_s,
     [](Scene& s) { s.bench.camera_is_frozen = true; }},
    {"hidden tag", StopReason::kTagLost, 0.15 + kSend_s,
     [](Scene& s) { s.bench.tag_is_hidden = true; }},
    {"pose that is not a number", StopReason::kPoseNotFinite, 0.05 + kSend_s,
     [](Scene& s) { s.bench.bend = [](auto& pose) { pose.world_from_robot.x_m = NAN; }; }},
    {"pose from the future", StopReason::kPoseNotFinite, 0.05 + kSend_s,
     [](Scene& s) { s.bench.bend = [](auto& pose) { pose.captured_s += 5.0; }; }},
    {"pose that jumps aside", StopReason::kPoseJump, 0.05 + kSend_s,
     [](Scene& s) { s.bench.bend = [](auto& pose) { pose.world_from_robot.y_m += 0.5; }; }},
    {"pose that turns around", StopReason::kPoseJump, 0.05 + kSend_s,
     [](Scene& s) { s.bench.bend = [](auto& pose) { pose.world_from_robot.yaw_rad += 3.0; }; }},
    {"unplugged camera", StopReason::kCameraGone, kSend_s,
     [](Scene& s) { s.bench.camera_fault = "the camera was unplugged"; }},
    {"tracker that throws", StopReason::kException, kSend_s, [](Scene& s) { s.throws = true; }},
    {"unplugged port", StopReason::kPortGone, 0.3 + kSend_s,
     [](Scene& s) { s.bench.line_is_gone = true; }},
    {"radio that swallows commands", StopReason::kLinkLagging, 0.3 + kSend_s,
     [](Scene& s) { s.bench.to_robot_is_cut = true; }},
    {"radio that swallows answers", StopReason::kLinkLagging, 0.25 + kSend_s,
     [](Scene& s) { s.bench.from_robot_is_cut = true; }},
    {"radio that grows slow", StopReason::kLinkLagging, 0.45 + kSend_s,
     [](Scene& s) { s.bench.line_delay_s = 0.2; }},
    {"line that takes no more bytes", StopReason::kLinkLagging, 0.3 + kSend_s,
     [](Scene& s) { s.bench.line_is_blocked = true; }},
    {"operator", StopReason::kOperator, kSend_s,
     [](Scene& s) {
       s.stopper = {StopReason::kOperator, "a key was pressed"};
     }},
    {"signal", StopReason::kSignal, kSend_s,
     [](Scene& s) {
       s.stopper = {StopReason::kSignal, "SIGTERM"};
     }},
    {"power above the limit", StopReason::kPowerRefused, kSend_s,
     [](Scene& s) {
       s.robot.Command({1.0001, 0.0});
     }},
    {"power that is not a number", StopReason::kPowerRefused, kSend_s,
     [](Scene& s) {
       s.robot.Command({NAN, 0.0});
     }},
    {"flat battery", StopReason::kBatteryLow, 0.1 + kSend_s,
     [](Scene& s) { s.bench.battery_mv = 3500; }},
    {"robot switched off and on", StopReason::kLinkLagging, 0.01,
     [](Scene& s) {
       s.bench.listener = std::make_unique<Listener>();
       s.bench.robot_is_on = false;
       RunAlone(s.bench, 0.001);
       s.bench.robot_is_on = true;
     }},
    {"robot that lost its radio partner", StopReason::kRobotStopped, 0.05,
     [](Scene& s) {
       s.bench.Chatter("OK+LOST");
       RunAlone(s.bench, 0.001);
     }},
    {"end of the trial", StopReason::kFinished, kSend_s, [](Scene& s) { s.robot.Stop(); }},
    {"exception in the trial", StopReason::kException, kSend_s,
     [](Scene& s) {
       struct Guard {
         RealRobot& robot;
         ~Guard() { robot.Stop(); }
       };
       try {
         const Guard guard{s.robot};
         throw std::runtime_error("out of luck");
       } catch (const std::runtime_error&) {
       }
     }},
    {"host stopped and continued", StopReason::kHostStalled, 0.3 + kSend_s,
     [](Scene& s) { RunAlone(s.bench, 1.0); }},
    {"host killed", std::nullopt, 0.3 + kSend_s, [](Scene&) {}, false},
};

TEST_CASE("Whatever goes wrong the motors are off in time and stay off") {
  REQUIRE(kFaults.size() >= 20);
  for (const Fault& fault : kFaults) {
    DYNAMIC_SECTION(fault.name) {
      HardwareOptions hardware;
      hardware.guard.battery_min_v = 3.6;
      Scene scene(hardware);
      const double before_m = scene.bench.Travelled_m();
      const double to_zero_s = TimeToZero(
          scene, [&] { fault.strike(scene); },
          [&] {
            if (fault.host_runs) {
              DriveOn(scene.robot, 0.001, scene.bench);
            } else {
              RunAlone(scene.bench, 0.001);
            }
          });
      CHECK(to_zero_s <= fault.within_s);
      const double distance_m = scene.bench.Travelled_m() - before_m;
      const double printed_m = StoppingDistance_m(hardware.stopping, 0.3);
      CHECK(distance_m <= printed_m);
      CHECK(scene.bench.SpeedOfWheels() < 1e-6);
      if (fault.reason) {
        CHECK(scene.robot.state() == DriveState::kStopped);
        REQUIRE(scene.robot.Record().stop);
        CHECK(EnumNames(StopReason{})[static_cast<size_t>(scene.robot.Record().stop->reason)] ==
              EnumNames(StopReason{})[static_cast<size_t>(*fault.reason)]);
        CHECK(scene.robot.Sense().fault);
        const std::string text = scene.robot.Record().stop->text;
        CHECK((text == "the trial is over") == (fault.reason == StopReason::kFinished));
        CHECK((text == "the trial ended with an error") ==
              (fault.name == std::string("exception in the trial")));
      }
    }
  }
}

TEST_CASE("A trial that wakes first after a standstill hears of it, not only of old poses") {
  Scene scene;
  RunAlone(scene.bench, 3.0);
  const trial::Sensed sensed = scene.robot.Sense();
  REQUIRE(sensed.fault);
  CHECK(sensed.fault->find("rift itself stood still for 3.0") != std::string::npos);
}

TEST_CASE("A control loop that hangs is cut off while the link goes on") {
  Scene scene;
  const double to_zero_s = TimeToZero(
      scene, [] {}, [&] { scene.robot.Advance(0.001); });
  CHECK(to_zero_s <= 0.1 + kSend_s);
  CHECK(scene.robot.Record().stop->reason == StopReason::kControlStale);
}

TEST_CASE("A power before arming stops the drive before it began") {
  Bench bench;
  RealRobot robot(bench, bench, bench, {{}, Protocol::kFramed, false});
  for (int i = 0; i < 20; ++i) robot.Advance(kPeriod_s);
  DriveOn(robot, 0.5, bench);
  CHECK(robot.Record().stop->reason == StopReason::kNotArmed);
  CHECK(bench.obeyed == std::set<std::pair<int, int>>{{0, 0}});
}

TEST_CASE("A robot that was not seen cannot be armed") {
  Bench bench;
  bench.tag_is_hidden = true;
  RealRobot robot(bench, bench, bench, {{}, Protocol::kFramed, false});
  robot.Advance(0.5);
  CHECK_THROWS_WITH(robot.Arm(), Catch::Contains("not been seen"));
}

TEST_CASE("A stopped drive sends zeros again and again and goes on only when armed anew") {
  Scene scene;
  scene.stopper = {StopReason::kOperator, "a key was pressed"};
  DriveOn(scene.robot, 0.3, scene.bench);
  scene.stopper.reset();
  const size_t zeros = scene.bench.zeros_heard;
  DriveOn(scene.robot, 1.0, scene.bench);
  CHECK(scene.bench.zeros_heard >= zeros + 15);
  CHECK(scene.bench.listener->Motors().IsZero());
  scene.robot.Arm();
  DriveOn(scene.robot, 0.3, scene.bench);
  CHECK(scene.bench.listener->Motors() == MilliPower{300, 280});
}

TEST_CASE("A stop is acknowledged by the robot or reported as not acknowledged") {
  Scene heard;
  heard.robot.Stop();
  heard.robot.ConfirmStop(1.0);
  CHECK(heard.robot.Record().stop_acknowledged == true);

  Scene deaf;
  deaf.bench.to_robot_is_cut = true;
  deaf.robot.Stop();
  deaf.robot.ConfirmStop(1.0);
  CHECK(deaf.robot.Record().stop_acknowledged == false);

  Bench bench;
  RealRobot plain(bench, bench, bench, {{}, Protocol::kPlain, false});
  plain.Stop();
  CHECK_FALSE(plain.Record().stop_acknowledged);
}

struct Noise {
  const char* name;
  std::function<std::vector<std::uint8_t>(std::uint8_t, std::mt19937_64&)> change;
};

const std::vector<Noise> kNoises{
    {"dropped", [](std::uint8_t, std::mt19937_64&) { return std::vector<std::uint8_t>{}; }},
    {"doubled",
     [](std::uint8_t byte, std::mt19937_64&) {
       return std::vector<std::uint8_t>{byte, byte};
     }},
    {"flipped",
     [](std::uint8_t byte, std::mt19937_64& random) {
       return std::vector<std::uint8_t>{static_cast<std::uint8_t>(byte ^ (1u << random() % 8))};
     }},
    {"replaced",
     [](std::uint8_t, std::mt19937_64& random) {
       return std::vector<std::uint8_t>{static_cast<std::uint8_t>(random())};
     }},
};

TEST_CASE("With frames no spoiled byte ever moves a wheel in another way than was commanded") {
  for (const Noise& noise : kNoises) {
    for (const double share : {0.001, 0.01, 0.1}) {
      DYNAMIC_SECTION(share << " of the bytes " << noise.name) {
        Bench bench;
        std::mt19937_64 random(5);
        bench.spoil = [&](std::uint8_t byte) {
          return std::uniform_real_distribution<>(0, 1)(random) < share
                     ? noise.change(byte, random)
                     : std::vector<std::uint8_t>{byte};
        };
        RealRobot robot(bench, bench, bench, {{}, Protocol::kFramed, false});
        for (int round = 0; round < 20; ++round) {
          robot.Advance(0.2);
          for (int i = 0; i < 10; ++i) robot.Advance(kPeriod_s);
          if (bench.Newest().newest) robot.Arm();
          for (int i = 0; i < 100; ++i) {
            robot.Sense();
            robot.Command({0.001 * ((round * 37 + i) % 400), 0.001 * ((i * 13) % 400)});
            robot.Advance(kPeriod_s);
          }
        }
        for (const auto& power : bench.obeyed)
          CHECK((power == std::pair(0, 0) || bench.written.contains(power)));
        CHECK(bench.obeyed.size() > 1);
        RunAlone(bench, 0.5);  // the host is gone
        CHECK(bench.listener->Motors().IsZero());
      }
    }
  }
}

TEST_CASE("Frames that are delayed at random are obeyed in order or not at all") {
  Bench bench;
  std::mt19937_64 random(6);
  bench.extra_delay_s = [&] { return std::uniform_real_distribution<>(0, 0.06)(random); };
  RealRobot robot(bench, bench, bench, {{}, Protocol::kFramed, false});
  for (int i = 0; i < 20; ++i) robot.Advance(kPeriod_s);
  robot.Arm();
  int last = 0;
  for (int i = 1; i < 200 && robot.state() == DriveState::kArmed; ++i) {
    robot.Sense();
    robot.Command({0.002 * i, 0.0});
    robot.Advance(kPeriod_s);
    CHECK(bench.listener->Motors().left >= last);
    last = bench.listener->Motors().left;
  }
  CHECK(last > 300);
}

trial::TrialResult Trial(RealRobot& robot, const trial::TrialOptions& options) {
  for (int i = 0; i < 20; ++i) robot.Advance(kPeriod_s);
  robot.Arm();
  return trial::RunTrial(robot, test::PaperWaypoints(), {}, options);
}

TEST_CASE("The trial loop of the simulator drives the robot to the last waypoint") {
  Bench bench;
  bench.line_delay_s = 0.005;
  RealRobot robot(bench, bench, bench, {{}, Protocol::kFramed, false});
  const trial::TrialResult result = Trial(robot, {.pace = trial::Pace::kNewPose});
  CHECK(result.reason == "the last waypoint was reached");
  robot.ConfirmStop(1.0);
  const DriveRecord evidence = robot.Record();
  CHECK(evidence.stop_acknowledged == true);
  REQUIRE(evidence.poses.size() > 30);
  for (const PoseStages& pose : evidence.poses) {
    if (pose.written_s < 0.0) continue;
    CHECK(pose.captured_s <= pose.arrived_s);
    CHECK(pose.sensed_s <= pose.commanded_s);
    CHECK(pose.written_s - pose.captured_s < 0.04);
  }
  CHECK(CountsAt(evidence.encoders, evidence.poses[20].captured_s));
}

TEST_CASE("Second thoughts about a pose do not hold up the command for the next one") {
  Bench bench;
  bench.line_delay_s = 0.005;
  RealRobot robot(bench, bench, bench, {{}, Protocol::kFramed, false});
  Trial(robot, {.pace = trial::Pace::kEveryPeriod});
  std::vector<double> waits_s;
  for (const PoseStages& pose : robot.Record().poses) {
    if (pose.written_s >= 0.0) waits_s.push_back(pose.written_s - pose.ready_s);
  }
  REQUIRE(waits_s.size() > 30);
  std::sort(waits_s.begin(), waits_s.end());
  CHECK(waits_s[waits_s.size() / 2] < 0.005);
}

TEST_CASE("Leaving the arena and running out of time stop the robot") {
  trial::TrialOptions small;
  small.arena.x_max_m = 0.0;
  trial::TrialOptions brief;
  brief.timeout_s = 1.0;
  for (const trial::TrialOptions& options : {small, brief}) {
    Bench bench;
    RealRobot robot(bench, bench, bench, {{}, Protocol::kFramed, false});
    const trial::TrialResult result = Trial(robot, options);
    CHECK(result.outcome != trial::Outcome::kReached);
    const double ended_s = bench.Now_s();
    const double ended_m = bench.Travelled_m();
    while (!bench.listener->Motors().IsZero() && bench.Now_s() < ended_s + 1.0) robot.Advance(1e-3);
    CHECK(bench.Now_s() - ended_s <= kSend_s);
    RunAlone(bench, 1.0);
    CHECK(bench.Travelled_m() - ended_m < StoppingDistance_m({}, 0.3));
  }
}

}  // namespace
}  // namespace rift::hardware
