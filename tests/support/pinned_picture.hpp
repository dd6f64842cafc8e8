#pragma once

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "support/tree.hpp"

namespace rift::test {

/// Empty when `picture`, four by four pixels averaged into one, is what tests/pinned/`name` holds
/// to kSame grey values, else where it differs most. With RIFT_PIN=1 in the environment the
/// file is written instead: look at it before it is committed.
inline std::string DifferenceFromPinnedPicture(const std::string& name, const cv::Mat& picture) {
  constexpr double kSame = 1.0;  // as processors may round differently
  cv::Mat small;
  cv::resize(picture, small, {picture.cols / 4, picture.rows / 4}, 0.0, 0.0, cv::INTER_AREA);
  const std::filesystem::path path = std::filesystem::path(SourceDir()) / "tests/pinned" / name;
  if (std::getenv("RIFT_PIN") != nullptr) {
    std::filesystem::create_directories(path.parent_path());
    return cv::imwrite(path.string(), small) ? "" : path.string() + " cannot be written";
  }
  const cv::Mat pinned = cv::imread(path.string(), cv::IMREAD_COLOR);
  if (pinned.size() != small.size()) {
    return fmt::format("tests/pinned/{} is {} x {}, and this is {} x {}: see RIFT_PIN", name,
                       pinned.cols, pinned.rows, small.cols, small.rows);
  }
  cv::Mat off;
  cv::absdiff(pinned.reshape(1), small.reshape(1), off);
  double most = 0.0;
  cv::Point where;
  cv::minMaxLoc(off, nullptr, &most, nullptr, &where);
  if (most <= kSame) return "";
  return fmt::format("tests/pinned/{} differs by {} grey values at ({}, {}): see RIFT_PIN", name,
                     most, where.x / 3, where.y);
}

}  // namespace rift::test
