#include <dlfcn.h>
#include <fmt/format.h>

#include <stdexcept>

#include "rift/vision/module.hpp"

namespace rift::vision {
namespace {

constexpr const char* kModule = "lib/rift/librift_vision.so";

// NODELETE: Qt, OpenCV and a capture thread that hangs in a driver must keep their code.
void* Open(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) {
    throw std::runtime_error(
        fmt::format("the camera needs {}, which is not there: install libopencv-dev and build rift "
                    "again",
                    path.string()));
  }
  void* module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (module == nullptr) {
    throw std::runtime_error(fmt::format("cannot load the camera side: {}", dlerror()));
  }
  return module;
}

}  // namespace

std::filesystem::path VisionModulePath() {
  const auto folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const auto in_build = folder / kModule;
  return std::filesystem::exists(in_build) ? in_build : folder.parent_path() / kModule;
}

std::unique_ptr<Vision> LoadVision(const std::filesystem::path& path) {
  void* symbol = dlsym(Open(path), kMakeVisionSymbol);
  if (symbol == nullptr) {
    throw std::runtime_error(fmt::format(
        "{} belongs to another version of rift: build and install both together", path.string()));
  }
  return std::unique_ptr<Vision>(reinterpret_cast<Vision* (*)()>(symbol)());
}

}  // namespace rift::vision
