#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "rift/view/film.hpp"
#include "rift/view/options.hpp"

namespace rift::view {

/// Shows films. Its code lives in a module of its own, since OpenCV's windows and codecs would cost
/// every start of rift 0.12 s.
class Viewer {
 public:
  virtual ~Viewer() = default;

  /// Why no window can be opened here, in one line for people; empty when one can.
  virtual std::string MissingDisplay() const = 0;
  /// Plays the film in a window until it is over or the user leaves. Throws std::runtime_error with
  /// MissingDisplay() where that is not empty.
  virtual void PlayInWindow(const Film& film, const ViewOptions& options) = 0;
  /// An H.264 file, named so only once it is whole. Throws std::runtime_error when it cannot be
  /// written, std::invalid_argument when the name does not end in .mp4.
  virtual void WriteVideo(const Film& film, const std::filesystem::path& path,
                          const ViewOptions& options) = 0;
};

std::unique_ptr<Viewer> LoadViewer();

}  // namespace rift::view
