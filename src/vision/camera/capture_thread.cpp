#include "rift/vision/camera/capture_thread.hpp"

#include <fmt/format.h>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <string>
#include <thread>

#include "rift/statistics/hash.hpp"
#include "rift/vision/camera/camera_source.hpp"
#include "rift/vision/camera/capture_options.hpp"
#include "rift/vision/camera/frame.hpp"
#include "rift/vision/camera/picture_reader.hpp"
#include "rift/vision/camera/steady_now.hpp"

namespace rift::vision {
namespace {

/// Tells pictures of a working camera from those of one that repeats itself or sees no light.
class PictureHealth {
 public:
  explicit PictureHealth(const CaptureOptions& options) : options_(options) {}

  /// kRunning, kFrozen or kBlack; Reason() says why. Throws CameraError (wrong format) for a
  /// picture that cannot be decoded when it is looked at.
  CameraState Check(const Frame& frame);
  std::string Reason() const;

 private:
  void CheckBrightness(const Frame& frame);

  CaptureOptions options_;
  std::optional<std::uint64_t> hash_;
  double same_since_s_ = 0.0;
  double same_for_s_ = 0.0;
  double looked_s_ = -1e9;
  double brightness_ = 255.0;
  int undecodable_ = 0;
};

constexpr int kMostUndecodable = 5;  // in a row: single damaged pictures happen on bad cables

void PictureHealth::CheckBrightness(const Frame& frame) {
  if (frame.arrived_s - looked_s_ < options_.look_s) return;
  looked_s_ = frame.arrived_s;
  const cv::Mat grey = SmallGreyOf(frame);
  if (grey.empty()) {
    if (++undecodable_ < kMostUndecodable) return;
    throw CameraError(CameraState::kWrongFormat,
                      "its pictures cannot be decoded: ask the camera for MJPEG or YUYV");
  }
  undecodable_ = 0;
  cv::Scalar mean, deviation;
  cv::meanStdDev(grey, mean, deviation);
  brightness_ = mean[0] + 3.0 * deviation[0];
}

CameraState PictureHealth::Check(const Frame& frame) {
  const std::uint64_t hash = statistics::Hash64(std::as_bytes(std::span(frame.bytes)));
  if (hash != hash_) same_since_s_ = frame.arrived_s;
  hash_ = hash;
  same_for_s_ = frame.arrived_s - same_since_s_;
  CheckBrightness(frame);
  if (same_for_s_ >= options_.same_s) return CameraState::kFrozen;
  return brightness_ < options_.black_level ? CameraState::kBlack : CameraState::kRunning;
}

std::string PictureHealth::Reason() const {
  if (same_for_s_ >= options_.same_s) {
    return fmt::format("the same picture for {:.1f} s: plug the camera out and in", same_for_s_);
  }
  if (brightness_ < options_.black_level) {
    return "the picture is black: lens cap, light, or exposure?";
  }
  return {};
}

/// Passes over pictures that claim too many pixels, none, or another size than the others: one
/// damaged byte of a JPEG's head must not end a session.
class SizeGuard {
 public:
  explicit SizeGuard(const CaptureOptions& options) : most_px_(1e6 * options.most_mpixel) {}

  bool IsGood(const Frame& frame) {
    if (frame.width_px < 1 || frame.height_px < 1) return false;
    if (static_cast<double>(frame.width_px) * frame.height_px > most_px_) return false;
    const cv::Size size(frame.width_px, frame.height_px);
    if (size_.empty()) size_ = size;
    if (size == size_) return other_count_ = 0, true;
    other_count_ = size == other_ ? other_count_ + 1 : 1;
    other_ = size;
    if (other_count_ < kMeant) return false;
    size_ = size;  // the camera was really switched; whoever cannot use that says so
    return true;
  }

 private:
  static constexpr int kMeant = 10;

  double most_px_;
  cv::Size size_, other_;
  int other_count_ = 0;
};

using Lock = std::unique_lock<std::mutex>;
using std::chrono::duration;

constexpr double kRateWindow_s = 1.0;
constexpr double kEndTimeout_s = 0.5;  // for the thread to end; longer, and it hangs in a driver

/// Pictures a second over the last window.
class RateMeter {
 public:
  void Count(double now_s) {
    times_s_.push_back(now_s);
    while (times_s_.front() < now_s - kRateWindow_s) times_s_.pop_front();
  }
  double Rate_hz() const {
    if (times_s_.size() < 3) return 0.0;
    return static_cast<double>(times_s_.size() - 1) / (times_s_.back() - times_s_.front());
  }

 private:
  std::deque<double> times_s_;
};

}  // namespace

struct CaptureThread::Shared {
  Shared(Opener opener, const CaptureOptions& capture_options)
      : open(std::move(opener)),
        options(capture_options),
        health(capture_options),
        sizes(capture_options) {}

  void Run();
  void ReadAll();
  void TakeNotes();
  void Keep(Frame frame, CameraState state, std::string reason);
  void End(CameraState state, const std::string& reason);
  CaptureStatus StatusAt(double now_s);

  const Opener open;
  const CaptureOptions options;
  PictureHealth health;  // used by the thread alone, and so are the next two
  SizeGuard sizes;
  std::uint64_t other_sizes = 0;

  std::mutex mutex;  // guards all that follows
  std::condition_variable changed;
  std::shared_ptr<CameraSource> source;
  std::exception_ptr failure;  // what is no CameraError goes to the one who asks for pictures
  std::optional<Frame> newest;
  CaptureStatus status;
  RateMeter rate;
  const double started_s = SteadyNow_s();
  double last_s = 0.0;
  bool stop = false;
  bool done = false;

