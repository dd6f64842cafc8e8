#include <catch2/catch.hpp>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "support/environment.hpp"
#include "support/running_rift.hpp"
#include "support/tree.hpp"
#include "support/trials.hpp"
#include "support/virtual_display.hpp"

namespace rift {
namespace {

using Catch::Matchers::Contains;
using test::Environment;
using test::ProcessResult;

const std::string kData = test::SourceDir() + "/data/camera";

/// True once `command` succeeded, tried for some seconds.
bool Succeeds(const std::string& command) {
  for (int i = 0; i < 200; ++i) {
    if (std::system((command + " >/dev/null 2>&1").c_str()) == 0) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return false;
}

void Do(const std::string& command) {
  INFO(command);
  CHECK(std::system((command + " >/dev/null 2>&1").c_str()) == 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(400));
}

TEST_CASE("Waypoints clicked in the window drive the simulator as they are") {
  const test::VirtualDisplay server;
  if (!server.Runs() || std::system("command -v xdotool >/dev/null") != 0) {
    WARN("SKIPPED: Xvfb or xdotool is not installed");
    return;
  }
  const test::TemporaryFolder folder;
  const Environment display("DISPLAY", server.Name());
  // The shim's camera goes on for ever.
  const std::string waypoints = folder / "wp.yaml";
  ProcessResult result;
  {
    const Environment jpegs("RIFT_SHIM_JPEGS", kData + "/frames");
    const Environment shim("LD_PRELOAD", test::BuildDir() + "/tests/librift_v4l2_shim.so");
    test::RunningRift rift({"track", "--camera", "/dev/video0", "--calibration",
                            kData + "/camera.yaml", "--out", folder / "log.csv", "--view",
                            "--record-waypoints", waypoints, "--duration", "60"});
    {
      const Environment none("LD_PRELOAD", "");
      REQUIRE(Succeeds("xdotool search --sync --onlyvisible --name '^rift track$'"));
      std::this_thread::sleep_for(std::chrono::milliseconds(500));
      const std::string window = "xdotool search --onlyvisible --name '^rift track$' ";
      Do(window + "mousemove --window %1 120 300 click 1");
      Do(window + "mousemove --window %1 320 260 click 1");
      Do(window + "mousemove --window %1 500 100 click 1");
      Do(window + "mousemove --window %1 520 220 click 1");
      Do(window + "windowfocus %1 key u");
      Do(window + "windowfocus %1 key s");
      Do(window + "windowfocus %1 key q");
    }
    result = rift.Wait();
  }
  INFO(result.out << result.err << test::ReadFile(waypoints));
  CHECK(result.exit_code == 0);
  const std::string yaml = test::ReadFile(waypoints);
  CHECK_THAT(yaml, Contains("start") && Contains("wp2") && !Contains("wp3"));
  CHECK_THAT(yaml, Contains("stop: false"));
  const ProcessResult simulated = test::RunRift(
      {"simulate", waypoints, "--out", folder / "sim", "--set", "trial.timeout_s=20"});
  INFO(simulated.err);
  CHECK(simulated.exit_code <= 1);
  CHECK(std::filesystem::exists(folder / "sim/trajectory.csv"));
}

}  // namespace
}  // namespace rift
