#include "rift/vision/camera/jpeg.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <span>

namespace rift::vision {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

const Bytes kStart{0xFF, 0xD8}, kEnd{0xFF, 0xD9};

/// A marker with its length and content.
Bytes Segment(int marker, const Bytes& content) {
  const std::size_t length = content.size() + 2;
  return Bytes{0xFF, static_cast<std::uint8_t>(marker), static_cast<std::uint8_t>(length >> 8),
               static_cast<std::uint8_t>(length & 0xFF)} +
         content;
}

/// A frame header of 0x0123 by 0x0245 pixels, height first.
Bytes FrameHeader(int marker) {
  return Segment(marker, {8, 0x02, 0x45, 0x01, 0x23, 1, 1, 0x11, 0});
}

const Bytes kTable = Segment(0xDB, Bytes(300, 7));

TEST_CASE("The size of a JPEG is that of its frame header, whichever of the thirteen it has") {
  for (int marker = 0xC0; marker <= 0xCF; ++marker) {
    INFO(marker);
    const auto size = SizeOfJpeg(kStart + kTable + FrameHeader(marker));
    const bool is_table = marker == 0xC4 || marker == 0xC8 || marker == 0xCC;
    REQUIRE(size.has_value() == !is_table);
    if (size) CHECK((size->width_px == 0x0123 && size->height_px == 0x0245));
  }
  CHECK_FALSE(SizeOfJpeg(kStart + FrameHeader(0xB0)));
  CHECK_FALSE(SizeOfJpeg(kStart + FrameHeader(0xD1)));
}

TEST_CASE(
    "Fill bytes, thumbnails and scans are no frame headers, and what is cut off has no size") {
  const Bytes other = Segment(0xC0, {8, 0, 1, 0, 1, 1, 1, 0x11, 0}),
              scan = Segment(0xDA, {1, 2, 3});
  CHECK(SizeOfJpeg(kStart + Bytes{0xFF, 0xFF} + FrameHeader(0xC0))->width_px == 0x0123);
  CHECK(SizeOfJpeg(kStart + Segment(0xE1, kStart + other) + FrameHeader(0xC2))->width_px == 0x0123);
  CHECK(SizeOfJpeg(kStart + FrameHeader(0xC0) + scan + other)->width_px == 0x0123);
  CHECK_FALSE(SizeOfJpeg(Bytes{0xFF, 0xD9} + FrameHeader(0xC0)));
  CHECK_FALSE(SizeOfJpeg(Bytes{0xFE, 0xD8} + FrameHeader(0xC0)));
  const Bytes whole = kStart + FrameHeader(0xC0);
  for (std::size_t length = 0; length <= whole.size(); ++length) {
    INFO(length);
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length));
    CHECK(SizeOfJpeg(cut).has_value() == (length >= 11));  // its width ends there
  }
}

TEST_CASE("A frame header is found where libjpeg finds it, so that no other size is decoded") {
  const Bytes header = FrameHeader(0xC2);
  const auto is_found = [&](const Bytes& before) {
    const auto size = SizeOfJpeg(kStart + before + header);
    return size && size->width_px == 0x0123 && size->height_px == 0x0245;
  };
  CHECK(is_found({0}));                       // stray bytes
  CHECK(is_found({7, 0xFF, 0x00, 9}));        // and those that look like a marker
  CHECK(is_found({0xFF, 0x01}));              // TEM has no length
  CHECK(is_found({0xFF, 0xD0, 0xFF, 0xD7}));  // RST0 to RST7 neither
  CHECK(is_found({0xFF, 0xE0, 0, 0}));        // a length that does not count itself
  CHECK_FALSE(is_found(kEnd));
  CHECK_FALSE(is_found(kStart));
  // By the old rule TEM's "length" leads over the frame header into a comment with another.
  const Bytes hidden = Segment(0xC2, {8, 0, 48, 0, 64, 1, 1, 0x11, 0}),
              shown = Segment(0xC0, {8, 0, 24, 0, 32, 1, 1, 0x11, 0});
  const std::size_t jump = 2 + 2 + 0xFFC2 - 4 - hidden.size() - 4;  // into the comment
  const Bytes picture =
      kStart + Bytes{0xFF, 0x01} + hidden + Segment(0xFE, Bytes(jump, 0) + shown + Bytes(20, 0));
  CHECK(SizeOfJpeg(picture)->width_px == 64);
  CHECK(SizeOfJpeg(picture)->height_px == 48);
}

