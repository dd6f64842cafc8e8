#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "rift/files/append_file.hpp"
#include "rift/hardware/real_robot.hpp"

namespace rift::sessions {

/// What a drive has recorded since it was last written.
struct DriveRows {
  std::string trajectory;  ///< rows of trajectory.csv
  std::string commands;    ///< rows of commands.csv
  hardware::DriveNews news;
  bool is_first = false;  ///< none, before the robot moves: the files are wanted
  bool is_last = false;
};

/// The growing files of a run folder: trajectory.csv, commands.csv, stages.csv, encoders.csv, and a
/// summary.json that says interrupted until somebody replaces it.
class DriveFiles {
 public:
  DriveFiles(std::filesystem::path folder, std::string interrupted_summary);
  /// Removes what it made when no row and no end of a drive came.
  ~DriveFiles();
  DriveFiles(const DriveFiles&) = delete;
  DriveFiles& operator=(const DriveFiles&) = delete;

  /// Appends and syncs; makes the files the first time that they are wanted. Counts
  /// `progress` up after each of its steps, any of which may block. Throws std::runtime_error.
  void Write(const DriveRows& rows, std::atomic<unsigned>& progress);

 private:
  void Make();

  std::filesystem::path folder_;
  std::string interrupted_summary_;
  bool is_a_run_ = false;
  std::vector<std::filesystem::path> made_;
  std::vector<std::unique_ptr<files::AppendFile>> files_;
};

/// Puts a drive on disk while it goes on: a thread writes every 0.25 s what came in since. The
/// caller never waits for the disk. When the thread cannot write, or stands still for four, the
/// drive is stopped.
class DriveLog : public hardware::DriveObserver {
 public:
  /// As DriveFiles::Write; called by the thread.
  using Write = std::function<void(const DriveRows&, std::atomic<unsigned>& progress)>;

  explicit DriveLog(Write write);
  /// Writes what waits, if the disk lets it.
  ~DriveLog() override;

  void Row(const trajectory::StampedPose& pose, std::span<const double> channels) override;
  void Sent(const trial::SentCommand& command) override;
  void Recorded(const hardware::DriveNews& news) override;

  /// Whether the files are there, so that a robot may move; to be asked again and again, and does
  /// not wait. Where they cannot be made the stopper says so.
  bool IsReady();
  /// Why the drive must stop; to be asked often.
  hardware::Stopper Stopper();
  /// Once, after the drive: writes the rest of `evidence` and ends the thread. Returns why the
  /// files are not whole; empty when they are.
  std::string Close(const hardware::DriveRecord& evidence);

 private:
  struct Shared;

  static void Run(const std::shared_ptr<Shared>& shared);
  template <class Add>
  void Hand(const Add& add);
  std::optional<std::pair<hardware::StopReason, std::string>> Stop();
  bool End();

  std::shared_ptr<Shared> shared_;  ///< the thread's as well, which a dead disk may hold for ever
  std::thread thread_;
  size_t poses_told_ = 0;
  size_t encoders_told_ = 0;
  unsigned progress_seen_ = 0;  // these three: the thread that asks the stopper alone
  double stuck_s_ = 0.0;
  std::optional<std::chrono::steady_clock::time_point> asked_;
};

}  // namespace rift::sessions
