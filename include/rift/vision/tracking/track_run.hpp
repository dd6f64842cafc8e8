#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "rift/vision/tracking/session.hpp"
#include "rift/vision/tracking/session_options.hpp"
#include "rift/vision/tracking/unseen_tag.hpp"

namespace rift::vision {

/// What a tracking run is made of and whom it talks to.
struct TrackParts {
  CameraSession& session;
  const SessionOptions& options;
  /// Robots beside the session's tag.
  std::vector<int> further_ids;
  /// Takes a row of the log, from the first sighting of a tag on one for each picture and tag:
  /// seen, predicted or lost (no pose). False when `t_s` is not later than that of the row before.
  std::function<bool(double t_s, const Sighting& sighting)> log;
  /// Shows a moment of the run, with what was seen of the session's tag and of each of further_ids
  /// in that picture, `moved_m` being the largest so far; false when the user has asked to end. A
  /// recording's last picture stays until then. None: no window.
  std::function<bool(const std::optional<Frame>& frame,
                     const std::vector<std::optional<Sighting>>& seen, const CaptureStatus& status,
                     const std::optional<double>& moved_m)>
      show;
  std::optional<double> duration_s;  ///< none: without end; of a recording by its own time
  std::function<bool()> is_stopped;
  /// One line for the user.
  std::function<void(const std::string&)> say;
};

/// What became of it.
struct TrackRun {
  CameraState state = CameraState::kOpening;  ///< at the end
  std::string reason;
  bool has_failed = false;  ///< the camera ended it, not the user or a recording's end
  CaptureStatus status;
  bool is_recording = false;
  int frames = 0;
  int rows = 0;  ///< of the log, with a pose that was measured
  std::array<int, EnumNames(Miss{}).size()> misses{};        ///< by Miss
  std::array<int, EnumNames(TrackState{}).size()> states{};  ///< pictures by TrackState
  int repeated = 0;  ///< sightings that were not later than the one before
  int most_tags_of_this_id = 1;
  int off_floor = 0;  ///< rows whose tag could not be held to a floor that is known
  /// Where no tag that was asked for was ever seen: what the newest picture shows, or the newest
  /// one in which other tags of the family were seen.
  InsteadOfTag instead;
  double zero_s = 0.0;  ///< of the rows' times, on the steady clock of this machine
  double first_t_s = 0.0, last_t_s = 0.0;  ///< of the rows
  std::vector<double> latencies_s;         ///< of the rows; none of a recording
  std::vector<double> costs_s;             ///< of finding the tag, each frame
  std::optional<double> moved_m;           ///< the reference tags' largest distance seen
};

/// Tracks until the user, the time, the recording or the camera ends it, which a camera does that
/// changes the size of its pictures (wrong format). Throws std::invalid_argument when its first
/// picture has another size than the calibration.
TrackRun RunTracking(const TrackParts& parts);

}  // namespace rift::vision
