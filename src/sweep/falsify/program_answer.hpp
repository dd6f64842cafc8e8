#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {

/// The id of a trial that a persistent program is asked for, of the JSON that it is told. A program
/// that answers with it tells which trial its line is about; the same in any worker.
std::string TrialId(nlohmann::ordered_json trial);

/// What in the answer of a persistent program to the trial of that id breaks the protocol, as one
/// line; empty: nothing. `line` is the answer as it came, `unread` what came after it.
std::string BreachIn(const nlohmann::ordered_json& answer, const std::string& line,
                     const std::string& id, const std::string& unread);

/// How the trial ended, of an answer without a breach.
TrialStatus StatusIn(const nlohmann::ordered_json& answer);

}  // namespace rift::sweep
