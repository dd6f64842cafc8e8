#include "rift/view/video.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <opencv2/videoio.hpp>
#include <stdexcept>

#include "painter.hpp"

namespace rift::view {
namespace {

namespace fs = std::filesystem;

// Beside the target under another name until it is whole; removed when that never happens. It
// keeps the extension, by which FFmpeg chooses the container.
class PartFile {
 public:
  explicit PartFile(const fs::path& target)
      : target_(target),
        part_(fs::absolute(target).replace_extension(fmt::format(".{}.part.mp4", ::getpid()))) {}
  ~PartFile() {
    std::error_code ignored;
    fs::remove(part_, ignored);
  }
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  const fs::path& Path() const { return part_; }
  void Keep() const { fs::rename(part_, target_); }

 private:
  fs::path target_;
  fs::path part_;
};

void Encode(const Film& film, const fs::path& path, cv::Size size) {
  // H.264, which browsers play; they refuse the "mp4v" that OpenCV's examples use.
  cv::VideoWriter writer(path.string(), cv::CAP_FFMPEG, cv::VideoWriter::fourcc('a', 'v', 'c', '1'),
                         film.fps, size);
  if (!writer.isOpened()) {
    throw std::runtime_error(fmt::format(
        "cannot write {}: the folder is missing or not writable, or FFmpeg has no H.264 encoder",
        path.string()));
  }
  const Painter painter(film.fixed, size);
  for (const Scene& scene : film.scenes) writer.write(painter.Paint(scene));
}

// VideoWriter reports no failed write (a full disk), so the file is asked.
size_t PicturesIn(const fs::path& path) {
  cv::VideoCapture video(path.string(), cv::CAP_FFMPEG);
  return video.isOpened() ? static_cast<size_t>(video.get(cv::CAP_PROP_FRAME_COUNT)) : 0;
}

}  // namespace

void WriteVideo(const Film& film, const fs::path& path, const ViewOptions& options) {
  if (path.extension() != ".mp4") {
    throw std::invalid_argument("the video " + path.string() + " must have a name ending in .mp4");
  }
  const PartFile part(path);
  Encode(film, part.Path(), {options.width_px, options.height_px});
  const size_t written = PicturesIn(part.Path());
  if (written != film.scenes.size()) {
    throw std::runtime_error(
        fmt::format("cannot write {}: only {} of {} pictures are in it (is the "
                    "disk full?)",
                    path.string(), written, film.scenes.size()));
  }
  part.Keep();
}

}  // namespace rift::view
