#include "picture_search.hpp"

namespace rift::vision {

void PictureSearch::Begin(const Frame& frame) {
  frame_ = &frame;
  is_read_ = false;
  patch_.reset();
  for (auto& found : found_) found.reset();
}

const GreyPatch* PictureSearch::Patch() {
  if (!is_read_) patch_ = reader_.Read(*frame_);
  is_read_ = true;
  return patch_ ? &*patch_ : nullptr;
}

const std::vector<TagDetection>& PictureSearch::Find(int decimate) {
  const auto index = static_cast<std::size_t>(decimate);
  auto& found = found_.at(index);
  if (found) return *found;
  auto& detector = detectors_.at(index);
  if (!detector) {
    detector = std::make_unique<TagDetector>(decimate, options_.MaxHamming(),
                                             options_.least_contrast, options_.family);
  }
  const GreyPatch* patch = Patch();
  return found.emplace(patch ? detector->Detect(*patch) : std::vector<TagDetection>());
}

}  // namespace rift::vision
