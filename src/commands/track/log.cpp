#include "log.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "rift/report/json/json.hpp"
#include "rift/terminal/print.hpp"

namespace rift::commands {
namespace {

constexpr double kFlushEvery_s = 0.5;

}  // namespace

void TrackLog::Open() {
  if (path_.has_parent_path()) std::filesystem::create_directories(path_.parent_path());
  errno = 0;
  file_.open(path_);
  if (!file_) {
    throw std::runtime_error(fmt::format("cannot write {}: {}", path_.string(), strerror(errno)));
  }
  file_ << report::SightingsHeader();
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
  if (!file_.is_open()) Open();
  file_ << report::SightingRow(t_s, sighting);
  if (t_s - flushed_t_s_ < kFlushEvery_s) return true;
  flushed_t_s_ = t_s;
  file_.flush();
  if (!file_) throw std::runtime_error(fmt::format("cannot write {}: disk full?", path_.string()));
  return true;
}

void TrackLog::Close() {
  if (!file_.is_open()) return;
  file_.close();
  if (!file_) throw std::runtime_error(fmt::format("cannot write {}: disk full?", path_.string()));
}

}  // namespace rift::commands
