#include "rift/statistics/bootstrap.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "rift/statistics/descriptive.hpp"
#include "rift/statistics/random.hpp"

namespace rift::statistics {

Interval BootstrapGroups(std::size_t groups, const GroupStatistic& statistic,
                         const BootstrapOptions& options, std::uint64_t seed) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  constexpr std::uint64_t kStream = 71;
  if (groups < 2) return {kNone, kNone};
  Random random(seed, kStream);
  std::vector<double> values;
  std::vector<std::size_t> drawn(groups);
  for (int i = 0; i < options.resamples; ++i) {
    for (std::size_t& group : drawn) group = random.Below(groups);
    const double value = statistic(drawn);
    if (!std::isnan(value)) values.push_back(value);
  }
  const double n = static_cast<double>(groups);
  const double t = StudentQuantile(n - 1.0, 0.5 + 0.5 * options.confidence);
  return CentralInterval(values, 1.0 - 2.0 * NormalCdf(-std::sqrt(n / (n - 1.0)) * t));
}

}  // namespace rift::statistics
