#include "rift/commands/command.hpp"

namespace rift::commands {

std::vector<Command> Commands(const CameraUses& camera) {
  return {
      {"simulate", "Drive the simulated robot through a waypoint task",
       [camera](CLI::App& app, int& exit_code) { AddSimulate(app, exit_code, camera); }},
      {"track", "Track the robot's tag with a camera, or calibrate the camera",
       [camera](CLI::App& app, int& exit_code) { AddTrack(app, exit_code, camera); }},
      {"drive", "Drive the real robot through a waypoint task, or measure its radio link",
       [camera](CLI::App& app, int& exit_code) { AddDrive(app, exit_code, camera); }},
      {"gap", "Measure the Sim-to-Real gap of trajectories", AddGap},
      {"sweep", "Find where in a parameter space the gap is too large, and why", AddSweep},
  };
}

}  // namespace rift::commands
