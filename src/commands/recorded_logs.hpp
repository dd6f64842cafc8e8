#pragma once

#include <map>
#include <string>

#include "input_hashes.hpp"
#include "rift/sweep/falsify/grid_sweep.hpp"
#include "rift/trajectory/log.hpp"

namespace rift::commands {

/// Logs from files, each read once however many trials it takes part in.
class RecordedLogs {
 public:
  /// `format_key` is what the user sets to tell the dialect ("reference.format"), for messages.
  RecordedLogs(trajectory::Format format, double tag_offset_m, std::string format_key)
      : format_(format), tag_offset_m_(tag_offset_m), format_key_(std::move(format_key)) {}

  /// A missing or bad log has its status and reason.
  const sweep::Recording& At(const std::string& path);
  const InputHashes& Hashes() const { return hashes_; }

 private:
  sweep::Recording Load(const std::string& path);

  trajectory::Format format_;
  double tag_offset_m_;
  std::string format_key_;
  InputHashes hashes_;
  std::map<std::string, sweep::Recording> recordings_;
};

}  // namespace rift::commands
