#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rift/vision/camera/camera_source.hpp"

namespace rift::vision {

// The sources of OpenCamera, each in its own file.
std::unique_ptr<CameraSource> OpenDevice(const std::string& path, const CaptureOptions& options);
std::unique_ptr<CameraSource> OpenStream(const std::string& url, const CaptureOptions& options);
std::unique_ptr<CameraSource> OpenImages(const std::string& pattern, const CaptureOptions& options);
/// A video file.
std::unique_ptr<CameraSource> OpenVideo(const std::string& path);
/// rtsp:// and whatever else FFmpeg reads from a network.
std::unique_ptr<CameraSource> OpenNetwork(const std::string& url, const CaptureOptions& options);

/// By its ending, in small or large letters, so that a missing file is refused as what it was meant
/// to be.
bool NamesPicture(std::string_view name);

/// A connection that breaks and is made again, until it was broken for too long.
class Reconnection {
 public:
  explicit Reconnection(double limit_s) : limit_s_(limit_s) {}

  /// A picture came.
  void Works(double now_s);
  /// The connection broke, or could not be made: notes why. Throws CameraError (unplugged) with the
  /// reason when there was never a picture, or none for longer than the limit.
  void Broke(const std::string& reason, double now_s);
  /// When it is time to try again.
  bool IsDue(double now_s) const { return now_s >= next_s_; }
  /// A new connection was begun.
  void Tries() { ++count_; }

  const std::string& Interruption() const { return reason_; }  ///< empty while pictures come
  int Count() const { return count_; }

 private:
  double limit_s_;
  std::optional<double> last_s_;
  double next_s_ = 0.0;
  std::string reason_;
  int count_ = 0;
};

/// Cuts multipart/x-mixed-replace (RFC 2046 5.1) into its parts, fed piece by piece. A part ends at
/// its Content-Length where it has one, else at the next boundary. Lines end with CRLF or LF.
class MultipartReader {
 public:
  /// `content_type` as the server sent it: `multipart/x-mixed-replace; boundary=frame`, quoted and
  /// with its dashes or not. Throws std::invalid_argument, quoting it, for any other type. A part
  /// of more than `most_bytes` is passed over, and so many are kept at most.
  MultipartReader(std::string_view content_type, std::size_t most_bytes);

  void Feed(std::string_view bytes) { waiting_.append(bytes); }
  /// The next whole part, if there is one. Throws std::runtime_error when none of the bytes is a
  /// boundary.
  std::optional<std::vector<std::uint8_t>> Take();
  /// Parts that were passed over: too large, or without an end.
  std::uint64_t Skipped() const { return skipped_; }

 private:
  struct Head {
    std::size_t begin = 0;  ///< of the part's body
    std::optional<std::size_t> length;
  };

  bool SkipToBoundary();
  std::optional<Head> TakeHead() const;
  /// Where the body ends; nothing while it has not all come.
  std::optional<std::size_t> EndOf(const Head& head) const;
  void PassOver(std::size_t bytes);

  std::string delimiter_;  ///< with its dashes
  std::string waiting_;
  std::size_t most_bytes_;
  std::uint64_t skipped_ = 0;
};

}  // namespace rift::vision
