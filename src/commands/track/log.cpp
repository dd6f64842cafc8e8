#include "log.hpp"

#include <fmt/format.h>

#include <cstring>
#include <stdexcept>
#include <utility>

#include "rift/report/json/json.hpp"
#include "rift/terminal/print.hpp"

namespace rift::commands {
namespace {

constexpr double kFlushEvery_s = 0.5;

}  // namespace

TrackLog::~TrackLog() {
  try {
    Close();
  } catch (const std::runtime_error&) {
    // Only while another error, which is the one to be told, unwinds.
  }
}

void TrackLog::Open() {
  if (path_.has_parent_path()) std::filesystem::create_directories(path_.parent_path());
  file_.emplace(path_);
  waiting_ = report::SightingsHeader();
}

/// Each row at once: whoever reads the pipe follows the robot.
void TrackLog::Print(double t_s, const vision::Sighting& sighting) {
  if (!has_header_) terminal::PrintData(report::SightingsHeader());
  has_header_ = true;
  terminal::PrintData(report::SightingRow(t_s, sighting));
  if (const int error = terminal::FlushResults(); error != 0) {
    throw std::runtime_error(fmt::format("cannot write to stdout: {}", strerror(error)));
  }
}

bool TrackLog::Add(double t_s, const vision::Sighting& sighting) {
  const auto [last, is_first] = last_t_s_.try_emplace(sighting.tag_id, t_s);
  if (!is_first && t_s <= last->second) return false;
  last->second = t_s;
  if (is_piped_) {
    Print(t_s, sighting);
    return true;
  }
  if (!file_) Open();
  waiting_ += report::SightingRow(t_s, sighting);
  if (t_s - flushed_t_s_ < kFlushEvery_s) return true;
  flushed_t_s_ = t_s;
  Flush();
  return true;
}

void TrackLog::Flush() {
  file_->RequireInPlace();
  file_->Append(std::exchange(waiting_, {}));
}

void TrackLog::Close() {
  if (!file_) return;
  Flush();
  file_->Sync();
  file_.reset();
}

}  // namespace rift::commands
