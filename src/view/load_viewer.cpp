#include "module_interface.hpp"
#include "rift/module/load.hpp"
#include "rift/view/viewer.hpp"

namespace rift::view {

std::filesystem::path ViewerModulePath() { return module::PathOf("librift_view.so"); }

std::unique_ptr<Viewer> LoadViewer(const std::filesystem::path& path) {
  void* const make = module::Load(path, kMakeViewerSymbol, "pictures of the moving robot need");
  return std::unique_ptr<Viewer>(reinterpret_cast<Viewer* (*)()>(make)());
}

}  // namespace rift::view
