#include "log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <stdexcept>

#include "rift/files/files.hpp"
#include "rift/odometry/odometry.hpp"
#include "rift/report/json/json.hpp"
#include "rift/trajectory/log.hpp"

namespace rift::sessions {
namespace {

using std::chrono::duration;
using std::chrono::steady_clock;

constexpr std::chrono::milliseconds kEvery{250};
constexpr std::chrono::seconds kLongestEnd{5};
// A disk that others keep busy answers a sync after a second or two; rows wait in memory meanwhile.
constexpr double kLongestWrite_s = 4.0;
constexpr double kLongestTurn_s = 0.05;  // of the link; longer ones are a standstill of rift itself

}  // namespace

DriveFiles::DriveFiles(std::filesystem::path folder, std::string interrupted_summary)
    : folder_(std::move(folder)), interrupted_summary_(std::move(interrupted_summary)) {}

DriveFiles::~DriveFiles() {
  if (is_a_run_) return;
  try {
    for (const auto& file : files_) file->RequireInPlace();
  } catch (const std::runtime_error&) {
    return;  // what has these names now is somebody else's
  }
  std::error_code stays;
  for (const std::filesystem::path& path : made_) std::filesystem::remove(path, stays);
}

void DriveFiles::Make() {
  if (!std::filesystem::is_directory(folder_)) {
    throw std::runtime_error(
        fmt::format("{} was removed or moved before the drive began", folder_.string()));
  }
  files::WriteFile(folder_ / "summary.json", interrupted_summary_);
  made_.push_back(folder_ / "summary.json");
  const std::pair<const char*, std::string> headers[]{
      {"trajectory.csv", trajectory::WriteRift({{}, trial::RecordedChannels()})},
      {"commands.csv", report::CommandsCsv({})},
      {"stages.csv", report::StagesCsv({})},
      {"encoders.csv", odometry::EncodersHeader()}};
  for (const auto& [name, header] : headers) {
    files_.push_back(std::make_unique<files::AppendFile>(folder_ / name));
    made_.push_back(folder_ / name);
    files_.back()->Append(header);
  }
}

void DriveFiles::Write(const DriveRows& rows, std::atomic<unsigned>& progress) {
  const bool is_empty = rows.trajectory.empty() && rows.commands.empty() && rows.news.poses.empty();
  if (files_.empty() && is_empty && !rows.is_first && !rows.is_last) return;
  if (!is_empty || rows.is_last) is_a_run_ = true;
  if (files_.empty()) Make();
  std::string stages;
  for (const hardware::PoseStages& pose : rows.news.poses) stages += report::StagesRow(pose);
  std::string encoders;
  for (const odometry::EncoderReading& reading : rows.news.encoders) {
    encoders += odometry::EncodersRow(reading);
  }
  const std::string* const texts[]{&rows.trajectory, &rows.commands, &stages, &encoders};
  for (size_t i = 0; i < files_.size(); ++i) {
    files_[i]->RequireInPlace();
    files_[i]->Append(*texts[i]);
    ++progress;
  }
  for (size_t i = 0; i < files_.size(); ++i) {
    if (!texts[i]->empty()) files_[i]->Sync();
    ++progress;
  }
}

struct DriveLog::Shared {
  explicit Shared(Write write_rows) : write(std::move(write_rows)) {}

