#include <catch2/catch.hpp>
#include <opencv2/imgcodecs.hpp>

#include "rift/vision/camera/capture_thread.hpp"
#include "support/processes/environment.hpp"
#include "support/until.hpp"
#include "vision/camera/sources.hpp"
#include "vision/mjpeg_server.hpp"
#include "vision/scripted_server.hpp"

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
  return CaptureThread([url, options] { return OpenCamera(url, options); }, options);
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
  CaptureOptions options;
  CHECK(options.silent_s < 1.0);
  options.reconnect_s = 0.0;
  MjpegServer ending(LargeJpeg(), {.pictures = 10});
  CaptureThread ended = Capturing(ending.Url(), options);
  WaitForState(ended, CameraState::kUnplugged);
  CHECK_THAT(ended.Status().reason, Contains("ended the stream"));
  CHECK(ended.Status().delivered == 10);

  MjpegServer silent(LargeJpeg(), {.pictures = 10, .then_silent = true});
  CaptureThread frozen = Capturing(silent.Url(), options);
  test::WaitUntil("all pictures were read", [&] { return frozen.Status().delivered == 10; });
  WaitForState(frozen, CameraState::kFrozen);
  // As long as it has been silent when it is asked.
  const std::string reason = frozen.Status().reason, says = "no picture for ";
  REQUIRE_THAT(reason, Catch::Matchers::StartsWith(says));
  CHECK(std::stod(reason.substr(says.size())) >= options.silent_s);
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
  MultipartReader reader("multipart/x-mixed-replace;boundary=\"--b\"", 1'000'000);
  std::vector<std::string> parts;
  for (std::size_t at = 0; at < body.size(); at += piece) {
    reader.Feed(std::string_view(body).substr(at, piece));
    while (const auto part = reader.Take()) parts.emplace_back(part->begin(), part->end());
  }
  CHECK(parts == std::vector<std::string>{"ab\r\nc", "xyz"});
}

constexpr std::string_view kOk =
    "HTTP/1.0 200 OK\r\nContent-Type: multipart/x-mixed-replace; boundary=b\r\n\r\n";

std::string SmallJpeg(int width_px = 64, int height_px = 48) {
  const cv::Mat picture(height_px, width_px, CV_8UC3, cv::Scalar(90, 120, 150));
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", picture, bytes);
  return {bytes.begin(), bytes.end()};
}

/// The same with another size in its frame header.
std::string Claiming(std::string jpeg, int width_px, int height_px) {
  const std::size_t at = jpeg.find("\xFF\xC0") + 5;
  for (const int value : {height_px, width_px}) {
    const std::size_t here = at + (value == width_px && width_px != height_px ? 2 : 0);
    jpeg[here] = static_cast<char>(value >> 8);
    jpeg[here + 1] = static_cast<char>(value & 0xFF);
  }
  if (width_px == height_px) {
    jpeg[at + 2] = jpeg[at];
    jpeg[at + 3] = jpeg[at + 1];
  }
  return jpeg;
}

std::string Part(const std::string& body, const std::string& head = "", bool bare_lf = false) {
  const std::string end = bare_lf ? "\n" : "\r\n";
  return end + "--b" + end + head + "Content-Length: " + std::to_string(body.size()) + end + end +
         body;
}

TEST_CASE("What a server answers is said in words and ends the session at once") {
  struct Answer {
    std::string status, says;
    CameraState state;
  };
  const std::vector<Answer> answers{
      {"400 Bad Request", "it refuses the request (http 400)", CameraState::kRefused},
      {"401 Unauthorized",
       "it wants a user and password: http://USER:PASSWORD@host/path (http 401)",
       CameraState::kRefused},
      {"403 Forbidden", "it refuses this user (http 403)", CameraState::kRefused},
      {"404 Not Found",
       "it has nothing at this path: look up the stream's address in its manual (http 404)",
       CameraState::kRefused},
      {"408 Request Timeout", "it refuses the request (http 408)", CameraState::kUnplugged},
      {"429 Too Many", "it refuses the request (http 429)", CameraState::kUnplugged},
      {"499 Closed", "it refuses the request (http 499)", CameraState::kRefused},
      {"500 Oops", "it has an error of its own (http 500)", CameraState::kUnplugged},
      {"503 Busy", "it is busy, often with too many viewers (http 503)", CameraState::kUnplugged}};
  for (const Answer& answer : answers) {
    synthetic::ScriptedServer server(
        {"HTTP/1.0 " + answer.status + "\r\nContent-Length: 0\r\n\r\n", ""});
    CaptureThread capture = Capturing(server.Url());
    WaitForState(capture, answer.state);
    CHECK_THAT(capture.Status().reason,
               Catch::Matchers::StartsWith(server.Url() + ": ") && Contains(answer.says));
  }
}

