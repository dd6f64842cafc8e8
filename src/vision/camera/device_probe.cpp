#include "device_probe.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "rift/vision/camera/camera_state.hpp"

namespace rift::vision {
namespace {

int Ask(int descriptor, unsigned long request, void* argument) {
  int answer = 0;
  do {
    answer = ioctl(descriptor, request, argument);
  } while (answer < 0 && errno == EINTR);
  return answer;
}

[[noreturn]] void Refuse(CameraState state, const std::string& path, const std::string& why) {
  throw CameraError(state, fmt::format("{}: {}", path, why));
}

[[noreturn]] void RefuseToOpen(const std::string& path, int error) {
  const char* reason = std::strerror(error);
  switch (error) {
    case EBUSY:
      Refuse(CameraState::kBusy, path, "another program uses it: close that one");
    case EACCES:
      Refuse(CameraState::kWrongFormat, path,
             fmt::format("{}: add your user to the group 'video'", reason));
    default:
      Refuse(CameraState::kUnplugged, path,
             fmt::format("{}: is the camera plugged in? `ls /dev/video*` shows those there are",
                         reason));
  }
}

}  // namespace

std::string FourccText(std::uint32_t fourcc) {
  std::string text;
  for (int shift = 0; shift < 32; shift += 8) text += static_cast<char>(fourcc >> shift & 0x7F);
  return text;
}

DeviceProbe::DeviceProbe(const std::string& path)
    : path_(path), descriptor_(open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC)) {
  if (descriptor_ < 0) RefuseToOpen(path, errno);
  try {
    CheckCaptures();
    CheckIdle();
  } catch (...) {
    close(descriptor_);
    throw;
  }
}

DeviceProbe::~DeviceProbe() { close(descriptor_); }

void DeviceProbe::CheckCaptures() const {
  v4l2_capability capability{};
  if (Ask(descriptor_, VIDIOC_QUERYCAP, &capability) < 0) {
    Refuse(CameraState::kWrongFormat, path_, "not a V4L2 device");
  }
  const std::uint32_t own = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0
                                ? capability.device_caps
                                : capability.capabilities;
  if ((own & V4L2_CAP_VIDEO_CAPTURE) == 0) {
    Refuse(
        CameraState::kWrongFormat, path_,
        "gives no pictures (many cameras have a second device for metadata: try the one before)");
  }
}

// Opening succeeds on a device in use; only asking for buffers tells.
void DeviceProbe::CheckIdle() const {
  v4l2_requestbuffers buffers{};
  buffers.count = 1;
  buffers.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffers.memory = V4L2_MEMORY_MMAP;
  const bool is_busy = Ask(descriptor_, VIDIOC_REQBUFS, &buffers) < 0 && errno == EBUSY;
  if (is_busy) Refuse(CameraState::kBusy, path_, "another program uses it: close that one");
  buffers.count = 0;
  Ask(descriptor_, VIDIOC_REQBUFS, &buffers);
}

bool DeviceProbe::IsPresent() const {
  v4l2_capability capability{};
  return Ask(descriptor_, VIDIOC_QUERYCAP, &capability) == 0 || errno != ENODEV;
}

std::vector<std::uint32_t> DeviceProbe::Formats() const {
  std::vector<std::uint32_t> formats;
  v4l2_fmtdesc format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  while (Ask(descriptor_, VIDIOC_ENUM_FMT, &format) == 0) {
    formats.push_back(format.pixelformat);
    ++format.index;
  }
  return formats;
}

}  // namespace rift::vision
