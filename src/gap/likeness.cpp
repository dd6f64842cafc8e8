#include "rift/gap/likeness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "arc_path.hpp"
#include "path_shape.hpp"
#include "rift/gap/result.hpp"
#include "rift/statistics/bootstrap.hpp"
#include "rift/statistics/descriptive.hpp"

namespace rift::gap {
namespace {

using trajectory::Trajectory;

constexpr int kWavelengths = 60;

/// Of a weave by 2 micrometres: less is rounding.
constexpr double kLeastPower_m2 = 1e-12;

double Speed_mps(const Trajectory& path, const LikenessOptions& options) {
  std::vector<double> speeds;
  const size_t stride = static_cast<size_t>(options.speed_stride);
  for (size_t i = 0; i + stride < path.poses.size(); ++i) {
    const auto &from = path.poses[i], &to = path.poses[i + stride];
    const double speed = (to.Position() - from.Position()).norm() / (to.t_s - from.t_s);
    if (speed > options.moving_mps) speeds.push_back(speed);
  }
  return statistics::Median(std::move(speeds));
}

/// Power of evenly spaced values at a wavelength, as share of 1 for a sine of amplitude 2.
double PowerAt(const std::vector<double>& values, double length_m, double wavelength_m) {
  double in_phase = 0.0, in_quadrature = 0.0;
  const double step_rad =
      2.0 * std::numbers::pi * length_m / wavelength_m / static_cast<double>(values.size() - 1);
  for (size_t i = 0; i < values.size(); ++i) {
    in_phase += values[i] * std::cos(step_rad * static_cast<double>(i));
    in_quadrature += values[i] * std::sin(step_rad * static_cast<double>(i));
  }
  const double n = static_cast<double>(values.size());
  return (in_phase * in_phase + in_quadrature * in_quadrature) / (n * n);
}

void AddSpread(const RepeatedSetting& setting, const GapOptions& gap, std::vector<double>& sim,
               std::vector<double>& real) {
  real.push_back(NoiseFloor_m(setting.reals, gap));
  if (setting.sims.size() == 1) {
    sim.push_back(NoiseFloor_m(setting.sims.front(), gap));
    return;
  }
  std::vector<double>
      spread_m;  // run i of one real trial and of the other: repeats as the reals are
  for (size_t a = 0; a < setting.sims.size(); ++a) {
    for (size_t b = 0; b < a; ++b) {
      const size_t runs = std::min(setting.sims[a].size(), setting.sims[b].size());
      for (size_t i = 0; i < runs; ++i) {
        spread_m.push_back(Gap(setting.sims[a][i], setting.sims[b][i], gap));
      }
    }
  }
  sim.push_back(statistics::MeanOfKnown(spread_m));
}

/// The runs that a real path is held against.
const std::vector<Trajectory>& SimsOf(const RepeatedSetting& setting, size_t real) {
  return setting.IsMatched() ? setting.sims[real] : setting.sims.front();
}

Trajectory AsPath(const Shape& shape) {
  Trajectory path;
  for (const Eigen::Vector2d& point : shape) {
    path.poses.push_back(
        {.t_s = static_cast<double>(path.poses.size()), .x_m = point.x(), .y_m = point.y()});
  }
  return path;
}

/// Furthest distance of a run from the mean of the others.
double BandWidth_m(const std::vector<Shape>& sims) {
  double width_m = 0.0;
  for (size_t i = 0; i < sims.size(); ++i) {
    std::vector<Shape> others = sims;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    width_m = std::max(width_m, Distance_m(sims[i], MeanShape(others)));
  }
  return width_m;
}

/// What is measured of one real path and its runs, gathered over all.
class Closeness {
 public:
  Closeness(const GapOptions& gap, const LikenessOptions& options) : gap_(gap), options_(options) {}

  void Add(const Trajectory& real, const std::vector<Trajectory>& sims) {
    if (sims.empty()) return;
    std::vector<Shape> shapes;
    for (const Trajectory& sim : sims) {
      gap_m_.push_back(Gap(sim, real, gap_));
      shapes.push_back(ShapeOf(sim, options_.points));
    }
    const Shape mean = MeanShape(shapes);
    mean_path_gap_m_.push_back(Gap(AsPath(mean), real, gap_));
    if (shapes.size() < 2) return;
    const bool is_inside = Distance_m(ShapeOf(real, options_.points), mean) <= BandWidth_m(shapes);
    inside_.push_back(is_inside ? 1.0 : 0.0);
    const double k = static_cast<double>(shapes.size());
    inside_expected_.push_back(k / (k + 1.0));
  }

