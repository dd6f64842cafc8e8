#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "support/inputs/trials.hpp"
#include "support/processes/environment.hpp"
#include "support/processes/running_rift.hpp"
#include "support/processes/virtual_display.hpp"
#include "support/tree.hpp"
#include "track/window_keys.hpp"

namespace rift {
namespace {

using Catch::Matchers::Contains;
using test::CountOf;
using test::Environment;
using test::ProcessResult;
using test::Succeeds;

const std::string kData = test::SourceDir() + "/data/camera";

TEST_CASE("Waypoints clicked in the window drive the simulator as they are") {
  const test::VirtualDisplay server;
  if (!server.Runs() || !Succeeds("command -v xdotool")) {
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
                            "--record-waypoints", waypoints, "--set", "track.capture.silent_s=60"});
    {
      const Environment none("LD_PRELOAD", "");
      const std::string window = "xdotool search --onlyvisible --name '^rift track$' ";
      rift.WaitUntil("the window shows a picture", [&] {
        return Succeeds("test $(" + window + "getwindowgeometry --shell | " +
                        "sed -n s/^HEIGHT=//p) -gt 300");
      });
      // Each click and key but the last changes the file.
      const auto saved = [&] {
        return std::filesystem::exists(waypoints) ? test::ReadFile(waypoints) : "";
      };
      const auto act = [&](const std::string& what, const auto& is_saved) {
        INFO(what);
        REQUIRE(Succeeds(window + what));
        rift.WaitUntil(what + " is saved", is_saved);
      };
      const std::vector<std::string> places{"120 300", "320 260", "500 100", "520 220"};
      for (std::size_t i = 0; i < places.size(); ++i) {
        act("mousemove --window %1 " + places[i] + " click 1",
            [&] { return CountOf("name:", saved()) == static_cast<int>(i) + 1; });
      }
      act("windowfocus --sync %1 key u", [&] { return CountOf("name:", saved()) == 3; });
      act("windowfocus --sync %1 key s", [&] { return CountOf("stop: false", saved()) == 1; });
      REQUIRE(Succeeds(window + "windowfocus --sync %1 key q"));
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
