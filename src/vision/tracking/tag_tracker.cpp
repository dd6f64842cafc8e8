#include "rift/vision/tracking/tag_tracker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>
#include <stdexcept>
#include <utility>

#include "edge_fit.hpp"
#include "rift/vision/camera/camera_model.hpp"
#include "rift/vision/camera/frame.hpp"
#include "rift/vision/camera/picture_reader.hpp"
#include "rift/vision/tracking/tag_detector.hpp"

namespace rift::vision {
namespace {

/// Where the corners will be, from the last two times they were seen: the square goes on moving and
/// turning as it did.
class MotionGuess {
 public:
  void Saw(double t_s, const TagCorners& corners);
  void Forget();
  /// None when nothing was seen in the `lost_after_s` before t_s.
  std::optional<TagCorners> At(double t_s, double lost_after_s) const;

 private:
  struct Seen {
    double t_s;
    TagCorners corners;
  };
  std::optional<Seen> last_;
  std::optional<Seen> before_;
};

/// The pixels around the corners with `margin` sides of the square to spare.
Region Around(const TagCorners& corners, double margin);

/// Mean length of the four sides.
double Side_px(const TagCorners& corners);

using Complex = std::complex<double>;

Complex Plane(const Eigen::Vector2d& p) { return {p.x(), p.y()}; }

/// z -> middle_to + ratio (z - middle_from): the similarity that fits the corners best.
struct Similarity {
  Complex middle_from;
  Complex middle_to;
  Complex ratio;
};

Similarity FitSimilarity(const TagCorners& from, const TagCorners& to) {
  Similarity fit{0.0, 0.0, 0.0};
  for (int i = 0; i < 4; ++i) {
    fit.middle_from += 0.25 * Plane(from[i]);
    fit.middle_to += 0.25 * Plane(to[i]);
  }
  Complex product = 0.0;
  double weight = 0.0;
  for (int i = 0; i < 4; ++i) {
    const Complex arm = Plane(from[i]) - fit.middle_from;
    product += std::conj(arm) * (Plane(to[i]) - fit.middle_to);
    weight += std::norm(arm);
  }
  fit.ratio = product / weight;
  return fit;
}

void MotionGuess::Saw(double t_s, const TagCorners& corners) {
  before_ = last_;
  last_ = Seen{t_s, corners};
}

void MotionGuess::Forget() {
  before_.reset();
  last_.reset();
}

std::optional<TagCorners> MotionGuess::At(double t_s, double lost_after_s) const {
  if (!last_ || !(std::abs(t_s - last_->t_s) <= lost_after_s)) return std::nullopt;
  if (!before_ || !(last_->t_s - before_->t_s > 0.0) || last_->t_s - before_->t_s > lost_after_s) {
    return last_->corners;
  }
  const Similarity step = FitSimilarity(before_->corners, last_->corners);
  const double share = (t_s - last_->t_s) / (last_->t_s - before_->t_s);
  const Complex middle = step.middle_to + share * (step.middle_to - step.middle_from);
  const Complex turn = std::polar(1.0, share * std::arg(step.ratio));
  TagCorners corners;
  for (int i = 0; i < 4; ++i) {
    const Complex corner = middle + turn * (Plane(last_->corners[i]) - step.middle_to);
    corners[i] = {corner.real(), corner.imag()};
  }
  return corners;
}

Region Around(const TagCorners& corners, double margin) {
  Eigen::Vector2d least = corners[0];
  Eigen::Vector2d greatest = corners[0];
  for (const Eigen::Vector2d& corner : corners) {
    least = least.cwiseMin(corner);
    greatest = greatest.cwiseMax(corner);
  }
  const double spare_px = margin * Side_px(corners);
  const auto pixel = [](double v) { return static_cast<int>(std::clamp(v, -1e6, 1e6)); };
  const int left = pixel(std::floor(least.x() - spare_px));
  const int top = pixel(std::floor(least.y() - spare_px));
  return {left, top, pixel(std::ceil(greatest.x() + spare_px)) + 1 - left,
          pixel(std::ceil(greatest.y() + spare_px)) + 1 - top};
}

double Side_px(const TagCorners& corners) {
  double sum = 0.0;
  for (int i = 0; i < 4; ++i) sum += (corners[(i + 1) % 4] - corners[i]).norm();
  return sum / 4.0;
}

}  // namespace

geometry::Pose2 Sighting::Planar() const {
  const Eigen::Vector3d forward = map_from_tag.linear().col(0);
  return {map_from_tag.translation().x(), map_from_tag.translation().y(),
          std::atan2(forward.y(), forward.x())};
}

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
