#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "rift/sweep/falsify/result.hpp"
#include "rift/trajectory/read_options.hpp"

namespace rift::sweep {

/// A trajectory as a sweep gets it, or why there is none.
struct Recording {
  TrialStatus status = TrialStatus::kOk;
  std::string reason;
  std::string source;  ///< a file, or what made it
  trajectory::Trajectory trajectory;
  std::vector<std::string> doubts{};           ///< trajectory::Log::doubts
  std::optional<trial::LimitCounts> limits{};  ///< what its controller asked for, where known
  double left_m = gap::kNotComputed;           ///< see TrialRow
};

/// What computation needs of the world around it: files and somebody to tell.
struct Inputs {
  /// The bytes of a file; nothing when there is no such file. Throws std::invalid_argument with the
  /// path and the reason when it cannot be read.
  std::function<std::optional<std::string>(const std::string& path)> read;
  /// Told what had to be mended in an input, one line each.
  std::function<void(const std::string& line)> note;
};

/// How the logs of one side are read.
struct LogOptions {
  trajectory::ReadOptions read;
  double tag_offset_m = 0.0;  ///< logs are moved so far forward along their yaw
  std::string format_key;     ///< what the user sets to tell the dialect ("reference.format")
  double grid_fps = 0.0;      ///< of trajectory::PutOnFrames; 0: stamps as logged
};

/// A log moved from the tag to the point `tag_offset_m` ahead of it, its stamps put back on frames;
/// where there are none the log's notes say so. Throws std::invalid_argument for text that breaks a
/// rule, and for an offset of a log whose yaw is not known.
trajectory::Log ReadMovedLog(const std::string& text, const std::string& path,
                             const LogOptions& options);

/// Logs from files, each read once however many trials it takes part in.
class RecordedLogs {
 public:
  RecordedLogs(Inputs inputs, LogOptions options)
      : inputs_(std::move(inputs)), options_(std::move(options)) {}

  /// A missing or bad log has its status and reason.
  const Recording& At(const std::string& path);
  /// Notes each log that was read and has the positions of another one, once.
  void NoteCopies();
  /// Fingerprint of a log that was read; empty for any other.
  std::string HashOf(const std::string& path) const;
  /// `hash  path` a line, sorted by path; 128-bit XXH3 in hexadecimal, as `xxhsum -H2` prints it.
  std::string HashesText() const;

 private:
  Recording Load(const std::string& path);

  Inputs inputs_;
  LogOptions options_;
  std::map<std::string, std::string> hash_of_;
  std::map<std::string, Recording> recordings_;
};

}  // namespace rift::sweep
