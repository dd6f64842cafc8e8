#include "rift/vision/tracking/tag_tracker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <stdexcept>
#include <utility>

#include "motion_guess.hpp"
#include "picture_search.hpp"
#include "rift/vision/camera/camera_model.hpp"
#include "rift/vision/camera/frame.hpp"
#include "rift/vision/camera/picture_reader.hpp"
#include "rift/vision/tracking/tag_detector.hpp"
#include "rift/vision/tracking/tag_visibility.hpp"
#include "robot_choice.hpp"
#include "tag_meter.hpp"

namespace rift::vision {
namespace {

constexpr double kWidestTile_px = 400.0;  // around the last place, searched at full size

Eigen::Vector2d Middle(const TagCorners& corners) {
  return 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
}

TagOptions WithId(TagOptions options, int id) {
  options.id = id;
  return options;
}

}  // namespace

geometry::Pose2 Sighting::Planar() const {
  const Eigen::Vector3d forward = map_from_tag.linear().col(0);
  return {map_from_tag.translation().x(), map_from_tag.translation().y(),
          std::atan2(forward.y(), forward.x())};
}

/// One tag from picture to picture. Cheap first: the edges where it should be, AprilTag in that
/// region, in a tile around its last place, in the whole picture at `acquire_decimate`, and with
/// each further picture without it finer, the third at full size.
class TagTracker::FollowedTag {
 public:
  FollowedTag(const CameraModel& camera, const TagOptions& options)
      : options_(options),
        coarsest_(DecimateFor(camera, options)),
        cells_(CellsOfTag(options.id, options.family)),
        meter_(camera, options),
        in_region_(options.region_decimate, options.MaxHamming(), options.least_contrast,
                   options.family),
        in_tile_(1, options.MaxHamming(), options.least_contrast, options.family),
        choice_(options) {}

  TrackResult Track(const Frame& frame, PictureSearch& picture);
  void Forget();

 private:
  struct Seen {
    std::vector<Sighting> sightings;  ///< of this id, the best first
    Miss miss = Miss::kNone;          ///< why there are none
    bool is_whole = false;
  };

  Seen Look(const Frame& frame, PictureSearch& picture);
  /// Where the motion so far leads.
  TrackResult TrackInRegion(const Frame& frame, const TagCorners& expected);
  /// Around the last place, as far as the robot can have got.
  void AddFromTile(PictureSearch& picture, double since_s, Seen& seen);
  void AddFromPicture(PictureSearch& picture, Seen& seen);
  void Add(const std::vector<TagDetection>& found, const GreyPatch& patch, TrackMode mode,
           Seen& seen);
  TrackResult Decide(const Frame& frame, Seen seen);
  int NextDecimate();
  bool IsRecheckDue() const;
  std::optional<Eigen::Vector3d> LastNormal() const;

