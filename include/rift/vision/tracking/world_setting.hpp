#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "rift/vision/tracking/session.hpp"
#include "rift/vision/tracking/session_options.hpp"
#include "rift/vision/tracking/tag_family.hpp"

namespace rift::vision {

/// A tag or a point on the floor whose place in the world is known.
struct FloorMark {
  int id = 0;
  std::string name;
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("id", self.id, 0, kLastTagId, "of a tag of the robot's family (track.tag.family)");
    field("name", self.name, "of a point, for the one who clicks");
    field("x_m", self.x_m, -1e3, 1e3, "where its middle lies in the world, x right");
    field("y_m", self.y_m, -1e3, 1e3, "y up, as on a map");
    field("z_m", self.z_m, -1e3, 1e3, "above the floor");
  }
};

/// What sets a world frame: tags to be seen or points to be clicked, never both.
struct FloorMarks {
  std::vector<FloorMark> tags, points;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("tags", self.tags, "reference tags on the floor");
    field("points", self.points, "marks on the floor that are clicked");
  }
};

/// Reads YAML. Throws yaml::Error with file:line:column for a wrong key or value,
/// std::invalid_argument unless there are either tags or points.
FloorMarks ReadFloorMarks(std::string_view text, const std::string& source);

/// What a world frame is set with. What follows throws std::runtime_error when the camera fails or
/// the user ends it before the frame is set, std::invalid_argument when its pictures are of another
/// size than its calibration.
struct WorldSetting {
  CameraSession& session;
  const SessionOptions& options;
  std::function<bool()> is_stopped;
  /// One line for the user; none: nothing is said.
  std::function<void(const std::string&)> say = {};

  /// Throws when no picture will come any more or the user has ended it.
  void ThrowIfOver() const;
};

/// Origin on the floor below the robot's tag, x where it looks. Throws std::invalid_argument when
/// the tag is not seen in time, or moves while its pose is averaged.
WorldFrame WorldFromRobot(const WorldSetting& setting);

/// Looks for the tags. Throws std::invalid_argument when too few are seen in time or they make no
/// frame.
WorldFrame WorldFromFloorTags(const WorldSetting& setting, const std::vector<FloorMark>& tags);

}  // namespace rift::vision
