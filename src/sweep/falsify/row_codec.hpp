#pragma once

#include <string>
#include <string_view>

#include "rift/sweep/falsify/trial_runner.hpp"

namespace rift::sweep {

/// A request as bytes for a worker.
std::string EncodeRequest(const TrialRequest& request);
TrialRequest DecodeRequest(std::string_view bytes);

/// What a trial found out, as bytes: everything of a row but what its request said already.
std::string EncodeFindings(const TrialRow& row);
/// Throws std::runtime_error for bytes of another layout.
void DecodeFindings(std::string_view bytes, TrialRow& row);

}  // namespace rift::sweep
