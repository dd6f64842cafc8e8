#include "rift/vision/camera/capture_thread.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "rift/vision/camera/camera_source.hpp"
#include "rift/vision/camera/steady_now.hpp"

namespace rift::vision {
namespace {

using Catch::Matchers::Contains;

/// What a scripted camera is told to do next: a picture, an error, or nothing for a while.
struct Move {
  std::shared_ptr<Frame> frame;
  std::optional<CameraState> error;
};

/// The test's end of a scripted camera: each Read waits for a move.
class Script {
 public:
  void Do(Move move) {
    const std::lock_guard lock(mutex_);
    moves_.push_back(std::move(move));
    changed_.notify_all();
  }
  /// Of one grey value at a time on the steady clock.
  void Give(int grey, double at_s, int width_px = 8) {
    Frame frame{.captured_s = at_s - 0.02, .arrived_s = at_s, .width_px = width_px, .height_px = 8};
    frame.bytes.assign(static_cast<std::size_t>(width_px) * 8, static_cast<std::uint8_t>(grey));
    Do({std::make_shared<Frame>(frame), {}});
  }
  /// Nothing comes any more, and nobody waits for it.
  void End() {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
    changed_.notify_all();
  }
  Move Next() {
    std::unique_lock lock(mutex_);
    ++asked_;
    changed_.wait(lock, [&] { return is_over_ || !moves_.empty(); });
    if (is_over_) return {nullptr, CameraState::kEnded};
    Move move = std::move(moves_.front());
    moves_.pop_front();
    return move;
  }

  /// How often the capture came for a move: what it was given before it has dealt with.
  int Asked() {
    const std::lock_guard lock(mutex_);
    return asked_;
  }

  bool is_recording = false;
  std::atomic<bool> is_present = true;

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Move> moves_;
  bool is_over_ = false;
  int asked_ = 0;
};

class ScriptedCamera final : public CameraSource {
 public:
  explicit ScriptedCamera(Script& script) : script_(script) {}
  bool Read(Frame& frame) override {
    Move move = script_.Next();
    if (move.error) throw CameraError(*move.error, "as the script says");
    if (!move.frame) return false;
    frame = std::move(*move.frame);
    return true;
  }
  bool IsPresent() const override { return script_.is_present; }
  bool IsRecording() const override { return script_.is_recording; }

