#include "log.hpp"

#include <stdexcept>

#include "rift/report/json/json.hpp"

namespace rift::sessions {
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

bool TrackLog::Add(double t_s, const vision::Sighting& sighting) {
  const auto [last, is_first] = last_t_s_.try_emplace(sighting.tag_id, t_s);
  if (!is_first && t_s <= last->second) return false;
  last->second = t_s;
  if (is_piped_) {
    const std::string header = has_header_ ? "" : report::SightingsHeader();
    has_header_ = true;
    print_(header + report::SightingRow(t_s, sighting));
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

}  // namespace rift::sessions