  std::thread thread;  // used by the CaptureThread alone
};

void CaptureThread::Shared::Run() {
  try {
    std::shared_ptr<CameraSource> opened = open();
    {
      const Lock lock(mutex);
      source = std::move(opened);
    }
    ReadAll();
  } catch (const CameraError& error) {
    End(error.state, error.what());
  } catch (...) {
    const Lock lock(mutex);
    failure = std::current_exception();
  }
  const Lock lock(mutex);
  done = true;
  changed.notify_all();
}

void CaptureThread::Shared::ReadAll() {
  const bool recording = source->IsRecording();
  for (std::uint64_t index = 0;;) {
    {
      Lock lock(mutex);
      if (recording) changed.wait(lock, [this] { return stop || !newest; });
      if (stop) return;
    }
    Frame frame;
    const bool came = source->Read(frame);
    const bool is_good = came && sizes.IsGood(frame);
    other_sizes += came && !is_good;
    TakeNotes();
    if (!is_good) continue;
    frame.index = index++;
    const CameraState state = recording ? CameraState::kRunning : health.Check(frame);
    Keep(std::move(frame), state, recording ? std::string() : health.Reason());
  }
}

void CaptureThread::Shared::TakeNotes() {
  SourceNotes notes = source->Notes();
  const Lock lock(mutex);
  status.skipped = notes.skipped + other_sizes;
  status.reconnects = notes.reconnects;
  if (notes.interruption.empty() || IsFinal(status.state)) return;
  status.state = CameraState::kReconnecting;
  status.reason = std::move(notes.interruption);
}

void CaptureThread::Shared::Keep(Frame frame, CameraState state, std::string reason) {
  const Lock lock(mutex);
  if (IsFinal(status.state)) return;  // it was seen to be unplugged meanwhile
  last_s = frame.arrived_s;
  rate.Count(frame.arrived_s);
  status.state = state;
  status.reason = std::move(reason);
  status.latency_s = frame.arrived_s - frame.captured_s;
  ++status.delivered;
  if (newest) ++status.dropped;
  newest = std::move(frame);
  changed.notify_all();
}

void CaptureThread::Shared::End(CameraState state, const std::string& reason) {
  const Lock lock(mutex);
  if (IsFinal(status.state)) return;
  status.state = state;
  status.reason = reason;
}

// The thread may hang in its driver, so silence is seen from here.
CaptureStatus CaptureThread::Shared::StatusAt(double now_s) {
  CaptureStatus seen = status;
  seen.rate_hz = rate.Rate_hz();
  const bool waits_for_reader = newest.has_value() && source && source->IsRecording();
  if (IsFinal(seen.state) || waits_for_reader) return seen;
  if (seen.state == CameraState::kReconnecting) return seen.rate_hz = 0.0, seen;
  const bool silent = seen.delivered > 0 ? now_s - last_s > options.silent_s
                                         : now_s - started_s > options.open_timeout_s;
  if (source && !source->IsPresent()) {
    status.state = seen.state = CameraState::kUnplugged;
    status.reason = seen.reason = "the device is gone";
  } else if (silent && !(source && source->IsRecording())) {
    seen.state = CameraState::kFrozen;
    seen.reason = seen.delivered > 0
                      ? fmt::format("no picture for {:.1f} s", now_s - last_s)
                      : fmt::format("no first picture within {:.1f} s", now_s - started_s);
    seen.rate_hz = 0.0;
  }
  return seen;
}

CaptureThread::CaptureThread(Opener open, const CaptureOptions& options)
    : shared_(std::make_shared<Shared>(std::move(open), options)) {
  shared_->thread = std::thread([shared = shared_] { shared->Run(); });
}

CaptureThread::~CaptureThread() {
  Lock lock(shared_->mutex);
  shared_->stop = true;
  shared_->changed.notify_all();
  const bool is_done = shared_->changed.wait_for(lock, duration<double>(kEndTimeout_s),
                                                 [this] { return shared_->done; });
  lock.unlock();
  // Joined, since a thread that closes its camera while the process ends finds libraries that have
  // cleaned up already.
  if (is_done) {
    shared_->thread.join();
  } else {
    shared_->thread.detach();
  }
}

std::optional<Frame> CaptureThread::Next(double timeout_s) {
  Lock lock(shared_->mutex);
  shared_->changed.wait_for(lock, duration<double>(timeout_s),
                            [this] { return shared_->newest || shared_->done; });
  if (shared_->failure) std::rethrow_exception(shared_->failure);
  std::optional<Frame> frame = std::move(shared_->newest);
  shared_->newest.reset();
  shared_->changed.notify_all();
  return frame;
}

CaptureStatus CaptureThread::Status() const {
  const Lock lock(shared_->mutex);
  CaptureStatus status = shared_->StatusAt(SteadyNow_s());
  // A recording has ended only once its last picture was taken.
  if (status.state == CameraState::kEnded && shared_->newest) status.state = CameraState::kRunning;
  return status;
}

bool CaptureThread::IsRecording() const {
  const Lock lock(shared_->mutex);
  return shared_->source && shared_->source->IsRecording();
}

std::unique_ptr<Capture> OpenCapture(const std::string& camera, const CaptureOptions& options) {
  return std::make_unique<CaptureThread>([camera, options] { return OpenCamera(camera, options); },
                                         options);
}

}  // namespace rift::vision
