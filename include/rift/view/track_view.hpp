#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "rift/control/waypoint.hpp"
#include "rift/view/track_window.hpp"

namespace rift::view {

/// The window of `rift track`, and the waypoints that are made in it. Path, waypoints and clicks
/// lie on the floor; in a map without a world frame, where no floor is known, on the plane in which
/// the tag was first seen.
class TrackView {
 public:
  struct Content {
    std::vector<Eigen::Vector2d> path_m;
    std::vector<control::Waypoint> planned;  ///< those of the path
    /// Called with the recorded waypoints whenever they change; none: they are not kept.
    std::function<void(const std::vector<control::Waypoint>&)> save;
  };

  /// `camera` must outlive it; path and waypoints are those of the first of the robots' tags.
  TrackView(const vision::CameraModel& camera, const std::vector<int>& tag_ids, Content content,
            ShowScene show = InWindow("rift track"));

  /// False when the user has asked to end. `seen`: of each robot in the order of `tag_ids`, which
  /// the picture shows or not.
  bool Show(const std::optional<vision::Frame>& frame,
            const std::vector<std::optional<vision::Sighting>>& seen,
            const vision::CaptureStatus& status, const std::optional<double>& moved_m);

 private:
  void Follow(SceneRobot& robot);
  void Apply(const TrackInput& input, const std::optional<vision::Sighting>& sighting);
  void Record(const Eigen::Vector2d& p_m, std::optional<double> heading_deg);
  std::vector<geometry::NamedPoint> Places() const;
  std::vector<std::string> Prompts(const std::optional<double>& moved_m) const;

  const vision::CameraModel& camera_;
  Content content_;
  ShowScene show_;
  std::vector<control::Waypoint> recorded_;
  std::vector<SceneRobot> robots_;
  std::optional<double> plane_z_m_;
  std::string said_;
};

}  // namespace rift::view
