#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "layout.hpp"

namespace rift::view {

/// Turns scenes of one run into pictures: 8 bits each of blue, green, red. Same scene, same pixels.
class Painter {
 public:
  /// Keeps a reference to the stage.
  Painter(const Stage& stage, cv::Size size);

  const Layout& layout() const { return layout_; }
  /// `footer`: lines at the foot of the text column.
  cv::Mat Paint(const Scene& scene, const std::vector<std::string>& footer = {}) const;

 private:
  const Stage& stage_;
  Layout layout_;
  cv::Mat backdrop_;
};

}  // namespace rift::view
