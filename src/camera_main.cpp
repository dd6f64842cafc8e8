#include "rift/commands/command.hpp"
#include "rift/commands/drive/drive.hpp"
#include "rift/commands/track/track.hpp"

/// The program rift-camera: all of rift, with cameras, windows and videos.
int main(int argc, char** argv) {
  using namespace rift::commands;
  return RunCommandLine(argc, argv,
                        {.track = Track, .drive = Drive, .simulate = SimulateWithCamera});
}
