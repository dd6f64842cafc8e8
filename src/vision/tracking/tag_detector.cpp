#include "rift/vision/tracking/tag_detector.hpp"

#include <apriltag/apriltag.h>
#include <apriltag/tag16h5.h>
#include <apriltag/tag25h9.h>
#include <apriltag/tag36h11.h>
#include <apriltag/tagStandard41h12.h>

#include <array>
#include <utility>

#include "rift/vision/camera/picture_reader.hpp"

namespace rift::vision {
namespace {

struct FamilyCalls {
  apriltag_family_t* (*create)();
  void (*destroy)(apriltag_family_t*);
};

/// In the order of TagFamily.
constexpr std::array<FamilyCalls, 4> kCalls{{{tag36h11_create, tag36h11_destroy},
                                             {tag25h9_create, tag25h9_destroy},
                                             {tag16h5_create, tag16h5_destroy},
                                             {tagStandard41h12_create, tagStandard41h12_destroy}}};

struct FamilyDeleter {
  TagFamily family;
  void operator()(apriltag_family_t* made) const {
    kCalls[static_cast<std::size_t>(family)].destroy(made);
  }
};
struct DetectorDeleter {
  void operator()(apriltag_detector_t* detector) const { apriltag_detector_destroy(detector); }
};
struct DetectionsDeleter {
  void operator()(zarray_t* detections) const { apriltag_detections_destroy(detections); }
};
using Family = std::unique_ptr<apriltag_family_t, FamilyDeleter>;

Family MakeFamily(TagFamily family) {
  return {kCalls[static_cast<std::size_t>(family)].create(), FamilyDeleter{family}};
}

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
  explicit State(TagFamily of) : family(MakeFamily(of)) {}

  Family family;
  /// Destroyed before the family it points to.
  std::unique_ptr<apriltag_detector_t, DetectorDeleter> detector{apriltag_detector_create()};
};

TagDetector::TagDetector(int decimate, int max_hamming, int least_contrast, TagFamily family)
    : state_(std::make_unique<State>(family)) {
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

TagCells CellsOfTag(int id, TagFamily family) {
  RequireTagId(id, family);
  const Family made = MakeFamily(family);
  TagCells cells{.shape = ShapeOf(family)};
  const int last = cells.shape.cells - 1, around = cells.shape.Around();
  const auto ring = [&cells](int first, int end) {
    for (int i = first; i <= end; ++i) {
      for (const auto& [row, column] :
           {std::pair(first, i), std::pair(end, i), std::pair(i, first), std::pair(i, end)}) {
        cells.is_white[row][column] = true;
      }
    }
  };
  // Around a black square the paper's border is white; a white square has a black one around it.
  if (cells.shape.is_white_square)
    ring(around, last - around);
  else
    ring(0, last);
  for (std::uint32_t bit = 0; bit < made->nbits; ++bit) {
    const std::uint64_t mask = std::uint64_t{1} << (made->nbits - 1 - bit);
    const int row = static_cast<int>(made->bit_y[bit]) + around;
    const int column = static_cast<int>(made->bit_x[bit]) + around;
    cells.is_white[row][column] = (made->codes[id] & mask) != 0;
    cells.is_bit[row][column] = true;
  }
  return cells;
}

std::vector<TagDetection> FindTags(const Frame& frame, int decimate, const TagOptions& options) {
  constexpr int kLeastContrast = 5;
  const auto grey = PictureReader().Read(frame);
  if (!grey) return {};
  std::vector<TagDetection> found =
      TagDetector(decimate, options.MaxHamming(), kLeastContrast, options.family).Detect(*grey);
  constexpr int kManyBits = 36;
  if (ShapeOf(options.family).bits < kManyBits) {
    std::erase_if(
        found, [&](const TagDetection& tag) { return tag.decision_margin < options.min_margin; });
  }
  return found;
}

}  // namespace rift::vision