TEST_CASE("A camera's user and password are in no text") {
  CHECK(WithoutPassword("http://me:secret@host:80/video?a@b") == "http://***@host:80/video?a@b");
  CHECK(WithoutPassword("rtsp://me@host") == "rtsp://***@host");
  CHECK(WithoutPassword("rtsp://me:se@cret@host/1") == "rtsp://***@host/1");
  for (const char* name : {"http://host/@live", "http://host?user=me@host", "/dev/video0",
                           "a@b/*.jpg", "rtsp://host/a://b@c"}) {
    CHECK(WithoutPassword(name) == name);
  }
  for (const auto& [name, shown] : std::vector<std::pair<std::string, std::string>>{
           {"http://host/v.cgi?user=a&pwd=x/y&channel=2",
            "http://host/v.cgi?user=a&pwd=***&channel=2"},
           {"http://host?password=x", "http://host?password=***"},
           {"http://me:x@host/v?PassWord=x;n=1#t", "http://***@host/v?PassWord=***;n=1#t"},
           {"http://host/v?auth=YWJj=&loginpas=&n", "http://host/v?auth=***&loginpas=***&n"},
           {"http://host/v?access_token=a=b", "http://host/v?access_token=***"},
           {"rtsp://host:554/user=a_password=x_channel=1.sdp?real=1",
            "rtsp://host:554/user=a_password=***?real=1"},
           {"rtsp://host/user=a&pw=x/2", "rtsp://host/user=a&pw=***/2"}}) {
    CHECK(WithoutPassword(name) == shown);
  }
  for (const char* name : {"http://host/v?channel=2&n=1", "http://host/pass/v", "pwd=x.jpg"}) {
    CHECK(WithoutPassword(name) == name);
  }
  const auto with_user = [](std::string url) { return url.insert(7, "me:secret@"); };
  // What a network camera sets for FFmpeg is not for the videos of the tests after it.
  const test::Environment ffmpeg("OPENCV_FFMPEG_CAPTURE_OPTIONS", std::nullopt);
  synthetic::ScriptedServer refusing({"HTTP/1.0 403 Forbidden\r\nContent-Length: 0\r\n\r\n", ""});
  MjpegServer no_video(LargeJpeg(), {.content_type = "text/html"});
  for (const auto& [url, state] : {std::pair(refusing.Url(), CameraState::kRefused),
                                   {no_video.Url(), CameraState::kWrongFormat},
                                   {"rtsp://127.0.0.1:9/", CameraState::kUnplugged}}) {
    CaptureThread capture = Capturing(with_user(url));
    WaitForState(capture, state);
    CHECK_THAT(capture.Status().reason,
               Catch::Matchers::StartsWith(url.substr(0, 7) + "***@" + url.substr(7) + ": "));
  }
  CHECK_THROWS_WITH(OpenCamera("http://me:secret@host:99999/", {}),
                    Catch::Matchers::StartsWith("http://***@host:99999/: it is no address"));
}

TEST_CASE("A stream of parts that are no JPEGs is a wrong format after eleven of them") {
  const auto state_after = [](int parts, bool has_picture) {
    std::string answer(kOk);
    if (has_picture) answer += Part(SmallJpeg());
    for (int i = 0; i < parts; ++i) answer += Part("this is no picture");
    if (parts < 11) answer += Part(SmallJpeg());
    synthetic::ScriptedServer server({answer, ""}, 1);
    CaptureThread capture = Capturing(server.Url());
    CaptureStatus status;
    test::WaitUntil("the stream is over", [&] {
      status = capture.Status();
      return IsFinal(status.state) || status.state == CameraState::kReconnecting;
    });
    return status;
  };
  CHECK(state_after(10, false).delivered == 1);
  const CaptureStatus wrong = state_after(11, false);
  CHECK(wrong.state == CameraState::kWrongFormat);
  CHECK_THAT(wrong.reason, Contains(": the stream's parts are no JPEGs"));
  CHECK(state_after(12, true).state == CameraState::kReconnecting);
}

