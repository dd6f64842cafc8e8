// Planted parameters found again: how often the truth lies in the stated interval, and whether a
// parameter without effect is flagged.
//
//   planted_study [--repeats N] [--logs N] [--phases N] [--runs N] [--iterations N] [--threads N]

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <map>

#include "identification/planted.hpp"
#include "rift/config/bind.hpp"
#include "rift/config/load.hpp"
#include "rift/config/tree.hpp"

namespace rift::test { void Probe(const GridStudy& robot, const std::vector<Planted>& planted, std::uint64_t repeat, int logs, int phases); }
namespace rift {
namespace {

int Study(std::map<std::string, int> asked) {
  config::Node tree = config::Load(RIFT_SOURCE_DIR "/configs/waypoints/paper.yaml", test::ReadFile);
  config::Merge(tree,
                config::Load(RIFT_SOURCE_DIR "/configs/robots/3pi_2040.yaml", test::ReadFile));
  test::GridStudy robot;
  config::Bind(tree, robot);
  sweep::CalibrationOptions options;
  options.runs = asked["--runs"];
  options.iterations = asked["--iterations"];
  options.horizon.phases = asked["--phases"];
  std::map<std::string, int> inside, flagged;
  std::map<std::string, double> bias, z2;
  for (int repeat = asked["--first"]; repeat < asked["--first"] + asked["--repeats"]; ++repeat) {
    std::vector<test::Planted> planted = test::PlantAt(static_cast<std::uint64_t>(repeat));
    if (const char* v = getenv("START")) planted[0].start = atof(v);
    if (const char* v = getenv("OUTLIER")) options.outlier_sd = atof(v);
    if (getenv("TRUTH")) for (auto& p : planted) p.start = p.truth;
    if (const char* v = getenv("ONLY")) planted = {planted[static_cast<size_t>(atoi(v))]};
    if (const char* v = getenv("FRAMES")) options.horizon.most_frames = atoi(v);
    if (const char* v = getenv("STEP")) options.step = atof(v);
    if (getenv("PROBE")) { fmt::print("{}: mismatch {}\n", repeat, planted[1].truth); test::Probe(robot, planted, static_cast<std::uint64_t>(repeat), asked["--logs"], asked["--phases"]); continue; }
    const sweep::Calibration found =
        test::FindPlanted(robot, planted, static_cast<std::uint64_t>(repeat), asked["--logs"],
                          options, asked["--threads"]);
    fmt::print("{:>3}:", repeat);
    for (size_t i = 0; i < planted.size(); ++i) {
      const sweep::CalibratedParameter& p = found.parameters[i];
      const bool is_inside = p.low <= planted[i].truth && planted[i].truth <= p.high;
      inside[planted[i].key] += is_inside;
      bias[planted[i].key] += (p.value - planted[i].truth) / asked["--repeats"];
      z2[planted[i].key] += std::pow((p.value - planted[i].truth) / (p.high - p.low) * 4, 2) / asked["--repeats"];
      flagged[planted[i].key] += !p.is_identified;
      fmt::print("  {:.4f} -> {:.4f} [{:.4f}, {:.4f}]{}{}", planted[i].truth, p.value, p.low,
                 p.high, is_inside ? "" : " OUT", p.is_identified ? "" : " flagged");
    }
    fmt::print("  {} steps {:.5f} {:.5f}\n", found.steps, found.loss_before, found.loss_after);
    std::fflush(stdout);
  }
  for (const auto& [key, count] : inside) {
    fmt::print("{}: inside in {} of {}, flagged in {}, bias {:.4f}, z {:.2f}\n", key, count, asked["--repeats"],
               flagged[key], bias[key], std::sqrt(z2[key]));
  }
  return 0;
}

}  // namespace
}  // namespace rift

int main(int count, char** arguments) {
  std::map<std::string, int> asked{{"--repeats", 20}, {"--first", 1}, {"--logs", 8},
                                   {"--phases", 4},   {"--runs", 0},  {"--iterations", 8},
                                   {"--threads", 1}};
  try {
    for (int i = 1; i + 1 < count; i += 2) asked.at(arguments[i]) = std::stoi(arguments[i + 1]);
    return rift::Study(asked);
  } catch (const std::exception& fault) {
    fmt::print(stderr, "{}\n", fault.what());
    return 1;
  }
}
