#include "rift/vision/calibration/live_views.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "rift/vision/camera/steady_now.hpp"

namespace rift::vision {
namespace {

constexpr double kTick_s = 0.02;
constexpr double kRedraw_s = 0.1;
// ROS's camera_calibration takes a view that differs by this much from all others.
constexpr double kUnlike = 0.2;
constexpr std::size_t kMostViews = 60;
constexpr double kStill_pxps = 40.0;  // two thirds of a pixel of blur at 1/60 s

double Distance(const ViewPlace& a, const ViewPlace& b) {
  return std::abs(a.x - b.x) + std::abs(a.y - b.y) + std::abs(a.size - b.size) +
         std::abs(a.skew - b.skew);
}

/// The views that were taken, and what they lack.
class TakenViews {
 public:
  TakenViews(const Board& board, const CalibrationOptions& options)
      : board_(board), options_(options) {
    Update();
  }

  /// The number of the view that this place is too like to, from 1; none: it is unlike all.
  std::optional<std::size_t> LikeWhich(const ViewPlace& place) const {
    for (std::size_t i = 0; i < places_.size(); ++i) {
      if (Distance(place, places_[i]) <= kUnlike) return i + 1;
    }
    return std::nullopt;
  }
  void Add(const BoardView& view) {
    views_.push_back(view);
    places_.push_back(PlaceOf(view, board_));
    Update();
  }
  void RemoveLast() {
    if (views_.empty()) return;
    views_.pop_back();
    places_.pop_back();
    Update();
  }

  bool IsPlenty() const { return IsCovered() && Missing() == 0; }
  bool IsCovered() const { return next_.text.empty(); }
  /// Views, however they lie.
  int Missing() const { return std::max(0, options_.good_views - static_cast<int>(views_.size())); }
  const NextView& Next() const { return next_; }
  const Coverage& Covered() const { return coverage_; }
  const std::vector<BoardView>& Views() const { return views_; }
  std::string NextText() const {
    if (!IsCovered()) return "next, " + next_.text;
    if (Missing() == 0) return "everything is covered";
    return fmt::format("everything is covered; {} more, unlike the others", Missing());
  }

 private:
  void Update() {
    std::vector<ViewResult> used;
    for (const BoardView& view : views_) used.push_back({.view = view, .used = true});
    coverage_ = CoverageOf(used, board_);
    next_ = NextViewFor(used, board_, options_.good_coverage);
  }

  Board board_;
  CalibrationOptions options_;
  std::vector<BoardView> views_;
  std::vector<ViewPlace> places_;
  Coverage coverage_;
  NextView next_;
};

/// A picture and the board in it.
struct Searched {
  BoardView view;
  double captured_s = 0.0;
};

class Gathering {
 public:
  Gathering(Capture& capture, const Board& board, const CalibrationOptions& options,
            const LiveListener& listener)
      : capture_(capture),
        board_(board),
        options_(options),
        listener_(listener),
        taken_(board, options) {}

  std::vector<BoardView> Run();

 private:
  void ReadPicture();
  void TakeSearched();
  void Judge(const Searched& before);
  void Add(const BoardView& view);
  bool IsStill(const Searched& before) const;
  void Show();
  void Obey(const LiveInput& input);
  void Hint();
  void WatchState();
  bool IsOver() const;

