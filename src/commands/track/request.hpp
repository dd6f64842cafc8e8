#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "rift/commands/arguments/arguments.hpp"
#include "rift/sessions/track/tracking.hpp"
#include "rift/vision/calibration/chessboard.hpp"

namespace rift::commands {

/// What `rift track` was asked for.
struct TrackRequest {
  std::string experiment;
  std::vector<std::string> overrides;
  sessions::TrackingJob job;  ///< but for its options
  std::string out;
  LogCopies copies;
  bool check = false;  ///< what precision is to be expected

  bool calibrate = false;
  vision::Board board;
  std::string images;
  std::string picture;

  std::string print_tag;    ///< a sheet to be printed
  std::string print_board;  ///< the same

  bool IsPrinting() const { return !print_tag.empty() || !print_board.empty(); }
  /// The log goes to stdout, and nothing beside it.
  bool IsPiped() const { return out == "-"; }

  /// Throws std::invalid_argument for what is missing or does not go together, and for a log that
  /// is no file, an input, a picture of the camera or another output.
  void Check() const;
};

/// Where the picture of a calibration goes.
std::filesystem::path PictureOf(const TrackRequest& request);
/// Where that of a refused one goes, `cam.refused.png` unless it was named: in the way of no later
/// calibration.
std::filesystem::path RefusedPictureOf(const TrackRequest& request);

}  // namespace rift::commands
