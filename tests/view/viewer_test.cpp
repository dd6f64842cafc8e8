#include "rift/view/video.hpp"
#include "rift/view/window.hpp"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <opencv2/videoio.hpp>
#include <optional>
#include <sstream>

#include "rift/view/film.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/environment.hpp"
#include "support/processes/process.hpp"
#include "support/processes/virtual_display.hpp"
#include "support/tree.hpp"
#include "support/until.hpp"
#include "view/synthetic_run.hpp"

namespace rift::view {
namespace {

using Catch::Matchers::Contains;
using synthetic::StraightRun;
using test::Environment;
using test::TemporaryFolder;

size_t FilesIn(const std::filesystem::path& folder) {
  size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) count += entry.exists();
  return count;
}

TEST_CASE("A video holds every picture of the film and they change") {
  const TemporaryFolder folder;
  const std::string path = folder / "run 100%d.mp4";
  const Film film = MakeFilm(StraightRun());
  WriteVideo(film, path, {});
  CHECK(FilesIn(folder.Path()) == 1);
  cv::VideoCapture video(path, cv::CAP_FFMPEG);
  REQUIRE(video.isOpened());
  CHECK(video.get(cv::CAP_PROP_FPS) == Approx(30.0));
  cv::Mat first, picture;
  REQUIRE(video.read(first));
  CHECK(first.size() == cv::Size(1280, 720));
  size_t count = 1;
  for (cv::Mat next; video.read(next); ++count) next.copyTo(picture);
  CHECK(count == film.scenes.size());
  CHECK(cv::norm(first, picture, cv::NORM_INF) > 100.0);
}

TEST_CASE("A video replaces an older file of its name, and no other") {
  const TemporaryFolder folder;
  const std::string path = folder / "run.mp4";
  test::WriteText(path, "old");
  test::WriteText(folder / "run.part.mp4", "another's");
  Run run = StraightRun();
  run.truth.poses.resize(3);
  WriteVideo(MakeFilm(run), path, {});
  CHECK(std::filesystem::file_size(path) > 1000);
  CHECK(test::ReadFile(folder / "run.part.mp4") == "another's");
}

TEST_CASE("A video that cannot be written is an error and leaves nothing behind") {
  const TemporaryFolder folder;
  const Film film = MakeFilm(StraightRun());
  CHECK_THROWS_WITH(WriteVideo(film, folder / "no/such/run.mp4", {}),
                    Contains("cannot write") && Contains("folder"));
  CHECK_THROWS_WITH(WriteVideo(film, folder / "run.avi", {}), Contains(".mp4"));
  CHECK(FilesIn(folder.Path()) == 0);
}

TEST_CASE("A disk that fills up is an error and leaves nothing behind") {
  const TemporaryFolder folder;
  const Film film = MakeFilm(StraightRun());
  rlimit old{};
  REQUIRE(getrlimit(RLIMIT_FSIZE, &old) == 0);
  const rlimit small{8000, old.rlim_max};  // writes beyond it fail as on a full disk
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  std::string message;
  try {
    WriteVideo(film, folder / "run.mp4", {});
  } catch (const std::runtime_error& error) {
    message = error.what();
  }
  setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, old_handler);
  CHECK_THAT(message, Contains("cannot write") && Contains("disk full"));
  CHECK(FilesIn(folder.Path()) == 0);
}

TEST_CASE("Without a display there is a reason in one line and no window and no crash") {
  const Environment wayland("WAYLAND_DISPLAY", std::nullopt);
  const bool unreachable = GENERATE(false, true);
  const Environment display("DISPLAY",
                            unreachable ? std::optional<std::string>(":9753") : std::nullopt);
  const std::string missing = MissingDisplay();
  CHECK_THAT(missing, Contains("no window") && !Contains("\n"));
  CHECK_THROWS_WITH(PlayInWindow(MakeFilm(StraightRun()), {}), missing);
}

TEST_CASE("Without a display a film is written all the same, and what shows nothing is told") {
  const TemporaryFolder folder;
  const Environment display("DISPLAY", "");
  Run run = StraightRun();
  run.truth.poses.resize(2);
  std::vector<std::string> told;
  const auto say = [&told](const std::string& line) { told.push_back(line); };
  ShowFilm(MakeFilm(run), folder / "run.mp4", true, say);
  CHECK(FilesIn(folder.Path()) == 1);
  CHECK(told == std::vector<std::string>{"note: --view shows nothing: " + MissingDisplay()});
  ShowFilm(MakeFilm(run), "", false, say);
  CHECK(told.size() == 1);
}

// Set in the process that opens the window: one of its own, since Qt takes its process along when
// the display ends.
constexpr const char* kShows = "RIFT_TEST_SHOWS_WINDOW";
constexpr const char* kWindowCase = "A window on a virtual display plays to its end";

void ShowWindow() {
  ViewOptions options;
  options.speed = 8.0;
  options.hold_s = 0.1;
  REQUIRE(MissingDisplay().empty());
  PlayInWindow(MakeFilm(StraightRun(), options), options);
}

TEST_CASE(kWindowCase) {
  if (std::getenv(kShows) != nullptr) return ShowWindow();
  const test::VirtualDisplay server;
  if (!server.Runs()) {
    WARN("SKIPPED: Xvfb is not installed");
    return;
  }
  const Environment display("DISPLAY", server.Name());
  const Environment shows(kShows, "1");
  const pid_t child = fork();
  if (child == 0) {
    ::alarm(static_cast<unsigned>(test::kGiveUp.count()));  // ends it when it hangs
    execl("/proc/self/exe", "rift_view_test", kWindowCase, static_cast<char*>(nullptr));
    _exit(127);
  }
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  REQUIRE(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 0);
}

TEST_CASE("A window starts no message bus where there is none, and takes the one there is") {
  const test::VirtualDisplay server;
  if (!server.Runs()) {
    WARN("SKIPPED: Xvfb is not installed");
    return;
  }
  const TemporaryFolder folder;
  const Environment display("DISPLAY", server.Name());
  const Environment platform("QT_QPA_PLATFORM", std::nullopt);
  const char* const kBus = "DBUS_SESSION_BUS_ADDRESS";
  const Environment runtime("XDG_RUNTIME_DIR", folder.Path().string());
  {
    const Environment bus(kBus, std::nullopt);
    RequireDisplay();
    CHECK(std::getenv(kBus) == std::string("disabled:"));
  }
  {
    const Environment bus(kBus, "unix:path=/run/a_bus");
    RequireDisplay();
    CHECK(std::getenv(kBus) == std::string("unix:path=/run/a_bus"));
  }
  {
    const Environment bus(kBus, std::nullopt);
    const Environment elsewhere("XDG_RUNTIME_DIR", std::nullopt);
    RequireDisplay();
    CHECK(std::getenv(kBus) == std::string("disabled:"));
  }
  test::WriteText(folder / "bus", "");
  const Environment bus(kBus, std::nullopt);
  RequireDisplay();
  CHECK(std::getenv(kBus) == nullptr);
}

TEST_CASE("The command line program does not load OpenCV by itself") {
  std::ifstream program(test::RiftBinary(), std::ios::binary);
  if (!program) {
    WARN("SKIPPED: rift is not built");
    return;
  }
  std::stringstream bytes;
  bytes << program.rdbuf();
  CHECK(bytes.str().find("libopencv_") == std::string::npos);
}

}  // namespace
}  // namespace rift::view
