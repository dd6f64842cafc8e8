// Planted parameters found again: how often the truth lies in the stated interval, and whether a
// parameter without effect is flagged.
//
//   planted_study [--repeats N] [--logs N] [--phases N] [--runs N] [--iterations N] [--threads N]

#include <fmt/format.h>

#include <cstdio>
#include <map>

#include "identification/planted.hpp"

namespace rift {
namespace {

int Study(std::map<std::string, int> asked) {
  const test::GridStudy robot = test::LoadGridStudy();
  sweep::CalibrationOptions options;
  options.runs = asked["--runs"];
  options.iterations = asked["--iterations"];
  options.horizon.phases = asked["--phases"];
  std::map<std::string, int> inside, flagged;
  std::map<std::string, double> bias;
  for (int repeat = asked["--first"]; repeat < asked["--first"] + asked["--repeats"]; ++repeat) {
    const std::vector<test::Planted> planted = test::PlantAt(static_cast<std::uint64_t>(repeat));
    const sweep::Calibration found =
        test::FindPlanted(robot, planted, static_cast<std::uint64_t>(repeat), asked["--logs"],
                          options, asked["--threads"]);
    fmt::print("{:>3}:", repeat);
    for (size_t i = 0; i < planted.size(); ++i) {
      const sweep::CalibratedParameter& p = found.parameters[i];
      const bool is_inside = p.low <= planted[i].truth && planted[i].truth <= p.high;
      inside[planted[i].key] += is_inside;
      bias[planted[i].key] += (p.value - planted[i].truth) / asked["--repeats"];
      flagged[planted[i].key] += !p.is_identified;
      fmt::print("  {:.4f} -> {:.4f} [{:.4f}, {:.4f}]{}{}", planted[i].truth, p.value, p.low,
                 p.high, is_inside ? "" : " OUT", p.is_identified ? "" : " flagged");
    }
    fmt::print("  {} steps, {} trials\n", found.steps, found.trials_simulated);
    std::fflush(stdout);
  }
  for (const auto& [key, count] : inside) {
    fmt::print("{}: inside in {} of {}, flagged in {}, mean error {:+.4f}\n", key, count,
               asked["--repeats"], flagged[key], bias[key]);
  }
  return 0;
}

}  // namespace
}  // namespace rift

int main(int count, char** arguments) {
  std::map<std::string, int> asked{{"--repeats", 20}, {"--first", 1}, {"--logs", 12},
                                   {"--phases", 12},  {"--runs", 0},  {"--iterations", 12},
                                   {"--threads", 1}};
  try {
    for (int i = 1; i + 1 < count; i += 2) asked.at(arguments[i]) = std::stoi(arguments[i + 1]);
    return rift::Study(asked);
  } catch (const std::exception& fault) {
    fmt::print(stderr, "{}\n", fault.what());
    return 1;
  }
}
