#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rift/control/waypoint.hpp"
#include "rift/view/track_window.hpp"

namespace rift::commands {

/// The window of `rift track`, and the waypoints that are made in it. Path, waypoints and clicks
/// lie on the floor; in a map without a world frame, where no floor is known, on the plane in which
/// the tag was first seen.
class TrackView {
 public:
  struct Content {
    std::vector<Eigen::Vector2d> path_m;
    std::vector<control::Waypoint> planned;  ///< those of the path
    std::string record_to;                   ///< file of the recorded waypoints; empty: none
    std::vector<std::string> prompts;
  };

  TrackView(const vision::CameraModel& camera, Content content);

  /// False when the user has asked to end. Writes the waypoints file whenever they change.
  bool Show(const std::optional<vision::Frame>& frame,
            const std::optional<vision::Sighting>& sighting, const vision::CaptureStatus& status,
            const std::optional<double>& moved_m);

  const std::vector<control::Waypoint>& Recorded() const { return recorded_; }

 private:
  void Obey(const view::TrackInput& input, const std::optional<vision::Sighting>& sighting);
  void Record(const Eigen::Vector2d& p_m, std::optional<double> heading_deg);
  void Save() const;
  std::vector<view::MapPlace> Places() const;
  std::vector<std::string> Prompts(const std::optional<double>& moved_m) const;

  const vision::CameraModel& camera_;
  Content content_;
  view::TrackWindow window_;
  std::vector<control::Waypoint> recorded_;
  std::vector<Eigen::Vector2d> trail_m_;
  std::optional<double> plane_z_m_;
  std::string said_;
};

/// A waypoint file, which is an experiment as it is.
std::string WaypointsYaml(const std::vector<control::Waypoint>& waypoints);

}  // namespace rift::commands
