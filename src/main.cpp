#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "rift/commands/command.hpp"

namespace {

/// Goes on as the program rift-camera, which links OpenCV, with the same arguments: it lies in
/// lib/rift beside this program (build tree) or beside its folder (install tree). Throws
/// std::runtime_error, saying what to do, when it is not there or cannot be run.
[[noreturn]] void RunCameraProgram(char** argv) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::read_symlink("/proc/self/exe").parent_path();
  const fs::path relative = "lib/rift/rift-camera";
  const fs::path in_build = folder / relative;
  const fs::path program = fs::exists(in_build) ? in_build : folder.parent_path() / relative;
  if (!fs::exists(program)) {
    throw std::runtime_error(fmt::format(
        "cameras, windows and videos need the program {}, which is not there: build and install "
        "rift again, with its OpenCV packages (./bootstrap install)",
        program.string()));
  }
  ::execv(program.c_str(), argv);
  throw std::runtime_error(fmt::format("cannot run {}: {}", program.string(), strerror(errno)));
}

}  // namespace

/// The program rift: what needs a camera, a window or a video is left to rift-camera.
// NOLINTNEXTLINE(bugprone-exception-escape): RunCommandLine tells what is thrown.
int main(int argc, char** argv) {
  const auto camera_program = [argv](const auto&) -> int { RunCameraProgram(argv); };
  return rift::commands::RunCommandLine(
      argc, argv, {.track = camera_program, .drive = camera_program, .simulate = camera_program});
}
