#include "rift/commands/camera_program.hpp"
#include "rift/commands/command.hpp"

/// The program rift: what needs a camera, a window or a video is left to rift-camera.
int main(int argc, char** argv) {
  const auto camera_program = [argv](const auto&) -> int {
    rift::commands::RunCameraProgram(argv);
  };
  return rift::commands::RunCommandLine(
      argc, argv, {.track = camera_program, .drive = camera_program, .simulate = camera_program});
}
