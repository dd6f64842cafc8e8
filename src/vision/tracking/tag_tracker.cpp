#include "rift/vision/tracking/tag_tracker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "edge_fit.hpp"
#include "motion_guess.hpp"
#include "rift/vision/camera/map_frame.hpp"
#include "rift/vision/camera/picture_reader.hpp"
#include "tag_bits.hpp"

namespace rift::vision {

class TagTracker::Search {
 public:
  Search(const CameraModel& camera, const TagOptions& options, std::function<double()> now_s)
      : camera_(camera),
        options_(options),
        now_s_(std::move(now_s)),
        map_from_camera_(MapFromCamera(camera)),
        cells_(CellsOfTag(options.id)),
        in_picture_(options.acquire_decimate, options.max_hamming, options.least_contrast),
        in_region_(options.region_decimate, options.max_hamming, options.least_contrast) {}

  TrackResult Track(const Frame& frame);
  void Forget() { motion_.Forget(); }

 private:
  TrackResult TrackInRegion(const Frame& frame, const TagCorners& expected);
  TrackResult TrackInPicture(const Frame& frame);
  /// AprilTag, then Measure the tag of our id; of several, the one nearest to the expected place,
  /// or else the one with the best margin.
  TrackResult Detect(TagDetector& detector, const GreyPatch& patch, TrackMode mode);
  const TagDetection* Choose(const std::vector<TagDetection>& found) const;
  /// Edges, bits and pose from a guess of the corners.
  TrackResult Measure(const GreyPatch& patch, const TagCorners& guess, TrackMode mode);
  TrackResult Believe(const FittedSquare& square, const ReadBits& bits, TrackMode mode);
  Eigen::Vector3d ExpectedUp(const TagPoses& poses) const;
  bool IsRecheckDue() const {
    return options_.recheck_every > 0 && since_picture_ >= options_.recheck_every;
  }

