#include <dlfcn.h>
#include <fmt/format.h>

#include <memory>
#include <stdexcept>

#include "module_interface.hpp"
#include "rift/view/viewer.hpp"

namespace rift::view {
namespace {

constexpr const char* kModule = "lib/rift/librift_view.so";

struct Closer {
  void operator()(void* module) const { dlclose(module); }
};
using Module = std::unique_ptr<void, Closer>;

Module Open(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) {
    throw std::runtime_error(
        fmt::format("pictures of the moving robot need {}, which is not there: install "
                    "libopencv-dev and build rift again",
                    path.string()));
  }
  // NODELETE: Qt and OpenCV leave threads and exit handlers behind that must keep their code.
  Module module(dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE));
  if (!module) throw std::runtime_error(fmt::format("cannot load the viewer: {}", dlerror()));
  return module;
}

}  // namespace

std::filesystem::path ViewerModulePath() {
  const auto folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const auto in_build = folder / kModule;
  return std::filesystem::exists(in_build) ? in_build : folder.parent_path() / kModule;
}

std::unique_ptr<Viewer> LoadViewer(const std::filesystem::path& path) {
  const Module module = Open(path);
  void* symbol = dlsym(module.get(), kMakeViewerSymbol);
  if (symbol == nullptr) {
    throw std::runtime_error(fmt::format(
        "{} belongs to another version of rift: build and install both together", path.string()));
  }
  return std::unique_ptr<Viewer>(reinterpret_cast<Viewer* (*)()>(symbol)());
}

}  // namespace rift::view
