#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "rift/experiment/track_options.hpp"
#include "rift/vision/camera/capture_thread.hpp"
#include "track_log.hpp"
#include "track_session.hpp"
#include "track_view.hpp"

namespace rift::commands {

/// What a tracking session is made of and whom it talks to.
struct TrackParts {
  vision::Capture& capture;
  const vision::CameraModel& camera;
  const experiment::TrackOptions& options;
  const SessionOptions& session;
  TrackLog& log;
  TrackView* view = nullptr;  ///< none: no window
  std::optional<double> duration_s;
  std::function<bool()> is_stopped;
  /// One line for the user.
  std::function<void(const std::string&)> say;
};

/// What became of it.
struct TrackRun {
  vision::CameraState state = vision::CameraState::kOpening;  ///< at the end
  std::string reason;
  bool has_failed = false;  ///< the camera ended it, not the user or a recording's end
  vision::CaptureStatus status;
  bool is_recording = false;
  int frames = 0;
  std::array<int, 7> misses{};  ///< by vision::Miss
  int repeated = 0;             ///< sightings that were not later than the one before
  int most_tags_of_this_id = 1;
  double zero_s = 0.0;  ///< of the rows' times, on the steady clock of this machine
  double first_t_s = 0.0, last_t_s = 0.0;  ///< of the rows
  std::vector<double> latencies_s;         ///< of the rows; none of a recording
  std::vector<double> costs_s;             ///< of finding the tag, each frame
  std::optional<double> moved_m;           ///< the reference tags' largest distance seen
};

/// Tracks until the user, the time, the recording or the camera ends it. Throws
/// std::invalid_argument when the stream's size is not the calibration's.
TrackRun Track(const TrackParts& parts);

}  // namespace rift::commands
