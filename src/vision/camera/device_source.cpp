#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <opencv2/videoio.hpp>

#include "device_probe.hpp"
#include "jpeg_size.hpp"
#include "sources.hpp"

namespace rift::vision {
namespace {

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
    Fill(frame, raw);
    return true;
  }

 private:
  // Drivers stamp with CLOCK_MONOTONIC, which is steady_clock here; some with other clocks or 0.
  double CapturedAt(double arrived_s) const {
    const double driver_s = capture_.get(cv::CAP_PROP_POS_MSEC) / 1000.0;
    const bool sane = driver_s <= arrived_s && driver_s > arrived_s - kOldestDriverTime_s;
    return sane ? driver_s : arrived_s;
  }

  void Fill(Frame& frame, const cv::Mat& raw) const {
    const std::size_t size = raw.total() * raw.elemSize();
    frame.bytes.assign(raw.data, raw.data + size);
    if (const auto jpeg = SizeOfJpeg(frame.bytes)) {
      frame.format = PixelFormat::kJpeg;
      frame.width_px = jpeg->width_px;
      frame.height_px = jpeg->height_px;
      frame.bytes.resize(JpegLength(frame.bytes));
      return;
    }
    frame.width_px = static_cast<int>(capture_.get(cv::CAP_PROP_FRAME_WIDTH));
    frame.height_px = static_cast<int>(capture_.get(cv::CAP_PROP_FRAME_HEIGHT));
    const std::size_t pixels = static_cast<std::size_t>(frame.width_px) * frame.height_px;
    const std::array<std::pair<std::size_t, PixelFormat>, 3> kinds{
        {{1, PixelFormat::kGrey}, {2, PixelFormat::kYuyv}, {3, PixelFormat::kBgr}}};
    for (const auto& [bytes, format] : kinds) {
      if (size != bytes * pixels) continue;
      frame.format = format;
      return;
    }
    throw CameraError(CameraState::kWrongFormat,
                      fmt::format("{}: {} bytes are no picture of {}x{} in MJPG, YUYV or GREY",
                                  path_, size, frame.width_px, frame.height_px));
  }

  std::string path_;
  DeviceProbe probe_;
  std::uint32_t format_;
  cv::VideoCapture capture_;
};

}  // namespace

std::unique_ptr<CameraSource> OpenDevice(const std::string& path, const CaptureOptions& options) {
  return std::make_unique<DeviceSource>(path, options);
}

}  // namespace rift::vision
