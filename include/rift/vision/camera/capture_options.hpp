#pragma once

#include <array>
#include <string>
#include <string_view>

namespace rift::vision {

/// What a V4L2 device is asked for.
enum class DeviceFormat { kMjpg, kYuyv };
constexpr std::array<std::string_view, 2> EnumNames(DeviceFormat) { return {"mjpg", "yuyv"}; }

struct CaptureOptions {
  int width_px = 1920;
  int height_px = 1080;
  double fps = 30.0;
  DeviceFormat format = DeviceFormat::kMjpg;
  double silent_s = 0.6;
  double same_s = 0.6;
  double black_level = 40.0;
  double look_s = 0.2;
  double open_timeout_s = 5.0;
  double reconnect_s = 30.0;
  double most_mbyte = 32.0;
  double most_mpixel = 40.0;
  std::string times;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("width_px", self.width_px, 16, 16384,
          "asked of a V4L2 device; other sources have theirs");
    field("height_px", self.height_px, 16, 16384, "asked of a V4L2 device");
    field("fps", self.fps, 0.1, 1000.0,
          "asked of a V4L2 device; rate of an image pattern; files of their own rate ignore it");
    field("format", self.format,
          "asked of a V4L2 device: mjpg reaches 30 Hz at 1080p over USB 2, yuyv costs no decoding");
    field("silent_s", self.silent_s, 0.05, 60.0,
          "a camera without a new picture so long is frozen");
    field("same_s", self.same_s, 0.05, 60.0,
          "a camera with always the same bytes so long is frozen (a sensor is never that quiet)");
    field("black_level", self.black_level, 0.0, 255.0,
          "a picture whose mean and three deviations stay below is black");
    field("look_s", self.look_s, 0.0, 60.0, "how often a picture is decoded to see if it is black");
    field("open_timeout_s", self.open_timeout_s, 0.1, 600.0,
          "a camera that gives no first picture so long after it was opened is frozen for good");
    field("reconnect_s", self.reconnect_s, 0.0, 1e6,
          "a network camera that broke off is asked again for so long");
    field("most_mbyte", self.most_mbyte, 0.01, 4096.0,
          "a compressed picture of more is passed over, whatever the source");
    field("most_mpixel", self.most_mpixel, 0.01, 1000.0,
          "a picture that claims more is passed over before it is decoded (8K video: 33)");
    field(
        "times", self.times,
        "file with the times of a pattern of pictures: a line each, seconds, or name and seconds; "
        "exif: as their EXIF data say; without either the numbers in their names count, at fps a "
        "second");
  }
};

}  // namespace rift::vision
