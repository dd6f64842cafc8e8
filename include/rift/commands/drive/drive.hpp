#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace rift::commands {

struct DriveRequest;

/// `drive` does the work.
void AddDrive(CLI::App& app, int& exit_code, const std::function<int(const DriveRequest&)>& drive);

/// Needs a camera: only rift-camera links it. Returns the exit code.
int Drive(const DriveRequest& request);

}  // namespace rift::commands
