#include <catch2/catch.hpp>
#include <opencv2/imgcodecs.hpp>

#include "rift/vision/camera/capture_thread.hpp"
#include "support/until.hpp"
#include "vision/camera/sources.hpp"
#include "vision/mjpeg_server.hpp"

namespace rift::vision {
namespace {

using Catch::Matchers::Contains;
using synthetic::MjpegServer;

// As many bytes as a camera of 1080p sends, so that buffers on the way fill as they do there.
std::vector<std::uint8_t> LargeJpeg() {
  cv::Mat picture(1080, 1920, CV_8UC3);
  cv::RNG(1).fill(picture, cv::RNG::UNIFORM, 60, 160);
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, 20});
  return bytes;
}

CaptureThread Capturing(const std::string& url, const CaptureOptions& options = {}) {
  return CaptureThread([url] { return OpenCamera(url, {}); }, options);
}

void WaitForState(const CaptureThread& capture, CameraState state) {
  test::WaitUntil("the camera is in the state " +
                      std::string(EnumNames(state)[static_cast<std::size_t>(state)]),
                  [&] { return capture.Status().state == state; });
}

TEST_CASE("A slow reader of an http camera is given the newest picture") {
  const bool content_length = GENERATE(true, false);
  MjpegServer server(LargeJpeg(), {.content_length = content_length, .paced = true});
  CaptureThread capture = Capturing(server.Url());
  // Without its length a picture is known to be whole when the next one begins.
  const std::uint64_t held = content_length ? 0 : 1;
  constexpr std::uint64_t kAtOnce = 6;
  for (std::uint64_t i = 1; i <= 15; ++i) {
    server.Release(kAtOnce);
    const std::uint64_t read = i * kAtOnce - held;
    // All are read although nobody takes them, so that none grows old on the way.
    test::WaitUntil("all pictures were read", [&] { return capture.Status().delivered >= read; });
    const auto frame = capture.Next(0.0);
    REQUIRE(frame);
    CHECK(frame->format == PixelFormat::kJpeg);
    CHECK(frame->width_px == 1920);
    CHECK(frame->index == read - 1);
    CHECK(MjpegServer::SentAt_s(frame->bytes) == server.SentTimes_s().at(read - 1));
    CHECK(capture.Status().delivered == read);
    CHECK(capture.Status().dropped == read - i);
  }
}

TEST_CASE("A stream that ends is unplugged and one that falls silent is frozen") {
  const CaptureOptions options;
  CHECK(options.silent_s < 1.0);
  MjpegServer ending(LargeJpeg(), {.pictures = 10});
  CaptureThread ended = Capturing(ending.Url());
  WaitForState(ended, CameraState::kUnplugged);
  CHECK_THAT(ended.Status().reason, Contains("ended the stream"));
  CHECK(ended.Status().delivered == 10);

  MjpegServer silent(LargeJpeg(), {.pictures = 10, .then_silent = true});
  CaptureThread frozen = Capturing(silent.Url(), options);
  test::WaitUntil("all pictures were read", [&] { return frozen.Status().delivered == 10; });
  WaitForState(frozen, CameraState::kFrozen);
  CHECK_THAT(frozen.Status().reason, Contains("no picture for 0."));
}

TEST_CASE("A server that sends no MJPEG is a wrong format and its type is quoted") {
  MjpegServer server(LargeJpeg(), {.content_type = "text/html"});
  CaptureThread capture = Capturing(server.Url());
  WaitForState(capture, CameraState::kWrongFormat);
  CHECK(capture.Status().delivered == 0);
  CHECK_THAT(capture.Status().reason, Contains("text/html"));
}

TEST_CASE("An address where nobody answers is unplugged") {
  CaptureThread capture = Capturing("http://127.0.0.1:9/video");
  WaitForState(capture, CameraState::kUnplugged);
  CHECK(capture.Status().delivered == 0);
}

TEST_CASE("Parts are cut the same however the bytes are split") {
  const std::string body =
      "\r\n--b\r\nContent-Type: image/jpeg\r\nContent-Length: 5\r\n\r\nab\r\nc"
      "\r\n--b\r\nContent-Type: image/jpeg\r\n\r\nxyz\r\n--b\r\n";
  const std::size_t piece = GENERATE(1U, 2U, 7U, 1000U);
  MultipartReader reader("multipart/x-mixed-replace;boundary=\"--b\"");
  std::vector<std::string> parts;
  for (std::size_t at = 0; at < body.size(); at += piece) {
    reader.Feed(std::string_view(body).substr(at, piece));
    while (const auto part = reader.Take()) parts.emplace_back(part->begin(), part->end());
  }
  CHECK(parts == std::vector<std::string>{"ab\r\nc", "xyz"});
}

}  // namespace
}  // namespace rift::vision
