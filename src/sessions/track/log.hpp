#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "rift/files/append_file.hpp"
#include "rift/vision/tracking/tag_tracker.hpp"

namespace rift::sessions {

/// Writes sightings as they come in the rift dialect, so that what was seen until a power cut is
/// there; the file appears with the first of them.
class TrackLog {
 public:
  using Print = std::function<void(std::string_view rows)>;

  /// What goes to "-" is printed, each row at once.
  TrackLog(std::filesystem::path path, Print print)
      : path_(std::move(path)), print_(std::move(print)), is_piped_(path_ == "-") {}
  /// Writes what waits; what cannot be written is lost silently: call Close before.
  ~TrackLog();
  TrackLog(const TrackLog&) = delete;
  TrackLog& operator=(const TrackLog&) = delete;

  /// `t_s` must be later than that of the row before of the same tag; a sighting at or before it is
  /// left out.
  /// Throws std::runtime_error when the file cannot be written, or is no longer where it was made.
  bool Add(double t_s, const vision::Sighting& sighting);
  /// Throws as Add does.
  void Close();

 private:
  void Open();
  void Flush();

  std::filesystem::path path_;
  Print print_;
  bool is_piped_;
  bool has_header_ = false;  // printed
  std::optional<files::AppendFile> file_;
  std::string waiting_;             // rows to be written
  std::map<int, double> last_t_s_;  // by tag
  double flushed_t_s_ = 0.0;
};

}  // namespace rift::sessions
