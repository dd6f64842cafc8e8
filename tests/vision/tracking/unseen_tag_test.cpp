#include "rift/vision/tracking/unseen_tag.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "vision/drawn_tag.hpp"

namespace rift::vision {
namespace {

using test::DrawnTag;
using test::WithWrongBit;

/// "tag36h11 3 unmeasured mirrored": what is told of a picture.
std::string Told(const Frame& frame, const TagOptions& tag, const std::vector<int>& further = {}) {
  const InsteadOfTag instead = LookForOthers(frame, tag, further);
  std::string text;
  for (const TagInPicture& other : instead.others) {
    text += std::string(NameOf(other.family)) + " " + std::to_string(other.id) + " ";
  }
  if (instead.is_unmeasured) text += "unmeasured ";
  if (instead.is_mirrored) text += "mirrored ";
  return text;
}

/// As a mirror shows it.
Frame InMirror(Frame frame) {
  for (int y = 0; y < frame.height_px; ++y) {
    const auto row = frame.bytes.begin() + static_cast<std::ptrdiff_t>(y) * frame.width_px;
    std::reverse(row, row + frame.width_px);
  }
  return frame;
}

TEST_CASE("A tag of any family is told with its id, unless it was asked for") {
  for (const TagFamily family :
       {TagFamily::k36h11, TagFamily::k25h9, TagFamily::k16h5, TagFamily::kStandard41h12}) {
    INFO(NameOf(family));
    const Frame frame = DrawnTag(CellsOfTag(3, family));
    CHECK(Told(frame, {.family = family, .id = 4}) == std::string(NameOf(family)) + " 3 ");
    CHECK(Told(frame, {.family = family, .id = 3}) == "unmeasured ");
    CHECK(Told(frame, {.family = family, .id = 4}, {5, 3}) == "unmeasured ");
    CHECK(Told(frame, {.family = family, .id = 4}, {5, 6}) == std::string(NameOf(family)) + " 3 ");
  }
}

TEST_CASE("A tag by the id of another family's is another tag") {
  const Frame frame = DrawnTag(CellsOfTag(3, TagFamily::k25h9));
  CHECK(Told(frame, {.family = TagFamily::k36h11, .id = 3}) == "tag25h9 3 ");
  CHECK(Told(frame, {.family = TagFamily::k36h11, .id = 0}, {3}) == "tag25h9 3 ");
}

TEST_CASE("A tag with a wrong bit is none that would be told, however many are put up with") {
  const Frame wrong = DrawnTag(WithWrongBit(CellsOfTag(3)));
  REQUIRE(FindTags(wrong, 1, {.max_hamming = 1}).size() == 1);
  CHECK(FindTags(wrong, 1, {.max_hamming = 1})[0].id == 3);
  CHECK(FindTags(wrong, 1, {.max_hamming = 1})[0].hamming == 1);
  CHECK(FindTags(wrong, 1, {.max_hamming = 0}).empty());
  for (const int max_hamming : {-1, 0, 1, 2}) {
    CHECK(Told(wrong, {.id = 0, .max_hamming = max_hamming}) == "");
    CHECK(Told(wrong, {.id = 3, .max_hamming = max_hamming}) == "");
  }
}

TEST_CASE("In a mirror the tag that was asked for first is known, and no other") {
  const Frame mirrored = InMirror(DrawnTag(CellsOfTag(3), 40, 200, 8, 24));
  CHECK(Told(mirrored, {.id = 3}) == "mirrored ");
  CHECK(Told(mirrored, {.id = 4}) == "");
  CHECK(Told(mirrored, {.id = 4}, {3}) == "");
  CHECK(Told(mirrored, {.family = TagFamily::k25h9, .id = 3}) == "");
  // What is not mirrored is not told to be.
  CHECK(Told(DrawnTag(CellsOfTag(3)), {.id = 4}) == "tag36h11 3 ");
}

TEST_CASE("A picture that cannot be decoded, and one of paper, show nothing") {
  Frame damaged{.width_px = 100, .height_px = 100, .format = PixelFormat::kJpeg, .bytes = {1, 2}};
  CHECK(Told(damaged, {}) == "");
  Frame paper{.width_px = 64, .height_px = 48};
  paper.bytes.assign(64 * 48, 200);
  CHECK(Told(paper, {}) == "");
}

}  // namespace
}  // namespace rift::vision
