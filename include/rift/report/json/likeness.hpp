#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "rift/gap/likeness.hpp"
#include "rift/sweep/calibrate/sweep_likeness.hpp"

namespace rift::report {

/// {spread: {sim, real, ratio}, ...}; null where there is nothing to tell it by.
nlohmann::ordered_json LikenessJson(const gap::Likeness& likeness);
/// The same, and what only a controller's side can tell.
nlohmann::ordered_json LikenessJson(const sweep::DriveLikeness& likeness);
/// likeness.json: {level: the same}.
nlohmann::ordered_json LikenessJson(const std::vector<sweep::GroupLikeness>& groups);

}  // namespace rift::report
