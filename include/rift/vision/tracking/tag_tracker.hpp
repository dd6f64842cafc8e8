#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "rift/geometry/pose2.hpp"
#include "rift/vision/camera/camera_model.hpp"
#include "rift/vision/camera/frame.hpp"
#include "rift/vision/tracking/tag_detector.hpp"
#include "rift/vision/tracking/tag_options.hpp"
#include "rift/vision/tracking/tag_pose.hpp"

namespace rift::vision {

/// How a sighting was found, by rising cost.
enum class TrackMode {
  kEdges,    ///< edges found where the motion so far leads, bits compared there
  kRegion,   ///< AprilTag in the region where the tag was expected
  kPicture,  ///< AprilTag in the whole picture
};
constexpr std::array<std::string_view, 3> EnumNames(TrackMode) {
  return {"edges", "region", "picture"};
}

/// Why there is no sighting.
enum class Miss {
  kNone,
  kDamagedFrame,
  kNoTag,
  kOtherTag,
  kDoubtfulBits,
  kNoEdges,
  kNoPose,
  kRival,  ///< a tag of the id was seen, but one that is known not to be the robot's
};
constexpr std::array<std::string_view, 8> EnumNames(Miss) {
  return {"none",          "damaged frame", "no tag",  "only other tags",
          "doubtful bits", "no edges",      "no pose", "a second tag of this id"};
}

/// What a pose is worth.
enum class TrackState {
  kTracked,    ///< measured, and the robot's
  kPredicted,  ///< not seen in this picture; where its motion so far leads
  kAmbiguous,  ///< measured, but another tag of this id may be the robot's
  kLost,       ///< neither seen nor predicted
};
constexpr std::array<std::string_view, 4> EnumNames(TrackState) {
  return {"tracked", "predicted", "ambiguous", "lost"};
}

/// Where the tag was in one frame, with the quality of the measurement.
struct Sighting {
  int tag_id = 0;
  TrackState state = TrackState::kTracked;
  bool is_on_floor = false;  ///< held to the height and tilt of a tag on the floor (FloorPrior)
  std::uint64_t frame_index = 0;
  double captured_s = 0.0;  ///< the frame's
  Eigen::Isometry3d camera_from_tag = Eigen::Isometry3d::Identity();
  /// In the world, z up, or where the camera has none in its own frame turned y-up (MapFromCamera).
  /// Tag frame: x right and y up as one reads the tag, z out of the paper; x is forward.
  Eigen::Isometry3d map_from_tag = Eigen::Isometry3d::Identity();
  bool in_world = false;                               ///< the map is the world
  PoseCovariance covariance = PoseCovariance::Zero();  ///< of map_from_tag, in the map's axes
  TagCorners corners;  ///< pixels of the picture as it is, lens included
  TrackMode mode = TrackMode::kPicture;
  int hamming = 0;               ///< wrong cells
  double decision_margin = 0.0;  ///< mean distance of the bits from the threshold, grey values
  double edge_px = 0.0;          ///< RMS of the edge points about their lines
  double reprojection_px = 0.0;  ///< RMS of the corners about the pose's
  double other_reprojection_px = NAN;  ///< of the planar solution that was not chosen
  int tags_of_this_id = 1;             ///< when the whole picture was last searched
  double latency_s = NAN;              ///< from capture to this result; NaN without a clock

  /// The tag's middle and its x axis on the floor.
  geometry::Pose2 Planar() const;
};

struct TrackResult {
  std::optional<Sighting> sighting;   ///< tracked or ambiguous
  std::optional<Sighting> predicted;  ///< without a sighting, while the last one is fresh
  Miss miss = Miss::kNone;            ///< kNone exactly when there is a sighting

  TrackState State() const {
    if (sighting) return sighting->state;
    return predicted ? TrackState::kPredicted : TrackState::kLost;
  }
};

/// Follows tags from frame to frame, each by itself: one robot's, or several robots' with an id
/// each. The same frames in the same order give the same sightings.
class TagTracker {
 public:
  /// now_s: the steady clock of Frame, for the latency alone; none leaves it NaN. further_ids:
  /// robots beside options.id. std::invalid_argument for an id that the family lacks.
  TagTracker(const CameraModel& camera, const TagOptions& options,
             std::function<double()> now_s = {}, const std::vector<int>& further_ids = {});
  ~TagTracker();
  TagTracker(TagTracker&&) noexcept;
  TagTracker& operator=(TagTracker&&) noexcept;

  /// The tag of options.id. std::invalid_argument when the frame's size is not the camera's.
  TrackResult Track(const Frame& frame);
  /// The same of every id, options.id first.
  std::vector<TrackResult> TrackAll(const Frame& frame);
  /// The next frame is searched as a whole.
  void Forget();

 private:
  class FollowedTag;
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace rift::vision
