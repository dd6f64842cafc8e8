#include "rift/vision/tracking/track_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>
#include <thread>
#include <utility>

#include "rift/vision/camera/camera_source.hpp"
#include "rift/vision/camera/steady_now.hpp"
#include "rift/vision/tracking/off_floor.hpp"

namespace rift::vision {
namespace {

constexpr double kTick_s = 0.02;
constexpr double kRedraw_s = 0.1;

class Tracking {
 public:
  explicit Tracking(const TrackParts& parts)
      : parts_(parts),
        tracker_(parts.session.MakeTracker(parts.further_ids)),
        started_s_(SteadyNow_s()),
        off_floor_(parts.session.camera(), parts.session.tag()) {}

  TrackRun Run();

 private:
  void Take(Frame frame);
  void Keep(const TrackResult& result, int tag_id, const Frame& frame);
  /// The row of a picture in which the tag was seen, predicted or lost.
  static Sighting RowOf(const TrackResult& result, int tag_id, const Frame& frame);
  /// A recording's times begin at zero and are rounded, so that the same recording gives the same
  /// bytes.
  void Rebase(Frame& frame);
  void WatchState();
  void WatchReferences(const Frame& frame);
  /// Holds the reference tags of a picture against where they set the frame.
  void CheckReferences(const Frame& frame);
  void Show();
  void HoldLastPicture();
  bool IsStopped() const;
  bool IsOver() const;

