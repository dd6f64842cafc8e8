#include "rift/vision/tracking/world_setting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "rift/vision/camera/steady_now.hpp"
#include "rift/vision/tracking/world_check.hpp"
#include "rift/vision/tracking/world_frame.hpp"
#include "rift/yaml/bind.hpp"
#include "rift/yaml/load.hpp"

namespace rift::vision {
namespace {

constexpr double kTick_s = 0.02;
constexpr double kRounded_s = 1e-6;  // a difference of times that count from the machine's start
constexpr double kStill_px = 0.5;    // some times the noise of a corner's mean

std::runtime_error NotSet(const CaptureStatus& status) {
  return std::runtime_error(
      fmt::format("camera {}: {}; the world frame was not set",
                  EnumNames(status.state)[static_cast<std::size_t>(status.state)], status.reason));
}

/// The next picture; throws when there will be none or none comes for long, and for one of another
/// size than the calibration: seen from straight above, reference tags fit a lens of any size.
Frame NextFrame(const WorldSetting& setting) {
  std::optional<double> frozen_since_s;  // a device that hangs is never over by itself
  for (;;) {
    std::optional<Frame> frame = setting.session.capture().Next(kTick_s);
    if (frame) {
      setting.session.RequireSize(*frame);
      return std::move(*frame);
    }
    setting.ThrowIfOver();
    const CaptureStatus status = setting.session.capture().Status();
    const double now_s = SteadyNow_s();
    if (status.state != CameraState::kFrozen) frozen_since_s.reset();
    if (status.state == CameraState::kFrozen && !frozen_since_s) frozen_since_s = now_s;
    if (frozen_since_s && now_s - *frozen_since_s > setting.options.give_up_s) {
      throw NotSet(status);
    }
  }
}

/// A time limit by the pictures' clock: a recording gives them out faster than they were taken. To
/// a microsecond: a recording counts from when it was opened, and how 0.4 s from there are rounded
/// depends on how long the machine has been up.
class TimeLimit {
 public:
  explicit TimeLimit(double limit_s) : limit_s_(limit_s) {}
  bool IsOver(const Frame& frame) {
    if (!has_begun_) begin_s_ = frame.captured_s;
    has_begun_ = true;
    return frame.captured_s - begin_s_ >= limit_s_ - kRounded_s;
  }

