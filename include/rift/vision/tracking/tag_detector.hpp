#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "rift/vision/camera/frame.hpp"
#include "rift/vision/tracking/tag_family.hpp"
#include "rift/vision/tracking/tag_options.hpp"

namespace rift::vision {

/// Corners of the square that a family is detected by (black, of tagStandard41h12 white), pixels of
/// the whole picture, middles at integers. As one reads the tag: bottom left, bottom right, top
/// right, top left.
using TagCorners = std::array<Eigen::Vector2d, 4>;

/// What a printed tag looks like: shape.cells x shape.cells cells, rows from the top; true is
/// white. The detected square is cells shape.Around() to shape.Around() + shape.square - 1.
struct TagCells {
  static constexpr int kMost = 10;
  using Grid = std::array<std::array<bool, kMost>, kMost>;

  TagShape shape;
  Grid is_white{};
  Grid is_bit{};  ///< of the id; the others are the same for all ids
};
/// Throws std::invalid_argument for an id that the family does not have.
TagCells CellsOfTag(int id, TagFamily family = TagFamily::k36h11);

struct TagDetection {
  int id = 0;
  int hamming = 0;               ///< bits that AprilTag corrected
  double decision_margin = 0.0;  ///< AprilTag's
  TagCorners corners;            ///< good to about 0.1 px; to 1 px when decimated
};

/// libapriltag for one family; the only file that sees its types is tag_detector.cpp.
class TagDetector {
 public:
  /// decimate: quads are sought in every n-th pixel; max_hamming: 0 to 2 bits are corrected.
  /// least_contrast: grey values between black and white nearby; what has less is not looked at.
  /// AprilTag's 5 is below the noise of a webcam, and most of its time goes into the noise's edges.
  TagDetector(int decimate, int max_hamming, int least_contrast = 5,
              TagFamily family = TagFamily::k36h11);
  ~TagDetector();
  TagDetector(TagDetector&&) noexcept;
  TagDetector& operator=(TagDetector&&) noexcept;

  /// Every tag of the family in the patch, in no particular order.
  std::vector<TagDetection> Detect(const GreyPatch& patch);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Every tag of the family in a picture; none in one that cannot be decoded. Of tag25h9 and
/// tag16h5, whose few bits other things show by chance, those below `min_margin` are left out.
std::vector<TagDetection> FindTags(const Frame& frame, int decimate, const TagOptions& options);

}  // namespace rift::vision