  CameraModel camera_;
  TagOptions options_;
  std::function<double()> now_s_;
  Eigen::Isometry3d map_from_camera_;
  TagCells cells_;
  TagDetector in_picture_;
  TagDetector in_region_;
  PictureReader reader_;
  MotionGuess motion_;
  std::optional<TagCorners> expected_;
  std::optional<Eigen::Vector3d> last_normal_in_camera_;
  int since_picture_ = 0;
  int tags_of_this_id_ = 1;
};

TrackResult TagTracker::Search::Track(const Frame& frame) {
  if (frame.width_px != camera_.width_px || frame.height_px != camera_.height_px) {
    throw std::invalid_argument(fmt::format(
        "frames are {} x {} but camera {} was calibrated at {} x {}: set the stream to that size "
        "or calibrate again",
        frame.width_px, frame.height_px, camera_.name, camera_.width_px, camera_.height_px));
  }
  expected_ = motion_.At(frame.captured_s, options_.lost_after_s);
  TrackResult result;
  if (expected_ && !IsRecheckDue()) result = TrackInRegion(frame, *expected_);
  if (!result.sighting && result.miss != Miss::kDamagedFrame) result = TrackInPicture(frame);
  if (!result.sighting) return result;
  Sighting& sighting = *result.sighting;
  sighting.frame_index = frame.index;
  sighting.captured_s = frame.captured_s;
  motion_.Saw(frame.captured_s, sighting.corners);
  last_normal_in_camera_ = sighting.camera_from_tag.linear().col(2);
  if (now_s_) sighting.latency_s = now_s_() - frame.captured_s;
  return result;
}

TrackResult TagTracker::Search::TrackInRegion(const Frame& frame, const TagCorners& expected) {
  ++since_picture_;
  const Region region =
      Clipped(Around(expected, options_.region_margin), frame.width_px, frame.height_px);
  if (region.empty()) return {std::nullopt, Miss::kNoTag};  // it should have left the picture
  const auto patch = reader_.Read(frame, region);
  if (!patch) return {std::nullopt, Miss::kDamagedFrame};
  const TrackResult result = Measure(*patch, expected, TrackMode::kEdges);
  return result.sighting ? result : Detect(in_region_, *patch, TrackMode::kRegion);
}

TrackResult TagTracker::Search::TrackInPicture(const Frame& frame) {
  since_picture_ = 0;
  const auto patch = reader_.Read(frame);
  if (!patch) return {std::nullopt, Miss::kDamagedFrame};
  return Detect(in_picture_, *patch, TrackMode::kPicture);
}

TrackResult TagTracker::Search::Detect(TagDetector& detector, const GreyPatch& patch,
                                       TrackMode mode) {
  const std::vector<TagDetection> found = detector.Detect(patch);
  if (mode == TrackMode::kPicture) {
    tags_of_this_id_ = static_cast<int>(std::count_if(
        found.begin(), found.end(), [&](const TagDetection& d) { return d.id == options_.id; }));
  }
  const TagDetection* ours = Choose(found);
  if (ours == nullptr) return {std::nullopt, found.empty() ? Miss::kNoTag : Miss::kOtherTag};
  return Measure(patch, ours->corners, mode);
}

const TagDetection* TagTracker::Search::Choose(const std::vector<TagDetection>& found) const {
  const auto cost = [&](const TagDetection& detection) {
    if (!expected_) return -detection.decision_margin;
    return (detection.corners[0] + detection.corners[2] - (*expected_)[0] - (*expected_)[2]).norm();
  };
  const TagDetection* best = nullptr;
  for (const TagDetection& detection : found) {
    if (detection.id != options_.id) continue;
    if (best == nullptr || cost(detection) < cost(*best)) best = &detection;
  }
  return best;
}

TrackResult TagTracker::Search::Measure(const GreyPatch& patch, const TagCorners& guess,
                                        TrackMode mode) {
  const std::optional<FittedSquare> square =
      FitSquare(camera_, patch, guess, options_.least_contrast);
  if (!square || square->rms_px > options_.max_fit_px) return {std::nullopt, Miss::kNoEdges};
  const ReadBits bits = CompareBits(camera_, patch, *square, cells_);
  if (bits.wrong > options_.max_hamming || bits.margin < options_.min_margin) {
    return {std::nullopt, Miss::kDoubtfulBits};
  }
  return Believe(*square, bits, mode);
}

TrackResult TagTracker::Search::Believe(const FittedSquare& square, const ReadBits& bits,
                                        TrackMode mode) {
  const std::optional<TagPoses> poses =
      SolveTagPoses(camera_, square.rays, options_.size_m, options_.corner_sigma_px);
  if (!poses) return {std::nullopt, Miss::kNoPose};
  const TagPose& pose =
      LikelierPose(*poses, ExpectedUp(*poses), options_.lens_sigma_px, options_.tilt_sigma_rad);
  if (pose.reprojection_px > options_.max_fit_px) return {std::nullopt, Miss::kNoPose};
  Sighting sighting;
  sighting.camera_from_tag = pose.camera_from_tag;
  sighting.map_from_tag = map_from_camera_ * pose.camera_from_tag;
  sighting.in_world = camera_.world.has_value();
  PoseCovariance turn = PoseCovariance::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = map_from_camera_.linear();
  sighting.covariance = turn * pose.covariance * turn.transpose();
  sighting.corners = square.pixels;
  sighting.mode = mode;
  sighting.hamming = bits.wrong;
  sighting.decision_margin = bits.margin;
  sighting.edge_px = square.rms_px;
  sighting.reprojection_px = pose.reprojection_px;
  if (poses->other) {
    sighting.other_reprojection_px =
        &pose == &poses->best ? poses->other->reprojection_px : poses->best.reprojection_px;
  }
  sighting.tags_of_this_id = tags_of_this_id_;
  return {sighting, Miss::kNone};
}

/// The floor's normal when it is known; else the tag's own when last seen, then whatever fits best.
Eigen::Vector3d TagTracker::Search::ExpectedUp(const TagPoses& poses) const {
  if (camera_.world) return map_from_camera_.linear().transpose() * Eigen::Vector3d::UnitZ();
  if (expected_ && last_normal_in_camera_) return *last_normal_in_camera_;
  return poses.best.camera_from_tag.linear().col(2);
}

TagTracker::TagTracker(const CameraModel& camera, const TagOptions& options,
                       std::function<double()> now_s)
    : search_(std::make_unique<Search>(camera, options, std::move(now_s))) {}

TagTracker::~TagTracker() = default;
TagTracker::TagTracker(TagTracker&&) noexcept = default;
TagTracker& TagTracker::operator=(TagTracker&&) noexcept = default;

TrackResult TagTracker::Track(const Frame& frame) { return search_->Track(frame); }

void TagTracker::Forget() { search_->Forget(); }

}  // namespace rift::vision