  TagOptions options_;
  int coarsest_;
  TagCells cells_;
  TagMeter meter_;
  TagDetector in_region_, in_tile_;
  PictureReader reader_;
  MotionGuess motion_;
  RobotChoice choice_;
  int since_picture_ = 0;
  int searches_ = 0;  ///< of the whole picture since the tag was last found by one
};

void TagTracker::FollowedTag::Forget() {
  motion_.Forget();
  choice_.Forget();
  searches_ = 0;
}

bool TagTracker::FollowedTag::IsRecheckDue() const {
  const int every = choice_.IsInDoubt() ? options_.doubt_recheck_every : options_.recheck_every;
  return options_.recheck_every > 0 && since_picture_ >= every;
}

int TagTracker::FollowedTag::NextDecimate() {
  switch (searches_++ % 3) {
    case 0:
      return coarsest_;
    case 1:
      return (coarsest_ + 1) / 2;
    default:
      return 1;
  }
}

std::optional<Eigen::Vector3d> TagTracker::FollowedTag::LastNormal() const {
  if (!motion_.Last()) return std::nullopt;
  return motion_.Last()->camera_from_tag.linear().col(2);
}

TrackResult TagTracker::FollowedTag::Track(const Frame& frame, PictureSearch& picture) {
  return Decide(frame, Look(frame, picture));
}

TagTracker::FollowedTag::Seen TagTracker::FollowedTag::Look(const Frame& frame,
                                                            PictureSearch& picture) {
  Seen seen;
  const auto expected = motion_.CornersAt(frame.captured_s, options_.lost_after_s);
  if (expected) {
    TrackResult result = TrackInRegion(frame, *expected);
    seen.miss = result.miss;
    if (result.sighting) seen.sightings.push_back(*result.sighting);
    if (result.miss == Miss::kDamagedFrame) return seen;
    if (result.sighting && !IsRecheckDue()) return seen;
  }
  AddFromPicture(picture, seen);
  if (seen.sightings.empty() && motion_.Last() && seen.miss != Miss::kDamagedFrame) {
    AddFromTile(picture, frame.captured_s - motion_.Last()->captured_s, seen);
  }
  return seen;
}

TrackResult TagTracker::FollowedTag::TrackInRegion(const Frame& frame, const TagCorners& expected) {
  ++since_picture_;
  // What is printed around the square is read too; region_margin is meant for one cell of eight.
  const double printed = static_cast<double>(cells_.shape.Around()) / cells_.shape.square - 0.125;
  const double margin_px = (options_.region_margin + printed) * Side_px(expected);
  const Region region = Clipped(Around(expected, margin_px), frame.width_px, frame.height_px);
  if (region.empty()) return {.miss = Miss::kNoTag};  // it should have left the picture
  const auto patch = reader_.Read(frame, region);
  if (!patch) return {.miss = Miss::kDamagedFrame};
  const TrackResult result =
      meter_.Measure(*patch, expected, cells_, TrackMode::kEdges, LastNormal());
  if (result.sighting) return result;
  Seen seen;
  Add(in_region_.Detect(*patch), *patch, TrackMode::kRegion, seen);
  if (seen.sightings.empty()) return {.miss = seen.miss};
  const auto off_px = [&](const Sighting& s) {
    return (Middle(s.corners) - Middle(expected)).norm();
  };
  return {.sighting = *std::min_element(
              seen.sightings.begin(), seen.sightings.end(),
              [&](const Sighting& a, const Sighting& b) { return off_px(a) < off_px(b); })};
}

void TagTracker::FollowedTag::AddFromPicture(PictureSearch& picture, Seen& seen) {
  const GreyPatch* patch = picture.Patch();
  if (patch == nullptr) {
    seen.miss = Miss::kDamagedFrame;
    return;
  }
  since_picture_ = 0;
  seen.is_whole = true;
  Add(picture.Find(NextDecimate()), *patch, TrackMode::kPicture, seen);
  if (!seen.sightings.empty()) searches_ = 0;
}

void TagTracker::FollowedTag::AddFromTile(PictureSearch& picture, double since_s, Seen& seen) {
  const TagCorners& last = motion_.Last()->corners;
  const double px_per_m = Side_px(last) / options_.size_m;
  const double reach_px = px_per_m * (options_.reach_m + options_.reach_mps * std::abs(since_s));
  const GreyPatch& all = *picture.Patch();
  const Region region = Clipped(Around(last, std::min(reach_px, kWidestTile_px)),
                                all.region.width_px, all.region.height_px);
  if (region.empty()) return;
  GreyPatch tile{region, {}};
  tile.pixels.reserve(static_cast<std::size_t>(region.width_px) * region.height_px);
  for (int y = region.y_px; y < region.y_px + region.height_px; ++y) {
    const auto row =
        all.pixels.begin() + static_cast<std::ptrdiff_t>(y) * all.region.width_px + region.x_px;
    tile.pixels.insert(tile.pixels.end(), row, row + region.width_px);
  }
  Add(in_tile_.Detect(tile), tile, TrackMode::kRegion, seen);
}

/// Those of this id that can be measured, by AprilTag's margin; one that is there already is not
/// another one.
void TagTracker::FollowedTag::Add(const std::vector<TagDetection>& found, const GreyPatch& patch,
                                  TrackMode mode, Seen& seen) {
  std::vector<const TagDetection*> ours;
  for (const TagDetection& tag : found) {
    if (tag.id == options_.id) ours.push_back(&tag);
  }
  std::stable_sort(ours.begin(), ours.end(), [](const TagDetection* a, const TagDetection* b) {
    return a->decision_margin > b->decision_margin;
  });
  if (seen.sightings.empty()) seen.miss = found.empty() ? Miss::kNoTag : Miss::kOtherTag;
  for (const TagDetection* tag : ours) {
    const bool is_known =
        std::any_of(seen.sightings.begin(), seen.sightings.end(), [&](const Sighting& sighting) {
          return (Middle(sighting.corners) - Middle(tag->corners)).norm() <
                 0.5 * Side_px(tag->corners);
        });
    if (is_known) continue;
    const TrackResult result = meter_.Measure(patch, tag->corners, cells_, mode, LastNormal());
    if (result.sighting) seen.sightings.push_back(*result.sighting);
    if (seen.sightings.empty()) seen.miss = result.miss;
  }
  if (!seen.sightings.empty()) seen.miss = Miss::kNone;
}

TrackResult TagTracker::FollowedTag::Decide(const Frame& frame, Seen seen) {
  std::vector<Eigen::Vector3d> places;
  for (const Sighting& s : seen.sightings) places.push_back(s.map_from_tag.translation());
  const RobotChoice::Verdict verdict = choice_.Choose(frame.captured_s, places, seen.is_whole);
  if (!verdict.robot) {
    TrackResult result{.predicted = motion_.PoseAt(frame.captured_s, options_.lost_after_s),
                       .miss = seen.sightings.empty() ? seen.miss : Miss::kRival};
    if (result.predicted) result.predicted->frame_index = frame.index;
    return result;
  }
  Sighting& sighting = seen.sightings[*verdict.robot];
  sighting.tag_id = options_.id;
  sighting.frame_index = frame.index;
  sighting.captured_s = frame.captured_s;
  sighting.state = verdict.is_ambiguous ? TrackState::kAmbiguous : TrackState::kTracked;
  sighting.tags_of_this_id = choice_.Tags();
  motion_.Saw(sighting);
  return {.sighting = sighting};
}

struct TagTracker::State {
  State(const CameraModel& model, const TagOptions& options, std::function<double()> clock)
      : camera(model), now_s(std::move(clock)), picture(options) {}