/// A grey progressive picture of 64 x 48 px with so many scans, all but the first without content.
Bytes OfScans(int scans) {
  const Bytes dc{0x00, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1};
  const Bytes ac{0x10, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xE0};
  const Bytes blocks(6, 0);  // 48 of them, a bit each
  Bytes picture = kStart + Segment(0xC2, {8, 0, 48, 0, 64, 1, 1, 0x11, 0}) +
                  Segment(0xDB, Bytes{0} + Bytes(64, 1)) + Segment(0xC4, dc + ac) +
                  Segment(0xDA, {1, 1, 0, 0, 0, 0}) + blocks;
  for (int i = 1; i < scans; ++i) picture = picture + Segment(0xDA, {1, 1, 0, 1, 63, 0}) + blocks;
  return picture + kEnd;
}

TEST_CASE("A picture of more scans than any camera makes is damaged, since each costs time") {
  JpegReader reader;
  const auto is_read = [&](int scans) {
    return reader.Read(OfScans(scans), 64, 48, {0, 0, 64, 48}).has_value();
  };
  CHECK(is_read(10));
  CHECK(is_read(100));
  CHECK_FALSE(is_read(101));
  CHECK(is_read(1));  // the reader goes on
  CHECK_FALSE(DecodeJpeg(OfScans(500), false, 8).empty());
  CHECK(DecodeJpeg(OfScans(501), false, 8).empty());
}

TEST_CASE("A picture ends at its end marker after the scan, whatever a driver leaves behind it") {
  const Bytes thumbnail = Segment(0xE1, kStart + kEnd), scan = Segment(0xDA, {1, 2, 3});
  const Bytes picture =
      kStart + thumbnail + scan + Bytes{9, 0xFF, 0x00, 0xD9, 0xFF, 0xD0, 5} + kEnd;
  CHECK(JpegLength(picture) == picture.size());
  CHECK(JpegLength(picture + Bytes(50, 3) + kEnd) == picture.size());
  CHECK(JpegLength(kStart + scan + kEnd + Bytes{1}) == 2 + scan.size() + 2);
  const Bytes endless = kStart + scan + Bytes(20, 1) + Bytes{0xFF};
  CHECK(JpegLength(endless) == endless.size());
  const Bytes text{'t', 'e', 'x', 't', 0xFF, 0xD9, 'a'};
  CHECK(JpegLength(text) == text.size());
}

TEST_CASE("The Exif segment is the first one of that name, without the name") {
  const Bytes name{'E', 'x', 'i', 'f', 0, 0}, one{1, 2, 3}, two{4, 5};
  const auto exif = [](const Bytes& bytes) {
    const auto found = ExifOfJpeg(bytes);
    return Bytes(found.begin(), found.end());
  };
  const Bytes other = Segment(0xE1, {'h', 't', 't', 'p', ':', '/', '/', 'x'});
  CHECK(exif(kStart + Segment(0xE1, name + one)) == one);
  CHECK(exif(kStart + other + kTable + Segment(0xE1, name + one)) == one);
  CHECK(exif(kStart + Segment(0xE1, name + one) + Segment(0xE1, name + two)) == one);
  CHECK(exif(kStart + Segment(0xE2, name + one)).empty());
  CHECK(exif(kStart + Segment(0xE1, name) + kEnd).empty());
  CHECK(exif(kStart + Segment(0xE1, {'E', 'x', 'i'}) + Bytes{'f', 0, 0, 1, 2}).empty());
  CHECK(exif(Segment(0xE1, name + one)).empty());
  Bytes cut = kStart + Segment(0xE1, name + one);
  cut.pop_back();
  CHECK(exif(cut) == Bytes{1, 2});
}

/// Grey steps from left to right and from top to bottom, no two blocks alike.
cv::Mat1b Steps(int width_px, int height_px) {
  cv::Mat1b picture(height_px, width_px);
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      picture(y, x) = static_cast<std::uint8_t>(20 + 3 * (x / 8) + 11 * (y / 8));
    }
  }
  return picture;
}

