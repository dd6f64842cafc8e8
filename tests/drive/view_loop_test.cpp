// What becomes of a drive whose window fails, or takes the whole process along.
#include "sessions/drive/view_loop.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "drive_scene.hpp"
#include "support/processes/environment.hpp"
#include "support/processes/virtual_display.hpp"

namespace rift::sessions {
namespace {

using std::chrono::milliseconds;

/// A drive that goes on until it is told to stop, and then says so.
struct EndlessDrive {
  std::atomic<bool> is_told = false, has_stopped = false;

  ViewedDrive SeenBy(const std::function<void()>& look) {
    return {.drive =
                [this] {
                  is_told.wait(false);
                  has_stopped = true;
                  return hardware::DriveRun{.has_begun = true};
                },
            .look = look,
            .stop =
                [this] {
                  is_told = true;
                  is_told.notify_all();
                },
            .redraw = milliseconds(1)};
  }
};

TEST_CASE("A window that fails stops the drive, and the failure is told once it has stopped") {
  EndlessDrive endless;
  int looks = 0;
  CHECK_THROWS_WITH(DriveInView(endless.SeenBy([&looks] {
                      if (++looks == 3) throw std::runtime_error("no more memory for pictures");
                    })),
                    "no more memory for pictures");
  CHECK(looks == 3);
  CHECK(endless.has_stopped);
}

TEST_CASE("A drive that ends by itself is not asked to, and gives what it has to give") {
  bool is_asked = false;
  const auto stop = [&is_asked] { is_asked = true; };
  const auto end = [] { return hardware::DriveRun{.has_begun = true, .stopping_distance_m = 0.5}; };
  CHECK(DriveInView({end, [] {}, stop, milliseconds(1)}).stopping_distance_m == 0.5);
  const auto fail = []() -> hardware::DriveRun { throw std::runtime_error("not armed"); };
  CHECK_THROWS_WITH(DriveInView({fail, [] {}, stop, milliseconds(1)}), "not armed");
  CHECK_FALSE(is_asked);
}

/// What a process ends with that leaves itself by exit() in its window: 10 when its drive had
/// stopped by the time that everything else is taken down, else 11.
int ExitOfProcess(bool hears_stop) {
  static EndlessDrive* endless = nullptr;
  const pid_t child = ::fork();
  if (child == 0) {
    endless = new EndlessDrive;  // it outlives the exit
    std::atexit([] { ::_exit(endless->has_stopped ? 10 : 11); });
    ViewedDrive viewed = endless->SeenBy([] { std::exit(1); });
    if (!hears_stop) {
      viewed.stop = [] {};
      viewed.patience = milliseconds(5);
    }
    DriveInView(viewed);
    ::_exit(12);
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST_CASE("A window that ends the process has stopped the drive before it does") {
  CHECK(ExitOfProcess(true) == 10);
  CHECK(ExitOfProcess(false) == 11);  // one that hears nothing holds it for its patience alone
}

TEST_CASE("A process that ends after a drive in a window has nothing to stop") {
  const pid_t child = ::fork();
  if (child == 0) {
    std::atexit([] { ::_exit(10); });
    DriveInView({[] { return hardware::DriveRun{}; }, [] {}, [] { ::_exit(11); }, milliseconds(1)});
    std::exit(1);
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  REQUIRE(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 10);
}

TEST_CASE("A display that goes away stops the robot before the process ends with it") {
  test::Uninterrupted(test::kAll, [](test::Scene& scene) {
    auto server = std::make_unique<test::VirtualDisplay>();
    if (!server->Runs()) {
      WARN("SKIPPED: Xvfb is not installed");
      return true;
    }
    const test::Environment display("DISPLAY", server->Name());
    std::vector<std::string> arguments = scene.Arguments();
    arguments.emplace_back("--view");
    test::RunningRift rift(arguments);
    // In the turn before the first leg it mostly stands.
    rift.WaitUntil("the first leg began or the drive is over", [&] {
      return rift.Err().find("loop delay") != std::string::npos || !rift.IsRunning();
    });
    test::WaitForMotion(rift, scene);
    server.reset();
    const test::ProcessResult result = rift.Wait();
    INFO(result.err << scene.floor.Told());
    // On a busy machine the drive was over before, or did not begin.
    if (!result.out.empty() || result.exit_code == 3) return false;
    CHECK_FALSE(scene.floor.Moves());
    CHECK_THAT(scene.floor.Told(), Catch::StartsWith("the robot stopped 0 times by itself"));
    CHECK(scene.Summary()["state"] == "interrupted");
    return true;
  });
}

}  // namespace
}  // namespace rift::sessions
