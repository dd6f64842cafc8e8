#include "rift/vision/tracking/track_window.hpp"

#include <cstdlib>
#include <opencv2/highgui.hpp>
#include <stdexcept>
#include <utility>

#include "rift/module/display.hpp"
#include "track_picture.hpp"

namespace rift::vision {
namespace {

constexpr int kEscape = 27;

class HighguiWindow : public TrackWindow {
 public:
  explicit HighguiWindow(std::string title) : title_(std::move(title)) {
    // The display that was looked at is the one to open: with another plugin Qt aborts when that
    // one is missing.
    setenv("QT_QPA_PLATFORM", "xcb", 1);
    cv::namedWindow(title_, cv::WINDOW_AUTOSIZE | cv::WINDOW_GUI_NORMAL);
    cv::setMouseCallback(title_, &HighguiWindow::OnMouse, this);
  }
  ~HighguiWindow() override {
    if (IsOpen()) cv::destroyWindow(title_);
  }
  HighguiWindow(const HighguiWindow&) = delete;
  HighguiWindow& operator=(const HighguiWindow&) = delete;

  TrackInput Show(const TrackScene& scene) override {
    const TrackPicture picture = DrawTrack(scene);
    px_per_shown_ = picture.px_per_shown;
    cv::imshow(title_, picture.bgr);
    TakeKey(cv::waitKeyEx(1), input_);
    if (!IsOpen()) input_.quit = true;
    return std::exchange(input_, {});
  }

 private:
  static void OnMouse(int event, int x, int y, int, void* self) {
    if (event == cv::EVENT_LBUTTONDOWN) static_cast<HighguiWindow*>(self)->Click(x, y);
  }
  void Click(int x, int y) {
    input_.clicks_px.emplace_back((x + 0.5) * px_per_shown_ - 0.5, (y + 0.5) * px_per_shown_ - 0.5);
  }
  bool IsOpen() const { return cv::getWindowProperty(title_, cv::WND_PROP_VISIBLE) > 0.0; }

  std::string title_;
  TrackInput input_;
  double px_per_shown_ = 1.0;
};

}  // namespace

std::unique_ptr<TrackWindow> OpenTrackWindow(const std::string& title) {
  if (const std::string missing = module::MissingDisplay(); !missing.empty()) {
    throw std::runtime_error(missing);
  }
  return std::make_unique<HighguiWindow>(title);
}

void TakeKey(int key, TrackInput& input) {
  if (key < 0) return;
  switch (key & 0xFF) {
    case 'q':
    case kEscape:
      input.quit = true;
      break;
    case 'u':
      input.undo = true;
      break;
    case 'w':
      input.here = true;
      break;
    case 's':
      input.toggle_stop = true;
      break;
    case 'c':
      input.clear_trail = true;
      break;
    default:
      break;
  }
}

}  // namespace rift::vision
