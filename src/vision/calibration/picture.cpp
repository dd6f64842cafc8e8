#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "rift/vision/calibration/calibration.hpp"

namespace rift::vision {

namespace {

constexpr int kWidth_px = 1280, kHeight_px = 820, kMargin_px = 20, kTitle_px = 70;
constexpr int kMapWidth_px = 800;
constexpr int kBar_px = 22, kBars_px = 880, kBarLength_px = 220;

const cv::Scalar kPaper{252, 252, 252}, kInk{40, 36, 32}, kFaint{170, 165, 160};
const cv::Scalar kGood{90, 160, 60}, kBad{50, 60, 210};

void Text(cv::Mat& picture, const cv::Point& at, const std::string& text, const cv::Scalar& colour,
          double scale = 0.45) {
  cv::putText(picture, text, at, cv::FONT_HERSHEY_SIMPLEX, scale, colour, 1, cv::LINE_AA);
}

cv::Scalar ColourOf(std::size_t view, std::size_t count) {
  const cv::Mat hsv(
      1, 1, CV_8UC3,
      cv::Scalar(180.0 * static_cast<double>(view) / static_cast<double>(count), 170, 190));
  cv::Mat bgr;
  cv::cvtColor(hsv, bgr, cv::COLOR_HSV2BGR);
  const cv::Vec3b c = bgr.at<cv::Vec3b>(0, 0);
  return {double(c[0]), double(c[1]), double(c[2])};
}

/// The camera's picture in small, with every corner and its error made long enough to be seen.
class CornerMap {
 public:
  CornerMap(cv::Mat& picture, const Calibration& calibration)
      : picture_(picture), calibration_(calibration) {
    for (const ViewResult& result : calibration.views) {
      width_px_ = std::max(width_px_, result.view.width_px);
      height_px_ = std::max(height_px_, result.view.height_px);
    }
    const double room_px = kHeight_px - kTitle_px - 3.0 * kMargin_px;
    scale_ = std::min(kMapWidth_px / std::max(1.0, 1.0 * width_px_),
                      room_px / std::max(1.0, 1.0 * height_px_));
    const double rms_px = std::isnan(calibration.rms_px) ? 1.0 : calibration.rms_px;
    longer_ = std::pow(10.0, std::round(std::log10(15.0 / std::max(rms_px, 1e-6) / scale_)));
  }

  void Draw() const {
    const cv::Rect frame(kMargin_px, kTitle_px, static_cast<int>(width_px_ * scale_),
                         static_cast<int>(height_px_ * scale_));
    cv::rectangle(picture_, frame, cv::Scalar(240, 238, 236), cv::FILLED);
    for (std::size_t i = 0; i < calibration_.views.size(); ++i) {
      if (!calibration_.views[i].view.corners.empty()) DrawView(i);
    }
    cv::rectangle(picture_, frame, kFaint, 1);
    Text(picture_, {kMargin_px, frame.br().y + 18},
         fmt::format("corners in the picture, a colour for each view; their errors {:g} times as "
                     "long; grey: left out",
                     longer_),
         kInk);
  }

 private:
  cv::Point At(const Eigen::Vector2d& pixel) const {
    return {kMargin_px + cvRound(pixel.x() * scale_), kTitle_px + cvRound(pixel.y() * scale_)};
  }
  void DrawView(std::size_t index) const {
    const ViewResult& result = calibration_.views[index];
    const cv::Scalar colour = result.used ? ColourOf(index, calibration_.views.size()) : kFaint;
    for (std::size_t i = 0; i < result.view.corners.size(); ++i) {
      const Eigen::Vector2d& corner = result.view.corners[i];
      cv::circle(picture_, At(corner), 2, colour, cv::FILLED, cv::LINE_AA);
      // Views that no fit has used have no errors: there were too few of them.
      if (!result.used || result.residuals_px.empty()) continue;
      cv::line(picture_, At(corner), At(corner + longer_ * result.residuals_px[i]), colour, 1,
               cv::LINE_AA);
    }
  }

