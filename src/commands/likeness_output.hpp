#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "rift/gap/likeness.hpp"
#include "rift/sweep/calibrate/sweep_likeness.hpp"

namespace rift::commands {

/// A table for the terminal, a line for each row, with what its columns mean.
std::string LikenessText(const std::vector<sweep::GroupLikeness>& rows);
/// {level: {spread: {sim, real, ratio}, ...}}; null where there is nothing to tell it by.
nlohmann::ordered_json LikenessJson(const std::vector<sweep::GroupLikeness>& rows);

/// The same without what only a controller's side can tell: sentences for the terminal.
std::string LikenessText(const gap::Likeness& likeness);
nlohmann::ordered_json LikenessJson(const gap::Likeness& likeness);

}  // namespace rift::commands
