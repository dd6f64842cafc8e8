#include "rift/module/load.hpp"
#include "rift/vision/module.hpp"

namespace rift::vision {

std::filesystem::path VisionModulePath() { return module::PathOf("librift_vision.so"); }

std::unique_ptr<Vision> LoadVision(const std::filesystem::path& path) {
  void* const make = module::Load(path, kMakeVisionSymbol, "the camera needs");
  return std::unique_ptr<Vision>(reinterpret_cast<Vision* (*)()>(make)());
}

}  // namespace rift::vision
