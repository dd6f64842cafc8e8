// The simulated robot against the 48 real trials of the paper's grid: what it does like the real
// one, and (--ablate) which of its parts make it so.
//
//   paper_grid_study [--seeds N] [--robot FILE.yaml] [--ablate] [key=value ...]

#include <fmt/format.h>

#include <cstring>
#include <exception>

#include "rift/config/bind.hpp"
#include "rift/config/load.hpp"
#include "rift/config/tree.hpp"
#include "benchmarks/grid_study.hpp"

namespace rift {
namespace {

struct Request {
  int seeds = 5;
  bool ablate = false;
  bool brief = false;
  std::string robot = RIFT_SOURCE_DIR "/configs/robots/3pi_2040.yaml";
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

test::GridStudy LoadStudy(const Request& request, const std::vector<std::string>& further) {
  config::Node tree = config::Load(RIFT_SOURCE_DIR "/configs/waypoints/paper.yaml", test::ReadFile);
  config::Merge(tree, config::Load(request.robot, test::ReadFile));
  for (const std::string& set : request.overrides) config::Merge(tree, config::ParseOverride(set));
  for (const std::string& set : further) config::Merge(tree, config::ParseOverride(set));
  test::GridStudy study;
  config::Bind(tree, study);
  return study;
}

test::GridSummary RunOnce(const Request& request, const std::vector<std::string>& further) {
  const test::GridStudy study = LoadStudy(request, further);
  std::vector<test::GridPair> pairs = test::LoadGrid(study);
  test::Simulate(study, request.seeds, pairs);
  return test::Summarise(pairs, "");
}

void PrintHeader() {
  fmt::print("{:<26} {:>6} {:>6} {:>13} {:>13} {:>13} {:>11} {:>13} {:>11} {:>13}  {}\n", "",
             "gap", "speed", "weave", "spread", "delay", "R2", "gain", "yaw", "first motion",
             "outcomes");
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

int Study(const Request& request) {
  if (request.brief) {
    PrintSummary("", RunOnce(request, {}));
    return 0;
  }
  PrintHeader();
  const test::GridStudy study = LoadStudy(request, {});
  std::vector<test::GridPair> pairs = test::LoadGrid(study);
  test::Simulate(study, request.seeds, pairs);
  for (const char* surface : {"ground", "cardboard", "parchment", "downhill", "0.15", "0.20"}) {
    PrintSummary(surface, test::Summarise(pairs, surface));
  }
  PrintSummary("all", test::Summarise(pairs, ""));
  if (getenv("DUMP")) {
    for (std::string g : {"ground", "cardboard", "parchment", "downhill", "0.15", "0.20"}) {
      double b = 0, sb = 0, n = 0, sn = 0;
      for (auto& p : pairs) if (p.files.surface == g || p.files.v_min == g) {
        b += p.real_traits.delay.bias_rad_s; ++n;
        for (auto& t : p.run_traits) sb += t.delay.bias_rad_s, ++sn;
      }
      fmt::print("{} bias real {:.3f} sim {:.3f}\n", g, b / n, sb / sn);
    }
    for (auto& p : pairs) {
      std::string f = fmt::format("/tmp/dump/{}_{}_{}_{}", p.files.surface, p.files.v_min, p.files.v_max, p.files.trial);
      for (int k = 0; k < 4; ++k) {
        FILE* o = fopen(fmt::format("{}_{}.txt", f, k).c_str(), "w");
        const auto& t = k == 0 ? p.real : p.runs[k - 1].trajectory;
        for (size_t i = 0; i < t.poses.size(); ++i) { const auto& q = t.poses[i];
          fmt::print(o, "{:.3f} {:.4f} {:.4f} {:.1f} {:.3f} {}\n", q.t_s - t.poses[0].t_s, q.x_m, q.y_m, 57.29578 * q.yaw_rad, q.target_x_m, k ? fmt::format("{:.3f} {:.3f}", t.channels[2].values[i], t.channels[3].values[i]) : "");}
        fclose(o);
      }
    }
  }
  return 0;
}

}  // namespace
}  // namespace rift

int main(int count, char** arguments) {
  try {
    if (rift::test::TrialsFolder().empty()) {
      fmt::print("SKIPPED: the authors' trials are not beside this clone (../shared/trials)\n");
      return 0;
    }
    return rift::Study(rift::ParseArguments(count, arguments));
  } catch (const std::exception& fault) {
    fmt::print(stderr, "{}\n", fault.what());
    return 1;
  }
}
