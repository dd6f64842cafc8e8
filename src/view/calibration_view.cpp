#include "rift/view/calibration_view.hpp"

#include <opencv2/highgui.hpp>

#include "calibration_picture.hpp"
#include "rift/view/window.hpp"

namespace rift::view {
namespace {

constexpr const char* kTitle = "rift track: calibration";
constexpr int kEscape = 27;

bool IsOpen() { return cv::getWindowProperty(kTitle, cv::WND_PROP_VISIBLE) > 0.0; }

}  // namespace

vision::LiveInput LiveInputOf(int key) {
  vision::LiveInput input;
  if (key < 0) return input;
  const int letter = key & 0xFFFF;  // see TakeKey
  input.take = letter == ' ';
  input.undo = letter == 'u';
  input.toggle = letter == 'a';
  input.finish = letter == 'q' || letter == kEscape;
  return input;
}

CalibrationView::CalibrationView() {
  RequireDisplay();
  cv::namedWindow(kTitle, cv::WINDOW_AUTOSIZE | cv::WINDOW_GUI_NORMAL);
}

CalibrationView::~CalibrationView() {
  if (IsOpen()) cv::destroyWindow(kTitle);
}

vision::LiveInput CalibrationView::Show(const vision::LiveScene& scene) {
  cv::imshow(kTitle, DrawCalibrating(scene));
  vision::LiveInput input = LiveInputOf(cv::waitKeyEx(1));
  input.finish = input.finish || !IsOpen();
  return input;
}

}  // namespace rift::view
