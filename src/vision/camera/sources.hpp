#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rift/vision/camera/camera_source.hpp"

namespace rift::vision {

// The live sources of OpenCamera, each in its own file.
std::unique_ptr<CameraSource> OpenDevice(const std::string& path, const CaptureOptions& options);
std::unique_ptr<CameraSource> OpenStream(const std::string& url, const CaptureOptions& options);

/// Cuts multipart/x-mixed-replace (RFC 2046 5.1) into its parts, fed piece by piece. A part ends at
/// its Content-Length where it has one, else at the next boundary.
class MultipartReader {
 public:
  /// `content_type` as the server sent it: `multipart/x-mixed-replace; boundary=frame`, quoted and
  /// with its dashes or not. Throws std::invalid_argument, quoting it, for any other type.
  explicit MultipartReader(std::string_view content_type);

  void Feed(std::string_view bytes) { waiting_.append(bytes); }
  /// The next whole part, if there is one. Throws std::runtime_error when a part grows beyond any
  /// picture.
  std::optional<std::vector<std::uint8_t>> Take();

 private:
  bool SkipToHeaders();
  void CheckSize() const;

  std::string delimiter_;  ///< with its dashes
  std::string waiting_;
};

}  // namespace rift::vision
