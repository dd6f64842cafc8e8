#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "rift/vision/camera/camera_source.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"

namespace rift::vision {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

void WriteGrey(const fs::path& path, int grey, int width_px = 12, int height_px = 8) {
  REQUIRE(cv::imwrite(path.string(), cv::Mat(height_px, width_px, CV_8UC1, cv::Scalar(grey))));
}

/// The grey values of the pictures that a source gives until it ends; -1 for one passed over.
std::vector<int> GreysOf(CameraSource& source) {
  std::vector<int> greys;
  for (;;) {
    Frame frame;
    try {
      if (!source.Read(frame)) {
        greys.push_back(-1);
        continue;
      }
    } catch (const CameraError& error) {
      CHECK(error.state == CameraState::kEnded);
      return greys;
    }
    CHECK((frame.width_px == 12 && frame.height_px == 8));
    greys.push_back(frame.format == PixelFormat::kGrey ? frame.bytes[5] : 1000);
  }
}

TEST_CASE("A camera is told by its name: device, stream, network, pictures, video") {
  const test::TemporaryFolder folder;
  for (const char* name : {"/dev/video0", "/dev/by-id/cam", "0", "12"}) {
    CHECK(KindOf(name) == SourceKind::kDevice);
  }
  CHECK(KindOf("http://cam/video") == SourceKind::kStream);
  CHECK(KindOf("https://cam/video") == SourceKind::kStream);
  for (const char* name : {"rtsp://cam/1", "httpx://cam", "a://b.jpg"}) {
    CHECK(KindOf(name) == SourceKind::kNetwork);
  }
  for (const char* name : {"a.jpg", "a.JPEG", "run/a.png", "a.Bmp", "a.tif", "a.TIFF", "a.pgm",
                           "a.ppm", "run/*.raw", "run/a?.x", "run/[ab]"}) {
    INFO(name);
    CHECK(KindOf(name) == SourceKind::kImages);
  }
  CHECK(KindOf(folder.Path().string()) == SourceKind::kImages);
  for (const char* name : {"run.mp4", "video0", "1a", "7.5", "-1", "dev/video2", "http:/cam", "jpg",
                           "a.jpg.avi", ""}) {
    INFO(name);
    CHECK(KindOf(name) == SourceKind::kVideo);
  }
}

TEST_CASE("A folder's pictures are read in the order of their numbers, whatever else lies in it") {
  const test::TemporaryFolder folder;
  WriteGrey(folder / "frame10.png", 110);
  WriteGrey(folder / "frame9.PGM", 109);
  WriteGrey(folder / "frame2.bmp", 102);
  WriteGrey(folder / "frame3.png", 103);
  std::ofstream(folder / "notes.txt") << "no picture";
  fs::create_directory(folder / "more.png");
  const auto source = OpenCamera(folder.Path().string(), {.fps = 10.0});
  CHECK(source->IsRecording());
  Frame first, second;
  REQUIRE(source->Read(first));
  REQUIRE(source->Read(second));
  CHECK(first.bytes[0] == 102);
  CHECK(second.bytes[0] == 103);
  CHECK(second.captured_s - first.captured_s == Approx(0.1));
  CHECK(GreysOf(*source) == std::vector<int>{109, 110});
  CHECK(source->Notes().skipped == 0);
  const auto some = OpenCamera(folder / "frame?.*", {});
  CHECK(GreysOf(*some) == std::vector<int>{102, 103, 109});
  const auto one = OpenCamera(folder / "frame3.png", {});
  CHECK(GreysOf(*one) == std::vector<int>{103});
}

TEST_CASE("What is no picture, or more than is put up with, is passed over and counted") {
  const test::TemporaryFolder folder;
  WriteGrey(folder / "a1.png", 101);
  std::ofstream(folder / "a2.png") << "not a PNG";
  std::ofstream(folder / "a3.jpg") << "";
  WriteGrey(folder / "a4.png", 104, 200, 100);  // 20,000 pixels
  std::ofstream(folder / "a5.png") << std::string(12'001, 'x');
  WriteGrey(folder / "a6.png", 106);
  const auto source =
      OpenCamera(folder.Path().string(), {.most_mbyte = 0.012, .most_mpixel = 19'999e-6});
  CHECK(GreysOf(*source) == std::vector<int>{101, -1, -1, -1, -1, 106});
  CHECK(source->Notes().skipped == 4);
  Frame frame;
  CHECK_THROWS_WITH(source->Read(frame), "all 6 pictures were read, 4 of them passed over");
}

TEST_CASE("A folder of which no picture can be decoded is a wrong format") {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "a.png") << "not a PNG";
  const auto source = OpenCamera(folder.Path().string(), {});
  Frame frame;
  CHECK_FALSE(source->Read(frame));
  try {
    source->Read(frame);
    FAIL("it ended without an error");
  } catch (const CameraError& error) {
    CHECK(error.state == CameraState::kWrongFormat);
    CHECK_THAT(error.what(), Contains("none of 1 pictures can be decoded"));
  }
}

TEST_CASE("A name that matches no picture, and a video that is not there, say what to give") {
  const test::TemporaryFolder folder;
  const std::string hint =
      "' matches no picture: give a folder or a quoted pattern such as 'run/*.jpg'";
  CHECK_THROWS_WITH(OpenCamera(folder / "*.jpg", {}), "'" + (folder / "*.jpg") + hint);
  CHECK_THROWS_WITH(OpenCamera(folder.Path().string(), {}), "'" + folder.Path().string() + hint);
  CHECK_THROWS_WITH(OpenCamera(folder / "run.mp4", {}),
                    (folder / "run.mp4") + ": there is no such file");
  CHECK_THROWS_WITH(
      OpenCamera("cam:8080", {}),
      "cam:8080: there is no such file; the address of a camera begins with http:// or rtsp://");
  std::ofstream(folder / "text.mp4") << "no video";
  CHECK_THROWS_WITH(OpenCamera(folder / "text.mp4", {}),
                    (folder / "text.mp4") + ": FFmpeg cannot open it: is it a video?");
}

TEST_CASE("A folder by the name of a picture is passed over, and as a list of times refused") {
  const test::TemporaryFolder folder;
  WriteGrey(folder / "a1.png", 101);
  fs::create_directory(folder / "a2.png");
  const auto source = OpenCamera(folder / "a*.png", {});
  CHECK(GreysOf(*source) == std::vector<int>{101, -1});
  CHECK_THROWS_WITH(OpenCamera(folder / "a*.png", {.times = folder / "a2.png"}),
                    "cannot read " + folder / "a2.png" + ": Is a directory");
  CHECK_THROWS_WITH(OpenCamera(folder / "a*.png", {.times = folder / "none"}),
                    "cannot read " + folder / "none" + ": No such file or directory");
  CHECK_THROWS_WITH(OpenCamera(folder / "a*.png", {.times = "/dev/zero"}),
                    Contains("/dev/zero") && Contains("at most 268435456 are taken"));
  std::ofstream(folder / "times.txt") << "1\n2.5\n";
  Frame first;
  REQUIRE(OpenCamera(folder / "a*.png", {.times = folder / "times.txt"})->Read(first));
}

TEST_CASE("Hidden files are no pictures of a folder, nor of a pattern") {
  const test::TemporaryFolder folder;
  WriteGrey(folder / "1.png", 101);
  WriteGrey(folder / ".1.png", 90);
  std::ofstream(folder / "._1.png") << "left by another system";
  CHECK(ImageFiles(folder.Path().string()) == std::vector<std::string>{folder / "1.png"});
  CHECK(ImageFiles(folder / "*.png") == std::vector<std::string>{folder / "1.png"});
}

TEST_CASE("Pictures whose times are guessed by their order are said, and no others") {
  const test::TemporaryFolder folder;
  for (const char* name : {"a.png", "b.png"}) WriteGrey(folder / name, 100);
  const CaptureOptions options{.fps = 12.5};
  CHECK(GuessedTimes(folder / "*.png", options) ==
        "no number in the names of " + folder / "*.png" +
            " rises from each picture to the next, so that they are taken to follow each other in "
            "the order of their names at 12.5 a second, and none to be missing: --times tells when "
            "they were taken");
  CHECK_FALSE(GuessedTimes(folder / "*.png", {.times = "times.txt"}));
  CHECK_FALSE(GuessedTimes(folder / "a.png", options));
  CHECK_FALSE(GuessedTimes("/dev/video0", options));
  const test::TemporaryFolder counted;
  for (const char* name : {"a1.png", "a2.png"}) WriteGrey(counted / name, 100);
  CHECK_FALSE(GuessedTimes(counted.Path().string(), options));
}

/// As ISO 15948 has it, bit by bit.
std::uint32_t CrcOf(const std::vector<std::uint8_t>& bytes) {
  std::uint32_t crc = 0xFFFFFFFF;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1) != 0 ? 0xEDB88320 : 0);
  }
  return ~crc;
}

