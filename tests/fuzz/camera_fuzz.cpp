// A camera's calibration, and the same text as a file of floor marks.
#include "fuzz.hpp"
#include "rift/vision/camera/camera_file.hpp"
#include "rift/vision/tracking/world_setting.hpp"
#include "rift/yaml/node.hpp"

namespace rift {
namespace {

/// False when it is refused, which is one line.
template <class Read>
bool IsRead(const Read& read) {
  try {
    read();
    return true;
  } catch (const yaml::Error& error) {
    fuzz::RequireOneLine(error.what());
  } catch (const std::invalid_argument& error) {
    fuzz::RequireOneLine(error.what());
  }
  return false;
}

}  // namespace
}  // namespace rift

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rift;
  const std::string_view text = fuzz::TextOf(data, size);
  IsRead([&] { vision::ReadFloorMarks(text, "marks.yaml"); });
  vision::CameraModel camera;
  if (!IsRead([&] { camera = vision::ReadCamera(text, "cam.yaml"); })) return 0;
  if (camera.width_px == 0 || camera.height_px == 0) return 0;  // to be taken from a picture
  const std::string written = vision::WriteCamera(camera, vision::CommentOfCamera(text));
  const vision::CameraModel again = vision::ReadCamera(written, "cam.yaml");
  fuzz::Require(vision::WriteCamera(again, vision::CommentOfCamera(written)) == written,
                "a camera that was written reads back the same", written);
  return 0;
}
