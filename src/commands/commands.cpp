#include "rift/commands/command.hpp"

namespace rift::commands {

const std::vector<Command>& Commands() {
  static const std::vector<Command> commands{
      {"simulate", "Drive the simulated robot through a waypoint task", AddSimulate},
      {"track", "Track the robot's tag with a camera, or calibrate the camera", AddTrack},
      {"drive", "Drive the real robot through a waypoint task, or measure its radio link",
       AddDrive},
      {"gap", "Measure the Sim-to-Real gap of trajectories", AddGap},
      {"sweep", "Find where in a parameter space the gap is too large, and why", AddSweep},
  };
  return commands;
}

}  // namespace rift::commands
