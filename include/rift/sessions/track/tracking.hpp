#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rift/experiment/experiment.hpp"
#include "rift/view/track_view.hpp"
#include "rift/vision/camera/camera_model.hpp"
#include "rift/vision/tracking/session_options.hpp"
#include "rift/vision/tracking/track_run.hpp"

namespace rift::sessions {

/// What is tracked, through which camera, and where it goes.
struct TrackingJob {
  std::string camera;
  std::string calibration;  ///< its file
  vision::SessionOptions session;
  experiment::TrackOptions options;
  std::vector<int> ids;  ///< of the robots' tags; none: options.tag.id
  std::optional<double> tag_height_m;
  std::string times;  ///< file with the times of a pattern of pictures
  std::optional<double> fps;
  std::string world;   ///< sets the world frame: "first", or a file with tags or points
  std::string log;     ///< its file, or "-"; empty: nothing but the world frame is set
  bool force = false;  ///< replace log and run file, and a better world frame
  bool view = false;
  std::string path;              ///< waypoints or a log, which the view shows
  std::string record_waypoints;  ///< file for those made in the view
  std::optional<double> duration_s;

  /// The log goes to `print`, and nothing beside it.
  bool IsPiped() const { return log == "-"; }
  /// What the experiment says of tracking, and in its place what is said here.
  experiment::TrackOptions OptionsFor(const experiment::Experiment& experiment) const;

  /// Calls field(key, member, [min, max,] what the value is called, help) for what stands in the
  /// place of the experiment's.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("tag_height_m", self.tag_height_m, 0.0, 2.0, "m",
          "of the tag above the floor [track.tag.height_m]");
    field("times", self.times, "FILE|exif",
          "when the pictures of a pattern were taken: a line each, seconds, or name and seconds; "
          "exif: as their EXIF data say [the numbers in their names, at --fps a second]");
    field("fps", self.fps, 0.1, 1000.0, "hz", "asked of a device; rate of a pattern of pictures");
  }
};

/// Whom tracking tells and asks.
struct TrackingListener {
  std::function<bool()> is_stopped;
  /// One line.
  std::function<void(const std::string&)> say;
  /// Rows of a log that is "-", at once: whoever reads them follows the robot. Throws when nobody
  /// can.
  std::function<void(std::string_view rows)> print;
};

/// Beside the log: what it was made from.
inline std::filesystem::path RunFileOf(const std::filesystem::path& log) {
  return std::filesystem::path(log).replace_extension().string() + ".run.json";
}

/// Throws std::invalid_argument for a log that is no file, an input, a picture of the camera or
/// another output. `inputs`, `copies`: files that are read and written beside those of the job.
void CheckNames(const TrackingJob& job, std::vector<std::filesystem::path> inputs,
                const std::vector<std::filesystem::path>& copies);

/// What a job reads before its camera is opened.
struct TrackingInputs {
  vision::CameraModel camera;  ///< as the calibration has it
  view::TrackView::Content content;
};
TrackingInputs ReadInputs(const TrackingJob& job);

/// Sets the world frame where that is asked for and keeps it in the calibration; then, where a log
/// is asked for, tracks, and writes log and run file. `report` gets the run before the camera is
/// closed. Throws std::invalid_argument for inputs that break a rule, std::runtime_error when the
/// camera or the log fails.
void Track(
    const TrackingJob& job, TrackingInputs inputs, const TrackingListener& listener,
    const std::function<void(const vision::TrackRun& run, const vision::TagOptions& tag)>& report);

}  // namespace rift::sessions
