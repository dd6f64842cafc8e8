#pragma once

#include <filesystem>
#include <fstream>
#include <map>

#include "rift/vision/tracking/tag_tracker.hpp"

namespace rift::commands {

/// Writes sightings as they come in the rift dialect, so that what was seen until a power cut is
/// there; the file appears with the first of them.
class TrackLog {
 public:
  /// "-" is stdout.
  explicit TrackLog(std::filesystem::path path) : path_(std::move(path)), is_piped_(path_ == "-") {}

  /// `t_s` must be later than that of the row before of the same tag; a sighting at or before it is
  /// left out.
  /// Throws std::runtime_error when the file cannot be written.
  bool Add(double t_s, const vision::Sighting& sighting);
  void Close();

 private:
  void Open();
  void Print(double t_s, const vision::Sighting& sighting);

  std::filesystem::path path_;
  bool is_piped_;
  bool has_header_ = false;  // on stdout
  std::ofstream file_;
  std::map<int, double> last_t_s_;  // by tag
  double flushed_t_s_ = 0.0;
};

}  // namespace rift::commands
