#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "rift/sessions/drive/plan.hpp"
#include "rift/sessions/drive/setup.hpp"

namespace rift::sessions {

/// Drives that belong together.
struct DriveSeries {
  std::filesystem::path out;  ///< its sweep.yaml says what they are for
  SeriesPlan plan;
  /// Words of the command to run before each drive, with names to be filled in; none: no command.
  std::vector<std::string> before_each;
  DriveSetup setup;
};

enum class SeriesEnd {
  kDone,
  kLeft,  ///< some did not reach the end and were left so
  /// It ended before the last one: by a person, by a fault where nobody is asked, or by a robot
  /// that did not acknowledge its stop; by that after the last one as well.
  kQuit,
};

/// Drives what is not done yet, asks about what was begun and not finished, writes sweep.yaml. A
/// drive that a key, the window or a signal stopped is the last one, and so is one whose stop the
/// robot did not acknowledge and, where nobody is asked and no command puts the scene back, one
/// that a fault stopped. After the last drive, with port and camera closed and the folder still
/// locked, `then` is called. Throws std::invalid_argument when the folder holds the drives of
/// another experiment.
SeriesEnd DriveAll(const DriveSeries& series, const Console& console,
                   const std::function<void()>& then);

}  // namespace rift::sessions