  void Put(Likeness& likeness) const {
    likeness.mean_gap_m = statistics::MeanOfKnown(gap_m_);
    likeness.mean_path_gap_m = statistics::MeanOfKnown(mean_path_gap_m_);
    likeness.inside_share = statistics::MeanOfKnown(inside_);
    likeness.inside_expected = statistics::MeanOfKnown(inside_expected_);
  }

 private:
  const GapOptions& gap_;
  const LikenessOptions& options_;
  std::vector<double> gap_m_, mean_path_gap_m_, inside_, inside_expected_;
};

std::vector<Shape> ShapesOf(std::span<const Trajectory> paths, int points) {
  std::vector<Shape> shapes;
  for (const Trajectory& path : paths) shapes.push_back(ShapeOf(path, points));
  return shapes;
}

void AddGroups(const RepeatedSetting& setting, int points, std::vector<ShuffleGroup>& groups) {
  if (!setting.IsMatched()) {
    groups.push_back({ShapesOf(setting.reals, points), ShapesOf(setting.sims.front(), points)});
    return;
  }
  for (size_t i = 0; i < setting.reals.size(); ++i) {
    groups.push_back({ShapesOf({&setting.reals[i], 1}, points), ShapesOf(setting.sims[i], points)});
  }
}

struct AllPaths {
  std::vector<Trajectory> sims, reals;
};

AllPaths Gather(std::span<const RepeatedSetting> settings) {
  AllPaths all;
  for (const RepeatedSetting& setting : settings) {
    all.reals.insert(all.reals.end(), setting.reals.begin(), setting.reals.end());
    for (const std::vector<Trajectory>& sims : setting.sims) {
      all.sims.insert(all.sims.end(), sims.begin(), sims.end());
    }
  }
  return all;
}

/// What is known of a number on both sides in one setting.
struct KnownValues {
  std::vector<double> sim, real;
};

/// The means over all, and the interval of their ratio over settings drawn anew.
BothSides MeanOf(const std::vector<KnownValues>& settings, const LikenessOptions& options,
                 std::uint64_t seed) {
  const auto mean_of = [&](std::span<const size_t> chosen) {
    std::vector<double> sim, real;
    for (const size_t i : chosen) {
      sim.insert(sim.end(), settings[i].sim.begin(), settings[i].sim.end());
      real.insert(real.end(), settings[i].real.begin(), settings[i].real.end());
    }
    return BothSides{statistics::MeanOfKnown(sim), statistics::MeanOfKnown(real)};
  };
  std::vector<size_t> every(settings.size());
  std::iota(every.begin(), every.end(), size_t{0});
  BothSides both = mean_of(every);
  both.ratio_interval = statistics::BootstrapGroups(
      settings.size(), [&](std::span<const size_t> drawn) { return mean_of(drawn).Ratio(); },
      options.bootstrap, seed);
  return both;
}

template <class Value>
BothSides MeanOfPaths(std::span<const RepeatedSetting> settings, const LikenessOptions& options,
                      std::uint64_t seed, Value value) {
  std::vector<KnownValues> known;
  for (const RepeatedSetting& setting : settings) {
    KnownValues& values = known.emplace_back();
    for (const Trajectory& path : setting.reals) values.real.push_back(value(path));
    for (const std::vector<Trajectory>& sims : setting.sims) {
      for (const Trajectory& path : sims) values.sim.push_back(value(path));
    }
  }
  return MeanOf(known, options, seed);
}

void Check(std::span<const RepeatedSetting> settings) {
  for (const RepeatedSetting& setting : settings) {
    if (setting.IsMatched() || setting.sims.size() == 1) continue;
    throw std::invalid_argument(
        fmt::format("a setting has {} real paths and {} lists of runs, and must have one list, or "
                    "one for each real path",
                    setting.reals.size(), setting.sims.size()));
  }
}

/// The rows of a path that gaps are measured from.
Trajectory Measured(const Trajectory& path, const GapOptions& gap) {
  return {gap.IsInSpace() ? MakeArcPathIn<3>(path, gap).poses : MakeArcPath(path, gap).poses, {}};
}

std::vector<RepeatedSetting> Measured(std::span<const RepeatedSetting> settings,
                                      const GapOptions& gap) {
  std::vector<RepeatedSetting> measured(settings.begin(), settings.end());
  for (RepeatedSetting& setting : measured) {
    for (Trajectory& path : setting.reals) path = Measured(path, gap);
    for (std::vector<Trajectory>& sims : setting.sims) {
      for (Trajectory& path : sims) path = Measured(path, gap);
    }
  }
  return measured;
}

}  // namespace

PathTraits TraitsOf(const Trajectory& path, const LikenessOptions& options) {
  double squares_m2 = 0.0;
  for (const double residual_m : LateralResiduals_m(ShapeOf(path, options.points))) {
    squares_m2 += residual_m * residual_m;
  }
  return {Speed_mps(path, options), std::sqrt(squares_m2 / options.points)};
}

Trajectory MeanPath(std::span<const Trajectory> paths, const LikenessOptions& options) {
  return AsPath(MeanShape(ShapesOf(paths, options.points)));
}

double MeanPathGap_m(const Trajectory& real, std::span<const Trajectory> runs,
                     const GapOptions& gap, const LikenessOptions& options) {
  if (runs.empty()) return kNotComputed;
  if (!gap.trim_standstill) return Gap(MeanPath(runs, options), real, gap);
  std::vector<Trajectory> trimmed;
  for (const Trajectory& run : runs) trimmed.push_back(Measured(run, gap));
  GapOptions of_trimmed = gap;
  of_trimmed.trim_standstill = false;
  return MeanPathGap_m(Measured(real, gap), trimmed, of_trimmed, options);
}

double DominantWavelength_m(std::span<const Trajectory> paths, const LikenessOptions& options) {
  double longest_m = 0.0;
  for (const Trajectory& path : paths) longest_m = std::max(longest_m, path.ArcLength_m());
  if (!(longest_m > options.wavelength_min_m)) return kNotComputed;
  const double growth = std::pow(longest_m / options.wavelength_min_m, 1.0 / (kWavelengths - 1));
  std::vector<double> power(kWavelengths, 0.0);
  for (const Trajectory& path : paths) {
    const std::vector<double> residuals_m = LateralResiduals_m(ShapeOf(path, options.points));
    for (int k = 0; k < kWavelengths; ++k) {
      power[k] +=
          PowerAt(residuals_m, path.ArcLength_m(), options.wavelength_min_m * std::pow(growth, k));
    }
  }
  const auto strongest = std::max_element(power.begin(), power.end());
  if (!(*strongest > kLeastPower_m2)) return kNotComputed;
  return options.wavelength_min_m *
         std::pow(growth, static_cast<double>(strongest - power.begin()));
}

Likeness MeasureLikeness(std::span<const RepeatedSetting> settings, const GapOptions& gap,
                         const LikenessOptions& options, std::mt19937_64& generator) {
  Check(settings);
  if (gap.trim_standstill) {
    // Once, of every path: the jitter of a standing robot is no part of its weave or shape either,
    // and a mean path is made of what is left.
    GapOptions of_trimmed = gap;
    of_trimmed.trim_standstill = false;
    return MeasureLikeness(Measured(settings, gap), of_trimmed, options, generator);
  }
  const AllPaths all = Gather(settings);
  Likeness likeness{.reals = all.reals.size(), .sims = all.sims.size()};
  likeness.wavelength_m = {DominantWavelength_m(all.sims, options),
                           DominantWavelength_m(all.reals, options)};
  std::vector<KnownValues> spread_m;
  Closeness closeness(gap, options);
  std::vector<ShuffleGroup> groups;
  for (const RepeatedSetting& setting : settings) {
    KnownValues& spread = spread_m.emplace_back();
    AddSpread(setting, gap, spread.sim, spread.real);
    AddGroups(setting, options.points, groups);
    for (size_t i = 0; i < setting.reals.size(); ++i) {
      closeness.Add(setting.reals[i], SimsOf(setting, i));
    }
  }
  closeness.Put(likeness);
  const EnergyTest test = TestEnergy(groups, options.shuffles, generator);
  likeness.energy_m = test.energy_m;
  likeness.energy_p = test.p;
  const std::uint64_t seed = generator();
  likeness.spread_m = MeanOf(spread_m, options, seed);
  likeness.weave_m = MeanOfPaths(settings, options, seed, [&](const Trajectory& path) {
    return TraitsOf(path, options).weave_m;
  });
  likeness.speed_mps = MeanOfPaths(settings, options, seed, [&](const Trajectory& path) {
    return TraitsOf(path, options).speed_mps;
  });
  return likeness;
}

}  // namespace rift::gap