  cv::Mat& picture_;
  const Calibration& calibration_;
  int width_px_ = 0, height_px_ = 0;
  double scale_ = 1.0, longer_ = 1.0;
};

void DrawBar(cv::Mat& picture, int row, const std::string& name, double share,
             const cv::Scalar& colour, const std::string& value) {
  const int y = kTitle_px + row * kBar_px;
  Text(picture, {kBars_px - 40, y + 14}, name.substr(0, 22), kInk, 0.4);
  const int x = kBars_px + 120;
  const int length = static_cast<int>(std::clamp(share, 0.0, 1.0) * kBarLength_px);
  cv::rectangle(picture, {x, y + 3, length, kBar_px - 8}, colour, cv::FILLED);
  Text(picture, {x + length + 5, y + 14}, value, kInk, 0.4);
}

int DrawCoverage(cv::Mat& picture, const Coverage& coverage) {
  int row = 0;
  Text(picture, {kBars_px - 40, kTitle_px - 8}, "coverage (1: plenty)", kInk);
  for (const auto& [name, share] : {std::pair{"x", coverage.x},
                                    {"y", coverage.y},
                                    {"size", coverage.size},
                                    {"skew", coverage.skew},
                                    {"picture", coverage.picture}}) {
    DrawBar(picture, row++, name, share * 0.8, kGood, fmt::format("{:.2f}", share));
  }
  return row;
}

void DrawErrors(cv::Mat& picture, const Calibration& calibration, int first_row) {
  constexpr std::size_t kMostBars = 26;
  double largest_px = 1e-9;
  for (const ViewResult& result : calibration.views) {
    if (!std::isnan(result.rms_px)) largest_px = std::max(largest_px, result.rms_px);
  }
  Text(picture, {kBars_px - 40, kTitle_px + (first_row + 1) * kBar_px + 6},
       "RMS error of each view, px (red: left out)", kInk);
  int row = first_row + 2;
  for (std::size_t i = 0; i < std::min(kMostBars, calibration.views.size()); ++i) {
    const ViewResult& result = calibration.views[i];
    const bool known = !std::isnan(result.rms_px);
    DrawBar(picture, row++, result.view.name, known ? 0.8 * result.rms_px / largest_px : 0.0,
            result.used ? ColourOf(i, calibration.views.size()) : kBad,
            known         ? fmt::format("{:.2f}", result.rms_px)
            : result.used ? "no fit"
                          : "left out");
  }
}

}  // namespace

void DrawCalibration(const Calibration& calibration, const std::filesystem::path& path) {
  cv::Mat picture(kHeight_px, kWidth_px, CV_8UC3, kPaper);
  const std::string_view verdict =
      EnumNames(calibration.verdict)[static_cast<std::size_t>(calibration.verdict)];
  Text(picture, {kMargin_px, 30}, fmt::format("Calibration: {}", verdict),
       calibration.verdict == CalibrationVerdict::kGood ? kGood : kBad, 0.8);
  Text(picture, {kMargin_px, 55},
       std::isnan(calibration.rms_px)
           ? "no lens was fitted"
           : fmt::format(
                 "{} lens, {:.2f} px RMS, {}",
                 EnumNames(Lens{})[static_cast<std::size_t>(calibration.camera.lens)],
                 calibration.rms_px,
                 std::isnan(calibration.floor_error_m)
                     ? "error on the floor not known"
                     : fmt::format("{:.2f} mm on the floor", 1e3 * calibration.floor_error_m)),
       kInk);
  CornerMap(picture, calibration).Draw();
  DrawErrors(picture, calibration, DrawCoverage(picture, calibration.coverage));
  bool written = false;
  try {
    written = cv::imwrite(path.string(), picture);
  } catch (const cv::Exception&) {  // an unknown ending; said below
  }
  if (!written) {
    throw std::runtime_error(fmt::format(
        "cannot write the picture {}: it must end in .png or .jpg in a folder that is there",
        path.string()));
  }
}

}  // namespace rift::vision
