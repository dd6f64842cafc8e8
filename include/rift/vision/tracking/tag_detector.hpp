#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "rift/vision/camera/frame.hpp"

namespace rift::vision {

/// Corners of the black square, pixels of the whole picture, middles at integers. As one reads the
/// tag: bottom left, bottom right, top right, top left.
using TagCorners = std::array<Eigen::Vector2d, 4>;

/// What a printed tag36h11 looks like: 10 x 10 cells, the white border included, rows from the top;
/// true is white. The black square is cells 1 to 8. Throws std::invalid_argument for an id that the
/// family does not have.
using TagCells = std::array<std::array<bool, 10>, 10>;
TagCells CellsOfTag(int id);

struct TagDetection {
  int id = 0;
  int hamming = 0;               ///< bits that AprilTag corrected
  double decision_margin = 0.0;  ///< AprilTag's
  TagCorners corners;            ///< good to about 0.1 px; to 1 px when decimated
};

/// libapriltag for tag36h11; the only file that sees its types is tag_detector.cpp.
class TagDetector {
 public:
  /// decimate: quads are sought in every n-th pixel; max_hamming: 0 to 2 bits are corrected.
  /// least_contrast: grey values between black and white nearby; what has less is not looked at.
  /// AprilTag's 5 is below the noise of a webcam, and most of its time goes into the noise's edges.
  TagDetector(int decimate, int max_hamming, int least_contrast = 5);
  ~TagDetector();
  TagDetector(TagDetector&&) noexcept;
  TagDetector& operator=(TagDetector&&) noexcept;

  /// Every tag of the family in the patch, in no particular order.
  std::vector<TagDetection> Detect(const GreyPatch& patch);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Every tag in a picture; none in one that cannot be decoded.
std::vector<TagDetection> FindTags(const Frame& frame, int decimate, int max_hamming);

}  // namespace rift::vision
