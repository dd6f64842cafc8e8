#pragma once

#include <memory>
#include <string>

#include "rift/vision/tracking/track_scene.hpp"

namespace rift::vision {

/// Throws std::runtime_error with module::MissingDisplay() where that is not empty.
std::unique_ptr<TrackWindow> OpenTrackWindow(const std::string& title);

/// What a key does, as cv::waitKeyEx reports it; -1 is no key.
void TakeKey(int key, TrackInput& input);

}  // namespace rift::vision
