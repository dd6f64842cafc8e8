#include <sys/wait.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdio>
#include <filesystem>
#include <string>

#include "support/processes/process.hpp"
#include "support/tree.hpp"
#include "support/until.hpp"

namespace rift {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;

const std::string kWaypoints = test::SourceDir() + "/configs/waypoints/paper.yaml";
const std::string kCamera = test::SourceDir() + "/data/camera/camera.yaml";

/// The program rift in a folder where the test says what lies beside it.
struct Installed {
  explicit Installed(const std::string& place) : rift(folder / place) {
    fs::create_directories(rift.parent_path());
    fs::copy_file(test::RiftBinary(), rift);
  }

  /// A program that says what it was asked and ends with 7.
  void PutCameraProgram() const {
    const std::string program = folder / "lib/rift/rift-camera";
    test::WriteText(program, "#!/bin/sh\necho \"camera: $*\"\nexit 7\n");
    fs::permissions(program, fs::perms::owner_all);
  }
  /// stdout and stderr together.
  test::ProcessResult Run(const std::string& arguments) const {
    test::ProcessResult result;
    const std::string command = "cd " + folder.Path().string() + " && timeout " +
                                std::to_string(test::kGiveUp.count()) + " " + rift.string() + " " +
                                arguments + " 2>&1 </dev/null";
    FILE* pipe = popen(command.c_str(), "r");
    REQUIRE(pipe != nullptr);
    for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) {
      result.out += static_cast<char>(c);
    }
    const int status = pclose(pipe);
    result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return result;
  }

  test::TemporaryFolder folder;
  fs::path rift;
};

const std::vector<std::string> kCameraUses{
    "track --camera /dev/video9 --calibration " + kCamera + " --out log.csv",
    "track --calibrate --images photos --out cam.yaml",
    "drive " + kWaypoints + " --port /dev/x --camera /dev/video9 --calibration " + kCamera,
    "drive --ping --port /dev/x",
    "simulate " + kWaypoints + " --video run.mp4 --out run",
    "simulate " + kWaypoints + " --view --out run",
    "simulate " + kWaypoints + " --twin --out run"};

TEST_CASE("What needs a camera or a window goes on as rift-camera with the same arguments") {
  const std::string place = GENERATE("rift", "bin/rift");
  const Installed installed(place);
  installed.PutCameraProgram();
  for (const std::string& arguments : kCameraUses) {
    const test::ProcessResult result = installed.Run(arguments);
    CHECK(result.out == "camera: " + arguments + "\n");
    CHECK(result.exit_code == 7);
  }
}

TEST_CASE("A camera program that is not there is named in one line that says what to do") {
  const Installed installed("rift");
  for (const std::string& arguments : kCameraUses) {
    const test::ProcessResult result = installed.Run(arguments);
    INFO(arguments);
    CHECK(result.exit_code == 3);
    CHECK_THAT(result.out, Catch::StartsWith("rift: cameras, windows and videos need") &&
                               Contains("lib/rift/rift-camera, which is not there") &&
                               EndsWith("(./bootstrap install)\n"));
    CHECK(std::count(result.out.begin(), result.out.end(), '\n') == 1);
  }
  CHECK_FALSE(fs::exists(installed.folder / "run"));
}

TEST_CASE("Help, wrong usage and a plain simulation need no camera program") {
  const Installed installed("rift");
  for (const char* help : {"--help", "--version", "track --help", "drive --help",
                           "simulate --view --help", "track --keys"}) {
    INFO(help);
    CHECK(installed.Run(help).exit_code == 0);
  }
  CHECK_THAT(installed.Run("track --help").out, Contains("--calibration CAM.yaml"));
  for (const auto& [arguments, says] :
       {std::pair{"track", "--camera is missing"},
        {"track --calibrate", "--images DIR or --camera"},
        {"track --no-such-flag", "--no-such-flag"},
        {"drive --port /dev/x", "EXPERIMENT is missing"},
        {"drive --ping", "--port is missing"},
        {"simulate --twin --video run.mp4", "--video excludes --twin"}}) {
    const test::ProcessResult result = installed.Run(arguments);
    INFO(arguments << ": " << result.out);
    CHECK(result.exit_code == 2);
    CHECK_THAT(result.out, Contains(says));
  }
  CHECK(installed.Run("simulate " + kWaypoints + " --seed 7 --out run").exit_code == 0);
}

}  // namespace
}  // namespace rift
