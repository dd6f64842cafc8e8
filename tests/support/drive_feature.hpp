#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "rift/sweep/calibrate/drive_features.hpp"
#include "rift/trajectory/trajectory.hpp"

namespace rift::test {

/// Where a feature stands among sweep::DriveFeatures(), by its name.
inline size_t PlaceOfFeature(const std::string& name) {
  const auto features = sweep::DriveFeatures();
  const auto found = std::find_if(features.begin(), features.end(),
                                  [&](const auto& one) { return one.name == name; });
  REQUIRE(found != features.end());
  return static_cast<size_t>(found - features.begin());
}

/// That feature of a log.
inline double Feature(const trajectory::Trajectory& log, const std::string& name) {
  return sweep::FeaturesOf(log, {})[PlaceOfFeature(name)];
}

}  // namespace rift::test
