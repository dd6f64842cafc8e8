#include <fcntl.h>
#include <fmt/format.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "rift/vision/camera/camera_source.hpp"
#include "rift/vision/camera/jpeg.hpp"
#include "rift/vision/camera/steady_now.hpp"
#include "sources.hpp"

namespace rift::vision {
namespace {

/// A second opening of a V4L2 device beside OpenCV's, which knows neither why it cannot open a
/// device nor that one is gone: OpenCV 4.6 hangs in read() when DQBUF answers EIO.
class DeviceProbe {
 public:
  /// Throws CameraError: unplugged (no such device), busy, wrong format (no camera, no right to
  /// open it).
  explicit DeviceProbe(const std::string& path);
  ~DeviceProbe();
  DeviceProbe(const DeviceProbe&) = delete;
  DeviceProbe& operator=(const DeviceProbe&) = delete;

  /// Whether the device still answers. Any thread may ask.
  bool IsPresent() const;
  /// The pixel formats (FOURCC) that it offers.
  std::vector<std::uint32_t> Formats() const;

 private:
  void CheckCaptures() const;
  void CheckIdle() const;

  std::string path_;
  int descriptor_ = -1;
};

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

/// Such as "MJPG".
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

constexpr double kOldestDriverTime_s = 1.0;

std::uint32_t Fourcc(const char (&name)[5]) {
  return static_cast<std::uint32_t>(cv::VideoWriter::fourcc(name[0], name[1], name[2], name[3]));
}

/// The wished format, else another one that is understood.
std::uint32_t ChooseFormat(const std::string& path, const std::vector<std::uint32_t>& offered,
                           DeviceFormat wish) {
  std::array<std::uint32_t, 3> known{Fourcc("MJPG"), Fourcc("YUYV"), Fourcc("GREY")};
  if (wish == DeviceFormat::kYuyv) std::swap(known[0], known[1]);
  for (const std::uint32_t format : known) {
    if (std::find(offered.begin(), offered.end(), format) != offered.end()) return format;
  }
  std::string list;
  for (const std::uint32_t format : offered) {
    list += (list.empty() ? "" : ", ") + FourccText(format);
  }
  throw CameraError(CameraState::kWrongFormat,
                    fmt::format("{}: gives {}, but rift reads MJPG, YUYV and GREY", path,
                                list.empty() ? "no pixel format" : list));
}

class DeviceSource : public CameraSource {
 public:
  DeviceSource(const std::string& path, const CaptureOptions& options)
      : path_(path), probe_(path), format_(ChooseFormat(path, probe_.Formats(), options.format)) {
    if (!capture_.open(path, cv::CAP_V4L2)) {
      throw CameraError(CameraState::kBusy,
                        fmt::format("{}: it is there but does not start: does another program use "
                                    "it, or another camera fill its USB bus?",
                                    path));
    }
    capture_.set(cv::CAP_PROP_FOURCC, static_cast<double>(format_));
    capture_.set(cv::CAP_PROP_FRAME_WIDTH, options.width_px);
    capture_.set(cv::CAP_PROP_FRAME_HEIGHT, options.height_px);
    capture_.set(cv::CAP_PROP_FPS, options.fps);
    // Bytes as they come: a tracker decodes only the region it needs.
    capture_.set(cv::CAP_PROP_CONVERT_RGB, 0.0);
  }

  bool IsPresent() const override { return probe_.IsPresent(); }

  bool Read(Frame& frame) override {
    if (!capture_.grab()) {
      if (IsPresent()) return false;
      throw CameraError(CameraState::kUnplugged, fmt::format("{}: the device is gone", path_));
    }
    frame.arrived_s = SteadyNow_s();
    frame.captured_s = CapturedAt(frame.arrived_s);
    cv::Mat raw;
    if (!capture_.retrieve(raw) || raw.empty()) return false;
    if (Fill(frame, raw)) return in_a_row_ = 0, true;
    ++skipped_;
    if (++in_a_row_ < kMostInARow) return false;
    throw CameraError(CameraState::kWrongFormat,
                      fmt::format("{}: {} bytes are no picture of {}x{} in MJPG, YUYV or GREY",
                                  path_, frame.bytes.size(), frame.width_px, frame.height_px));
  }
  SourceNotes Notes() const override { return {.skipped = skipped_}; }

 private:
  // On a bad cable a JPEG comes without its head, now and then.
  static constexpr int kMostInARow = 5;

  // Drivers stamp with CLOCK_MONOTONIC, which is steady_clock here; some with other clocks or 0.
  double CapturedAt(double arrived_s) const {
    const double driver_s = capture_.get(cv::CAP_PROP_POS_MSEC) / 1000.0;
    const bool sane = driver_s <= arrived_s && driver_s > arrived_s - kOldestDriverTime_s;
    return sane ? driver_s : arrived_s;
  }

  /// False for bytes that are no picture in a format that is understood.
  bool Fill(Frame& frame, const cv::Mat& raw) const {
    const std::size_t size = raw.total() * raw.elemSize();
    frame.bytes.assign(raw.data, raw.data + size);
    if (const auto jpeg = SizeOfJpeg(frame.bytes)) {
      frame.format = PixelFormat::kJpeg;
      frame.width_px = jpeg->width_px;
      frame.height_px = jpeg->height_px;
      frame.bytes.resize(JpegLength(frame.bytes));
      return true;
    }
    frame.width_px = static_cast<int>(capture_.get(cv::CAP_PROP_FRAME_WIDTH));
    frame.height_px = static_cast<int>(capture_.get(cv::CAP_PROP_FRAME_HEIGHT));
    const std::size_t pixels = static_cast<std::size_t>(frame.width_px) * frame.height_px;
    const std::array<std::pair<std::size_t, PixelFormat>, 3> kinds{
        {{1, PixelFormat::kGrey}, {2, PixelFormat::kYuyv}, {3, PixelFormat::kBgr}}};
    for (const auto& [bytes, format] : kinds) {
      if (size != bytes * pixels) continue;
      frame.format = format;
      return true;
    }
    return false;
  }

  std::string path_;
  DeviceProbe probe_;
  std::uint32_t format_;
  cv::VideoCapture capture_;
  std::uint64_t skipped_ = 0;
  int in_a_row_ = 0;  ///< of those
};

}  // namespace

std::unique_ptr<CameraSource> OpenDevice(const std::string& path, const CaptureOptions& options) {
  return std::make_unique<DeviceSource>(path, options);
}

}  // namespace rift::vision
