#include "rift/commands/camera_program.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace rift::commands {

namespace fs = std::filesystem;

void RunCameraProgram(char** argv) {
  const fs::path folder = fs::read_symlink("/proc/self/exe").parent_path();
  const fs::path relative = "lib/rift/rift-camera";
  const fs::path in_build = folder / relative;
  const fs::path program = fs::exists(in_build) ? in_build : folder.parent_path() / relative;
  if (!fs::exists(program)) {
    throw std::runtime_error(fmt::format(
        "cameras, windows and videos need the program {}, which is not there: build and install "
        "rift again, with libopencv-dev",
        program.string()));
  }
  ::execv(program.c_str(), argv);
  throw std::runtime_error(fmt::format("cannot run {}: {}", program.string(), strerror(errno)));
}

}  // namespace rift::commands
