#include "rift/vision/camera/picture_file.hpp"

#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "support/processes/process.hpp"
#include "vision/camera/picture_size.hpp"

namespace rift::vision {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr int kWidth_px = 300, kHeight_px = 7;

Bytes Encoded(const std::string& ending) {
  const int type = ending == ".pgm" ? CV_8UC1 : CV_8UC3;
  const cv::Mat picture(kHeight_px, kWidth_px, type, cv::Scalar(10, 20, 30));
  Bytes bytes;
  REQUIRE(cv::imencode(ending, picture, bytes));
  return bytes;
}

void Write(const std::string& path, const Bytes& bytes) {
  test::WriteText(path, std::string(bytes.begin(), bytes.end()));
}

bool Is(const std::optional<PictureSize>& size, double width_px, double height_px) {
  return size && size->width_px == width_px && size->height_px == height_px;
}

Bytes Text(const std::string& text) { return {text.begin(), text.end()}; }

TEST_CASE("The head of each kind of picture states the size that it is decoded to") {
  const test::TemporaryFolder folder;
  for (const char* ending : {".jpg", ".png", ".bmp", ".tif", ".ppm", ".pgm"}) {
    INFO(ending);
    const Bytes bytes = Encoded(ending);
    CHECK(Is(StatedSize(bytes), kWidth_px, kHeight_px));
    const std::string path = folder / "picture";  // kinds are told by their bytes
    Write(path, bytes);
    const PictureFile file = ReadPictureFile(path, 1e6, 1.0);
    CHECK(file.problem.empty());
    REQUIRE(file.bytes == bytes);
    const cv::Mat grey = DecodePicture(file.bytes, false), colour = DecodePicture(bytes, true);
    CHECK((grey.cols == kWidth_px && grey.rows == kHeight_px && grey.channels() == 1));
    CHECK((colour.cols == kWidth_px && colour.rows == kHeight_px && colour.channels() == 3));
    for (std::size_t length = 0; length < std::min<std::size_t>(bytes.size(), 40); ++length) {
      const bool is_stated = StatedSize(std::span(bytes).first(length)).has_value();
      if (ending == std::string(".png")) CHECK(is_stated == (length >= 24));
      if (ending == std::string(".bmp")) CHECK(is_stated == (length >= 26));
    }
  }
}

TEST_CASE("A BMP may be of the old head, or have its rows from the top") {
  Bytes core(26, 0);
  core[0] = 'B';
  core[1] = 'M';
  core[14] = 12;
  core[18] = 0x2C;  // 300 by 7
  core[19] = 0x01;
  core[20] = 7;
  CHECK(Is(StatedSize(core), 300.0, 7.0));
  Bytes turned = Encoded(".bmp");
  for (const std::size_t at : {22, 23, 24, 25}) turned[at] = 0xFF;
  turned[22] = 0xF9;  // -7
  CHECK(Is(StatedSize(turned), 300.0, 7.0));
}

/// A TIFF of one folder with such entries, of either byte order.
Bytes Tiff(bool is_little, const std::vector<std::array<unsigned, 3>>& tags) {
  Bytes bytes = Text(is_little ? "II" : "MM");
  const auto put = [&](unsigned number, int length) {
    for (int i = 0; i < length; ++i) {
      const int byte = is_little ? i : length - 1 - i;
      bytes.push_back(static_cast<std::uint8_t>(number >> (8 * byte)));
    }
  };
  put(42, 2);
  put(8, 4);
  put(static_cast<unsigned>(tags.size()), 2);
  for (const auto& [tag, type, value] : tags) {
    put(tag, 2);
    put(type, 2);
    put(1, 4);
    put(value, type == 3 ? 2 : 4);
    if (type == 3) put(0, 2);
  }
  return bytes;
}

TEST_CASE("A TIFF states its size in either byte order, short or long, and that of its tiles") {
  constexpr unsigned kShort = 3, kLong = 4, kByte = 1;
  for (const bool is_little : {true, false}) {
    INFO(is_little);
    const auto size = [&](const std::vector<std::array<unsigned, 3>>& tags) {
      return StatedSize(Tiff(is_little, tags));
    };
    CHECK(Is(size({{256, kShort, 640}, {257, kLong, 70'000}}), 640.0, 70'000.0));
    CHECK(Is(size({{256, kLong, 64}, {257, kLong, 48}, {322, kLong, 4096}, {323, kShort, 16}}),
             4096.0, 48.0));
    CHECK_FALSE(size({{256, kShort, 640}}));
    CHECK_FALSE(size({{257, kShort, 640}}));
    CHECK_FALSE(size({{256, kByte, 64}, {257, kShort, 640}}));
  }
}

TEST_CASE("A Netpbm head has comments and white space of any length") {
  CHECK(Is(StatedSize(Text("P5 # made by hand\n#\n\n 300\t# wide\n7\n255\n")), 300.0, 7.0));
  CHECK(Is(StatedSize(Text("P2\n300 7")), 300.0, 7.0));
  CHECK_FALSE(StatedSize(Text("P5 300")));
  CHECK_FALSE(StatedSize(Text("P5 300 # 7")));
  CHECK_FALSE(StatedSize(Text("P5 -300 7")));
  CHECK_FALSE(StatedSize(Text("P7\nWIDTH 300\nHEIGHT 7\n")));
  for (const char* other : {"P1 300 7", "P4 300 7", "P7 300 7", "p5 300 7", "no 300 7"}) {
    CHECK_FALSE(StatedSize(Text(other)));
  }
  for (const char* kind : {"P2 300 7", "P3 300 7", "P5 300 7", "P6 300 7"}) {
    CHECK(Is(StatedSize(Text(kind)), 300.0, 7.0));
  }
}

TEST_CASE("What stands behind a Netpbm head in memory is none of it") {
  const Bytes head = Text("P5 300 71 255");
  const auto size_of = [&](std::size_t length) {
    return StatedSize(std::span(head).first(length));
  };
  CHECK(Is(size_of(9), 300.0, 71.0));
  CHECK(Is(size_of(8), 300.0, 7.0));
  for (std::size_t length = 0; length <= 7; ++length) CHECK_FALSE(size_of(length));
}

TEST_CASE("What is no picture, or more than is put up with, is told before it is read") {
  const test::TemporaryFolder folder;
  const auto problem = [&](const Bytes& bytes, double most_bytes, double most_mpixel) {
    Write(folder / "picture", bytes);
    const PictureFile file = ReadPictureFile(folder / "picture", most_bytes, most_mpixel);
    CHECK(file.problem.empty() != file.bytes.empty());
    return file.problem;
  };
  const std::string no_picture =
      "the picture cannot be decoded: it is no JPEG, PNG, BMP, TIFF, PGM or PPM";
  CHECK(problem(Text("text"), 1e6, 1.0) == no_picture);
  CHECK(problem({}, 1e6, 1.0) == no_picture);
  CHECK(problem(Encoded(".webp"), 1e6, 1.0) == no_picture);
  const Bytes tiff = Tiff(true, {{256, 4, 30'000}, {257, 4, 20'000}});
  CHECK(problem(tiff, 1e6, 600.0).empty());
  CHECK(problem(tiff, 1e6, 599.9) ==
        "30000 x 20000 pixels, and at most 599.9 million are read: make it smaller");
  const Bytes png = Encoded(".png");
  const auto length = static_cast<double>(png.size());
  CHECK(problem(png, length, 1.0).empty());
  CHECK(problem(png, length - 1.0, 1.0) == std::to_string(png.size()) + " bytes, and at most " +
                                               std::to_string(png.size() - 1) + " are read");
}

TEST_CASE("A pipe, a device and a folder are no pictures, and nothing waits for them") {
  const test::TemporaryFolder folder;
  REQUIRE(::mkfifo((folder / "pipe.png").c_str(), 0600) == 0);
  std::filesystem::create_symlink("/dev/zero", folder / "endless.png");
  std::filesystem::create_directory(folder / "folder.png");
  for (const char* name : {"pipe.png", "endless.png", "folder.png", "none.png"}) {
    INFO(name);
    const PictureFile file = ReadPictureFile(folder / name, 1e6, 1.0);
    CHECK(file.problem == "it is no file");
    CHECK(file.bytes.empty());
  }
}

}  // namespace
}  // namespace rift::vision
