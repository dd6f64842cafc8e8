#include "rift/vision/tracking/tag_detector.hpp"

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
#include <fmt/format.h>

#include <stdexcept>

#include "rift/vision/camera/picture_reader.hpp"

namespace rift::vision {
namespace {

struct FamilyDeleter {
  void operator()(apriltag_family_t* family) const { tag36h11_destroy(family); }
};
struct DetectorDeleter {
  void operator()(apriltag_detector_t* detector) const { apriltag_detector_destroy(detector); }
};
struct DetectionsDeleter {
  void operator()(zarray_t* detections) const { apriltag_detections_destroy(detections); }
};
using Family = std::unique_ptr<apriltag_family_t, FamilyDeleter>;

/// AprilTag counts from the picture's corner, so that the first pixel's middle is (0.5, 0.5), and
/// from the patch's corner.
TagDetection FromAprilTag(const apriltag_detection_t& found, const Region& region) {
  TagDetection detection{found.id, found.hamming, found.decision_margin, {}};
  for (int i = 0; i < 4; ++i) {
    detection.corners[i] = {found.p[i][0] - 0.5 + region.x_px, found.p[i][1] - 0.5 + region.y_px};
  }
  return detection;
}

}  // namespace

struct TagDetector::State {
  Family family{tag36h11_create()};
  /// Destroyed before the family it points to.
  std::unique_ptr<apriltag_detector_t, DetectorDeleter> detector{apriltag_detector_create()};
};

TagDetector::TagDetector(int decimate, int max_hamming, int least_contrast)
    : state_(std::make_unique<State>()) {
  apriltag_detector_add_family_bits(state_->detector.get(), state_->family.get(), max_hamming);
  state_->detector->quad_decimate = static_cast<float>(decimate);
  state_->detector->nthreads = 1;
  state_->detector->qtp.min_white_black_diff = least_contrast;
}

TagDetector::~TagDetector() = default;
TagDetector::TagDetector(TagDetector&&) noexcept = default;
TagDetector& TagDetector::operator=(TagDetector&&) noexcept = default;

std::vector<TagDetection> TagDetector::Detect(const GreyPatch& patch) {
  // Its threshold works on tiles of 4 x 4 decimated pixels and fails on a picture without any.
  const int least_px = 8 * static_cast<int>(state_->detector->quad_decimate);
  if (patch.region.width_px < least_px || patch.region.height_px < least_px) return {};
  // AprilTag reads the pixels only; its interface lacks the const.
  image_u8_t image{patch.region.width_px, patch.region.height_px, patch.region.width_px,
                   const_cast<std::uint8_t*>(patch.pixels.data())};
  const std::unique_ptr<zarray_t, DetectionsDeleter> found(
      apriltag_detector_detect(state_->detector.get(), &image));
  std::vector<TagDetection> detections;
  for (int i = 0; i < zarray_size(found.get()); ++i) {
    apriltag_detection_t* detection = nullptr;
    zarray_get(found.get(), i, &detection);
    detections.push_back(FromAprilTag(*detection, patch.region));
  }
  return detections;
}

TagCells CellsOfTag(int id) {
  const Family family(tag36h11_create());
  const int count = static_cast<int>(family->ncodes);
  if (id < 0 || id >= count) {
    throw std::invalid_argument(
        fmt::format("tag id {}: the family tag36h11 has the ids 0 to {}", id, count - 1));
  }
  TagCells cells{};
  for (int i = 0; i < 10; ++i) cells[0][i] = cells[9][i] = cells[i][0] = cells[i][9] = true;
  for (std::uint32_t bit = 0; bit < family->nbits; ++bit) {
    const std::uint64_t mask = std::uint64_t{1} << (family->nbits - 1 - bit);
    cells[family->bit_y[bit] + 1][family->bit_x[bit] + 1] = (family->codes[id] & mask) != 0;
  }
  return cells;
}

std::vector<TagDetection> FindTags(const Frame& frame, int decimate, int max_hamming) {
  const auto grey = PictureReader().Read(frame);
  return grey ? TagDetector(decimate, max_hamming).Detect(*grey) : std::vector<TagDetection>();
}

}  // namespace rift::vision
