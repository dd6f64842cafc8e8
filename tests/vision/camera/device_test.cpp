#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <cstdio>
#include <map>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <regex>
#include <tuple>

#include "rift/vision/camera/camera_source.hpp"
#include "support/processes/process.hpp"
#include "support/tree.hpp"
#include "support/until.hpp"

namespace rift::vision {
namespace {

using Catch::Matchers::Contains;

/// What capture_probe printed about the shim's camera.
struct Probed {
  std::string text;

  double Number(const std::string& name) const {
    std::smatch match;
    const std::regex line("(^|\n)" + name + " ([-0-9.]+)");
    return std::regex_search(text, match, line) ? std::stod(match[2]) : -1.0;
  }
  bool Names(const std::string& state) const {
    return text.find("state " + state + ": ") != std::string::npos;
  }
  bool HasLeft() const { return text.ends_with("\nleft\n"); }
};

Probed Probe(const std::map<std::string, std::string>& shim, const std::string& arguments) {
  std::string command = "env LD_PRELOAD=" + test::BuildDir() + "/tests/librift_v4l2_shim.so";
  for (const auto& [name, value] : shim) command += fmt::format(" RIFT_SHIM_{}='{}'", name, value);
  command += " timeout " + std::to_string(test::kGiveUp.count()) + " " + test::BuildDir() +
             "/tests/rift_capture_probe " + arguments + " 2>&1";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  Probed probed;
  std::array<char, 512> line{};
  while (std::fgets(line.data(), line.size(), pipe.get()) != nullptr) probed.text += line.data();
  return probed;
}

/// JPEGs with something to see in them, or black ones.
class JpegFolder {
 public:
  JpegFolder(int width_px, int height_px, bool black = false) {
    for (int i = 0; i < 6; ++i) {
      cv::Mat picture(height_px, width_px, CV_8UC3, cv::Scalar::all(black ? 3 : 120));
      if (!black) cv::circle(picture, {60 + 20 * i, 100}, 40, {255, 255, 255}, cv::FILLED);
      cv::imwrite(folder_ / ("f" + std::to_string(i) + ".jpg"), picture);
    }
  }
  std::string Path() const { return folder_.Path().string(); }

