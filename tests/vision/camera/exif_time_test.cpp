#include "vision/camera/exif_time.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <opencv2/core.hpp>

#include "rift/vision/camera/camera_source.hpp"
#include "rift/vision/camera/jpeg.hpp"
#include "support/processes/process.hpp"

namespace rift::vision {
namespace {

using Catch::Matchers::Contains;
using Bytes = std::vector<std::uint8_t>;

/// A JPEG whose Exif segment holds a date, and a fraction of a second unless that is empty. The
/// offsets are those of TIFF 6.0: one folder that leads to the Exif folder, then the date.
struct Photograph {
  std::string date, fraction;
  bool is_little = true;

  Bytes tiff;

  void Number(std::size_t value, int length) {
    for (int i = 0; i < length; ++i) {
      const int shift = 8 * (is_little ? i : length - 1 - i);
      tiff.push_back(static_cast<std::uint8_t>(value >> shift));
    }
  }
  void Entry(int tag, int type, std::size_t count) {
    Number(tag, 2);
    Number(type, 2);
    Number(count, 4);
  }
  void Text(const std::string& text, std::size_t length) {
    for (std::size_t i = 0; i < length; ++i) tiff.push_back(i < text.size() ? text[i] : 0);
  }

  Bytes Tiff() {
    tiff.clear();
    Text(is_little ? "II" : "MM", 2);
    Number(42, 2);
    Number(8, 4);
    Number(1, 2);  // the folder at 8
    Entry(0x8769, 4, 1);
    Number(26, 4);
    Number(0, 4);
    Number(fraction.empty() ? 1 : 2, 2);  // the Exif folder at 26
    Entry(0x9003, 2, date.size() + 1);
    Number(64, 4);
    if (!fraction.empty()) {
      Entry(0x9291, 2, fraction.size() + 1);
      fraction.size() < 4 ? Text(fraction, 4) : Number(84, 4);
    }
    tiff.resize(64);
    Text(date, 20);
    Text(fraction, 20);
    return tiff;
  }
  Bytes Jpeg() {
    const Bytes exif = Tiff();
    Bytes jpeg = WriteJpeg(cv::Mat1b(16, 16, std::uint8_t{100}), 80, false);
    Bytes segment{0xFF, 0xE1, 0, static_cast<std::uint8_t>(exif.size() + 8), 'E', 'x', 'i',
                  'f',  0,    0};
    segment.insert(segment.end(), exif.begin(), exif.end());
    jpeg.insert(jpeg.begin() + 2, segment.begin(), segment.end());
    return jpeg;
  }
};

void Write(const std::string& path, const Bytes& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

TEST_CASE("The date of a photograph is read with its fraction of a second in both byte orders") {
  const bool is_little = GENERATE(true, false);
  const auto taken_s = [&](const std::string& date, const std::string& fraction) {
    return ExifTime_s(Photograph{date, fraction, is_little}.Jpeg());
  };
  CHECK(taken_s("1970:01:02 00:00:01", "").value() == 86401.0);
  // date --date='2026-11-23 12:34:56 UTC' +%s
  CHECK(taken_s("2026:11:23 12:34:56", "25").value() == Approx(1795437296.25).epsilon(1e-15));
  CHECK(taken_s("2026:11:23 12:34:56", "250731").value() ==
        Approx(1795437296.250731).epsilon(1e-15));
  CHECK(taken_s("2024:02:29 23:59:59", "9  ").value() == Approx(1709251199.9).epsilon(1e-15));
}

TEST_CASE("A photograph without a date, or with none that can be, has no time") {
  for (const char* date : {"2026:02:30 12:00:00", "0000:00:00 00:00:00", "    :  :     :  :  ",
                           "2026:11:23 25:00:00", "2026:11:23", "2026-11-23T12:00:00Z"}) {
    INFO(date);
    CHECK_FALSE(ExifTime_s(Photograph{date, "25"}.Jpeg()));
  }
  CHECK_FALSE(ExifTime_s(WriteJpeg(cv::Mat1b(16, 16, std::uint8_t{100}), 80, false)));
  CHECK_FALSE(ExifTime_s(Bytes{}));
}

TEST_CASE("Wherever a photograph is cut or damaged its time is the one in it or none") {
  const Bytes whole = Photograph{"2026:11:23 12:34:56", "250731"}.Jpeg();
  for (std::size_t length = 0; length < 130; ++length) {
    // A copy of that very length, so that a byte beyond it is noticed by AddressSanitizer.
    ExifTime_s(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length)));
  }
  int read = 0;
  for (std::size_t at = 2; at < 130; ++at) {
    for (const int value : {0x00, 0x7F, 0xFF}) {
      Bytes damaged = whole;
      damaged[at] = static_cast<std::uint8_t>(value);
      read += ExifTime_s(damaged).has_value();
    }
  }
  CHECK(read > 30);  // bytes that do not matter
  CHECK(read < 3 * 128);
}

TEST_CASE("Pictures are read at the times of their EXIF data") {
  const test::TemporaryFolder folder;
  Write(folder / "a1.jpg", Photograph{"2026:11:23 12:34:59", "900"}.Jpeg());
  Write(folder / "a2.jpg", Photograph{"2026:11:23 12:35:00", "150"}.Jpeg());
  Write(folder / "a10.jpg", Photograph{"2026:11:23 12:35:02", "0"}.Jpeg());
  CaptureOptions options;
  options.times = "exif";
  const auto camera = OpenCamera(folder / "*.jpg", options);
  std::vector<double> times_s;
  for (Frame frame; times_s.size() < 3;) {
    REQUIRE(camera->Read(frame));
    times_s.push_back(frame.captured_s);
  }
  CHECK(times_s[1] - times_s[0] == Approx(0.25).margin(1e-6));
  CHECK(times_s[2] - times_s[0] == Approx(2.1).margin(1e-6));

  for (const auto& [second, later] : {std::pair{"02", "2.100"}, {"01", "1.100"}}) {
    Write(folder / "a11.jpg", Photograph{"2026:11:23 12:35:" + std::string(second), ""}.Jpeg());
    CHECK_THROWS_WITH(
        OpenCamera(folder / "*.jpg", options),
        (folder / "a11.jpg") + ": by its EXIF data it was taken " + later +
            " s after the first picture, not later than the one before (2.100 s): a camera that "
            "writes no SubSecTimeOriginal tells whole seconds only");
  }
  Write(folder / "a11.jpg", WriteJpeg(cv::Mat1b(16, 16, std::uint8_t{100}), 80, false));
  CHECK_THROWS_WITH(OpenCamera(folder / "*.jpg", options),
                    Contains("a11.jpg: no DateTimeOriginal") && Contains("--times FILE"));
}

TEST_CASE("EXIF data are looked for in the first 256 KiB of a file") {
  const test::TemporaryFolder folder;
  CaptureOptions options;
  options.times = "exif";
  const auto open_behind = [&](int profiles) {
    Bytes jpeg = Photograph{"2026:11:23 12:34:59", "900"}.Jpeg(), profile(2 + 65535);
    const Bytes head{0xFF, 0xE2, 0xFF, 0xFF};
    std::copy(head.begin(), head.end(), profile.begin());
    for (int i = 0; i < profiles; ++i) {
      jpeg.insert(jpeg.begin() + 2, profile.begin(), profile.end());
    }
    Write(folder / "a.jpg", jpeg);
    return OpenCamera(folder / "a.jpg", options);
  };
  CHECK_NOTHROW(open_behind(3));
  CHECK_THROWS_WITH(open_behind(4), (folder / "a.jpg") +
                                        ": no DateTimeOriginal in its EXIF data; --times FILE "
                                        "takes a list of times");
}

TEST_CASE("An hour has 60 minutes, a minute may have a leap second, and digits alone count") {
  const auto seconds = [](const std::string& date, const std::string& fraction = "") {
    return ExifTime_s(Photograph{date, fraction}.Jpeg());
  };
  CHECK(seconds("1970:01:01 23:59:60") == 86400.0);
  CHECK(seconds("1970:12:31 00:00:00") == 364.0 * 86400.0);
  for (const char* date : {"1970:01:01 24:00:00", "1970:01:01 00:60:00", "1970:01:01 00:00:61",
                           "1970:13:01 00:00:00", "1970:01:32 00:00:00", "1970:01:01 00:00:5 ",
                           "1970:01:01 00:-1:00", "197x:01:01 00:00:00"}) {
    INFO(date);
    CHECK_FALSE(seconds(date));
  }
  CHECK(seconds("1970:01:01 00:00:00", "5x7").value() == Approx(0.5));
  CHECK(seconds("1970:01:01 00:00:00", "/9").value() == 0.0);
  CHECK(seconds("1970:01:01 00:00:00", ":9").value() == 0.0);
}

TEST_CASE("An entry counts by its tag and its type, and a folder by its offset") {
  const Bytes whole = Photograph{"1970:01:01 00:00:07", "25"}.Jpeg();
  constexpr std::size_t kTiff = 2 + 4 + 6;  // behind the start, the segment's head and its name
  // Places from the TIFF's begin, and what is there.
  struct Entry {
    std::size_t at;
    int was, is;
  };
  const auto with = [&](const Entry& entry) {
    Bytes changed = whole;
    REQUIRE(changed[kTiff + entry.at] == entry.was);
    changed[kTiff + entry.at] = static_cast<std::uint8_t>(entry.is);
    return ExifTime_s(changed);
  };
  CHECK(ExifTime_s(whole).value() == Approx(7.25));
  for (const Entry& entry : {Entry{0, 'I', 'X'},
                             {1, 'I', 'X'},
                             {2, 42, 43},
                             {4, 8, 9},
                             {10, 0x69, 0x68},
                             {12, 4, 3},
                             {18, 26, 27},
                             {28, 0x03, 0x04},
                             {30, 2, 3},
                             {36, 64, 65}}) {
    INFO("byte " << entry.at);
    CHECK_FALSE(with(entry));
  }
  // The fraction by itself may be missing.
  CHECK(with({40, 0x91, 0x90}).value() == Approx(7.0));
  CHECK(with({42, 2, 3}).value() == Approx(7.0));
}

}  // namespace
}  // namespace rift::vision
