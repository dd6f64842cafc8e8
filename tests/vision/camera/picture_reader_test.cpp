#include "rift/vision/camera/picture_reader.hpp"

#include <catch2/catch.hpp>
#include <opencv2/core.hpp>

#include "rift/vision/camera/jpeg.hpp"
#include "vision/rendered_tags.hpp"

namespace rift::vision {
namespace {

Frame Render(PixelFormat format, const SyntheticCameraOptions& options = {}) {
  std::mt19937_64 generator(1);
  return SyntheticCamera(test::PaperCamera(), options)
      .Render(test::RobotAt(0.1, 0.1, 0.5), format, generator);
}

TEST_CASE("A region holds the very pixels of the whole picture in every format") {
  const PixelFormat format =
      GENERATE(PixelFormat::kJpeg, PixelFormat::kGrey, PixelFormat::kBgr, PixelFormat::kYuyv);
  const Frame frame = Render(format);
  PictureReader reader;
  const auto whole = reader.Read(frame);
  REQUIRE(whole);
  // The first is not at the blocks of a JPEG; the others touch the picture's borders.
  for (const Region& region : {Region{935, 441, 163, 117}, {0, 0, 40, 40}, {1900, 1050, 20, 30}}) {
    const auto part = reader.Read(frame, region);
    REQUIRE(part);
    REQUIRE(part->region == region);
    int different = 0;
    for (int y = 0; y < region.height_px; ++y) {
      for (int x = 0; x < region.width_px; ++x) {
        const double a = part->At(region.x_px + x, region.y_px + y);
        if (a != whole->At(region.x_px + x, region.y_px + y)) ++different;
      }
    }
    CHECK(different == 0);
  }
}

TEST_CASE("A region is cut to the picture and none is left outside") {
  PictureReader reader;
  const Frame frame = Render(PixelFormat::kJpeg);
  CHECK(reader.Read(frame, {-50, -20, 100, 100})->region == Region{0, 0, 50, 80});
  CHECK(reader.Read(frame, {1900, 1000, 400, 400})->region == Region{1900, 1000, 20, 80});
  CHECK_FALSE(reader.Read(frame, {2000, 0, 100, 100}));
  CHECK_FALSE(reader.Read(frame, {0, -200, 100, 100}));
}

TEST_CASE("Compressed and raw frames show the same picture") {
  PictureReader reader;
  SyntheticCameraOptions quiet;  // JPEG frames draw other noise than raw ones
  quiet.noise_grey = 0.0;
  auto jpeg = reader.Read(Render(PixelFormat::kJpeg, quiet));
  auto grey = reader.Read(Render(PixelFormat::kGrey, quiet));
  const cv::Mat a(1080, 1920, CV_8UC1, jpeg->pixels.data());
  const cv::Mat b(1080, 1920, CV_8UC1, grey->pixels.data());
  CHECK(cv::norm(a, b, cv::NORM_L1) / static_cast<double>(a.total()) < 2.0);
  CHECK(cv::norm(a, b, cv::NORM_INF) < 25.0);
}

TEST_CASE("A grey picture that is written in colour is grey in every channel, whatever its shape") {
  for (const cv::Size size : {cv::Size(640, 48), cv::Size(48, 640), cv::Size(33, 65)}) {
    cv::Mat1b grey(size);
    for (int y = 0; y < size.height; ++y) grey.row(y).setTo(60 + 100 * y / size.height);
    const cv::Mat read = DecodeJpeg(WriteJpeg(grey, 95, true), true, 8);
    REQUIRE(read.size() == size);
    cv::Mat expected;
    cv::merge(std::vector<cv::Mat>(3, grey), expected);
    INFO(size.width << " x " << size.height);
    CHECK(cv::norm(read, expected, cv::NORM_INF) < 5.0);
    std::vector<cv::Mat> channels;
    cv::split(read, channels);
    CHECK(cv::norm(channels[0], channels[1], cv::NORM_INF) == 0.0);
    CHECK(cv::norm(channels[2], channels[1], cv::NORM_INF) == 0.0);
  }
}

TEST_CASE("Damaged frames are told from whole ones") {
  PictureReader reader;
  const Frame whole = Render(PixelFormat::kJpeg);
  const Region low{900, 900, 100, 100};
  Frame cut = whole;
  cut.bytes.resize(cut.bytes.size() / 2);
  CHECK_FALSE(reader.Read(cut));
  CHECK_FALSE(reader.Read(cut, low));
  Frame text = whole;
  text.bytes.assign({'n', 'o', 't', ' ', 'a', ' ', 'j', 'p', 'e', 'g'});
  CHECK_FALSE(reader.Read(text));
  Frame empty = whole;
  empty.bytes.clear();
  CHECK_FALSE(reader.Read(empty));
  Frame other_size = whole;
  other_size.width_px = 1280;
  other_size.height_px = 720;
  CHECK_FALSE(reader.Read(other_size));
  Frame short_raw = Render(PixelFormat::kGrey);
  short_raw.bytes.pop_back();
  CHECK_FALSE(reader.Read(short_raw));
  // And the reader still works after all of them.
  CHECK(reader.Read(whole, low));
}

TEST_CASE("Random bytes in a compressed frame never crash the reader") {
  PictureReader reader;
  const Frame whole = Render(PixelFormat::kJpeg);
  std::mt19937_64 generator(3);
  for (int i = 0; i < 100; ++i) {
    Frame frame = whole;
    for (int k = 0; k < 1 + i % 20; ++k) {
      // Mostly in the headers, where a wrong byte does most.
      const std::size_t end = k % 2 == 0 ? 700 : frame.bytes.size();
      frame.bytes[generator() % end] = static_cast<std::uint8_t>(generator());
    }
    const auto patch = reader.Read(frame, {800, 400, 160, 160});
    if (patch) CHECK(patch->pixels.size() == 160 * 160);
  }
  CHECK(reader.Read(whole));
}

/// Four by two pixels of blue, green, red and grey, in the bytes of each raw format.
Frame Colours(PixelFormat format) {
  Frame frame{.width_px = 4, .height_px = 2, .format = format};
  const std::vector<cv::Vec3b> bgr{{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {90, 90, 90}};
  for (int i = 0; i < 8; ++i) {
    const cv::Vec3b& c = bgr[static_cast<std::size_t>(i % 4)];
    if (format == PixelFormat::kBgr) frame.bytes.insert(frame.bytes.end(), {c[0], c[1], c[2]});
    if (format == PixelFormat::kGrey) frame.bytes.push_back(static_cast<std::uint8_t>(10 * i));
    if (format == PixelFormat::kYuyv) {
      frame.bytes.push_back(static_cast<std::uint8_t>(10 * i));
      frame.bytes.push_back(128);
    }
  }
  return frame;
}

TEST_CASE("A raw picture is grey and coloured as its format says") {
  PictureReader reader;
  for (const PixelFormat format : {PixelFormat::kGrey, PixelFormat::kYuyv}) {
    const Frame frame = Colours(format);
    const auto patch = reader.Read(frame);
    REQUIRE(patch);
    const cv::Mat grey = SmallGreyOf(frame), bgr = BgrOf(frame);
    REQUIRE((grey.size() == cv::Size(4, 2) && bgr.size() == cv::Size(4, 2)));
    REQUIRE((grey.type() == CV_8UC1 && bgr.type() == CV_8UC3));
    for (int i = 0; i < 8; ++i) {
      CHECK(patch->pixels[static_cast<std::size_t>(i)] == 10 * i);
      CHECK(grey.at<std::uint8_t>(i / 4, i % 4) == 10 * i);
      // YUYV holds 16 to 235.
      const double shown =
          format == PixelFormat::kGrey ? 10.0 * i : std::max(0.0, (10.0 * i - 16.0) * 1.164);
      for (int k = 0; k < 3; ++k) {
        CHECK(bgr.at<cv::Vec3b>(i / 4, i % 4)[k] == Approx(shown).margin(1.0));
      }
    }
    Frame cut = frame;
    cut.bytes.pop_back();
    CHECK_FALSE(reader.Read(cut));
  }
  const Frame frame = Colours(PixelFormat::kBgr);
  const auto patch = reader.Read(frame);
  REQUIRE(patch);
  Frame cut = frame;
  cut.bytes.pop_back();
  CHECK_FALSE(reader.Read(cut));
  const cv::Mat grey = SmallGreyOf(frame), bgr = BgrOf(frame);
  const std::array<double, 4> weights{0.114 * 255, 0.587 * 255, 0.299 * 255, 90};  // ITU-R BT.601
  for (int i = 0; i < 8; ++i) {
    const double expected = weights[static_cast<std::size_t>(i % 4)];
    CHECK(patch->pixels[static_cast<std::size_t>(i)] == Approx(expected).margin(1.0));
    CHECK(grey.at<std::uint8_t>(i / 4, i % 4) == Approx(expected).margin(1.0));
    for (int k = 0; k < 3; ++k) {
      CHECK(bgr.at<cv::Vec3b>(i / 4, i % 4)[k] == frame.bytes[static_cast<std::size_t>(3 * i + k)]);
    }
  }
}

TEST_CASE("A compressed picture is looked at in an eighth of its size and shown in all of it") {
  Frame frame{.width_px = 64, .height_px = 40, .format = PixelFormat::kJpeg};
  frame.bytes = WriteJpeg(cv::Mat1b(40, 64, std::uint8_t{77}), 90, true);
  const cv::Mat small = SmallGreyOf(frame), bgr = BgrOf(frame);
  CHECK((small.size() == cv::Size(8, 5) && small.type() == CV_8UC1));
  CHECK((bgr.size() == cv::Size(64, 40) && bgr.type() == CV_8UC3));
  CHECK(small.at<std::uint8_t>(2, 2) == Approx(77).margin(1.0));
  CHECK(bgr.at<cv::Vec3b>(2, 2)[0] == Approx(77).margin(2.0));
  frame.bytes = {1, 2, 3};
  CHECK(SmallGreyOf(frame).empty());
  CHECK(BgrOf(frame).empty());
}

}  // namespace
}  // namespace rift::vision
