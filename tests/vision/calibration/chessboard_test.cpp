#include "rift/vision/calibration/chessboard.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "rift/vision/camera/jpeg.hpp"
#include "support/processes/process.hpp"

namespace rift::vision {
namespace {

using Catch::Matchers::Contains;

constexpr int kSquare_px = 40;
const Board kBoard{7, 5, 0.025};

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

TEST_CASE("A photograph is not turned as its EXIF data say, since its lens was not") {
  const test::TemporaryFolder folder;
  cv::Mat1b aside;  // not in the middle, where half a turn changes nothing
  cv::copyMakeBorder(Drawn(), aside, 0, 0, 80, 0, cv::BORDER_CONSTANT, 255);
  std::vector<std::uint8_t> jpeg = WriteJpeg(aside, 95, false);
  const auto corners_of = [&] {
    std::ofstream(folder / "board.jpg", std::ios::binary)
        .write(reinterpret_cast<const char*>(jpeg.data()),
               static_cast<std::streamsize>(jpeg.size()));
    return FindBoard(folder / "board.jpg", kBoard);
  };
  const BoardView plain = corners_of();
  REQUIRE(plain.corners.size() == 35);
  for (const auto orientation :
       {std::uint8_t{3}, std::uint8_t{6}}) {  // by half a turn, by a quarter
    // An Exif segment with a folder of one entry (TIFF 6.0): 0x0112, a short, the orientation.
    const std::vector<std::uint8_t> exif{
        0xFF, 0xE1, 0,    34,   'E', 'x', 'i', 'f', 0, 0, 'I',         'I', 42, 0, 8, 0, 0, 0,
        1,    0,    0x12, 0x01, 3,   0,   1,   0,   0, 0, orientation, 0,   0,  0, 0, 0, 0, 0};
    jpeg = WriteJpeg(aside, 95, false);
    jpeg.insert(jpeg.begin() + 2, exif.begin(), exif.end());
    const BoardView turned = corners_of();
    CHECK((turned.width_px == plain.width_px && turned.height_px == plain.height_px));
    REQUIRE(turned.corners.size() == 35);
    for (std::size_t i = 0; i < 35; ++i) {
      CHECK((turned.corners[i] - plain.corners[i]).norm() == 0.0);
    }
  }
}

Frame FrameOf(const cv::Mat& picture) {
  Frame frame{.width_px = picture.cols, .height_px = picture.rows};
  if (picture.channels() == 3) frame.format = PixelFormat::kBgr;
  frame.bytes.assign(picture.datastart, picture.dataend);
  return frame;
}

TEST_CASE("The corners of a large picture are found to a tenth of its own pixels") {
  const int times = GENERATE(1, 5);  // 400 and 2000 px wide
  cv::Mat picture;
  cv::resize(Drawn(), picture, {}, times, times, cv::INTER_NEAREST);
  for (const BoardSearch search : {BoardSearch::kThorough, BoardSearch::kQuick}) {
    const BoardView view = FindBoard(FrameOf(picture), kBoard, "it", search);
    REQUIRE(view.corners.size() == 35);
    CHECK(view.method == BoardMethod::kSector);
    CHECK((view.name == "it" && view.problem.empty() && view.coloured == 0.0));
    CHECK((view.width_px == 400 * times && view.height_px == 320 * times));
    for (int i = 0; i < 35; ++i) {
      const Eigen::Vector2d line(80.0 + kSquare_px * (i % 7), 80.0 + kSquare_px * (i / 7));
      const Eigen::Vector2d expected = times * line - Eigen::Vector2d::Constant(0.5);
      CHECK((view.corners[static_cast<std::size_t>(i)] - expected).norm() < 0.1);
    }
  }
}

TEST_CASE("The corners of small squares are not drawn to those beside them") {
  // Squares of 10 px, seen obliquely, so that the corners around one are not alike on all sides.
  const cv::Mat1b sheet = Drawn();
  const std::vector<cv::Point2f> from{{0.F, 0.F}, {399.F, 0.F}, {399.F, 319.F}, {0.F, 319.F}},
      to{{20.F, 30.F}, {118.F, 20.F}, {124.F, 104.F}, {30.F, 96.F}};
  const cv::Mat turn = cv::getPerspectiveTransform(from, to);
  cv::Mat large, picture;
  const cv::Mat four = (cv::Mat_<double>(3, 3) << 4.0, 0.0, 1.5, 0.0, 4.0, 1.5, 0.0, 0.0, 1.0);
  cv::warpPerspective(sheet, large, four * turn, {640, 480}, cv::INTER_LINEAR, cv::BORDER_CONSTANT,
                      255);
  cv::resize(large, picture, {160, 120}, 0.0, 0.0, cv::INTER_AREA);
  const BoardView view = FindBoard(FrameOf(picture), kBoard, "it");
  REQUIRE(view.corners.size() == 35);
  std::vector<cv::Point2f> corners, expected;
  for (int i = 0; i < 35; ++i) {
    corners.emplace_back(static_cast<float>((2 + i % 7) * kSquare_px) - 0.5F,
                         static_cast<float>((2 + i / 7) * kSquare_px) - 0.5F);
  }
  cv::perspectiveTransform(corners, expected, turn);
  double squares = 0.0;
  for (std::size_t i = 0; i < 35; ++i) {
    squares += (view.corners[i] - Eigen::Vector2d(expected[i].x, expected[i].y)).squaredNorm() / 35;
  }
  CHECK(std::sqrt(squares) < 0.3);
}

TEST_CASE("What is drawn over a board in colour is its share of the board's pixels") {
  cv::Mat picture;
  cv::cvtColor(Drawn(), picture, cv::COLOR_GRAY2BGR);
  const auto share = [&](const cv::Scalar& colour, const cv::Rect& where) {
    cv::Mat drawn = picture.clone();
    drawn(where).setTo(colour);
    const BoardView view = FindBoard(FrameOf(drawn), kBoard, "it");
    REQUIRE(view.corners.size() == 35);
    return view.coloured;
  };
  // 240 by 160 px lie within the corners; the inner part of one white square of 40 px.
  const cv::Rect inside(130, 90, 20, 20);
  const double all = 241.0 * 161.0;
  CHECK(share({0, 0, 255}, inside) == Approx(400.0 / all).epsilon(0.01));
  CHECK(share({0, 255, 0}, inside) == Approx(400.0 / all).epsilon(0.01));
  CHECK(share({0, 0, 255}, {50, 90, 20, 20}) == 0.0);  // beside the corners
  CHECK(share({166, 166, 255}, inside) == 0.0);        // a saturation of 89 of 255
  CHECK(share({164, 164, 255}, inside) > 0.0);         // of 91
  CHECK(share({0, 0, 79}, {90, 90, 20, 20}) == 0.0);   // dark on black
  CHECK(share({0, 0, 81}, {90, 90, 20, 20}) > 0.0);
}

TEST_CASE("A picture is black where its mean and three deviations are below 40") {
  const auto problem = [](int grey, int other) {
    cv::Mat picture(60, 80, CV_8UC1, cv::Scalar(grey));
    picture.colRange(0, 40).setTo(other);
    const BoardView view = FindBoard(FrameOf(picture), kBoard, "it");
    CHECK(view.corners.empty());
    CHECK(view.method == BoardMethod::kNone);
    CHECK((view.width_px == 80 && view.height_px == 60));
    return view.problem;
  };
  const std::string none = "no chessboard of 7 x 5 inner corners in it";
  CHECK(problem(39, 39) == "the picture is black");
  CHECK(problem(40, 40) == none);
  CHECK(problem(9, 15) == "the picture is black");   // 12 and thrice 3
  CHECK(problem(16, 28) == none);                    // 22 and thrice 6
  CHECK(problem(14, 26) == "the picture is black");  // 20 and thrice 6
  CHECK(problem(2, 24) == none);                     // 13 and thrice 11
}

TEST_CASE("Each file is told with its corners or what is wrong with it, until it is stopped") {
  const test::TemporaryFolder folder;
  cv::imwrite(folder / "board.png", Drawn());
  test::WriteText(folder / "text.png", "no picture");
  const std::vector<std::uint8_t> jpeg = WriteJpeg(Drawn(), 90, false);
  const auto write = [&](const char* name, std::vector<std::uint8_t> bytes) {
    std::ofstream(folder / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  };
  write("board.jpg", jpeg);
  write("half.jpg", {jpeg.begin(), jpeg.begin() + static_cast<std::ptrdiff_t>(jpeg.size() / 2)});
  std::vector<std::uint8_t> huge = jpeg;
  for (std::size_t at = 0; at + 9 < huge.size(); ++at) {
    if (huge[at] != 0xFF || huge[at + 1] != 0xC0) continue;
    huge[at + 5] = huge[at + 7] = 0x18;  // 6308 by 6352 pixels and so on: more than 40 million
    huge[at + 6] = 0xA4;
    huge[at + 8] = 0xD0;
  }
  write("huge.jpg", huge);
  std::vector<std::string> said;
  int asked = 0;
  const ViewListener listener{.is_stopped = [&] { return ++asked > 5; },
                              .say = [&](const std::string& line) { said.push_back(line); }};
  std::vector<std::string> files;
  for (const char* name : {"board.png", "text.png", "board.jpg", "half.jpg", "huge.jpg"}) {
    files.push_back(folder / name);
  }
  const std::vector<BoardView> views = ViewsFromFiles(files, kBoard, listener);
  REQUIRE(views.size() == 5);
  const std::string too_large =
      "huge.jpg: 6352 x 6308 pixels, and at most 40 million are read: make it smaller";
  CHECK(said == std::vector<std::string>{
                    "board.png: 35 corners",
                    "text.png: the picture cannot be decoded: it is no JPEG, PNG, BMP, TIFF, PGM "
                    "or PPM",
                    "board.jpg: 35 corners",
                    "half.jpg: its JPEG is damaged: copy it again, or leave it out", too_large});
  CHECK(views[2].corners.size() == 35);
  CHECK(views[3].corners.empty());
  CHECK_THROWS_WITH(ViewsFromFiles(files, kBoard, listener),
                    "stopped before all pictures were read");
  Frame damaged{.width_px = 400, .height_px = 320, .format = PixelFormat::kJpeg, .bytes = {1, 2}};
  CHECK(FindBoard(damaged, kBoard, "frame").problem == "the picture cannot be decoded");
  std::filesystem::create_directory(folder / "folder.png");
  CHECK(FindBoard(folder / "folder.png", kBoard).problem == "it is no file");
}

TEST_CASE("A board has 3 to 100 inner corners both ways and squares of up to ten metres") {
  for (const Board& good : {Board{3, 3, 10.0}, Board{100, 100, 0.001}}) CHECK_NOTHROW(good.Check());
  for (const auto& [columns, rows] : {std::pair{2, 9}, {9, 2}, {101, 9}, {9, 101}}) {
    CHECK_THROWS_WITH((Board{columns, rows, 0.025}.Check()),
                      "a board of " + std::to_string(columns) + " x " + std::to_string(rows) +
                          " inner corners: there must be 3 to 100 both ways (squares less one)");
  }
  CHECK_THROWS_WITH((Board{9, 6, 10.1}.Check()),
                    "squares of 10.1 m: the side of one square in metres is needed, above 0 and up "
                    "to 10 (25 mm are 0.025)");
  CHECK_THROWS_WITH((Board{9, 6, 0.0}.Check()), Contains("above 0"));
  CHECK_THROWS_WITH((Board{9, 6, -1.0}.Check()), Contains("squares of -1 m"));
  CHECK_THROWS((Board{9, 6, std::nan("")}.Check()));
  CHECK_THROWS_WITH(FindBoard(FrameOf(Drawn()), {2, 9, 0.025}, "it"), Contains("3 to 100"));
  CHECK_THROWS_WITH(FindBoard(FrameOf(Drawn()), {7, 5, 0.0}, "it"), Contains("squares of 0 m"));
}

}  // namespace
}  // namespace rift::vision
