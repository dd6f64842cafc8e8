#include <algorithm>
#include <catch2/catch.hpp>
#include <opencv2/imgcodecs.hpp>

#include "rift/vision/camera/capture_thread.hpp"
#include "vision/camera/sources.hpp"
#include "vision/mjpeg_server.hpp"

namespace rift::vision {
namespace {

using Catch::Matchers::Contains;
using synthetic::MjpegServer;
using synthetic::ServerOptions;

// As many bytes as a camera of 1080p sends, so that buffers on the way fill as they do there.
std::vector<std::uint8_t> LargeJpeg() {
  cv::Mat picture(1080, 1920, CV_8UC3);
  cv::RNG(1).fill(picture, cv::RNG::UNIFORM, 60, 160);
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, 20});
  return bytes;
}

CaptureThread Capturing(const std::string& url) {
  return CaptureThread([url] { return OpenCamera(url, {}); }, {});
}

/// Waits until the camera is in this state; how long that took, or 99.
double SecondsUntil(const CaptureThread& capture, CameraState state) {
  const double begin_s = SteadyNow_s();
  while (SteadyNow_s() < begin_s + 5.0) {
    if (capture.Status().state == state) return SteadyNow_s() - begin_s;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return 99.0;
}

TEST_CASE("A slow reader of an http camera stays below 100 ms behind") {
  const bool content_length = GENERATE(true, false);
  MjpegServer server(LargeJpeg(), {.content_length = content_length});
  CaptureThread capture = Capturing(server.Url());
  std::vector<double> ages_s;
  std::uint64_t last = 0;
  for (int i = 0; i < 15; ++i) {
    const auto frame = capture.Next(2.0);
    REQUIRE(frame);
    ages_s.push_back(MjpegServer::Now_s() - MjpegServer::SentAt_s(frame->bytes));
    CHECK(frame->format == PixelFormat::kJpeg);
    CHECK(frame->width_px == 1920);
    CHECK((i == 0 || frame->index > last));
    last = frame->index;
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  std::sort(ages_s.begin(), ages_s.end());
  INFO("median " << ages_s[7] << " s, worst " << ages_s.back() << " s");
  CHECK(ages_s[7] < 0.100);
  const CaptureStatus status = capture.Status();
  CHECK(status.delivered > 30);
  CHECK(status.dropped > status.delivered / 2);
}

TEST_CASE("A stream that ends is unplugged and one that falls silent is frozen within a second") {
  MjpegServer ending(LargeJpeg(), {.pictures = 10});
  CaptureThread ended = Capturing(ending.Url());
  REQUIRE(ended.Next(2.0));
  CHECK(SecondsUntil(ended, CameraState::kUnplugged) < 1.0 + 10 / 30.0);
  CHECK_THAT(ended.Status().reason, Contains("ended the stream"));

  MjpegServer silent(LargeJpeg(), {.pictures = 10, .then_silent = true});
  CaptureThread frozen = Capturing(silent.Url());
  REQUIRE(frozen.Next(2.0));
  CHECK(SecondsUntil(frozen, CameraState::kFrozen) < 1.0 + 10 / 30.0);
}

TEST_CASE("A server that sends no MJPEG is a wrong format and its type is quoted") {
  MjpegServer server(LargeJpeg(), {.content_type = "text/html"});
  CaptureThread capture = Capturing(server.Url());
  CHECK(SecondsUntil(capture, CameraState::kWrongFormat) < 1.0);
  CHECK_THAT(capture.Status().reason, Contains("text/html"));
}

TEST_CASE("An address where nobody answers is unplugged within a second") {
  CaptureThread capture = Capturing("http://127.0.0.1:9/video");
  CHECK(SecondsUntil(capture, CameraState::kUnplugged) < 1.0);
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
