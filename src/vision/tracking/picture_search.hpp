#pragma once

#include <array>
#include <memory>
#include <vector>

#include "rift/vision/camera/picture_reader.hpp"
#include "rift/vision/tracking/tag_detector.hpp"
#include "rift/vision/tracking/tag_options.hpp"

namespace rift::vision {

/// AprilTag over whole pictures: each picture is decoded once and searched once at each decimation,
/// however many tags are sought in it.
class PictureSearch {
 public:
  explicit PictureSearch(const TagOptions& options) : options_(options) {}

  /// The next picture; it must outlive the searches in it.
  void Begin(const Frame& frame);
  /// nullptr when the picture is damaged.
  const GreyPatch* Patch();
  /// Every tag of the family at every `decimate`-th pixel, 1 to 8; none in a damaged picture.
  const std::vector<TagDetection>& Find(int decimate);

 private:
  static constexpr int kCoarsest = 8;

  TagOptions options_;
  PictureReader reader_;
  const Frame* frame_ = nullptr;
  bool is_read_ = false;
  std::optional<GreyPatch> patch_;
  std::array<std::unique_ptr<TagDetector>, kCoarsest + 1> detectors_;
  std::array<std::optional<std::vector<TagDetection>>, kCoarsest + 1> found_;
};

}  // namespace rift::vision
