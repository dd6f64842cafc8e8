#include <atomic>
#include <catch2/catch.hpp>
#include <mutex>
#include <thread>

#include "rift/vision/camera/capture_thread.hpp"
#include "rift/vision/camera/jpeg.hpp"
#include "rift/vision/camera/steady_now.hpp"
#include "support/until.hpp"

namespace rift::vision {
namespace {

using Catch::Matchers::StartsWith;

/// Pictures as fast as they are read, then nothing; what it tells beside them may be changed.
class ListCamera final : public CameraSource {
 public:
  struct List {
    std::vector<Frame> frames;
    bool is_recording = false;
    std::mutex mutex;
    SourceNotes notes;
    std::atomic<bool> is_closed = false;
  };
  explicit ListCamera(std::shared_ptr<List> list) : list_(std::move(list)) {}
  ~ListCamera() override { list_->is_closed = true; }

  bool Read(Frame& frame) override {
    if (next_ == list_->frames.size()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      return false;
    }
    frame = list_->frames[next_++];
    return true;
  }
  SourceNotes Notes() const override {
    const std::lock_guard lock(list_->mutex);
    return list_->notes;
  }
  bool IsRecording() const override { return list_->is_recording; }

 private:
  std::shared_ptr<List> list_;
  std::size_t next_ = 0;
};

CaptureThread Capturing(const std::shared_ptr<ListCamera::List>& list,
                        const CaptureOptions& options) {
  return CaptureThread([list] { return std::make_unique<ListCamera>(list); }, options);
}

Frame GreyFrame(int left, int right, double at_s) {
  Frame frame{.captured_s = at_s - 0.25, .arrived_s = at_s, .width_px = 8, .height_px = 4};
  for (int i = 0; i < 32; ++i) {
    frame.bytes.push_back(static_cast<std::uint8_t>(i % 8 < 4 ? left : right));
  }
  return frame;
}

CaptureStatus WhenItIs(const CaptureThread& capture, CameraState state) {
  CaptureStatus status;
  test::WaitUntil("the camera is in its state", [&] {
    status = capture.Status();
    return status.state == state;
  });
  return status;
}

TEST_CASE("A camera without a first picture is frozen after its own time, and so is a silent one") {
  const auto nothing = std::make_shared<ListCamera::List>();
  const double begin_s = SteadyNow_s();  // before its thread, which may outrun this one
  const CaptureThread opening = Capturing(nothing, {.silent_s = 0.001, .open_timeout_s = 0.2});
  CaptureStatus status = WhenItIs(opening, CameraState::kFrozen);
  CHECK(SteadyNow_s() - begin_s > 0.15);
  CHECK_THAT(status.reason, StartsWith("no first picture within "));
  CHECK(std::stod(status.reason.substr(24)) >= 0.2 - 0.051);

  const auto one = std::make_shared<ListCamera::List>();
  one->frames = {GreyFrame(100, 100, SteadyNow_s())};
  const CaptureThread silent = Capturing(one, {.silent_s = 0.2, .open_timeout_s = 0.001});
  test::WaitUntil("its picture was read", [&] { return silent.Status().delivered == 1; });
  status = WhenItIs(silent, CameraState::kFrozen);
  CHECK_THAT(status.reason, StartsWith("no picture for 0."));
  CHECK(status.rate_hz == 0.0);
  CHECK(status.delivered == 1);
  CHECK(status.latency_s == Approx(0.25));
}

TEST_CASE("A recording that nobody reads is not silent") {
  const auto list = std::make_shared<ListCamera::List>();
  list->is_recording = true;
  list->frames = {GreyFrame(100, 100, 0.0), GreyFrame(100, 100, 1.0)};
  CaptureThread capture = Capturing(list, {.silent_s = 0.001, .open_timeout_s = 0.001});
  test::WaitUntil("a picture waits", [&] { return capture.Status().delivered == 1; });
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  CHECK(capture.Status().state == CameraState::kRunning);
  REQUIRE(capture.Next(20.0));
  REQUIRE(capture.Next(20.0));
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  CHECK(capture.Status().state == CameraState::kRunning);  // it is read to its end by its reader
  CHECK(capture.Status().delivered == 2);
}

TEST_CASE("A first picture that states no height is passed over, and the next one sets the size") {
  const auto list = std::make_shared<ListCamera::List>();
  const double now_s = SteadyNow_s();
  list->frames = {GreyFrame(100, 100, now_s), GreyFrame(101, 100, now_s + 0.1)};
  list->frames[0].height_px = 0;
  CaptureThread capture = Capturing(list, {.silent_s = 60.0});
  CaptureStatus status;
  test::WaitUntil("both were read", [&] {
    status = capture.Status();
    return status.delivered + status.skipped == 2;
  });
  CHECK(status.skipped == 1);
  const auto frame = capture.Next(20.0);
  REQUIRE(frame);
  CHECK((frame->width_px == 8 && frame->height_px == 4));
}

TEST_CASE("What a source tells of is in the status, and an interruption is a state of its own") {
  const auto list = std::make_shared<ListCamera::List>();
  const double now_s = SteadyNow_s();
  for (int i = 0; i < 5; ++i) list->frames.push_back(GreyFrame(100 + i, 100, now_s + 0.1 * i));
  list->frames[2].width_px = 4;  // another size, which the capture itself passes over
  list->frames[2].height_px = 8;
  list->notes = {.skipped = 3, .reconnects = 7};
  const CaptureThread capture = Capturing(list, {.silent_s = 60.0});
  CaptureStatus status;
  test::WaitUntil("all were read", [&] { return (status = capture.Status()).delivered == 4; });
  CHECK(status.skipped == 4);
  CHECK(status.reconnects == 7);
  CHECK(status.state == CameraState::kRunning);
  CHECK(status.rate_hz == Approx(3.0 / 0.4));
  {
    const std::lock_guard lock(list->mutex);
    list->notes = {.skipped = 5, .reconnects = 8, .interruption = "no route"};
  }
  status = WhenItIs(capture, CameraState::kReconnecting);
  CHECK(status.reason == "no route");
  CHECK(status.skipped == 6);
  CHECK(status.rate_hz == 0.0);
}

TEST_CASE("A picture is as bright as its mean and three deviations") {
  // Halves of 0 and of 18: 9 and thrice 9. Halves of 15 and 25: 20 and thrice 5.
  struct Case {
    int left, right;
    double black_level;
    CameraState state;
  };
  for (const Case& one : {Case{0, 18, 35.9, CameraState::kRunning},
                          {0, 18, 36.1, CameraState::kBlack},
                          {15, 25, 34.9, CameraState::kRunning},
                          {15, 25, 35.1, CameraState::kBlack}}) {
    const auto list = std::make_shared<ListCamera::List>();
    list->frames = {GreyFrame(one.left, one.right, SteadyNow_s())};
    const CaptureThread capture =
        Capturing(list, {.silent_s = 60.0, .black_level = one.black_level});
    CaptureStatus status;
    test::WaitUntil("it was read", [&] { return (status = capture.Status()).delivered == 1; });
    CHECK(status.state == one.state);
    CHECK(status.reason == (one.state == CameraState::kBlack
                                ? "the picture is black: lens cap, light, or exposure?"
                                : ""));
  }
}

TEST_CASE("Five pictures in a row that cannot be decoded are a wrong format, four are not") {
  const double now_s = SteadyNow_s();
  const auto pictures = [&](const std::string& good_and_bad) {
    const auto list = std::make_shared<ListCamera::List>();
    for (std::size_t i = 0; i < good_and_bad.size(); ++i) {
      Frame frame = GreyFrame(100, 100, now_s + 0.01 * static_cast<double>(i));
      frame.format = PixelFormat::kJpeg;
      frame.bytes = good_and_bad[i] == 'g'
                        ? WriteJpeg(cv::Mat1b(4, 8, std::uint8_t{100}), 90, false)
                        : std::vector<std::uint8_t>{1, 2, 3};
      frame.bytes.push_back(static_cast<std::uint8_t>(i));  // none repeats the one before
      list->frames.push_back(frame);
    }
    return list;
  };
  const CaptureOptions each{.silent_s = 60.0, .look_s = 0.0};
  const CaptureThread some = Capturing(pictures("gbbbbgbbbbg"), each);
  const auto is_over = [](const CaptureThread& capture) {
    return IsFinal(capture.Status().state) || capture.Status().delivered == 11;
  };
  test::WaitUntil("all were read", [&] { return is_over(some); });
  CHECK(some.Status().state == CameraState::kRunning);
  const CaptureThread many = Capturing(pictures("gbbbbgbbbbb"), each);
  test::WaitUntil("it is over", [&] { return is_over(many); });
  const CaptureStatus status = many.Status();
  CHECK(status.state == CameraState::kWrongFormat);
  CHECK(status.delivered == 10);
  CHECK(status.reason == "its pictures cannot be decoded: ask the camera for MJPEG or YUYV");
  // Looked at every 20 ms, of which there are few among so many.
  const CaptureThread seldom = Capturing(pictures("gbbbbbbb"), {.silent_s = 60.0, .look_s = 0.02});
  test::WaitUntil("all were read", [&] { return seldom.Status().delivered == 8; });
}

TEST_CASE("A camera is closed when its capture ends, and not before") {
  for (const bool is_recording : {false, true}) {  // one waits for pictures, one for its reader
    const auto list = std::make_shared<ListCamera::List>();
    list->is_recording = is_recording;
    list->frames = {GreyFrame(100, 100, SteadyNow_s())};
    {
      const CaptureThread capture = Capturing(list, {});
      test::WaitUntil("a picture waits", [&] { return capture.Status().delivered == 1; });
      CHECK_FALSE(list->is_closed);
    }
    test::WaitUntil("it is closed", [&] { return list->is_closed.load(); });
  }
}

/// A camera whose driver hangs until it is let go.
struct Hanging {
  std::atomic<bool> is_asked = false, is_let_go = false, is_closed = false;
};

class HangingCamera final : public CameraSource {
 public:
  explicit HangingCamera(std::shared_ptr<Hanging> state) : state_(std::move(state)) {}
  ~HangingCamera() override { state_->is_closed = true; }

  bool Read(Frame&) override {
    state_->is_asked = true;
    state_->is_let_go.wait(false);
    return false;
  }

 private:
  std::shared_ptr<Hanging> state_;
};

TEST_CASE("A capture ends while its camera hangs, which is closed once it hangs no more") {
  const auto state = std::make_shared<Hanging>();
  {
    const CaptureThread capture([state] { return std::make_unique<HangingCamera>(state); }, {});
    test::WaitUntil("it hangs", [&] { return state->is_asked.load(); });
  }
  CHECK_FALSE(state->is_closed);
  state->is_let_go = true;
  state->is_let_go.notify_all();
  test::WaitUntil("it is closed", [&] { return state->is_closed.load(); });
}

}  // namespace
}  // namespace rift::vision
