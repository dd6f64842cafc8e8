// Captures from a camera until it is in a state (-: whatever it is in), then MORE pictures, or
// until it ends, and prints what became of it, a line each, so that a test can do so in a process
// with another V4L2 device (v4l2_shim.cpp):
//   rift_capture_probe CAMERA STATE MORE mjpg|yuyv FPS WIDTH HEIGHT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>

#include "rift/vision/camera/capture_thread.hpp"

namespace {

using namespace rift::vision;

struct Seen {
  int frames = 0;
  double latency_s = 0.0;
  std::optional<double> captured_s;
  double off_beat = 0.0;       ///< most that a picture was beside a multiple of 1 / fps, in 1 / fps
  double shortest_step = 1e9;  ///< between two pictures, in 1 / fps

  void Take(const Frame& frame, double fps) {
    if (frames++ == 0) {
      fmt::print("first {} {} {}\n", EnumNames(frame.format)[static_cast<int>(frame.format)],
                 frame.width_px, frame.height_px);
    }
    latency_s += frame.arrived_s - frame.captured_s;
    if (captured_s) {
      const double step = (frame.captured_s - *captured_s) * fps;
      off_beat = std::max(off_beat, std::abs(step - std::round(step)));
      shortest_step = std::min(shortest_step, step);
    }
    captured_s = frame.captured_s;
  }
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 8) return 2;
  const std::string name = argv[1], wanted = argv[2];
  const std::uint64_t more = std::strtoull(argv[3], nullptr, 10);
  CaptureOptions options;
  options.format = std::string(argv[4]) == "yuyv" ? DeviceFormat::kYuyv : DeviceFormat::kMjpg;
  options.fps = std::atof(argv[5]);
  options.width_px = std::atoi(argv[6]);
  options.height_px = std::atoi(argv[7]);
  options.open_timeout_s = 600.0;
  CaptureStatus status;
  Seen seen;
  {
    CaptureThread capture([&] { return OpenCamera(name, options); }, options);
    CameraState shown = CameraState::kOpening;
    std::optional<std::uint64_t> enough;
    if (wanted == "-") enough = more;
    while (!IsFinal(status.state) && !(enough && status.delivered >= *enough)) {
      if (const auto frame = capture.Next(0.02)) seen.Take(*frame, options.fps);
      status = capture.Status();
      if (status.state == shown) continue;
      shown = status.state;
      const std::string state(EnumNames(shown)[static_cast<int>(shown)]);
      fmt::print("state {}: {}\n", state, status.reason);
      if (state == wanted && !enough) enough = status.delivered + more;
    }
  }
  fmt::print(
      "rate {:.2f}\nlatency {:.4f}\nframes {}\noff_beat {:.4f}\nshortest_step {:.4f}\n"
      "skipped {}\nleft\n",
      status.rate_hz, seen.latency_s / std::max(seen.frames, 1), seen.frames, seen.off_beat,
      seen.shortest_step, status.skipped);
  return 0;
}
