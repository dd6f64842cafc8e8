#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "rift/vision/camera/frame.hpp"

namespace rift::vision {

// libjpeg-turbo; the only file that sees its types is jpeg.cpp.

struct JpegSize {
  int width_px = 0;
  int height_px = 0;
};

/// The size that a JPEG's frame header states (ITU T.81 B.2.2), without decoding, of the header
/// that libjpeg decodes by; nothing when these bytes are no JPEG.
std::optional<JpegSize> SizeOfJpeg(std::span<const std::uint8_t> bytes);

/// As CaptureOptions::times: when the pictures' EXIF data say that they were taken.
inline constexpr std::string_view kTimesFromExif = "exif";

/// The TIFF structure in its Exif segment (Exif 2.32, 4.7.2); none where there is no such segment.
std::span<const std::uint8_t> ExifOfJpeg(std::span<const std::uint8_t> bytes);

/// How many of the bytes belong to the picture: drivers hand out their whole buffer, and what
/// follows the end marker is left over from older pictures.
std::size_t JpegLength(std::span<const std::uint8_t> bytes);

/// Decodes the luma of parts of pictures.
class JpegReader {
 public:
  JpegReader();
  ~JpegReader();
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;

  /// The luma of the region, which lies inside a picture of the given size. None when the data are
  /// damaged as far as they were read, are a picture of another size, or have more than 100 scans.
  std::optional<GreyPatch> Read(const std::vector<std::uint8_t>& bytes, int width_px, int height_px,
                                const Region& region);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The whole picture, in blue, green, red or in grey, at `eighths` / 8 of its size (1, 2, 4 or 8).
/// Empty when it cannot be decoded, is of another size than SizeOfJpeg says, or has more than 500
/// scans (libjpeg-turbo's own limit); damaged data are grey where they are. Prints nothing, which
/// OpenCV's reader does for every damaged picture.
cv::Mat DecodeJpeg(std::span<const std::uint8_t> bytes, bool colour, int eighths);

/// Compresses a grey picture at a quality of 1 to 100. colour: as YCbCr 4:2:0 with constant chroma,
/// the form that webcams send; otherwise luma alone.
std::vector<std::uint8_t> WriteJpeg(const cv::Mat1b& picture, int quality, bool colour);

}  // namespace rift::vision
