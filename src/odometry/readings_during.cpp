#include "rift/odometry/readings_during.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace rift::odometry {
namespace {

EncoderReading ReadingAt(const std::vector<EncoderReading>& readings, double t_s) {
  const auto [left, right] = *CountsAt(readings, t_s);
  return {t_s, {std::llround(left), std::llround(right)}};
}

}  // namespace

std::vector<EncoderReading> ReadingsDuring(const trajectory::Trajectory& log,
                                           const std::vector<EncoderReading>& readings) {
  if (log.poses.empty() || readings.empty()) return {};
  const double from_s = std::max(log.poses.front().t_s, readings.front().t_s);
  const double to_s = std::min(log.poses.back().t_s, readings.back().t_s);
  if (!(from_s < to_s)) return {};
  std::vector<EncoderReading> during{ReadingAt(readings, from_s)};
  std::copy_if(
      readings.begin(), readings.end(), std::back_inserter(during),
      [&](const EncoderReading& reading) { return reading.t_s > from_s && reading.t_s < to_s; });
  during.push_back(ReadingAt(readings, to_s));
  return during;
}

}  // namespace rift::odometry
