#include "rift/view/track_window.hpp"

#include <memory>
#include <opencv2/highgui.hpp>
#include <utility>

#include "rift/view/window.hpp"
#include "track_picture.hpp"

namespace rift::view {
namespace {

constexpr int kEscape = 27;

}  // namespace

void TakeKey(int key, TrackInput& input) {
  if (key < 0) return;
  input.any_key = true;
  switch (key & 0xFFFF) {  // a key symbol below Shift, Ctrl and such; Insert is 0xFF63, and c 0x63
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

ShowScene InWindow(const std::string& title) {
  const auto window = std::make_shared<TrackWindow>(title);
  return [window](const TrackScene& scene) { return window->Show(scene); };
}

TrackWindow::TrackWindow(std::string title) : title_(std::move(title)) {
  RequireDisplay();
  cv::namedWindow(title_, cv::WINDOW_AUTOSIZE | cv::WINDOW_GUI_NORMAL);
  cv::setMouseCallback(title_, &TrackWindow::OnMouse, this);
}

TrackWindow::~TrackWindow() {
  if (IsOpen()) cv::destroyWindow(title_);
}

TrackInput TrackWindow::Show(const TrackScene& scene) {
  const TrackPicture picture = DrawTrack(scene);
  px_per_shown_ = picture.px_per_shown;
  cv::imshow(title_, picture.bgr);
  TakeKey(cv::waitKeyEx(1), input_);
  if (!IsOpen()) input_.quit = input_.closed = true;
  return std::exchange(input_, {});
}

void TrackWindow::OnMouse(int event, int x, int y, int, void* window) {
  if (event != cv::EVENT_LBUTTONDOWN) return;
  auto& self = *static_cast<TrackWindow*>(window);
  const double scale = self.px_per_shown_;
  self.input_.clicks_px.emplace_back((x + 0.5) * scale - 0.5, (y + 0.5) * scale - 0.5);
}

bool TrackWindow::IsOpen() const {
  return cv::getWindowProperty(title_, cv::WND_PROP_VISIBLE) > 0.0;
}

}  // namespace rift::view