 private:
  double limit_s_;
  bool has_begun_ = false;
  double begin_s_ = 0.0;
};

/// The mean over some sightings, from `first` on.
TagCorners MeanCorners(const std::vector<TagCorners>& seen, std::size_t first, std::size_t count) {
  TagCorners mean;
  mean.fill(Eigen::Vector2d::Zero());
  for (std::size_t i = first; i < first + count; ++i) {
    for (std::size_t k = 0; k < mean.size(); ++k) {
      mean[k] += seen[i][k] / static_cast<double>(count);
    }
  }
  return mean;
}

/// The mean of a moving robot's poses is none of them. Held in the picture, where a corner is known
/// to a tenth of a pixel whatever the height and the tilt: its first third against its last.
void RequireStandstill(const std::vector<TagCorners>& seen, int tag_id,
                       const SessionOptions& options) {
  if (seen.size() < 2) return;
  const std::size_t third = std::max<std::size_t>(1, seen.size() / 3);
  const TagCorners first = MeanCorners(seen, 0, third);
  const TagCorners last = MeanCorners(seen, seen.size() - third, third);
  double farthest_px = 0.0;
  for (std::size_t k = 0; k < first.size(); ++k) {
    farthest_px = std::max(farthest_px, (last[k] - first[k]).norm());
  }
  if (farthest_px <= kStill_px) return;
  throw std::invalid_argument(fmt::format(
      "tag {} moved by {:.1f} px while its first pose was averaged over {:g} s (at most {:g}): let "
      "the robot stand still, or give --world-average 0 to take a single picture",
      tag_id, farthest_px, options.world_average_s, kStill_px));
}

/// A frame from another robot's tag, or from one that lies about, is none of this robot's.
void RequireOneRobot(const Sighting& sighting) {
  if (sighting.tags_of_this_id < 2) return;
  throw std::invalid_argument(fmt::format(
      "{} tags with the robot's id {} are in the picture, and nobody knows which one is the "
      "robot's: take away all but the robot's; the world frame was not set",
      sighting.tags_of_this_id, sighting.tag_id));
}

/// A reference tag has one place, and of two in the picture nobody knows which one was measured.
void RequireOneOfEach(const std::vector<ReferenceMark>& marks,
                      const std::vector<TagDetection>& seen) {
  for (const ReferenceMark& mark : marks) {
    const auto tags = std::count_if(seen.begin(), seen.end(),
                                    [&](const TagDetection& tag) { return tag.id == mark.tag_id; });
    if (tags < 2) continue;
    throw std::invalid_argument(
        fmt::format("{} tags with the id {} are in the picture, and the file names one place for "
                    "it: take away those that lie elsewhere",
                    tags, mark.tag_id));
  }
}

/// Four tags laid out in centimetres fit each other perfectly; only a tag of known size tells.
void CheckScaleOf(const WorldSetting& setting, const WorldFrame& world,
                  const std::vector<TagDetection>& seen) {
  CameraModel camera = setting.session.camera();
  camera.world = world;
  const TagOptions& tag = setting.session.tag();
  const auto scale = ScaleByTag(camera, seen, tag.id, tag.size_m, tag.height_m);
  if (scale) {
    CheckScale(*scale, tag.size_m, setting.options.world_scale);
  } else if (setting.say) {
    setting.say(fmt::format(
        "note: the robot's tag {} is not in the picture, so the scale of the frame is not checked",
        tag.id));
  }
}

/// Places in centimetres fit each other and break the limit by the factor alone: what is said is
/// the factor then.
void RefuseOtherUnit(const WorldSetting& setting, const std::vector<ReferenceMark>& marks,
                     const std::vector<TagDetection>& seen) {
  constexpr double kGross = 10.0;
  CameraModel camera = setting.session.camera();
  try {
    camera.world = WorldFromTags(camera, marks, seen, HUGE_VAL);
  } catch (const std::invalid_argument&) {
    return;
  }
  const TagOptions& tag = setting.session.tag();
  const auto scale = ScaleByTag(camera, seen, tag.id, tag.size_m, tag.height_m);
  if (scale && *scale > kGross) CheckScale(*scale, tag.size_m, setting.options.world_scale);
}

WorldFrame FrameOf(const WorldSetting& setting, const std::vector<ReferenceMark>& marks,
                   const std::vector<TagDetection>& seen) {
  try {
    return WorldFromTags(setting.session.camera(), marks, seen, setting.options.world_limit_m);
  } catch (const std::invalid_argument&) {
    RefuseOtherUnit(setting, marks, seen);
    throw;
  }
}

/// One tag has one place.
void RefuseTwice(const yaml::Node& root) {
  const yaml::Node::Entry* tags = root.Find("tags");
  if (tags == nullptr) return;
  std::set<std::string> ids;
  for (const yaml::Node& tag : tags->value.items) {
    const yaml::Node::Entry* id = tag.Find("id");
    if (id != nullptr && !ids.insert(id->value.text).second) {
      yaml::Fail(id->value, "tags[].id", "this tag has a place already: name each tag once");
    }
  }
}

}  // namespace

FloorMarks ReadFloorMarks(std::string_view text, const std::string& source) {
  FloorMarks marks;
  const yaml::Node root = yaml::Parse(text, source);
  yaml::Bind(root, marks);
  RefuseTwice(root);
  if (marks.tags.empty() == marks.points.empty()) {
    throw std::invalid_argument(fmt::format(
        "{}: a world frame wants either `tags:` or `points:`, each with x_m and y_m", source));
  }
  return marks;
}

void WorldSetting::ThrowIfOver() const {
  if (is_stopped()) throw std::runtime_error("stopped before the world frame was set");
  const CaptureStatus status = session.capture().Status();
  if (IsFinal(status.state)) throw NotSet(status);
}

WorldFrame WorldFromRobot(const WorldSetting& setting) {
  CameraModel camera = setting.session.camera();
  camera.world.reset();
  TagTracker tracker(camera, setting.session.tag());
  TimeLimit search(setting.options.world_patience_s);
  std::optional<TimeLimit> averaging;
  std::vector<Eigen::Isometry3d> poses;
  std::vector<TagCorners> corners;
  for (;;) {
    setting.ThrowIfOver();
    const Frame frame = NextFrame(setting);
    if (const auto sighting = tracker.Track(frame).sighting) {
      RequireOneRobot(*sighting);
      poses.push_back(sighting->camera_from_tag);
      corners.push_back(sighting->corners);
      if (!averaging) averaging.emplace(setting.options.world_average_s);
    }
    if (averaging && averaging->IsOver(frame)) break;
    if (poses.empty() && search.IsOver(frame)) {
      throw std::invalid_argument(
          fmt::format("tag {} was not seen within {:g} s: the world frame was not set",
                      setting.session.tag().id, setting.options.world_patience_s));
    }
  }
  RequireStandstill(corners, setting.session.tag().id, setting.options);
  return WorldFromFirstPose(poses, setting.session.tag().height_m);
}

WorldFrame WorldFromFloorTags(const WorldSetting& setting, const std::vector<FloorMark>& tags) {
  std::vector<ReferenceMark> marks;
  for (const FloorMark& tag : tags) {
    RequireTagId(tag.id, setting.session.tag().family);
    marks.push_back({tag.id, {tag.x_m, tag.y_m, tag.z_m}, Eigen::Vector2d::Zero()});
  }
  TimeLimit search(setting.options.world_patience_s);
  for (;;) {
    setting.ThrowIfOver();
    const Frame frame = NextFrame(setting);
    const std::vector<TagDetection> seen =
        FindTags(frame, setting.options.world_decimate, setting.session.tag());
    RequireOneOfEach(marks, seen);
    std::size_t found = 0;
    for (const ReferenceMark& mark : marks) {
      for (const TagDetection& tag : seen) found += tag.id == mark.tag_id;
    }
    // With some missing, the last try says which.
    const bool is_last = search.IsOver(frame) || setting.session.capture().IsRecording();
    if (found >= marks.size() || is_last) {
      WorldFrame world = FrameOf(setting, marks, seen);
      CheckScaleOf(setting, world, seen);
      return world;
    }
  }
}

}  // namespace rift::vision