TEST_CASE("A picture is not turned as its EXIF data say, since its lens was not") {
  const test::TemporaryFolder folder;
  WriteGrey(folder / "a.png", 101);
  std::ifstream file(folder / "a.png", std::ios::binary);
  std::vector<std::uint8_t> png{std::istreambuf_iterator<char>(file), {}};
  // TIFF 6.0: a folder of one entry, 0x0112, a short: turned by a quarter.
  std::vector<std::uint8_t> chunk{'e', 'X', 'I', 'f', 'I', 'I', 42, 0, 8, 0, 0, 0, 1, 0, 0x12,
                                  1,   3,   0,   1,   0,   0,   0,  6, 0, 0, 0, 0, 0, 0, 0};
  const std::uint32_t crc = CrcOf(chunk);
  for (const int shift : {24, 16, 8, 0}) chunk.push_back(static_cast<std::uint8_t>(crc >> shift));
  chunk.insert(chunk.begin(), {0, 0, 0, 26});
  png.insert(png.begin() + 33, chunk.begin(), chunk.end());  // behind the signature and the head
  std::ofstream(folder / "b.png", std::ios::binary)
      .write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
  const auto source = OpenCamera(folder / "*.png", {});
  CHECK(GreysOf(*source) == std::vector<int>{101, 101});
}

