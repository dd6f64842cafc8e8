#include "view/calibration_picture.hpp"

#include <catch2/catch.hpp>
#include <opencv2/imgproc.hpp>

namespace rift::view {
namespace {

const vision::Board kBoard{.columns = 3, .rows = 3, .square_m = 0.03};
const cv::Scalar kYellow{0, 225, 255}, kGreen{40, 220, 40};

vision::Frame DarkFrame() {
  vision::Frame frame{.width_px = 1920, .height_px = 1080};
  frame.bytes.assign(1920 * 1080, 30);
  return frame;
}

/// Where a colour is in the picture.
cv::Rect Around(const cv::Mat& picture, const cv::Scalar& colour, const cv::Rect& part) {
  cv::Mat found;
  cv::inRange(picture(part), colour, colour, found);
  std::vector<cv::Point> pixels;
  cv::findNonZero(found, pixels);
  return pixels.empty() ? cv::Rect() : cv::boundingRect(pixels) + part.tl();
}

struct Shot {
  vision::Frame frame = DarkFrame();
  std::vector<vision::BoardView> taken;
  vision::LiveScene scene{
      .frame = &frame, .taken = &taken, .board = kBoard, .good_views = 10, .good_coverage = 0.75};
};

TEST_CASE(
    "The outline of where the board is wanted is yellow at that place and goes with the need") {
  Shot shot;
  shot.scene.next = {{0.9, 0.9, 0.25, 0.0}, "hold it there"};
  const cv::Rect floor(0, 200, 1280, 460);  // neither words nor bars
  const cv::Rect drawn = Around(DrawCalibrating(shot.scene), kYellow, floor);
  const auto wanted = vision::OutlineAt(shot.scene.next.place, kBoard, 1920, 1080);
  const double shown = 1280.0 / 1920.0;
  CHECK(drawn.x == Approx(wanted[0].x() * shown).margin(3.0));
  CHECK(drawn.y == Approx(wanted[0].y() * shown).margin(3.0));
  CHECK(drawn.width == Approx((wanted[1] - wanted[0]).norm() * shown).margin(5.0));
  shot.scene.next = {};
  CHECK(Around(DrawCalibrating(shot.scene), kYellow, floor).empty());
}

TEST_CASE("The corners that were found are green where they are in the picture") {
  Shot shot;
  vision::BoardView view{.name = "frame000001", .width_px = 1920, .height_px = 1080};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      view.corners.emplace_back(900 + 90 * column, 500 + 90 * row);
  }
  const cv::Rect floor(0, 200, 1280, 460);
  CHECK(Around(DrawCalibrating(shot.scene), kGreen, floor).empty());
  shot.scene.searched = &view;
  const cv::Rect drawn = Around(DrawCalibrating(shot.scene), kGreen, floor);
  CHECK((drawn.tl() + drawn.br()).x / 2.0 == Approx(990.0 / 1.5).margin(2.0));
  CHECK((drawn.tl() + drawn.br()).y / 2.0 == Approx(590.0 / 1.5).margin(2.0));
  CHECK(drawn.width == Approx(180.0 / 1.5 + 6.0).margin(3.0));
}

TEST_CASE("Bars stand on a panel through which three tenths of the picture are seen") {
  Shot shot;
  const cv::Mat drawn = DrawCalibrating(shot.scene);
  // Of grey 30 and of the panel's 32, 28, 26.
  CHECK(drawn.at<cv::Vec3b>(1, 1275) == cv::Vec3b(31, 29, 27));
  CHECK(drawn.at<cv::Vec3b>(87, 1275) == cv::Vec3b(31, 29, 27));
  CHECK(drawn.at<cv::Vec3b>(88, 1275) == cv::Vec3b::all(30));
  CHECK(drawn.at<cv::Vec3b>(87, 1089) == cv::Vec3b::all(30));
}

TEST_CASE("A bar is as long as its coverage, yellow until it is enough") {
  Shot shot;
  const cv::Rect bars(1090, 0, 190, 90);
  shot.scene.coverage = {.x = 0.5};
  const cv::Mat half = DrawCalibrating(shot.scene);
  CHECK(Around(half, kYellow, bars).width == Approx(60).margin(1.0));
  CHECK(Around(half, kGreen, bars).empty());
  shot.scene.coverage = {.x = 0.8};
  const cv::Mat enough = DrawCalibrating(shot.scene);
  CHECK(Around(enough, kGreen, bars).width == Approx(96).margin(1.0));
  CHECK(Around(enough, kYellow, bars).empty());
  shot.scene.coverage = {.x = 0.75};  // as much as is asked for
  const cv::Mat just = DrawCalibrating(shot.scene);
  CHECK(Around(just, kGreen, bars).width == Approx(90).margin(1.0));
  CHECK(Around(just, kYellow, bars).empty());
}

TEST_CASE("Long advice is wrapped beside the bars and does not run under them") {
  Shot shot;
  const cv::Rect bars(1090, 0, 190, 720);
  const cv::Mat without = DrawCalibrating(shot.scene)(bars).clone();
  for (int i = 0; i < 60; ++i) shot.scene.advice += "hold it still ";
  const cv::Mat with = DrawCalibrating(shot.scene);
  CHECK(cv::norm(with(bars), without, cv::NORM_INF) == 0.0);
  cv::Mat letters;
  cv::inRange(with(cv::Rect(900, 60, 190, 60)), cv::Scalar::all(150), cv::Scalar::all(255),
              letters);
  CHECK(cv::countNonZero(letters) > 500);
}

TEST_CASE("Before the first picture there is a window with the advice all the same") {
  Shot shot;
  shot.scene.frame = nullptr;
  const cv::Mat empty = DrawCalibrating(shot.scene);
  CHECK(empty.cols == 640);
  shot.scene.advice = "hold the board still";
  cv::Mat differs;
  cv::extractChannel(empty != DrawCalibrating(shot.scene), differs, 1);
  CHECK(cv::countNonZero(differs) > 100);
}

TEST_CASE("When all is covered more views are asked for, as long as there are too few of them") {
  Shot shot;
  shot.taken.resize(2);
  // The second line: "everything is covered", and with it what to do, which is longer by half.
  const auto width_px = [&](int good_views) {
    shot.scene.good_views = good_views;
    cv::Mat letters;
    cv::inRange(DrawCalibrating(shot.scene)(cv::Rect(0, 27, 1000, 18)), cv::Scalar::all(150),
                cv::Scalar::all(255), letters);
    std::vector<cv::Point> pixels;
    cv::findNonZero(letters, pixels);
    return cv::boundingRect(pixels).width;
  };
  CHECK(width_px(1) > 100);
  CHECK(width_px(2) == width_px(1));
  CHECK(width_px(3) > 1.5 * width_px(2));
}

TEST_CASE("The corners of views that were taken are blue") {
  Shot shot;
  shot.taken.resize(1);
  shot.taken[0].corners = {{600.0, 600.0}};
  const cv::Rect around(390, 390, 20, 20);
  const cv::Rect drawn = Around(DrawCalibrating(shot.scene), cv::Scalar(235, 140, 60), around);
  CHECK((drawn.tl() + drawn.br()).x / 2.0 == Approx(400.0).margin(1.0));
  CHECK((drawn.tl() + drawn.br()).y / 2.0 == Approx(400.0).margin(1.0));
  CHECK_FALSE(drawn.empty());
}

}  // namespace
}  // namespace rift::view