  const TrackParts& parts_;
  TagTracker tracker_;
  double started_s_;
  TrackRun run_;
  std::optional<double> first_captured_s_;
  std::optional<Frame> frame_;
  std::vector<std::optional<Sighting>> seen_;  // of each robot, in frame_
  std::set<int> seen_ids_;
  std::optional<Frame> with_other_tags_;  // while none was seen that was asked for
  OffFloorCheck off_floor_;
  std::optional<std::string> wrong_size_;  // of a picture that came after others
  std::optional<double> failing_since_s_;
  std::optional<double> checked_s_;
  std::optional<std::uint64_t> shown_index_;
  double shown_s_ = 0.0;
  bool quit_ = false;
  bool is_time_over_ = false;  // of a recording
};

void Tracking::Rebase(Frame& frame) {
  if (!first_captured_s_) run_.zero_s = frame.captured_s;
  if (!first_captured_s_) first_captured_s_ = frame.captured_s;
  if (run_.is_recording) {
    frame.captured_s = std::round((frame.captured_s - *first_captured_s_) * 1e6) / 1e6;
  }
}

Sighting Tracking::RowOf(const TrackResult& result, int tag_id, const Frame& frame) {
  if (result.sighting) return *result.sighting;
  if (result.predicted) return *result.predicted;
  Sighting lost;
  lost.state = TrackState::kLost;
  lost.corners.fill(Eigen::Vector2d::Zero());
  lost.tag_id = tag_id;
  lost.frame_index = frame.index;
  lost.captured_s = frame.captured_s;
  return lost;
}

void Tracking::Keep(const TrackResult& result, int tag_id, const Frame& frame) {
  ++run_.misses[static_cast<std::size_t>(result.miss)];
  ++run_.states[static_cast<std::size_t>(result.State())];
  if (result.sighting) seen_ids_.insert(tag_id);
  if (!seen_ids_.contains(tag_id)) return;  // nothing to tell yet
  Sighting row = RowOf(result, tag_id, frame);
  if (run_.is_recording) row.latency_s = std::nan("");  // its clock is its own
  const double t_s = run_.is_recording
                         ? row.captured_s
                         : std::round((row.captured_s - *first_captured_s_) * 1e6) / 1e6;
  if (!parts_.log(t_s, row)) {
    ++run_.repeated;
    return;
  }
  if (!result.sighting) return;
  if (++run_.rows == 1) run_.first_t_s = t_s;
  run_.last_t_s = t_s;
  if (!run_.is_recording) run_.latencies_s.push_back(row.latency_s);
  run_.most_tags_of_this_id = std::max(run_.most_tags_of_this_id, row.tags_of_this_id);
  run_.off_floor += off_floor_.HasFloor() && !row.is_on_floor;
  if (const auto warning = off_floor_.Add(row)) parts_.say("warning: " + *warning);
}

void Tracking::Take(Frame frame) {
  const CameraModel& camera = parts_.session.camera();
  const bool has_size = frame.width_px == camera.width_px && frame.height_px == camera.height_px;
  if (run_.frames > 0 && !has_size) {
    wrong_size_ = fmt::format(
        "after {} pictures of {}x{} pixels, for which its calibration is, it gives {}x{}: keep its "
        "size and turn while it tracks",
        run_.frames, camera.width_px, camera.height_px, frame.width_px, frame.height_px);
    return;
  }
  if (run_.frames == 0) run_.is_recording = parts_.session.capture().IsRecording();
  Rebase(frame);
  is_time_over_ = run_.is_recording && parts_.duration_s && frame.captured_s > *parts_.duration_s;
  if (is_time_over_) return;
  ++run_.frames;
  const double begin_s = SteadyNow_s();
  const std::vector<TrackResult> results = tracker_.TrackAll(frame);
  run_.costs_s.push_back(SteadyNow_s() - begin_s);
  Keep(results.front(), parts_.session.tag().id, frame);
  for (std::size_t i = 1; i < results.size(); ++i) {
    Keep(results[i], parts_.further_ids[i - 1], frame);
  }
  seen_.clear();
  for (const TrackResult& result : results) {
    seen_.push_back(result.sighting);
    if (result.sighting && run_.is_recording) seen_.back()->latency_s = std::nan("");
  }
  WatchReferences(frame);
  const bool shows_others = results.front().miss == Miss::kOtherTag;
  if (run_.rows > 0) with_other_tags_.reset();
  if (run_.rows == 0 && shows_others) with_other_tags_ = frame;
  frame_ = std::move(frame);
}

void Tracking::WatchReferences(const Frame& frame) {
  const SessionOptions& options = parts_.options;
  const std::optional<WorldFrame>& world = parts_.session.camera().world;
  const bool has_marks = world && !world->marks.empty();
  if (!has_marks || (checked_s_ && frame.captured_s - *checked_s_ < options.check_every_s)) return;
  CheckReferences(frame);
}

void Tracking::CheckReferences(const Frame& frame) {
  const SessionOptions& options = parts_.options;
  Look look = parts_.session.LookAt(frame, options.check_decimate);
  const bool is_first = !checked_s_;
  if (is_first && !look.moved_m) look = parts_.session.LookAt(frame, 1);
  if (is_first) {
    const auto unseen = UnseenReferences(parts_.session.camera(), look);
    if (unseen) parts_.say("note: " + *unseen);
  }
  checked_s_ = frame.captured_s;
  if (!look.moved_m) return;
  const bool is_known = MovedWarning(run_.moved_m, options.moved_m).has_value();
  const std::optional<std::string> warning = MovedWarning(look.moved_m, options.moved_m);
  if (warning && !is_known) parts_.say(*warning);
  run_.moved_m = std::max(run_.moved_m.value_or(0.0), *look.moved_m);
}

void Tracking::WatchState() {
  const CameraState before = run_.status.state;
  run_.status = parts_.session.capture().Status();
  if (wrong_size_) {
    run_.status.state = CameraState::kWrongFormat;
    run_.status.reason = *wrong_size_;
  }
  const CameraState state = run_.status.state;
  // A camera that is asked again has its own limit (CaptureOptions::reconnect_s).
  const bool fails = state != CameraState::kOpening && state != CameraState::kRunning &&
                     state != CameraState::kEnded && state != CameraState::kReconnecting;
  if (!fails) failing_since_s_.reset();
  if (fails && !failing_since_s_) failing_since_s_ = SteadyNow_s();
  const bool starts = before == CameraState::kOpening && state == CameraState::kRunning;
  if (state == before || starts || state == CameraState::kEnded) return;
  const std::string reason =
      run_.status.reason.empty() ? "" : fmt::format(": {}", run_.status.reason);
  parts_.say(fmt::format("camera {}{}", EnumNames(state)[static_cast<std::size_t>(state)], reason));
}

/// By the user, or by the time that was asked for: of a recording the time of its pictures, which
/// come as fast as they are read.
bool Tracking::IsStopped() const {
  if (quit_ || is_time_over_ || parts_.is_stopped()) return true;
  return !run_.is_recording && parts_.duration_s && SteadyNow_s() - started_s_ > *parts_.duration_s;
}

bool Tracking::IsOver() const {
  if (IsStopped() || IsFinal(run_.status.state)) return true;
  return failing_since_s_ && SteadyNow_s() - *failing_since_s_ > parts_.options.give_up_s;
}

void Tracking::Show() {
  if (!parts_.show) return;
  // The same picture is drawn again only to answer clicks and keys.
  const bool is_new = frame_ && frame_->index != shown_index_;
  if (!is_new && SteadyNow_s() - shown_s_ < kRedraw_s) return;
  if (frame_) shown_index_ = frame_->index;
  // A recording is shown at the speed at which it was made.
  while (run_.is_recording && frame_ && SteadyNow_s() - started_s_ < frame_->captured_s && !quit_) {
    quit_ = !parts_.show(frame_, seen_, run_.status, run_.moved_m) || IsStopped();
    std::this_thread::sleep_for(std::chrono::duration<double>(kTick_s / 4));
  }
  quit_ = quit_ || !parts_.show(frame_, seen_, run_.status, run_.moved_m);
  shown_s_ = SteadyNow_s();
}

/// A recording is over in seconds; what it showed is to be looked at.
void Tracking::HoldLastPicture() {
  if (!parts_.show || is_time_over_ || run_.status.state != CameraState::kEnded) return;
  while (!quit_ && !parts_.is_stopped()) {
    quit_ = !parts_.show(frame_, seen_, run_.status, run_.moved_m);
    std::this_thread::sleep_for(std::chrono::duration<double>(kTick_s));
  }
}

TrackRun Tracking::Run() {
  while (!IsOver()) {
    std::optional<Frame> frame = parts_.session.capture().Next(kTick_s);
    if (frame) Take(std::move(*frame));
    WatchState();
    Show();
  }
  // A camera that was moved since the last check moved its rows as well.
  if (frame_ && checked_s_ && *checked_s_ < frame_->captured_s) CheckReferences(*frame_);
  HoldLastPicture();
  if (run_.rows == 0 && frame_) {
    run_.instead =
        LookForOthers(with_other_tags_.value_or(*frame_), parts_.session.tag(), parts_.further_ids);
  }
  run_.state = run_.status.state;
  run_.reason = run_.status.reason;
  run_.has_failed = failing_since_s_.has_value() && !quit_ && !parts_.is_stopped();
  return run_;
}

}  // namespace

TrackRun RunTracking(const TrackParts& parts) { return Tracking(parts).Run(); }

}  // namespace rift::vision