/// Whether a folder's only picture is taken.
bool IsTaken(const test::TemporaryFolder& folder, const CaptureOptions& options) {
  Frame frame;
  return OpenCamera(folder.Path().string(), options)->Read(frame);
}

TEST_CASE(
    "A picture of as many bytes or pixels as are put up with is taken, of one more it is not") {
  const test::TemporaryFolder padded;
  WriteGrey(padded / "a.png", 101);
  std::ofstream(padded / "a.png", std::ios::binary | std::ios::app) << std::string(12'200, '\0');
  fs::resize_file(padded / "a.png", 12'000);  // what stands behind a PNG's end is passed over
  CHECK(IsTaken(padded, {.most_mbyte = 0.012}));
  fs::resize_file(padded / "a.png", 12'001);
  CHECK_FALSE(IsTaken(padded, {.most_mbyte = 0.012}));
  // The lowest byte of a side, the one before it, and the one before that.
  for (const auto& [width_px, height_px] :
       {std::pair{200, 100}, {300, 80}, {80, 300}, {65'540, 1}}) {
    INFO(width_px << " x " << height_px);
    const test::TemporaryFolder folder;
    WriteGrey(folder / "a.png", 101, width_px, height_px);
    const int pixels = width_px * height_px;
    CHECK(IsTaken(folder, {.most_mpixel = 1e-6 * pixels}));
    CHECK_FALSE(IsTaken(folder, {.most_mpixel = 1e-6 * (pixels - 1)}));
  }
}

}  // namespace
}  // namespace rift::vision
