#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/videoio.hpp>
#include <optional>
#include <string>
#include <vector>

#include "rift/vision/camera/camera_source.hpp"
#include "rift/vision/camera/steady_now.hpp"
#include "support/processes/environment.hpp"
#include "support/processes/process.hpp"
#include "support/until.hpp"

namespace rift::vision {
namespace {

/// Pictures that brighten from one to the next; OpenCV's own writer of AVI files.
void WriteVideo(const std::string& path, int pictures, double fps) {
  cv::VideoWriter writer(path, cv::CAP_OPENCV_MJPEG, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'),
                         fps, {64, 48});
  REQUIRE(writer.isOpened());
  for (int i = 0; i < pictures; ++i) {
    writer.write(cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(40 + 20 * i)));
  }
}

/// Dark on the left and bright on the right.
void WriteHalves(const std::string& path) {
  cv::VideoWriter writer(path, cv::CAP_FFMPEG, cv::VideoWriter::fourcc('a', 'v', 'c', '1'), 30.0,
                         {64, 48});
  REQUIRE(writer.isOpened());
  cv::Mat picture(48, 64, CV_8UC3, cv::Scalar::all(40));
  picture.colRange(32, 64).setTo(cv::Scalar::all(200));
  for (int i = 0; i < 6; ++i) writer.write(picture);
}

/// Says in the file that it is to be shown turned by half a turn, as a phone does that was held so:
/// by the matrix in the head of its track (ISO 14496-12, 8.3.2).
void HoldUpsideDown(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  const std::size_t head = bytes.find("tkhd");
  REQUIRE(head != std::string::npos);
  const std::size_t matrix = head + 4 + 40;
  const std::string minus_one("\xFF\xFF\0\0", 4);
  for (const std::size_t element : {0, 4}) bytes.replace(matrix + 4 * element, 4, minus_one);
  test::WriteText(path, bytes);
}

TEST_CASE("A video has its pictures as the sensor has them, however the phone was held") {
  const test::TemporaryFolder folder;
  const std::string path = folder / "phone.mp4";
  WriteHalves(path);
  HoldUpsideDown(path);
  REQUIRE(cv::VideoCapture(path, cv::CAP_FFMPEG).get(cv::CAP_PROP_ORIENTATION_META) == 180.0);
  const auto source = OpenCamera(path, {});
  Frame frame;
  REQUIRE(source->Read(frame));
  REQUIRE(frame.bytes.size() == 64 * 48 * 3);
  CHECK(frame.bytes[(24 * 64 + 8) * 3] < 100);
  CHECK(frame.bytes[(24 * 64 + 56) * 3] > 140);
}

TEST_CASE("A video is read picture by picture at the times of its file, until its last one") {
  const test::TemporaryFolder folder;
  WriteVideo(folder / "run.avi", 6, 12.0);
  const auto source = OpenCamera(folder / "run.avi", {.fps = 100.0});
  CHECK(source->IsRecording());
  std::vector<double> times_s;
  for (int i = 0; i < 6; ++i) {
    Frame frame;
    REQUIRE(source->Read(frame));
    CHECK((frame.width_px == 64 && frame.height_px == 48));
    REQUIRE(frame.format == PixelFormat::kBgr);
    REQUIRE(frame.bytes.size() == 64 * 48 * 3);
    CHECK(frame.bytes[64 * 24 * 3] == Approx(40 + 20 * i).margin(4));
    CHECK(frame.arrived_s >= frame.captured_s - 1.0);
    times_s.push_back(frame.captured_s);
  }
  for (int i = 1; i < 6; ++i) CHECK(times_s[i] - times_s[0] == Approx(i / 12.0).margin(1e-3));
  Frame frame;
  try {
    source->Read(frame);
    FAIL("it ended without an error");
  } catch (const CameraError& error) {
    CHECK(error.state == CameraState::kEnded);
    CHECK(error.what() == folder / "run.avi" + ": the last picture was read");
  }
}

/// Six pictures at 12 a second in the container that the name ends with.
void WriteCoded(const std::string& path, const char* code) {
  cv::VideoWriter writer(path, cv::CAP_FFMPEG,
                         cv::VideoWriter::fourcc(code[0], code[1], code[2], code[3]), 12.0,
                         {64, 48});
  REQUIRE(writer.isOpened());
  for (int i = 0; i < 6; ++i) {
    writer.write(cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(40 + 20 * i)));
  }
}

