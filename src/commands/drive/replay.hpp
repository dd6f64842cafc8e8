#pragma once

#include "request.hpp"

namespace rift::commands {

/// Shows a drive that was: in a window, or as a video. Returns the exit code.
int ReplayDrive(const DriveRequest& request);

}  // namespace rift::commands
