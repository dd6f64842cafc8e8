// Captures from a camera for some seconds and prints what became of it, a line each, so that a test
// can do so in a process with another V4L2 device (v4l2_shim.cpp):
//   rift_capture_probe CAMERA SECONDS mjpg|yuyv FPS WIDTH HEIGHT
#include <fmt/format.h>

#include <cstdlib>
#include <string>

#include "rift/vision/camera/capture_thread.hpp"

int main(int argc, char** argv) {
  using namespace rift::vision;
  if (argc != 7) return 2;
  CaptureOptions options;
  options.format = std::string(argv[3]) == "yuyv" ? DeviceFormat::kYuyv : DeviceFormat::kMjpg;
  options.fps = std::atof(argv[4]);
  options.width_px = std::atoi(argv[5]);
  options.height_px = std::atoi(argv[6]);
  const std::string name = argv[1];
  const double end_s = SteadyNow_s() + std::atof(argv[2]);
  double last_frame_s = SteadyNow_s(), destroyed_s = 0.0, latency_s = 0.0;
  CaptureStatus status;
  int frames = 0;
  {
    CaptureThread capture([&] { return OpenCamera(name, options); }, options);
    CameraState shown = CameraState::kOpening;
    while (SteadyNow_s() < end_s && !IsFinal(status.state)) {
      if (const auto frame = capture.Next(0.02)) {
        last_frame_s = SteadyNow_s();
        latency_s += frame->arrived_s - frame->captured_s;
        if (frames++ == 0) {
          fmt::print("first {} {} {}\n", EnumNames(frame->format)[static_cast<int>(frame->format)],
                     frame->width_px, frame->height_px);
        }
      }
      status = capture.Status();
      if (status.state == shown) continue;
      shown = status.state;
      fmt::print("state {} after {:.3f} s without a frame: {}\n",
                 EnumNames(shown)[static_cast<int>(shown)], SteadyNow_s() - last_frame_s,
                 status.reason);
    }
    destroyed_s = SteadyNow_s();
  }
  fmt::print("rate {:.2f}\nlatency {:.4f}\nframes {}\nleft {:.3f}\n", status.rate_hz,
             latency_s / std::max(frames, 1), frames, SteadyNow_s() - destroyed_s);
  return 0;
}
