#include "track_world.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>
#include <vector>

#include "enum_name.hpp"
#include "files.hpp"
#include "rift/view/display.hpp"
#include "rift/view/track_window.hpp"
#include "rift/vision/tracking/tag_tracker.hpp"
#include "rift/vision/tracking/world_frame.hpp"
#include "rift/yaml/bind.hpp"
#include "rift/yaml/load.hpp"

namespace rift::commands {
namespace {

constexpr double kTick_s = 0.02;

struct PlaceBlock {
  int id = 0;
  std::string name;
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("id", self.id, 0, 586, "of a tag of the family tag36h11");
    field("name", self.name, "of a point, for the one who clicks");
    field("x_m", self.x_m, -1e3, 1e3, "where its middle lies in the world, x right");
    field("y_m", self.y_m, -1e3, 1e3, "y up, as on a map");
    field("z_m", self.z_m, -1e3, 1e3, "above the floor");
  }
};

struct PlacesFile {
  std::vector<PlaceBlock> tags, points;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("tags", self.tags, "reference tags on the floor");
    field("points", self.points, "marks on the floor that are clicked");
  }
};

PlacesFile ReadPlaces(const std::string& path) {
  PlacesFile file;
  yaml::Bind(yaml::Parse(ReadFile(path), path), file);
  if (file.tags.empty() == file.points.empty()) {
    throw std::invalid_argument(fmt::format(
        "{}: a world frame wants either `tags:` or `points:`, each with x_m and y_m", path));
  }
  return file;
}

void ThrowIfOver(const WorldParts& parts) {
  if (parts.is_stopped()) throw std::runtime_error("stopped before the world frame was set");
  const vision::CaptureStatus status = parts.capture.Status();
  if (!vision::IsFinal(status.state)) return;
  throw std::runtime_error(fmt::format("camera {}: {}; the world frame was not set",
                                       NameOf(status.state), status.reason));
}

/// The next picture; throws when there will be none.
vision::Frame NextFrame(const WorldParts& parts) {
  for (;;) {
    if (std::optional<vision::Frame> frame = parts.capture.Next(kTick_s)) return std::move(*frame);
    ThrowIfOver(parts);
  }
}

/// Time by the pictures, which a recording gives out faster than they were taken.
class Patience {
 public:
  explicit Patience(double limit_s) : limit_s_(limit_s) {}
  bool IsOver(const vision::Frame& frame) {
    if (!has_begun_) begin_s_ = frame.captured_s;
    has_begun_ = true;
    return frame.captured_s - begin_s_ >= limit_s_;
  }

 private:
  double limit_s_;
  bool has_begun_ = false;
  double begin_s_ = 0.0;
};

vision::WorldFrame FromFirstPose(const WorldParts& parts, vision::CameraModel camera) {
  camera.world.reset();
  vision::TagTracker tracker(camera, parts.options.tag);
  Patience patience(parts.session.world_patience_s);
  std::optional<Patience> averaging;
  std::vector<Eigen::Isometry3d> poses;
  for (;;) {
    ThrowIfOver(parts);
    const vision::Frame frame = NextFrame(parts);
    if (const auto sighting = tracker.Track(frame).sighting) {
      poses.push_back(sighting->camera_from_tag);
      if (!averaging) averaging.emplace(parts.session.world_average_s);
    }
    if (averaging && averaging->IsOver(frame)) break;
    if (poses.empty() && patience.IsOver(frame)) {
      throw std::invalid_argument(
          fmt::format("tag {} was not seen within {:g} s: the world frame was not set",
                      parts.options.tag.id, parts.session.world_patience_s));
    }
  }
  return vision::WorldFromFirstPose(poses, parts.session.tag_height_m);
}

vision::WorldFrame FromTags(const WorldParts& parts, const vision::CameraModel& camera,
                            const std::vector<PlaceBlock>& tags) {
  std::vector<vision::ReferenceMark> marks;
  for (const PlaceBlock& tag : tags) {
    marks.push_back({tag.id, {tag.x_m, tag.y_m, tag.z_m}, Eigen::Vector2d::Zero()});
  }
  Patience patience(parts.session.world_patience_s);
  for (;;) {
    ThrowIfOver(parts);
    const vision::Frame frame = NextFrame(parts);
    const std::vector<vision::TagDetection> seen =
        vision::FindTags(frame, parts.session.world_decimate, parts.options.tag.max_hamming);
    std::size_t found = 0;
    for (const vision::ReferenceMark& mark : marks) {
      for (const vision::TagDetection& tag : seen) found += tag.id == mark.tag_id;
    }
    // With some missing, the last try says which.
    const bool last = patience.IsOver(frame) || parts.capture.IsRecording();
    if (found >= marks.size() || last) return vision::WorldFromTags(camera, marks, seen);
  }
}

vision::WorldFrame FromClicks(const WorldParts& parts, vision::CameraModel camera,
                              const std::vector<PlaceBlock>& points) {
  if (const std::string missing = view::MissingDisplay(); !missing.empty()) {
    throw std::runtime_error(fmt::format("{}: points cannot be clicked, use tags", missing));
  }
  camera.world.reset();
  view::TrackWindow window("rift track: world frame");
  std::vector<vision::WorldPoint> clicked;
  std::optional<vision::Frame> frame;
  while (clicked.size() < points.size()) {
    if (auto next = parts.capture.Next(kTick_s)) frame = std::move(next);
    if (!(frame && parts.capture.IsRecording())) ThrowIfOver(parts);
    if (parts.is_stopped()) throw std::runtime_error("stopped before the world frame was set");
    const PlaceBlock& wanted = points[clicked.size()];
    view::TrackScene scene{.camera = &camera, .frame = frame ? &*frame : nullptr};
    scene.status = parts.capture.Status();
    scene.prompts = {fmt::format("click point {} of {}: {} at x {:g} m, y {:g} m (u takes back)",
                                 clicked.size() + 1, points.size(), wanted.name, wanted.x_m,
                                 wanted.y_m)};
    const view::TrackInput input = window.Show(scene);
    if (input.quit) throw std::runtime_error("ended before the world frame was set");
    if (input.undo && !clicked.empty()) clicked.pop_back();
    for (const Eigen::Vector2d& pixel : input.clicks_px) {
      if (clicked.size() == points.size()) break;
      const PlaceBlock& point = points[clicked.size()];
      clicked.push_back({{point.x_m, point.y_m, point.z_m}, pixel});
    }
  }
  return vision::WorldFromPoints(camera, clicked, fmt::format("{} clicked points", clicked.size()));
}

}  // namespace

vision::WorldFrame SetWorld(const WorldParts& parts, const vision::CameraModel& camera,
                            const std::string& wish) {
  if (wish == "first") return FromFirstPose(parts, camera);
  const PlacesFile file = ReadPlaces(wish);
  return file.tags.empty() ? FromClicks(parts, camera, file.points)
                           : FromTags(parts, camera, file.tags);
}

}  // namespace rift::commands
