#include "rift/report/text/likeness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rift::report {
namespace {

using gap::BothSides;

std::string Number(double value, int decimals) {
  return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value, decimals);
}

std::string Millimetres(const BothSides& both) {
  return fmt::format("{}/{} {}", Number(1e3 * both.sim, 1), Number(1e3 * both.real, 1),
                     Number(both.Ratio(), 2));
}

std::string Seconds(const BothSides& both) {
  return fmt::format("{}/{}", Number(both.sim, 3), Number(both.real, 3));
}

/// "spread: 28.1 mm, of the robot 39.0 mm (ratio 0.72)"; nothing when one side has none.
std::string Sentence(const char* name, const BothSides& both, double scale, const char* unit) {
  if (std::isnan(both.Ratio())) return "";
  return fmt::format("{}: {:.1f} {}, the robot's {:.1f} {} (ratio {:.2f})\n", name,
                     scale * both.sim, unit, scale * both.real, unit, both.Ratio());
}

}  // namespace

std::string LikenessText(const std::vector<sweep::GroupLikeness>& groups) {
  size_t width = 8;
  for (const sweep::GroupLikeness& group : groups) width = std::max(width, group.level.size());
  std::string text = fmt::format(
      "likeness: simulated / real; a simulator that is like the robot has all ratios at 1\n"
      "{:<{}}  {:>17}  {:>17}  {:>11}  {:>11}  {:>15}  {:>8}  {:>6}\n",
      "", width, "spread_mm", "weave_mm", "delay_s", "speed_ratio", "wavelength_mm", "energy_p",
      "inside");
  for (const auto& [level, likeness] : groups) {
    const gap::Likeness& path = likeness.path;
    text += fmt::format("{:<{}}  {:>17}  {:>17}  {:>11}  {:>11}  {:>15}  {:>8}  {:>6}\n", level,
                        width, Millimetres(path.spread_m), Millimetres(path.weave_m),
                        Seconds(likeness.loop_delay_s), Number(path.speed_mps.Ratio(), 3),
                        fmt::format("{}/{}", Number(1e3 * path.wavelength_m.sim, 0),
                                    Number(1e3 * path.wavelength_m.real, 0)),
                        Number(path.energy_p, 3), Number(path.inside_share, 2));
  }
  return text;
}

std::string LikenessText(const gap::Likeness& likeness) {
  std::string text =
      fmt::format("likeness of {} simulated and {} real paths:\n", likeness.sims, likeness.reals);
  text += Sentence("  spread of the repeats", likeness.spread_m, 1e3, "mm");
  text += Sentence("  weave", likeness.weave_m, 1e3, "mm");
  text += Sentence("  wavelength of the weave", likeness.wavelength_m, 1e3, "mm");
  text += Sentence("  speed", likeness.speed_mps, 1e3, "mm/s");
  text += fmt::format("  mean simulated path: {:.4f} m from a real one in the mean\n",
                      likeness.mean_path_gap_m);
  if (!std::isnan(likeness.energy_p)) {
    text +=
        fmt::format("  two-sample test: p = {:.3f} that one robot drove both\n", likeness.energy_p);
  }
  if (!std::isnan(likeness.inside_share)) {
    text += fmt::format(
        "  inside the simulated band: {:.0f} % of the real paths ({:.0f} % expected of a perfect "
        "simulator)\n",
        100.0 * likeness.inside_share, 100.0 * likeness.inside_expected);
  }
  return text;
}

}  // namespace rift::report
