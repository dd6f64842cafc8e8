#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/videoio.hpp>

#include "rift/vision/camera/camera_source.hpp"
#include "support/processes/process.hpp"

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

}  // namespace
}  // namespace rift::vision
