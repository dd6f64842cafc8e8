#pragma once

namespace rift::commands {

/// Goes on as the program rift-camera, which links OpenCV, with the same arguments: it lies in
/// lib/rift beside this program (build tree) or beside its folder (install tree). Throws
/// std::runtime_error, saying what to do, when it is not there or cannot be run.
[[noreturn]] void RunCameraProgram(char** argv);

}  // namespace rift::commands
