#include "rift/view/viewer.hpp"
#include "rift/module/display.hpp"
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

std::unique_ptr<Viewer> LoadViewer() { return std::make_unique<OpenCvViewer>(); }

}  // namespace rift::view
