#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace rift::vision {

/// A picture of a file, read and not decoded.
struct PictureFile {
  std::vector<std::uint8_t> bytes;
  std::string problem;  ///< why it is not to be decoded, for a person; empty: nothing
};

/// Reads a picture that is no more than is put up with, which is looked at before memory for it is
/// taken: what is no file (a pipe or device may have no end), more bytes, no picture of a kind that
/// StatedSize knows, or one of more pixels has a problem and no bytes.
PictureFile ReadPictureFile(const std::string& path, double most_bytes, double most_mpixel);

/// Decodes what ReadPictureFile gave, in grey or in blue, green and red, as the sensor has it: a
/// lens does not turn with the camera, as EXIF data tell. Empty when it cannot be decoded.
cv::Mat DecodePicture(const std::vector<std::uint8_t>& bytes, bool colour);

}  // namespace rift::vision
