#pragma once

#include <filesystem>

#include "track_request.hpp"

namespace rift::commands {

/// Beside the log.
std::filesystem::path RunFileOf(const std::filesystem::path& log);

/// Throws std::invalid_argument for a log that is no file, an input, a picture of the camera or
/// another output.
void CheckLogName(const TrackRequest& request);

}  // namespace rift::commands
