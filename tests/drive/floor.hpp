#pragma once

#include <fmt/format.h>

#include <cmath>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "hardware/pseudo_terminal.hpp"
#include "rift/control/diff_drive.hpp"
#include "rift/hardware/listener.hpp"
#include "rift/hardware/serial_port.hpp"
#include "rift/vision/camera/camera_file.hpp"
#include "support/inputs/paper_camera.hpp"
#include "support/inputs/wire_bytes.hpp"
#include "vision/mjpeg_server.hpp"
#include "vision/rendered_tags.hpp"

namespace rift::test {

/// The paper's camera with half its pixels.
inline vision::CameraModel SmallCamera() {
  vision::CameraModel camera = PaperCamera();
  camera.width_px /= 2;
  camera.height_px /= 2;
  camera.k.topRows<2>() *= 0.5;
  return camera;
}

/// A robot on a floor under a camera, for the rift binary: the listener behind a pseudo terminal,
/// and an http camera. The robot moves by a fixed time with every picture, however long the machine
/// takes for one, so a slow machine makes a slow world and no other path. The robot's own clock
/// goes slower than the machine's, else its watchdog would stop it when the machine is busy.
class Floor {
 public:
  /// The camera is gone after `moving_pictures` of a robot that moves.
  explicit Floor(const geometry::Pose2& start, int moving_pictures = 1'000'000)
      : pose_(start),
        moving_pictures_(moving_pictures),
        camera_(SmallCamera(), vision::SyntheticCameraOptions{}),
        listening_([this](const std::stop_token& stop) {
          while (!stop.stop_requested()) Listen();
        }),
        server_([this] { return NextPicture(); }, {.fps = kPictures_hz}) {}

  const std::string& Port() const { return terminal_.path(); }
  std::string Camera() const { return server_.Url(); }
  geometry::Pose2 Pose() {
    const std::lock_guard lock(mutex_);
    return pose_;
  }
  /// What the robot would say of itself.
  std::string Told() {
    const std::lock_guard lock(mutex_);
    return fmt::format("the robot stopped {} times by itself and rejected {} commands",
                       listener_.Stops(), listener_.Rejected());
  }
  /// It obeyed everything, but for a time when it had stopped by itself.
  bool WasObedient() {
    const std::lock_guard lock(mutex_);
    return listener_.Rejected() == 0 || listener_.Stops() > 0;
  }
  /// What came that is no command.
  std::string NoCommands() {
    const std::lock_guard lock(mutex_);
    return BytesThatAreNoCommands(heard_);
  }
  /// What changes in the pictures of a camera that shows its last one again and again.
  enum class Repeat { kNothing, kComment, kPixels };
  /// From now on, while the robot goes on. `kComment`: other bytes in a comment of each; `kPixels`:
  /// the same scene is drawn anew, with noise in every pixel.
  void RepeatPicture(Repeat repeat) {
    const std::lock_guard lock(mutex_);
    repeat_ = repeat;
  }
  /// From its first motion on it obeys as ever and answers nothing.
  void FallSilentOnceItMoves() {
    const std::lock_guard lock(mutex_);
    is_silent_once_it_moves_ = true;
  }
  bool Moves() {
    const std::lock_guard lock(mutex_);
    return !listener_.Motors().IsZero();
  }

 private:
  static constexpr double kPictures_hz = 20.0;
  static constexpr double kStep_s = 1.0 / 60.0;
  static constexpr double kClockSpeed = 0.1;

  void Listen() {
    const std::vector<std::uint8_t> heard = terminal_.Read(2);
    const std::lock_guard lock(mutex_);
    heard_.insert(heard_.end(), heard.begin(), heard.end());
    const auto counts = [](double rolled_m) {
      return static_cast<std::int32_t>(std::floor(3564.0 * rolled_m));
    };
    const auto now_ms = static_cast<std::uint32_t>(1000.0 * kClockSpeed * clock_.Now_s());
    const std::vector<std::uint8_t> said =
        listener_.Poll(now_ms, heard, {counts(rolled_left_m_), counts(rolled_right_m_), 4800});
    is_silent_ = is_silent_ || (is_silent_once_it_moves_ && !listener_.Motors().IsZero());
    if (!is_silent_) terminal_.Write(said);
  }

  std::vector<std::uint8_t> NextPicture() {
    std::optional<Repeat> repeat;
    {
      const std::lock_guard lock(mutex_);
      const hardware::MilliPower motors = listener_.Motors();
      if (!motors.IsZero() && moving_pictures_-- == 0) return {};
      constexpr double kFull_mps = 1.206;  // of a wheel at full power
      rolled_left_m_ += kFull_mps * 1e-3 * motors.left * kStep_s;
      rolled_right_m_ += kFull_mps * 1e-3 * motors.right * kStep_s;
      pose_ = drive_.Drive(pose_, {1e-3 * motors.left, 1e-3 * motors.right}, kStep_s);
      repeat = repeat_;
      if (!repeat) shown_ = pose_;
    }
    if (repeat == Repeat::kNothing) return last_;
    if (repeat == Repeat::kComment) return WithComment(last_);
    last_ = camera_
                .Render(RobotAt(shown_.x_m, shown_.y_m, shown_.yaw_rad), vision::PixelFormat::kJpeg,
                        generator_)
                .bytes;
    return last_;
  }

  /// The same picture with a JPEG comment of random bytes behind its first marker.
  std::vector<std::uint8_t> WithComment(std::vector<std::uint8_t> jpeg) {
    std::vector<std::uint8_t> comment{0xff, 0xfe, 0x00, 0x0a};
    for (int i = 0; i < 8; ++i) comment.push_back(static_cast<std::uint8_t>(generator_()));
    jpeg.insert(jpeg.begin() + 2, comment.begin(), comment.end());
    return jpeg;
  }

  std::mutex mutex_;
  geometry::Pose2 pose_;
  int moving_pictures_;
  std::optional<Repeat> repeat_;
  // Used by the camera's thread alone.
  geometry::Pose2 shown_;
  std::vector<std::uint8_t> last_;
  double rolled_left_m_ = 0.0, rolled_right_m_ = 0.0;
  std::vector<std::uint8_t> heard_;
  bool is_silent_once_it_moves_ = false, is_silent_ = false;
  control::DiffDrive drive_;
  hardware::Listener listener_;
  hardware::SteadyClock clock_;
  hardware::PseudoTerminal terminal_;
  vision::SyntheticCamera camera_;
  std::mt19937_64 generator_{1};
  std::jthread listening_;
  vision::synthetic::MjpegServer server_;
};

}  // namespace rift::test