  Capture& capture_;
  const Board& board_;
  const CalibrationOptions& options_;
  const LiveListener& listener_;
  TakenViews taken_;
  std::shared_ptr<const Frame> frame_;
  std::future<Searched> search_;
  Searched searched_;
  std::string advice_;
  bool takes_by_itself_ = true, is_asked_ = false, is_finished_ = false, is_new_ = false;
  double shown_s_ = 0.0, hinted_s_ = SteadyNow_s();
  std::string hint_;
  CaptureStatus status_;
  std::optional<double> failing_since_s_;
};

/// A recording gives its next picture only when this one was searched; of a live camera the newest
/// is taken when the search is free.
void Gathering::ReadPicture() {
  const bool is_busy = search_.valid();
  if (is_busy && capture_.IsRecording()) {
    search_.wait_for(std::chrono::duration<double>(kTick_s));
    return;
  }
  std::optional<Frame> next = capture_.Next(kTick_s);
  if (!next) return;
  frame_ = std::make_shared<const Frame>(std::move(*next));
  is_new_ = true;
  if (is_busy) return;
  const BoardSearch search = capture_.IsRecording() ? BoardSearch::kThorough : BoardSearch::kQuick;
  search_ = std::async(std::launch::async, [frame = frame_, board = board_, search] {
    return Searched{FindBoard(*frame, board, fmt::format("frame{:06}", frame->index), search),
                    frame->captured_s};
  });
}

void Gathering::TakeSearched() {
  if (!search_.valid()) return;
  if (search_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  const Searched before = std::exchange(searched_, search_.get());
  Judge(before);
}

/// A board in motion blurs, and a rolling shutter bends it.
bool Gathering::IsStill(const Searched& before) const {
  if (capture_.IsRecording()) return true;  // its pictures may be photographs
  if (before.view.corners.size() != searched_.view.corners.size()) return false;
  const double passed_s = searched_.captured_s - before.captured_s;
  double farthest_px = 0.0;
  for (std::size_t i = 0; i < before.view.corners.size(); ++i) {
    const Eigen::Vector2d step = searched_.view.corners[i] - before.view.corners[i];
    farthest_px = std::max(farthest_px, step.norm());
  }
  return farthest_px <= kStill_pxps * passed_s;
}

/// Takes the picture that was searched last, or says why not.
void Gathering::Judge(const Searched& before) {
  const BoardView& view = searched_.view;
  if (view.corners.empty()) {
    advice_ = view.problem + ": show all of it, with the white around its squares";
    return;
  }
  const ViewPlace place = PlaceOf(view, board_);
  const std::string way = taken_.IsCovered() ? "" : WayTo(place, taken_.Next().place);
  const auto like = taken_.LikeWhich(place);
  if (is_asked_) {
    is_asked_ = false;
    Add(view);
  } else if (like) {
    advice_ = fmt::format("like view {}{}{}", *like, way.empty() ? "" : ": ", way);
  } else if (!IsStill(before)) {
    advice_ = "hold the board still";
  } else if (takes_by_itself_) {
    Add(view);
  } else {
    advice_ = way.empty() ? "the board is well placed" : way;
  }
}

void Gathering::Add(const BoardView& view) {
  taken_.Add(view);
  advice_ = fmt::format("view {} is taken", taken_.Views().size());
  listener_.say(
      fmt::format("view {}: {}; {}", taken_.Views().size(), view.name, taken_.NextText()));
  hinted_s_ = SteadyNow_s();
  hint_.clear();
}

void Gathering::Show() {
  const double now_s = SteadyNow_s();
  if (!listener_.show || (!is_new_ && now_s - shown_s_ < kRedraw_s)) return;
  is_new_ = false;
  shown_s_ = now_s;
  Obey(listener_.show({.frame = frame_.get(),
                       .searched = searched_.view.name.empty() ? nullptr : &searched_.view,
                       .taken = &taken_.Views(),
                       .board = board_,
                       .coverage = taken_.Covered(),
                       .next = taken_.Next(),
                       .advice = advice_,
                       .takes_by_itself = takes_by_itself_,
                       .good_views = options_.good_views,
                       .good_coverage = options_.good_coverage,
                       .status = status_}));
}

void Gathering::Obey(const LiveInput& input) {
  is_asked_ = is_asked_ || input.take;
  is_finished_ = is_finished_ || input.finish;
  if (input.toggle) takes_by_itself_ = !takes_by_itself_;
  if (!input.undo || taken_.Views().empty()) return;
  listener_.say(fmt::format("view {} is taken back", taken_.Views().size()));
  taken_.RemoveLast();
}

/// Tells, where nobody looks at a window, why no view is taken.
void Gathering::Hint() {
  const double now_s = SteadyNow_s();
  if (advice_.empty() || now_s - hinted_s_ < listener_.hint_s) return;
  hinted_s_ = now_s;
  if (advice_ != hint_) listener_.say(advice_);
  hint_ = advice_;
}

void Gathering::WatchState() {
  const CameraState before = status_.state;
  status_ = capture_.Status();
  const CameraState state = status_.state;
  const bool fails = state == CameraState::kFrozen || state == CameraState::kBlack;
  if (!fails) failing_since_s_.reset();
  if (fails && !failing_since_s_) failing_since_s_ = SteadyNow_s();
  if (state == before || state == CameraState::kEnded || state == CameraState::kOpening) return;
  if (before == CameraState::kOpening && state == CameraState::kRunning) return;
  const std::string reason = status_.reason.empty() ? "" : ": " + status_.reason;
  listener_.say(
      fmt::format("camera {}{}", EnumNames(state)[static_cast<std::size_t>(state)], reason));
}

bool Gathering::IsOver() const {
  if (listener_.is_stopped() || is_finished_ || taken_.Views().size() >= kMostViews) return true;
  if (!capture_.IsRecording() && taken_.IsPlenty()) return true;
  if (failing_since_s_ && SteadyNow_s() - *failing_since_s_ > listener_.give_up_s) return true;
  return IsFinal(status_.state) && !search_.valid();
}

std::vector<BoardView> Gathering::Run() {
  listener_.say(
      "move the board about: near and far, to every edge, tilted; Ctrl-C ends and "
      "calibrates; first, " +
      taken_.Next().text);
  while (!IsOver()) {
    ReadPicture();
    TakeSearched();
    WatchState();
    Show();
    Hint();
  }
  const bool has_failed =
      failing_since_s_ || (IsFinal(status_.state) && status_.state != CameraState::kEnded);
  if (has_failed && taken_.Views().empty()) {
    throw std::runtime_error(fmt::format("no view of the board was taken: {}", status_.reason));
  }
  return taken_.Views();
}

}  // namespace

std::vector<BoardView> ViewsFromCamera(Capture& capture, const Board& board,
                                       const CalibrationOptions& options,
                                       const LiveListener& listener) {
  return Gathering(capture, board, options, listener).Run();
}

}  // namespace rift::vision
