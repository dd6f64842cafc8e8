#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace rift::commands {

struct TrackRequest;

/// `track` does the work.
void AddTrack(CLI::App& app, int& exit_code, const std::function<int(const TrackRequest&)>& track);

/// Needs a camera: only rift-camera links it. Returns the exit code.
int Track(const TrackRequest& request);

}  // namespace rift::commands