TEST_CASE("A video whose file holds no times is read at its rate") {
  const test::TemporaryFolder folder;
  WriteCoded(folder / "run.h264", "H264");
  const auto source = OpenCamera(folder / "run.h264", {});
  std::vector<double> times_s;
  for (Frame frame; times_s.size() < 6; times_s.push_back(frame.captured_s)) {
    REQUIRE(source->Read(frame));
  }
  for (int i = 1; i < 6; ++i) CHECK(times_s[i] - times_s[0] == Approx(i / 12.0).margin(1e-6));
}

TEST_CASE("JPEGs one after the other, as of a saved stream, begin at zero and keep one pace") {
  const test::TemporaryFolder folder;
  WriteCoded(folder / "run.mjpeg", "MJPG");
  const double opened_s = SteadyNow_s();
  const auto source = OpenCamera(folder / "run.mjpeg", {});
  Frame frame;
  REQUIRE(source->Read(frame));
  CHECK(frame.captured_s >= opened_s);
  CHECK(frame.captured_s <= SteadyNow_s());
  const double first_s = frame.captured_s;
  for (int i = 1; i < 6; ++i) {
    REQUIRE(source->Read(frame));
    CHECK(frame.captured_s - first_s == Approx(i / 25.0).margin(2e-3));  // FFmpeg's rate of such
  }
}

constexpr const char* kOptions = "OPENCV_FFMPEG_CAPTURE_OPTIONS";

TEST_CASE("A network stream that ends is said and asked again, with times of this machine") {
  const test::Environment unset(kOptions, std::nullopt);
  const test::TemporaryFolder folder;
  const std::string path = folder / "run.mkv", url = "file://" + path;
  WriteCoded(path, "mp4v");
  const double before_s = SteadyNow_s();
  const auto source = OpenCamera(url, {.reconnect_s = 600.0});
  CHECK(std::getenv(kOptions) == std::string("rtsp_transport;tcp|fflags;nobuffer"));
  CHECK_FALSE(source->IsRecording());
  Frame frame;
  REQUIRE(source->Read(frame));
  CHECK((frame.width_px == 64 && frame.height_px == 48));
  CHECK(frame.format == PixelFormat::kBgr);
  CHECK(frame.captured_s == frame.arrived_s);
  CHECK((before_s < frame.captured_s && frame.captured_s <= SteadyNow_s()));
  for (int pictures = 1; source->Read(frame); ++pictures) REQUIRE(pictures < 6);
  CHECK(source->Notes().interruption == url + ": the stream ended");
  CHECK(source->Notes().reconnects == 0);
  test::WaitUntil("the stream is open again", [&] { return source->Read(frame); });
  CHECK(source->Notes().interruption.empty());
  CHECK(source->Notes().reconnects == 1);
  std::filesystem::remove(path);
  test::WaitUntil("the stream is asked for a third time", [&] {
    source->Read(frame);
    return source->Notes().reconnects == 2;
  });
  CHECK(source->Notes().interruption ==
        url +
            ": FFmpeg cannot open it: is the camera on, and are address, user and password "
            "right? (OPENCV_FFMPEG_LOGLEVEL=16 shows what FFmpeg says)");
}

TEST_CASE("A network stream that never came, or is away for too long, is over") {
  const test::Environment own(kOptions, "fflags;discardcorrupt");
  const auto end_of = [](const auto& deed) -> std::string {
    try {
      deed();
    } catch (const CameraError& error) {
      CHECK(error.state == CameraState::kUnplugged);
      return error.what();
    }
    return "it goes on";
  };
  const test::TemporaryFolder folder;
  const std::string path = folder / "run.mkv", url = "file://" + path;
  CHECK_THAT(end_of([&] { OpenCamera(url, {}); }),
             Catch::StartsWith(url + ": FFmpeg cannot open it: is the camera on"));
  WriteCoded(path, "mp4v");
  const auto source = OpenCamera(url, {.reconnect_s = 0.0});
  Frame frame;
  CHECK(end_of([&] {
          while (source->Read(frame)) continue;
        }) == url + ": the stream ended; it did not come back within 0 s");
  CHECK(std::getenv(kOptions) == std::string("fflags;discardcorrupt"));
}

}  // namespace
}  // namespace rift::vision
