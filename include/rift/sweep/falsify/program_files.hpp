#pragma once

#include <string>
#include <vector>

#include "rift/experiment/experiment.hpp"

namespace rift::sweep {

// Files of the command line of a program, without which every trial would fail in the same way.
// Both throw std::invalid_argument that says what is missing and what to do; a word that is filled
// in for each trial is not looked at.

/// The programs of candidate.run and reference.run themselves: each an absolute path, or a name in
/// PATH, that may be executed. `file` is the experiment's, for messages.
void RequirePrograms(const experiment::Experiment& experiment, const std::string& file);

/// The script that it interprets, where interpreter and ending leave no doubt that it is one. A
/// script beside the experiment was made absolute when that was read, and programs run in a folder
/// of their own.
void RequireScript(const std::vector<std::string>& words);

}  // namespace rift::sweep
