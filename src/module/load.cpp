#include "rift/module/load.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <stdexcept>

namespace rift::module {

std::filesystem::path PathOf(const std::string& file) {
  const auto folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const auto relative = std::filesystem::path("lib/rift") / file;
  const auto in_build = folder / relative;
  return std::filesystem::exists(in_build) ? in_build : folder.parent_path() / relative;
}

void* Load(const std::filesystem::path& path, const char* symbol, const std::string& needed_by) {
  if (!std::filesystem::exists(path)) {
    throw std::runtime_error(
        fmt::format("{} {}, which is not there: install libopencv-dev and build rift again",
                    needed_by, path.string()));
  }
  // NODELETE: Qt, OpenCV and a capture thread that hangs in a driver must keep their code.
  void* const module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (module == nullptr) {
    throw std::runtime_error(fmt::format("cannot load a module of rift: {}", dlerror()));
  }
  void* const found = dlsym(module, symbol);
  if (found == nullptr) {
    throw std::runtime_error(fmt::format(
        "{} belongs to another version of rift: build and install both together", path.string()));
  }
  return found;
}

}  // namespace rift::module
