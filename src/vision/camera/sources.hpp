#pragma once

#include <memory>
#include <string>

#include "rift/vision/camera/camera_source.hpp"

namespace rift::vision {

// The kinds of sources, each in its own file; see OpenCamera.
std::unique_ptr<CameraSource> OpenDevice(const std::string& path, const CaptureOptions& options);
std::unique_ptr<CameraSource> OpenStream(const std::string& url, const CaptureOptions& options);
std::unique_ptr<CameraSource> OpenVideo(const std::string& name, bool is_recording);
std::unique_ptr<CameraSource> OpenImages(const std::string& pattern, double fps);

}  // namespace rift::vision
