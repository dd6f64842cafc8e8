// A picture of a camera, as every reader of rift takes it.
#include <algorithm>
#include <cmath>
#include <vector>

#include "fuzz.hpp"
#include "rift/vision/camera/jpeg.hpp"
#include "vision/camera/exif_time.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rift;
  using vision::Region;
  const std::vector<std::uint8_t> bytes(data, data + size);
  if (const auto taken_s = vision::ExifTime_s(bytes)) {
    fuzz::Require(std::abs(*taken_s) < 1e12, "a date lies within ten thousand years");
  }
  fuzz::Require(vision::JpegLength(bytes) <= size, "a picture is no longer than its bytes");
  const std::optional<vision::JpegSize> stated = vision::SizeOfJpeg(bytes);
  if (!stated) return 0;  // cameras' pictures are asked for their size first
  const auto [width, height] = *stated;
  const bool is_large = 1.0 * width * height > 1 << 16;  // takes long, teaches little
  if (width <= 0 || height <= 0 || is_large) return 0;
  static vision::JpegReader reader;  // as in a session: of one picture after the other
  const Region all{0, 0, width, height};
  const Region part{width / 3, height / 3, std::max(1, width / 2), std::max(1, height / 2)};
  for (const Region& region : {all, part}) {
    const auto patch = reader.Read(bytes, width, height, region);
    if (!patch) continue;
    fuzz::Require(
        patch->pixels.size() == static_cast<std::size_t>(region.width_px) * region.height_px,
        "a patch has the pixels of its region");
  }
  for (const int eighths : {8, 1}) {
    vision::DecodeJpeg(bytes, true, eighths);
    vision::DecodeJpeg(bytes, false, eighths);
  }
  return 0;
}
