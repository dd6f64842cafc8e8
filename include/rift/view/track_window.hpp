#pragma once

#include <functional>
#include <string>

#include "rift/view/track_scene.hpp"

namespace rift::view {

/// What the user did since the last picture.
struct TrackInput {
  bool quit = false;         ///< q, Escape, or the window was closed
  bool closed = false;       ///< the window was closed
  bool any_key = false;      ///< also one without a meaning of its own
  bool undo = false;         ///< take the last waypoint away
  bool here = false;         ///< a waypoint where the robot is
  bool toggle_stop = false;  ///< the last waypoint: stop there or pass
  bool clear_trail = false;
  std::vector<Eigen::Vector2d> clicks_px;  ///< in the camera's picture
};

/// What a key does, as cv::waitKeyEx reports it: adds it to `input`. Negative: there was none.
void TakeKey(int key, TrackInput& input);

/// Shows a scene and tells what the user did since the last one; for one thread.
using ShowScene = std::function<TrackInput(const TrackScene&)>;

/// In a TrackWindow that stays open as long as what is returned, and its copies. Throws
/// std::runtime_error with MissingDisplay() where that is not empty.
ShowScene InWindow(const std::string& title);

/// A window with the camera's picture, for one thread.
class TrackWindow {
 public:
  /// Throws std::runtime_error with MissingDisplay() where that is not empty.
  explicit TrackWindow(std::string title);
  ~TrackWindow();
  TrackWindow(const TrackWindow&) = delete;
  TrackWindow& operator=(const TrackWindow&) = delete;

  TrackInput Show(const TrackScene& scene);

 private:
  static void OnMouse(int event, int x, int y, int flags, void* window);
  bool IsOpen() const;

  std::string title_;
  TrackInput input_;
  double px_per_shown_ = 1.0;
};

}  // namespace rift::view
