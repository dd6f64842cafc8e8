#include "rift/vision/rendering/print_sheet.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <regex>
#include <sstream>

#include "rift/vision/tracking/tag_detector.hpp"
#include "support/processes/process.hpp"
#include "support/tree.hpp"

namespace rift::vision {
namespace {

constexpr double kPxPerMm = 5.0;

std::string FileText(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// What a printer makes of the sheet's rectangles.
cv::Mat Printed(const std::string& svg) {
  std::smatch size;
  REQUIRE(std::regex_search(svg, size, std::regex("width=\"([0-9.]+)mm\" height=\"([0-9.]+)mm\"")));
  cv::Mat sheet(cvRound(std::stod(size[2]) * kPxPerMm), cvRound(std::stod(size[1]) * kPxPerMm),
                CV_8U, cv::Scalar(255));
  const std::regex rectangle(
      "<rect x=\"([0-9.]+)\" y=\"([0-9.]+)\" width=\"([0-9.]+)\" height=\"([0-9.]+)\"/>");
  for (std::sregex_iterator at(svg.begin(), svg.end(), rectangle), end; at != end; ++at) {
    const auto px = [&](int i) { return std::stod((*at)[static_cast<std::size_t>(i)]) * kPxPerMm; };
    const int left = cvRound(px(1)), top = cvRound(px(2));
    const int right = cvRound(px(1) + px(3)), bottom = cvRound(px(2) + px(4));
    sheet(cv::Rect(left, top, right - left, bottom - top)).setTo(0);
  }
  return sheet;
}

TEST_CASE("A printed tag is found with its id and the size that was asked for") {
  const cv::Mat sheet = Printed(TagSheet(7, 0.0475));
  GreyPatch patch{{0, 0, sheet.cols, sheet.rows}, {sheet.datastart, sheet.dataend}};
  const auto found = TagDetector(2, 0).Detect(patch);
  REQUIRE(found.size() == 1);
  CHECK(found[0].id == 7);
  const double side_mm = (found[0].corners[1] - found[0].corners[0]).norm() / kPxPerMm;
  CHECK(side_mm == Approx(47.5).margin(0.3));
  // As one reads the sheet, its bottom edge is the tag's.
  CHECK(found[0].corners[0].y() > found[0].corners[3].y());
  CHECK(found[0].corners[1].x() > found[0].corners[0].x());
}

TEST_CASE("A printed chessboard is found with its corners and the squares that were asked for") {
  const Board board{13, 9, 0.025};
  const test::TemporaryFolder folder;
  cv::imwrite(folder / "board.png", Printed(ChessboardSheet(board)));
  const BoardView view = FindBoard(folder / "board.png", board);
  REQUIRE(view.corners.size() == 117);
  const double row_mm = (view.corners[12] - view.corners[0]).norm() / kPxPerMm;
  CHECK(row_mm == Approx(12 * 25.0).margin(0.2));
}

TEST_CASE("What no sheet holds is refused with its size") {
  using Catch::Matchers::Contains;
  CHECK_THROWS_WITH(ChessboardSheet({13, 9, 0.05}), Contains("700 x 500 mm"));
  CHECK_THROWS_WITH(TagSheet(0, 0.5), Contains("does not go on A3"));
  CHECK_THROWS_WITH(TagSheet(900, 0.05), Contains("0 to 586"));
}

TEST_CASE("The sheets in data are those that this code makes") {
  const std::string folder = test::SourceDir() + "/data/camera/print/";
  CHECK(FileText(folder + "tag36h11_0.svg") == TagSheet(0, 0.0475));
  CHECK(FileText(folder + "chessboard_13x9_25mm.svg") == ChessboardSheet({13, 9, 0.025}));
}

}  // namespace
}  // namespace rift::vision
