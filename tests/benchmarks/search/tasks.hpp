#pragma once

#include <optional>
#include <string>
#include <vector>

#include "search/functions.hpp"

namespace rift::test {

/// A task of the study by name, with the loss that counts as success: rastrigin, rosenbrock,
/// ellipsoid, peaks (targets that random search reaches in every second run of 1e5 evaluations),
/// deceiving, flat, robot (below zero).
struct StudyTask {
  Task task;
  double target = 0.0;
};

const std::vector<std::string>& StudyNames();

/// Throws std::invalid_argument for another name. The robot is the same for every seed.
StudyTask StudyTaskOf(const std::string& name, std::uint64_t seed);

}  // namespace rift::test