  Write write;
  std::atomic<unsigned> progress = 0;
  std::atomic<bool> has_failed = false;  ///< after it `failure` stays as it is
  std::mutex mutex;
  std::condition_variable changed;
  DriveRows waiting;
  std::string failure;
  bool is_wanted = false;  ///< its files are, before there is a row
  bool is_ready = false;   ///< they are there
  bool is_ending = false;
  bool is_over = false;
};

DriveLog::DriveLog(Write write) : shared_(std::make_shared<Shared>(std::move(write))) {
  thread_ = std::thread([shared = shared_] { Run(shared); });
}

DriveLog::~DriveLog() {
  if (thread_.joinable()) End();
}

void DriveLog::Run(const std::shared_ptr<Shared>& shared) {
  for (bool is_over = false; !is_over;) {
    DriveRows rows;
    {
      std::unique_lock lock(shared->mutex);
      const auto is_urgent = [&] {
        return shared->is_ending || (shared->is_wanted && !shared->is_ready);
      };
      shared->changed.wait_for(lock, kEvery, is_urgent);
      std::swap(rows, shared->waiting);
      rows.is_first = shared->is_wanted && !shared->is_ready;
      is_over = shared->is_ending;
    }
    try {
      shared->write(rows, shared->progress);
      if (rows.is_first) {
        const std::lock_guard lock(shared->mutex);
        shared->is_ready = true;
      }
    } catch (const std::exception& error) {
      shared->failure = error.what();
      shared->has_failed = is_over = true;
    }
    ++shared->progress;
  }
  const std::lock_guard lock(shared->mutex);
  shared->is_over = true;
  shared->changed.notify_all();
}

template <class Add>
void DriveLog::Hand(const Add& add) {
  const std::lock_guard lock(shared_->mutex);
  add(shared_->waiting);
}

void DriveLog::Row(const trajectory::StampedPose& pose, std::span<const double> channels) {
  const std::string row = trajectory::RiftRow(pose, channels);
  Hand([&](DriveRows& rows) { rows.trajectory += row; });
}

void DriveLog::Sent(const trial::SentCommand& command) {
  const std::string row = report::CommandsRow(command);
  Hand([&](DriveRows& rows) { rows.commands += row; });
}

void DriveLog::Recorded(const hardware::DriveNews& news) {
  poses_told_ += news.poses.size();
  encoders_told_ += news.encoders.size();
  Hand([&](DriveRows& rows) {
    rows.news.poses.insert(rows.news.poses.end(), news.poses.begin(), news.poses.end());
    rows.news.encoders.insert(rows.news.encoders.end(), news.encoders.begin(), news.encoders.end());
  });
}

bool DriveLog::IsReady() {
  const std::lock_guard lock(shared_->mutex);
  if (!std::exchange(shared_->is_wanted, true)) shared_->changed.notify_all();
  return shared_->is_ready;
}

hardware::Stopper DriveLog::Stopper() {
  return [this] { return Stop(); };
}

std::optional<std::pair<hardware::StopReason, std::string>> DriveLog::Stop() {
  const auto failed = [](const std::string& why) {
    return std::pair(hardware::StopReason::kLogFailed, why);
  };
  if (shared_->has_failed) return failed(shared_->failure);
  const auto now = steady_clock::now();
  const double turn_s = asked_ ? duration<double>(now - *asked_).count() : 0.0;
  asked_ = now;
  const unsigned progress = shared_->progress;
  stuck_s_ = progress == progress_seen_ ? stuck_s_ + std::min(turn_s, kLongestTurn_s) : 0.0;
  progress_seen_ = progress;
  if (stuck_s_ <= kLongestWrite_s) return std::nullopt;
  return failed(fmt::format("the log has not been written for {:.1f} s", stuck_s_));
}

bool DriveLog::End() {
  bool is_over = false;
  {
    std::unique_lock lock(shared_->mutex);
    shared_->is_ending = true;
    shared_->changed.notify_all();
    is_over = shared_->changed.wait_for(lock, kLongestEnd, [&] { return shared_->is_over; });
  }
  is_over ? thread_.join() : thread_.detach();
  return is_over;
}

std::string DriveLog::Close(const hardware::DriveRecord& evidence) {
  const auto after = [](const auto& all, size_t told) {
    return std::vector(all.begin() + std::min(told, all.size()), all.end());
  };
  Recorded({after(evidence.poses, poses_told_), after(evidence.encoders, encoders_told_)});
  Hand([](DriveRows& rows) { rows.is_last = true; });
  if (!End()) return fmt::format("its disk has not answered for {} s", kLongestEnd.count());
  return shared_->failure;
}

}  // namespace rift::sessions
