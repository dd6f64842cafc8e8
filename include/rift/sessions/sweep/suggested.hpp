#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "rift/experiment/experiment.hpp"

namespace rift::sessions {

/// An experiment on the robot that a sweep suggested: what of suggested.yaml a drive needs.
struct SuggestedExperiment {
  int number = 0;  ///< from 1; its drives go into suggested/NUMBER_TRIAL
  std::vector<experiment::Parameter> parameters;  ///< those of the sweep that a person sets
  experiment::Theta values;                       ///< of these
  int repeats = 0;
  bool is_predicted_to_fail = false;
  std::string why;  ///< one sentence; empty when the file has none
};

/// The file in the folder of a sweep, and where a drive of it is saved.
std::filesystem::path SuggestedFile(const std::filesystem::path& sweep);
std::filesystem::path SuggestedFolder(const std::filesystem::path& sweep);
std::filesystem::path SuggestedDrive(const std::filesystem::path& sweep, int number, int trial);

std::string WriteSuggested(const std::vector<SuggestedExperiment>& experiments);

/// Empty when the folder has no such file. Throws yaml::Error, naming file, line and rule, when it
/// is none, or sets what the experiment's space does not vary.
std::vector<SuggestedExperiment> ReadSuggested(const std::filesystem::path& sweep,
                                               const experiment::Experiment& experiment);

}  // namespace rift::sessions
