#include "rift/vision/tracking/tag_detector.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "vision/drawn_tag.hpp"

namespace rift::vision {
namespace {

using test::DrawnTag;

TEST_CASE("A detector finds the corners where the square is, in its place of the whole picture") {
  const Frame frame = DrawnTag(CellsOfTag(7), 40, 200, 8, 24);
  // The square of eight cells begins a cell right of and below the printed border.
  const double left = 24.0 + 8.0 - 0.5, top = 8.0 + 8.0 - 0.5, side = 64.0;
  for (const auto& [x_px, y_px] : {std::pair{0, 0}, {300, 1000}}) {
    GreyPatch patch{{x_px, y_px, frame.width_px, frame.height_px}, frame.bytes};
    const auto found = TagDetector(1, 0).Detect(patch);
    REQUIRE(found.size() == 1);
    CHECK(found[0].id == 7);
    CHECK(found[0].hamming == 0);
    CHECK(found[0].decision_margin > 50.0);
    const TagCorners corners{
        {{left, top + side}, {left + side, top + side}, {left + side, top}, {left, top}}};
    for (int i = 0; i < 4; ++i) {
      INFO(i << ": " << found[0].corners[i].transpose());
      CHECK((found[0].corners[i] - Eigen::Vector2d(x_px, y_px) - corners[i]).norm() < 0.3);
    }
  }
}

TEST_CASE("A tag is looked for from five grey values between its black and its white on") {
  const auto found = [](int contrast, int least_contrast) {
    const Frame frame = DrawnTag(CellsOfTag(7), 100, 100 + contrast, 12, 12);
    GreyPatch patch{{0, 0, frame.width_px, frame.height_px}, frame.bytes};
    const auto by_default = TagDetector(1, 0).Detect(patch);
    CHECK(FindTags(frame, 1, {.max_hamming = 0}).size() == by_default.size());
    return TagDetector(1, 0, least_contrast).Detect(patch).size();
  };
  CHECK(found(5, 5) == 1);
  CHECK(found(4, 5) == 0);
  CHECK(found(30, 30) == 1);
  CHECK(found(29, 30) == 0);
}

TEST_CASE("As many wrong bits are corrected as are asked for") {
  const Frame frame = DrawnTag(test::WithWrongBit(CellsOfTag(7)));
  const GreyPatch patch{{0, 0, frame.width_px, frame.height_px}, frame.bytes};
  CHECK(TagDetector(1, 0).Detect(patch).empty());
  REQUIRE(TagDetector(1, 1).Detect(patch).size() == 1);
  CHECK(TagDetector(1, 1).Detect(patch)[0].hamming == 1);
}

TEST_CASE("A picture too small for its tiles holds no tag") {
  for (const auto& [width_px, height_px] :
       {std::pair{15, 40}, {40, 15}, {7, 300}, {300, 7}, {1, 1}, {0, 0}}) {
    GreyPatch patch{{0, 0, width_px, height_px}, {}};
    patch.pixels.assign(static_cast<std::size_t>(width_px) * height_px, 100);
    CHECK(TagDetector(2, 0).Detect(patch).empty());
  }
}

TEST_CASE("The bits of a tag are all of its cells but those of its borders") {
  const TagCells cells = CellsOfTag(0);
  for (int row = 0; row < 10; ++row) {
    for (int column = 0; column < 10; ++column) {
      const int ring = std::min({row, column, 9 - row, 9 - column});
      INFO(row << " " << column);
      CHECK(cells.is_bit[row][column] == (ring >= 2));
      if (ring == 0) CHECK(cells.is_white[row][column]);
      if (ring == 1) CHECK_FALSE(cells.is_white[row][column]);
    }
  }
}

}  // namespace
}  // namespace rift::vision