  CameraModel camera;
  std::function<double()> now_s;
  PictureSearch picture;
  std::deque<FollowedTag> tags;
};

TagTracker::TagTracker(const CameraModel& camera, const TagOptions& options,
                       std::function<double()> now_s, const std::vector<int>& further_ids)
    : state_(std::make_unique<State>(camera, options, std::move(now_s))) {
  state_->tags.emplace_back(camera, options);
  for (const int id : further_ids) state_->tags.emplace_back(camera, WithId(options, id));
}

TagTracker::~TagTracker() = default;
TagTracker::TagTracker(TagTracker&&) noexcept = default;
TagTracker& TagTracker::operator=(TagTracker&&) noexcept = default;

std::vector<TrackResult> TagTracker::TrackAll(const Frame& frame) {
  const CameraModel& camera = state_->camera;
  if (frame.width_px != camera.width_px || frame.height_px != camera.height_px) {
    throw std::invalid_argument(fmt::format(
        "frames are {} x {} but camera {} was calibrated at {} x {}: set the stream to that size "
        "or calibrate again",
        frame.width_px, frame.height_px, camera.name, camera.width_px, camera.height_px));
  }
  state_->picture.Begin(frame);
  std::vector<TrackResult> results;
  for (FollowedTag& tag : state_->tags) {
    TrackResult& result = results.emplace_back(tag.Track(frame, state_->picture));
    if (result.sighting && state_->now_s) {
      result.sighting->latency_s = state_->now_s() - frame.captured_s;
    }
  }
  return results;
}

TrackResult TagTracker::Track(const Frame& frame) { return TrackAll(frame).front(); }

void TagTracker::Forget() {
  for (FollowedTag& tag : state_->tags) tag.Forget();
}

}  // namespace rift::vision