TEST_CASE("What is no address, and what answers without http, is refused with the address") {
  CHECK_THROWS_WITH(OpenCamera("http://cam:99999/video", {}),
                    "http://cam:99999/video: it is no address of a camera, http://HOST:PORT/PATH "
                    "with a port up to 65535");
  synthetic::ScriptedServer server({"SSH-2.0-OpenSSH_9.2\r\n", ""});
  CaptureThread capture = Capturing(server.Url());
  WaitForState(capture, CameraState::kUnplugged);
  CHECK_THAT(capture.Status().reason, Contains("what answers there does not speak http"));
}

TEST_CASE("A stream that falls silent is asked again and says what came that was no picture") {
  const std::string huge = "\r\n--b\r\nContent-Length: 18446744073709551610\r\n\r\n";
  synthetic::ScriptedServer server({std::string(kOk) + Part(SmallJpeg()) + Part("no picture") +
                                    Part("nor this") + huge + Part("nor that")});
  CaptureThread capture = Capturing(server.Url(), {.most_mbyte = 2.5});
  WaitForState(capture, CameraState::kReconnecting);
  const CaptureStatus status = capture.Status();
  CHECK(status.delivered == 1);
  CHECK(status.skipped == 4);
  CHECK(status.reason == server.Url() +
                             ": nothing came for 5 s, after 4 parts that are no picture or larger "
                             "than track.capture.most_mbyte, 2.5");
}

TEST_CASE("Damaged parts and odd heads are passed over and counted") {
  const std::string jpeg = SmallJpeg();
  const std::string huge = "\r\n--b\r\nContent-Length: 18446744073709551610\r\n\r\n";
  synthetic::ScriptedServer server(
      {std::string(kOk) + Part(jpeg) + Part("this is no picture") +
       Part(jpeg, "X-Old-Content-Length: 3\r\n") + Part(jpeg, "", true) + huge + Part(jpeg) +
       Part(Claiming(jpeg, 883, 720)) + Part(Claiming(jpeg, 20000, 20000)) + Part(jpeg)});
  CaptureThread capture = Capturing(server.Url());
  test::WaitUntil("the good ones were read", [&] { return capture.Status().delivered == 5; });
  CHECK(capture.Status().skipped == 4);
  CHECK(capture.Next(0.0)->width_px == 64);
}

TEST_CASE("Heads without an end hold no more than the budget") {
  MultipartReader reader("multipart/x-mixed-replace;boundary=b", 1'000'000);
  for (int i = 0; i < 100; ++i) {
    reader.Feed("--b\nContent-Type: image/jpeg\n" + std::string(100'000, 'x'));
    CHECK_FALSE(reader.Take());
  }
  CHECK(reader.Skipped() > 50);
}

TEST_CASE("A stream that breaks off is asked for again and goes on") {
  const std::string huge = "\r\n--b\r\nContent-Length: 99999999999\r\n\r\n";
  const std::string once = std::string(kOk) + Part(SmallJpeg()) + huge +
                           Part("this is no picture") + huge + Part(SmallJpeg());
  synthetic::ScriptedServer server({once, once}, 1);
  CaptureThread capture = Capturing(server.Url());
  WaitForState(capture, CameraState::kReconnecting);
  CHECK_THAT(capture.Status().reason, Contains("ended the stream"));
  server.Allow();  // before, the state would pass unseen where the test is slow
  test::WaitUntil("it went on", [&] { return capture.Status().delivered == 4; });
  CHECK(capture.Status().reconnects == 1);
  CHECK(capture.Status().skipped == 6);  // three each time
}

TEST_CASE("A part of as many bytes as are put up with is read, of one more it is passed over") {
  const std::string jpeg = SmallJpeg();
  synthetic::ScriptedServer server({std::string(kOk) + Part(jpeg + "x") + Part(jpeg)});
  CaptureThread capture =
      Capturing(server.Url(), {.most_mbyte = 1e-6 * (static_cast<double>(jpeg.size()) + 0.5)});
  CaptureStatus status;
  test::WaitUntil("both were read", [&] {
    status = capture.Status();
    return status.delivered + status.skipped >= 2;
  });
  CHECK(status.delivered == 1);
  CHECK(status.skipped == 1);
  CHECK(capture.Next(0.0)->bytes.size() == jpeg.size());
}

}  // namespace
}  // namespace rift::vision
