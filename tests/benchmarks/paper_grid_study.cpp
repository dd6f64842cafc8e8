// The simulated robot against the 48 real trials of the paper's grid: what it does like the real
// one, and (--ablate) which of its parts make it so.
//
//   paper_grid_study [--seeds N] [--robot FILE.yaml] [--ablate] [--brief] [key=value ...]

#include <fmt/format.h>

#include <cstring>

#include "benchmarks/run_study.hpp"
#include "identification/grid_study.hpp"

namespace rift {
namespace {

struct Request {
  int seeds = 5;
  bool ablate = false;
  bool brief = false;
  std::string robot = test::kAuthorsRobot;
  std::vector<std::string> overrides;
};

Request ParseArguments(int count, char** arguments) {
  Request request;
  for (int i = 1; i < count; ++i) {
    const std::string argument = arguments[i];
    if (argument == "--ablate") {
      request.ablate = true;
    } else if (argument == "--brief") {
      request.brief = true;
    } else if (argument == "--seeds" && i + 1 < count) {
      request.seeds = std::stoi(arguments[++i]);
    } else if (argument == "--robot" && i + 1 < count) {
      request.robot = arguments[++i];
    } else {
      request.overrides.push_back(argument);
    }
  }
  return request;
}

test::GridSummary RunOnce(const Request& request, const std::vector<std::string>& further) {
  std::vector<std::string> overrides = request.overrides;
  overrides.insert(overrides.end(), further.begin(), further.end());
  const test::GridStudy study = test::LoadGridStudy(request.robot, overrides);
  std::vector<test::GridPair> pairs = test::LoadGrid(study);
  test::Simulate(study, request.seeds, pairs);
  return test::Summarise(pairs, "");
}

void PrintHeader() {
  fmt::print("{:<26} {:>6} {:>6} {:>13} {:>13} {:>13} {:>11} {:>13} {:>11} {:>13}  {}\n", "", "gap",
             "speed", "weave", "spread", "delay", "R2", "gain", "yaw", "first motion", "outcomes");
  fmt::print("{:<26} {:>6} {:>6} {:>13} {:>13} {:>13} {:>11} {:>13} {:>11} {:>13}\n", "", "mm",
             "ratio", "mm sim/real", "mm sim/real", "s sim/real", "sim/real", "rad/s", "deg",
             "s sim/real");
}

void PrintSummary(const std::string& name, const test::GridSummary& s) {
  constexpr double kDeg = 57.29578;
  fmt::print(
      "{:<26} {:6.1f} {:6.3f} {:6.1f}/{:6.1f} {:6.1f}/{:6.1f} {:6.3f}/{:6.3f} {:5.2f}/{:5.2f} "
      "{:6.1f}/{:6.1f} {:5.1f}/{:5.1f} {:6.2f}/{:6.2f}  {} reached of {}, {} missed, {} circled\n",
      name, 1e3 * s.gap_m, s.speed_ratio, 1e3 * s.weave_m, 1e3 * s.real_weave_m, 1e3 * s.spread_m,
      1e3 * s.real_spread_m, s.delay_s, s.real_delay_s, s.r2, s.real_r2, s.gain, s.real_gain,
      kDeg * s.yaw_rad, kDeg * s.real_yaw_rad, s.first_motion_s, s.real_first_motion_s, s.reached,
      s.runs, s.missed, s.circled);
}

struct Change {
  std::string name;
  std::vector<std::string> overrides;
};

/// One mechanism at a time. Where a change takes delay out of the loop, a second line puts it back
/// as a fixed delay, so that the mechanism is told from its delay.
std::vector<Change> Changes() {
  const std::string link = "simulation.link.", motor = "simulation.motor.",
                    mocap = "simulation.mocap.", body = "simulation.body.",
                    terrain = "simulation.terrain.surfaces.";
  const std::vector<std::string> still{mocap + "noise_across_m=0", mocap + "blur_across_s=0",
                                       mocap + "noise_along_m=0",  mocap + "noise_yaw_rad=0",
                                       mocap + "frame_jitter_s=0", mocap + "blur_yaw_rad_per_mps=0",
                                       mocap + "stamp_jitter_s=0"};
  return {
      {"as identified", {}},
      {"tag on the axle", {mocap + "tag_ahead_m=0"}},
      {"no link delay", {link + "delay_s=0"}},
      {"link delay + 30 ms", {link + "delay_s=0.13"}},
      {"no listener hold", {link + "poll_s=0"}},
      {"no hold, same delay", {link + "poll_s=0", link + "delay_s=0.20"}},
      {"no overrun, same delay", {link + "uart_bytes=0", link + "delay_s=0.14"}},
      {"a fifth of the lines lost", {link + "line_loss=0.2"}},
      {"1 byte in 100 lost", {link + "byte_loss=0.01"}},
      {"no motor lag", {motor + "lag_s=0"}},
      {"motor lag 60 ms", {motor + "lag_s=0.06"}},
      {"no dead band", {motor + "dead_band=0"}},
      {"dead band 0.14", {motor + "dead_band=0.14"}},
      {"motors alike", {motor + "mismatch=0"}},
      {"caster without friction", {body + "caster_mu=0"}},
      {"grip 0.3 everywhere",
       {terrain + "ground.mu=0.3", terrain + "cardboard.mu=0.3", terrain + "parchment.mu=0.3",
        terrain + "downhill.mu=0.3"}},
      {"caster and weight behind", {body + "caster_ahead_m=-0.0404", body + "com_ahead_m=-0.008"}},
      {"no camera noise", still},
      {"deciding every 20 ms", {"trial.pace=every_period"}}};
}

void Ablate(const Request& request) {
  fmt::print("\n");
  for (const Change& change : Changes()) {
    PrintSummary(change.name, RunOnce(request, change.overrides));
  }
}

int Study(const Request& request) {
  if (request.brief) {
    PrintSummary("", RunOnce(request, {}));
    return 0;
  }
  PrintHeader();
  const test::GridStudy study = test::LoadGridStudy(request.robot, request.overrides);
  std::vector<test::GridPair> pairs = test::LoadGrid(study);
  test::Simulate(study, request.seeds, pairs);
  for (const char* surface : {"ground", "cardboard", "parchment", "downhill", "0.15", "0.20"}) {
    PrintSummary(surface, test::Summarise(pairs, surface));
  }
  PrintSummary("all", test::Summarise(pairs, ""));
  if (request.ablate) Ablate(request);
  return 0;
}

}  // namespace
}  // namespace rift

int main(int count, char** arguments) {
  return rift::test::RunStudy([&] { return rift::Study(rift::ParseArguments(count, arguments)); });
}