 private:
  Script& script_;
};

constexpr double kLong_s = 20.0;

/// A camera under a script, and its capture; its thread is let go at the end.
struct Session {
  explicit Session(CaptureOptions options = {}, bool is_recording = false) {
    script.is_recording = is_recording;
    options.silent_s = options.open_timeout_s = 60.0;
    capture.emplace([this] { return std::make_unique<ScriptedCamera>(script); }, options);
  }
  ~Session() {
    script.End();
    capture.reset();
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// The status once it counts so many pictures.
  CaptureStatus After(std::uint64_t delivered) const {
    for (;;) {
      const CaptureStatus status = capture->Status();
      if (status.delivered >= delivered || IsFinal(status.state)) return status;
      std::this_thread::yield();
    }
  }
  Frame Next() { return capture->Next(kLong_s).value(); }

  Script script;
  std::optional<CaptureThread> capture;
};

TEST_CASE("Of a live camera the newest picture is given, and those before it are counted") {
  Session session;
  CHECK(session.capture->Status().state == CameraState::kOpening);
  CHECK_FALSE(session.capture->IsRecording());
  const double begin_s = SteadyNow_s();
  for (int i = 0; i < 4; ++i) session.script.Give(100 + i, begin_s + 0.1 * i);
  const CaptureStatus status = session.After(4);
  CHECK(status.state == CameraState::kRunning);
  CHECK(status.dropped == 3);
  CHECK(status.skipped == 0);
  CHECK(status.rate_hz == Approx(10.0));
  CHECK(status.latency_s == Approx(0.02));
  const Frame frame = session.Next();
  CHECK(frame.bytes[0] == 103);
  CHECK(frame.index == 3);
  CHECK_FALSE(session.capture->Next(0.0));
}

TEST_CASE("The rate of pictures is that of the last second") {
  Session session;
  const double begin_s = SteadyNow_s();
  session.script.Give(100, begin_s);
  session.script.Give(101, begin_s + 5.0);
  CHECK(session.After(2).rate_hz == 0.0);  // one picture within the last second: no rate
  session.script.Give(102, begin_s + 5.25);
  CHECK(session.After(3).rate_hz == 0.0);
  session.script.Give(103, begin_s + 5.5);
  CHECK(session.After(4).rate_hz == Approx(4.0));
  // A second ago is within it.
  Session even;
  const double whole_s = std::ceil(begin_s);
  for (const double after_s : {0.0, 0.5, 1.0}) even.script.Give(100, whole_s + after_s);
  CHECK(even.After(3).rate_hz == Approx(2.0));
}

TEST_CASE("A recording is given picture by picture and ends after its last one") {
  Session session({}, true);
  for (int i = 0; i < 3; ++i) session.script.Give(50, 1.0 * i);  // all alike, and long ago
  session.script.Do({{}, CameraState::kEnded});
  for (int i = 0; i < 3; ++i) {
    CHECK(session.Next().captured_s == Approx(1.0 * i - 0.02));
    CHECK(session.capture->IsRecording());
  }
  CHECK_FALSE(session.capture->Next(kLong_s));
  const CaptureStatus status = session.capture->Status();
  CHECK(status.state == CameraState::kEnded);
  CHECK(status.delivered == 3);
  CHECK(status.dropped == 0);
}

TEST_CASE("A camera that repeats its picture is frozen once it did so for long enough") {
  Session session({.same_s = 0.5});
  const double begin_s = SteadyNow_s();
  session.script.Give(100, begin_s);
  session.script.Give(100, begin_s + 0.49);
  CHECK(session.After(2).state == CameraState::kRunning);
  session.script.Give(100, begin_s + 0.5);
  const CaptureStatus frozen = session.After(3);
  CHECK(frozen.state == CameraState::kFrozen);
  CHECK(frozen.reason == "the same picture for 0.5 s: plug the camera out and in");
  session.script.Give(101, begin_s + 0.6);
  const CaptureStatus again = session.After(4);
  CHECK(again.state == CameraState::kRunning);
  CHECK(again.reason.empty());
}

TEST_CASE("A picture without light is black, judged as often as pictures are looked at") {
  Session session({.black_level = 40.0, .look_s = 0.2});
  const double begin_s = SteadyNow_s();
  session.script.Give(40, begin_s);
  const CaptureStatus just = session.After(1);
  CHECK(just.state == CameraState::kRunning);
  CHECK(just.reason.empty());
  session.script.Give(39, begin_s + 0.1);  // not looked at yet
  CHECK(session.After(2).state == CameraState::kRunning);
  session.script.Give(38, begin_s + 0.21);
  const CaptureStatus black = session.After(3);
  CHECK(black.state == CameraState::kBlack);
  CHECK_THAT(black.reason, Contains("the picture is black"));
  session.script.Give(200, begin_s + 0.45);
  CHECK(session.After(4).state == CameraState::kRunning);
  Session quarter({.black_level = 40.0, .look_s = 0.25});
  const double whole_s = std::ceil(begin_s);
  quarter.script.Give(41, whole_s);
  quarter.script.Give(38, whole_s + 0.25);  // just when it is time
  CHECK(quarter.After(2).state == CameraState::kBlack);
}

TEST_CASE("Pictures of another size are passed over, until the camera means it") {
  Session session;
  const double begin_s = SteadyNow_s();
  session.script.Give(100, begin_s, 8);
  for (int i = 0; i < 9; ++i) session.script.Give(101 + i, begin_s + 0.01 * i, 16);
  session.script.Give(120, begin_s + 0.2, 8);  // as before: the count begins anew
  CaptureStatus status = session.After(2);
  CHECK(status.skipped == 9);
  CHECK(session.Next().width_px == 8);
  for (int i = 0; i < 10; ++i) session.script.Give(130 + i, begin_s + 0.3 + 0.01 * i, 16);
  status = session.After(3);
  CHECK(status.skipped == 18);
  const Frame frame = session.Next();
  CHECK(frame.width_px == 16);
  CHECK(frame.bytes[0] == 139);
}

TEST_CASE("A picture of more pixels than are put up with is passed over, and one of none") {
  Session session({.most_mpixel = 96e-6});  // 96 pixels
  const double begin_s = SteadyNow_s();
  session.script.Give(100, begin_s, 13);  // 104 of them
  session.script.Give(100, begin_s, 0);
  session.script.Give(101, begin_s + 0.1, 12);
  const CaptureStatus status = session.After(1);
  CHECK(status.skipped == 2);
  CHECK(session.Next().bytes[0] == 101);
  Session narrow;
  narrow.script.Give(102, begin_s, 1);
  CHECK(narrow.Next().width_px == 1);
}

TEST_CASE("An error of the camera is its state, and the first one stays") {
  Session session;
  session.script.Give(100, SteadyNow_s());
  session.script.Do({{}, CameraState::kUnplugged});
  session.Next();
  CHECK_FALSE(session.capture->Next(kLong_s));
  CHECK(session.capture->Status().state == CameraState::kUnplugged);
  CHECK(session.capture->Status().reason == "as the script says");
}

TEST_CASE("A device that is gone is unplugged while its driver still hangs, and stays so") {
  Session session;
  session.script.Give(100, SteadyNow_s());
  session.Next();
  session.script.is_present = false;
  CaptureStatus status = session.capture->Status();
  CHECK(status.state == CameraState::kUnplugged);
  CHECK(status.reason == "the device is gone");
  session.script.is_present = true;
  session.script.Give(101, SteadyNow_s());  // too late
  while (session.script.Asked() < 3) std::this_thread::yield();
  status = session.capture->Status();
  CHECK(status.state == CameraState::kUnplugged);
  CHECK(status.delivered == 1);
  session.script.Do({{}, CameraState::kWrongFormat});  // and so is another end
  CHECK_FALSE(session.capture->Next(kLong_s));
  status = session.capture->Status();
  CHECK(status.state == CameraState::kUnplugged);
  CHECK(status.reason == "the device is gone");
}

TEST_CASE("What goes wrong beside the camera reaches who asks for pictures") {
  CaptureThread capture(
      []() -> std::unique_ptr<CameraSource> {
        throw std::invalid_argument("no picture matches *.jpg");
      },
      {});
  CHECK_THROWS_WITH(capture.Next(kLong_s), "no picture matches *.jpg");
}

}  // namespace
}  // namespace rift::vision
