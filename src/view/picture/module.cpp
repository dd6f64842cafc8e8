#include "rift/module/display.hpp"
#include "rift/view/viewer.hpp"
#include "video.hpp"
#include "window.hpp"

namespace rift::view {
namespace {

class OpenCvViewer : public Viewer {
 public:
  std::string MissingDisplay() const override { return module::MissingDisplay(); }
  void PlayInWindow(const Film& film, const ViewOptions& options) override {
    view::PlayInWindow(film, options);
  }
  void WriteVideo(const Film& film, const std::filesystem::path& path,
                  const ViewOptions& options) override {
    view::WriteVideo(film, path, options);
  }
};

}  // namespace
}  // namespace rift::view

// Its name is kMakeViewerSymbol of module_interface.hpp, where the number is explained.
extern "C" [[gnu::visibility("default")]] rift::view::Viewer* rift_view_make_viewer_1() {
  return new rift::view::OpenCvViewer;
}
