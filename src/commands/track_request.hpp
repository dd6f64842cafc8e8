#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rift/vision/calibration/chessboard.hpp"
#include "track_session.hpp"

namespace rift::commands {

/// What `rift track` was asked for.
struct TrackRequest {
  std::string experiment;
  std::vector<std::string> overrides;
  std::string camera;
  std::string calibration;
  std::string out;
  std::string world;  ///< "first", or a file with tags or points
  std::string path;
  std::string record_waypoints;
  std::optional<double> fps;
  std::optional<double> duration_s;
  bool view = false;

  SessionOptions session;

  bool calibrate = false;
  vision::Board board;
  std::string images;
  std::string picture;
};

}  // namespace rift::commands