 private:
  test::TemporaryFolder folder_;
};

TEST_CASE("A V4L2 camera runs at the rate asked for in MJPG and in YUYV") {
  const int fps = GENERATE(30, 60);
  const bool mjpg = GENERATE(true, false);
  const JpegFolder jpegs(640, 480);
  const Probed probed =
      Probe({{"JPEGS", jpegs.Path()}},
            fmt::format("/dev/video0 - 40 {} {} 640 480", mjpg ? "mjpg" : "yuyv", fps));
  INFO(probed.text);
  CHECK_THAT(probed.text, Contains(mjpg ? "first jpeg 640 480" : "first yuyv 640 480"));
  CHECK(probed.Number("rate") > 0.0);
  // The shim stamps the light of a picture at multiples of 1 / fps, 12 ms before it hands it out.
  CHECK(probed.Number("off_beat") < 0.01);
  CHECK(probed.Number("shortest_step") == Approx(1.0).margin(0.01));
  CHECK(probed.Number("latency") > 0.011);
  CHECK(probed.HasLeft());
}

TEST_CASE("A picture is as old as its driver says, unless that is not yet or over a second ago") {
  const JpegFolder jpegs(320, 240);
  // By how much the driver's clock is late, and what the age is then; a busy machine adds to it.
  for (const auto& [late_s, least_s, most_s] :
       {std::tuple{-0.5, 0.511, 0.999}, {-1.1, 0.0, 0.0}, {1e6, 0.0, 0.0}}) {
    const Probed probed = Probe({{"JPEGS", jpegs.Path()}, {"STAMPS", fmt::format("{}", late_s)}},
                                "/dev/video0 - 2 mjpg 60 320 240");
    INFO(late_s << "\n" << probed.text);
    CHECK(probed.Number("latency") >= least_s);
    CHECK(probed.Number("latency") <= most_s);
    CHECK(probed.HasLeft());
  }
}

TEST_CASE("A fault of a V4L2 camera is named and nothing hangs") {
  struct Fault {
    std::string name, state;
  };
  const Fault fault = GENERATE(Fault{"unplug", "unplugged"}, Fault{"eio", "frozen"},
                               Fault{"hang", "frozen"}, Fault{"busy", "busy"});
  const bool mjpg = GENERATE(true, false);
  const JpegFolder jpegs(640, 480);
  const Probed probed =
      Probe({{"JPEGS", jpegs.Path()}, {"FAULT", fault.name}},
            fmt::format("/dev/video0 {} 0 {} 30 640 480", fault.state, mjpg ? "mjpg" : "yuyv"));
  INFO(fault.name << (mjpg ? " mjpg\n" : " yuyv\n") << probed.text);
  CHECK(probed.Names(fault.state));
  CHECK(probed.HasLeft());
}

TEST_CASE("Pictures that repeat or that see no light are named while they keep coming") {
  const bool mjpg = GENERATE(true, false);
  const JpegFolder light(320, 240), dark(320, 240, true);
  const auto camera = [mjpg](const std::string& state) {
    return fmt::format("/dev/video0 {} 5 {} 30 320 240", state, mjpg ? "mjpg" : "yuyv");
  };
  const Probed frozen = Probe({{"JPEGS", light.Path()}, {"FAULT", "freeze"}}, camera("frozen"));
  INFO(frozen.text);
  CHECK(frozen.Names("frozen"));
  CHECK(frozen.HasLeft());
  const Probed black =
      Probe({{"JPEGS", dark.Path()}, {"FAULT", "black"}, {"AFTER", "10"}}, camera("black"));
  INFO(black.text);
  CHECK(black.Names("black"));
  CHECK(black.HasLeft());
}

TEST_CASE("JPEGs that come without their begin are passed over, unless no others come") {
  const JpegFolder jpegs(320, 240);
  const auto probed_with = [&](const std::string& fault) {
    return Probe({{"JPEGS", jpegs.Path()}, {"FAULT", fault}, {"AFTER", "3"}},
                 "/dev/video0 - 6 mjpg 60 320 240");
  };
  const Probed some = probed_with("headless");
  INFO(some.text);
  CHECK(some.Number("skipped") >= 8.0);  // up to four after each picture
  CHECK_FALSE(some.Names("wrong format"));
  CHECK(some.HasLeft());
  const Probed none = probed_with("torn");
  INFO(none.text);
  CHECK(none.Number("frames") > 0.0);
  CHECK(none.Names("wrong format"));
  CHECK_THAT(none.text, Contains(" bytes are no picture of 320x240 in MJPG, YUYV or GREY"));
  CHECK(none.HasLeft());
}

TEST_CASE("A camera without a format that is understood is named with those it has") {
  const Probed probed = Probe({{"FORMATS", "H264,NV12"}}, "/dev/video0 - 1 mjpg 30 640 480");
  CHECK_THAT(probed.text, Contains("state wrong format") && Contains("gives H264, NV12"));
}

/// What is said of a device that is not opened: "STATE: reason".
std::string Refusal(const std::string& path) {
  try {
    OpenCamera(path, {});
  } catch (const CameraError& error) {
    return std::string(EnumNames(error.state)[static_cast<std::size_t>(error.state)]) + ": " +
           error.what();
  }
  return "opened";
}

TEST_CASE("A device that is none, or not there, is named with what to do") {
  CHECK(Refusal("/dev/video93") ==
        "unplugged: /dev/video93: No such file or directory: is the camera plugged in? `ls "
        "/dev/video*` shows those there are");
  CHECK(Refusal("93") == Refusal("/dev/video93"));
  CHECK(Refusal("/dev/null") == "wrong format: /dev/null: not a V4L2 device");
  const int before = ::dup(1);  // a device that is refused is closed again
  ::close(before);
  for (int i = 0; i < 3; ++i) Refusal("/dev/null");
  const int after = ::dup(1);
  ::close(after);
  CHECK(after == before);
}

TEST_CASE("What keeps a device from being a camera is said with its state in a whole line") {
  struct Fault {
    std::string name, says;
  };
  const std::string no_pictures =
      "wrong format: /dev/video0: gives no pictures (many cameras have a second device for "
      "metadata: try the one before)";
  const std::string busy = "busy: /dev/video0: another program uses it: close that one";
  for (const Fault& fault :
       {Fault{"metadata", no_pictures}, Fault{"screen", no_pictures}, Fault{"busy", busy},
        Fault{"taken", busy},
        Fault{"denied",
              "wrong format: /dev/video0: Permission denied: add your user to the group "
              "'video'"}}) {
    const Probed probed = Probe({{"FAULT", fault.name}}, "/dev/video0 - 1 mjpg 30 640 480");
    INFO(fault.name << "\n" << probed.text);
    CHECK_THAT(probed.text, Contains("state " + fault.says + "\n"));
    CHECK(probed.HasLeft());
  }
  // Names of formats have four letters: of three none is left.
  const Probed none = Probe({{"FORMATS", "XXX"}}, "/dev/video0 - 1 mjpg 30 640 480");
  CHECK_THAT(none.text, Contains("state wrong format: /dev/video0: gives no pixel format, but rift "
                                 "reads MJPG, YUYV and GREY\n"));
}

TEST_CASE("Of the formats that a device has the wished one is taken, else one that is understood") {
  const JpegFolder jpegs(320, 240);
  struct Offer {
    std::string formats, wish, first;
  };
  for (const Offer& offer :
       {Offer{"H264,YUYV", "mjpg", "yuyv"}, Offer{"NV12,MJPG", "yuyv", "jpeg"}}) {
    const Probed probed = Probe({{"JPEGS", jpegs.Path()}, {"FORMATS", offer.formats}},
                                "/dev/video0 - 1 " + offer.wish + " 60 320 240");
    INFO(offer.formats << " for " << offer.wish << "\n" << probed.text);
    CHECK_THAT(probed.text, Contains("first " + offer.first + " 320 240\n"));
    CHECK(probed.HasLeft());
  }
}

}  // namespace
}  // namespace rift::vision
