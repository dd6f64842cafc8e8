// Every number of a likeness beside that of tests/gap/oracle/likeness.py, which knows the
// definitions and nothing of rift.

#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "rift/gap/likeness.hpp"
#include "support/inputs/oracle.hpp"

namespace rift::gap {
namespace {

using trajectory::Trajectory;

/// Slow at first; weaves about a parabola. `cells`: rows, seconds, length, left, bend, amplitude
/// and waves of the weave, and its phase.
Trajectory Drive(const std::vector<std::string>& cells) {
  std::vector<double> of;
  for (const std::string& cell : cells) of.push_back(std::stod(cell));
  REQUIRE(of.size() == 8);
  Trajectory path;
  const int rows = static_cast<int>(of[0]);
  for (int i = 0; i < rows; ++i) {
    const double s = static_cast<double>(i) / (rows - 1);
    const double x = of[2] * s * (0.4 + 0.6 * s);
    const double weave = of[5] * std::sin(2.0 * std::numbers::pi * of[6] * s + of[7]);
    path.poses.push_back({.t_s = of[1] * s, .x_m = x, .y_m = of[3] + of[4] * x * x + weave});
  }
  return path;
}

std::vector<RepeatedSetting> Settings() {
  std::vector<RepeatedSetting> settings;
  for (const std::vector<std::string>& cells : test::OracleRows("gap", "likeness_drives.csv")) {
    const size_t setting = std::stoul(cells[0]);
    if (setting == settings.size()) settings.emplace_back();
    const Trajectory path = Drive({cells.begin() + 2, cells.end()});
    RepeatedSetting& repeats = settings[setting];
    if (cells[1] == "real") {
      repeats.reals.push_back(path);
      continue;
    }
    const size_t list = std::stoul(cells[1]);
    if (list == repeats.sims.size()) repeats.sims.emplace_back();
    repeats.sims[list].push_back(path);
  }
  return settings;
}

TEST_CASE("Each number of a likeness is the one that the definition gives in NumPy") {
  GapOptions gap;
  gap.samples = 200;
  gap.skip_start = 0.1;
  LikenessOptions options;
  options.shuffles = 19'999;
  std::mt19937_64 generator(5);
  const Likeness found = MeasureLikeness(Settings(), gap, options, generator);
  std::map<std::string, double> fields{{"reals", static_cast<double>(found.reals)},
                                       {"sims", static_cast<double>(found.sims)},
                                       {"wavelength_m/sim", found.wavelength_m.sim},
                                       {"wavelength_m/real", found.wavelength_m.real},
                                       {"mean_gap_m", found.mean_gap_m},
                                       {"mean_path_gap_m", found.mean_path_gap_m},
                                       {"inside_share", found.inside_share},
                                       {"inside_expected", found.inside_expected},
                                       {"energy_m", found.energy_m},
                                       {"energy_p", found.energy_p}};
  for (const auto& [name, both] :
       {std::pair{"spread_m", found.spread_m}, std::pair{"weave_m", found.weave_m},
        std::pair{"speed_mps", found.speed_mps}}) {
    fields[name + std::string("/sim")] = both.sim;
    fields[name + std::string("/real")] = both.real;
    fields[name + std::string("/low")] = both.ratio_interval.low;
    fields[name + std::string("/high")] = both.ratio_interval.high;
  }
  const auto rows = test::OracleRows("gap", "likeness.csv");
  CHECK(rows.size() == fields.size());
  for (const std::vector<std::string>& cells : rows) {
    INFO(cells[0]);
    const double expected = std::stod(cells[1]);
    if (cells[0] == "energy_p") {  // of shuffles drawn, where the script goes through all of them
      const double sd = std::sqrt(expected * (1.0 - expected) / options.shuffles);
      CHECK(std::abs(fields.at("energy_p") - expected) < 4.0 * sd);
    } else {
      CHECK(fields.at(cells[0]) == Approx(expected).epsilon(1e-9));
    }
  }
}

}  // namespace
}  // namespace rift::gap