TEST_CASE("A picture is decoded at eighths of its size, in grey or in three alike") {
  const cv::Mat1b picture = Steps(100, 76);
  const Bytes jpeg = WriteJpeg(picture, 95, false);
  for (const int eighths : {1, 2, 4, 8}) {
    for (const bool colour : {false, true}) {
      INFO(eighths << " " << colour);
      const cv::Mat read = DecodeJpeg(jpeg, colour, eighths);
      REQUIRE(read.channels() == (colour ? 3 : 1));
      CHECK(read.cols == (100 * eighths + 7) / 8);
      CHECK(read.rows == (76 * eighths + 7) / 8);
      // The middle of block (5, 3).
      const cv::Point middle(5 * eighths + eighths / 2, 3 * eighths + eighths / 2);
      const int grey = colour ? read.at<cv::Vec3b>(middle)[2] : read.at<std::uint8_t>(middle);
      CHECK(grey == Approx(20 + 15 + 33).margin(2.0));
    }
  }
  CHECK(DecodeJpeg(Bytes{1, 2, 3}, true, 8).empty());
  CHECK(DecodeJpeg(Bytes{}, true, 8).empty());
  CHECK(WriteJpeg(picture, 95, false).size() > WriteJpeg(picture, 20, false).size());
  CHECK(WriteJpeg(picture, 95, true).size() > jpeg.size());
  const Bytes even = WriteJpeg(cv::Mat1b(16, 16, std::uint8_t{100}), 95, true);
  CHECK(DecodeJpeg(even, true, 8).at<cv::Vec3b>(8, 8) == cv::Vec3b::all(100));  // of no colour
  // What is cut off is grey, and the rest is there.
  const Bytes half(jpeg.begin(), jpeg.begin() + static_cast<std::ptrdiff_t>(jpeg.size() * 3 / 4));
  const cv::Mat damaged = DecodeJpeg(half, false, 8);
  REQUIRE(damaged.size() == picture.size());
  CHECK(damaged.at<std::uint8_t>(4, 44) == Approx(picture(4, 44)).margin(2.0));
}

TEST_CASE("Stray bytes before a marker are no damage") {
  Bytes jpeg = WriteJpeg(Steps(64, 48), 95, false);
  std::size_t at = 2;
  while (jpeg[at + 1] != 0xC0) at += 2 + (jpeg[at + 2] << 8 | jpeg[at + 3]);
  at += 2 + (jpeg[at + 2] << 8 | jpeg[at + 3]);  // behind the frame header
  jpeg.insert(jpeg.begin() + static_cast<std::ptrdiff_t>(at), {1, 2, 3});
  JpegReader reader;
  const auto patch = reader.Read(jpeg, 64, 48, {8, 16, 24, 16});
  REQUIRE(patch);
  CHECK(patch->At(20.0, 20.0) == Approx(20 + 3 * 2 + 11 * 2).margin(2.0));
  jpeg[at + 3 + 1] = 0x02;  // no marker that there is
  CHECK_FALSE(reader.Read(jpeg, 64, 48, {8, 16, 24, 16}));
  CHECK_FALSE(reader.Read(WriteJpeg(Steps(64, 48), 95, false), 48, 64, {0, 0, 8, 8}));
  CHECK_FALSE(reader.Read(WriteJpeg(Steps(64, 48), 95, false), 64, 47, {0, 0, 8, 8}));
  CHECK_FALSE(reader.Read({}, 64, 48, {0, 0, 8, 8}));
  CHECK_FALSE(reader.Read(WriteJpeg(Steps(64, 48), 95, false), 64, 48, {8, 8, 0, 4}));
}

TEST_CASE("What stands behind the bytes of a picture in memory is none of it") {
  const Bytes exif = Segment(0xE1, {'E', 'x', 'i', 'f', 0, 0, 1, 2, 3});
  const Bytes whole =
      kStart + exif + FrameHeader(0xC0) + Segment(0xDA, {1, 2, 3}) + Bytes{9} + kEnd;
  const std::size_t size_ends = 2 + exif.size() + 9;  // of the frame header its width ends there
  for (std::size_t length = 0; length < whole.size(); ++length) {
    INFO(length);
    const std::span<const std::uint8_t> cut = std::span(whole).first(length);
    CHECK(JpegLength(cut) == length);
    CHECK(SizeOfJpeg(cut).has_value() == (length >= size_ends));
    // Behind the name, at 12 bytes, are three more.
    CHECK(ExifOfJpeg(cut).size() == (length < 12 ? 0 : std::min<std::size_t>(length - 12, 3)));
  }
  CHECK(JpegLength(whole) == whole.size());
}

}  // namespace
}  // namespace rift::vision
