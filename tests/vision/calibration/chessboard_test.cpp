#include "rift/vision/calibration/chessboard.hpp"

#include <catch2/catch.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "support/processes/process.hpp"

namespace rift::vision {
namespace {

constexpr int kSquare_px = 40;

/// A board of 7 x 5 inner corners on white, without perspective.
cv::Mat1b Drawn() {
  cv::Mat1b sheet(8 * kSquare_px, 10 * kSquare_px, std::uint8_t{255});
  for (int row = 0; row < 6; ++row) {
    for (int column = row % 2; column < 8; column += 2) {
      sheet(cv::Rect((column + 1) * kSquare_px, (row + 1) * kSquare_px, kSquare_px, kSquare_px))
          .setTo(0);
    }
  }
  return sheet;
}

TEST_CASE("A board turned any way is found where it is, from its upper left end on") {
  const test::TemporaryFolder folder;
  const cv::Mat1b sheet = Drawn();
  for (int degrees = -170; degrees <= 170; degrees += 20) {
    cv::Mat turn = cv::getRotationMatrix2D(cv::Point2f(sheet.size()) / 2.0F, degrees, 1.0);
    turn.at<double>(0, 2) += 480.0 - sheet.cols / 2.0;
    turn.at<double>(1, 2) += 360.0 - sheet.rows / 2.0;
    cv::Mat picture;
    cv::warpAffine(sheet, picture, turn, {960, 720}, cv::INTER_AREA, cv::BORDER_CONSTANT, 255);
    cv::imwrite(folder / "board.png", picture);
    const BoardView view = FindBoard(folder / "board.png", {7, 5, 0.025});
    INFO(degrees << " degrees: " << view.problem);
    REQUIRE(view.corners.size() == 35);
    const Eigen::Vector2d first = view.corners.front(), last = view.corners.back();
    CHECK(first.sum() < last.sum());
    // Corner lines of the sheet stand between pixels.
    const auto corner = [&](int column, int row) {
      const cv::Vec3d p((column + 2) * kSquare_px - 0.5, (row + 2) * kSquare_px - 0.5, 1.0);
      return Eigen::Vector2d(turn.row(0).dot(cv::Mat(p).t()), turn.row(1).dot(cv::Mat(p).t()));
    };
    const bool is_forward = corner(0, 0).sum() < corner(6, 4).sum();
    for (int i = 0; i < 35; ++i) {
      const int at = is_forward ? i : 34 - i;
      CHECK((view.corners[static_cast<std::size_t>(i)] - corner(at % 7, at / 7)).norm() < 0.2);
    }
  }
}

}  // namespace
}  // namespace rift::vision
