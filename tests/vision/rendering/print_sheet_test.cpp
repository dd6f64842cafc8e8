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
  CHECK_THROWS_WITH(ChessboardSheet({13, 9, 0.05}),
                    "a chessboard of 700 x 500 mm does not go on A3");
  CHECK_THROWS_WITH(TagSheet(0, 0.5), "a tag with its border of 625 x 625 mm does not go on A3");
  CHECK_THROWS_WITH(TagSheet(900, 0.05), Contains("0 to 586"));
}

TEST_CASE("The sheets in data are those that this code makes") {
  const std::string folder = test::SourceDir() + "/data/camera/print/";
  CHECK(FileText(folder + "tag36h11_0.svg") == TagSheet(0, 0.0475));
  CHECK(FileText(folder + "chessboard_13x9_25mm.svg") == ChessboardSheet({13, 9, 0.025}));
}

TEST_CASE("A sheet is A4 as long as that has room above the caption, then A3 on its side") {
  const auto paper = [](const Board& board) {
    const std::string svg = ChessboardSheet(board);
    return svg.substr(svg.find("width="), svg.find(" viewBox") - svg.find("width="));
  };
  const std::string a4 = "width=\"210mm\" height=\"297mm\"",
                    a3 = "width=\"420mm\" height=\"297mm\"";
  // A4 has 194 by 267 mm for squares, A3 has 404 by 267.
  CHECK(paper({9, 9, 0.01939}) == a4);
  CHECK(paper({9, 9, 0.01941}) == a3);
  CHECK(paper({4, 9, 0.0267}) == a4);
  CHECK_THROWS_WITH(ChessboardSheet({4, 9, 0.02671}),
                    Catch::Contains("a chessboard of 133.55 x 267.1 mm"));
  CHECK(paper({19, 9, 0.0202}) == a3);
  CHECK_THROWS_WITH(ChessboardSheet({19, 9, 0.02021}), Catch::Contains("does not go on A3"));
}

TEST_CASE("A board on A4 has its squares in the middle, its ruler and its caption at the foot") {
  const std::string svg = ChessboardSheet({3, 4, 0.03});
  // Four by five squares of 30 mm: (210 - 120) / 2 from the left and 8 from the top; ten black.
  CHECK_THAT(svg, Catch::Contains(
                      "<rect x=\"45.0000\" y=\"8.0000\" width=\"30.0000\" height=\"30.0000\"/>") &&
                      Catch::Contains("<rect x=\"135.0000\" y=\"38.0000\"") &&
                      Catch::Contains("<rect x=\"105.0000\" y=\"128.0000\""));
  int rectangles = 0;
  for (std::size_t at = 0; (at = svg.find("<rect", at)) != std::string::npos; ++at) ++rectangles;
  CHECK(rectangles == 10);
  CHECK_THAT(svg,
             Catch::Contains("d=\"M8 289h100M8 287.5v3M108 287.5v3\"") &&
                 Catch::Contains("x=\"8\" y=\"282\"") && Catch::Contains("x=\"8\" y=\"286\"") &&
                 Catch::Contains(">chessboard of 3 x 4 inner corners, squares of 30 mm<") &&
                 Catch::Contains(">This line: 100 mm. Print at 100 %, matt, and glue it flat.<"));
}

TEST_CASE(
    "Of a family with a white square the white one has the size, and all that is printed is "
    "drawn") {
  const std::string svg = TagSheet(17, 0.05, TagFamily::kStandard41h12);
  CHECK_THAT(svg, Catch::Contains(">tagStandard41h12 id 17, white square 50 mm; cut along the grey "
                                  "line; the robot's front is to the right<") &&
                      Catch::Contains("<path d=\"M60 30h90v90h-90z\" stroke=\"#999\""));
  const TagCells cells = CellsOfTag(17, TagFamily::kStandard41h12);
  const cv::Mat sheet = Printed(svg);
  for (int row = 0; row < 9; ++row) {
    for (int column = 0; column < 9; ++column) {
      const cv::Point middle(cvRound((65.0 + 10.0 * column) * kPxPerMm),
                             cvRound((35.0 + 10.0 * row) * kPxPerMm));
      CHECK((sheet.at<std::uint8_t>(middle) == 255) == cells.is_white[row][column]);
    }
  }
}

TEST_CASE("A tag that fills its sheet ends above the caption") {
  // Ten cells for eight: A4 has 194 mm for them, A3 on its side 267 mm.
  const auto foot_mm = [](double size_m, const std::string& paper) {
    const std::string svg = TagSheet(0, size_m);
    CHECK_THAT(svg, Catch::Contains(paper));
    std::smatch outline;
    REQUIRE(std::regex_search(
        svg, outline, std::regex("M([0-9.]+) ([0-9.]+)h([0-9.]+)v[^\"]*\" stroke=\"#999\"")));
    CHECK(std::stod(outline[3]) == Approx(1250.0 * size_m));
    CHECK(std::stod(outline[2]) >= 8.0);
    return std::stod(outline[2]) + std::stod(outline[3]);
  };
  CHECK(foot_mm(0.155, "width=\"210mm\"") == Approx(30.0 + 193.75));
  CHECK(foot_mm(0.18, "width=\"420mm\"") == Approx(30.0 + 225.0));
  for (const double size_m : {0.2, 0.2136})
    CHECK(foot_mm(size_m, "width=\"420mm\"") <= 297.0 - 8.0 - 14.0);
}

}  // namespace
}  // namespace rift::vision
