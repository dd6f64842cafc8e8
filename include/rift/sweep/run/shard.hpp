#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rift/sweep/run/journal.hpp"

namespace rift::sweep {

/// What a shard computes: a list of trials, or something that asks for its trials by itself, one
/// after the other, and is run in one process with its workers.
enum class ShardKind { kTrials, kSweep, kShrink, kRareEvent, kCalibration };

inline std::span<const std::string_view> EnumNames(ShardKind) {
  static constexpr std::array<std::string_view, 5> kNames{"trials", "sweep", "shrink", "rare event",
                                                          "calibration"};
  return kNames;
}

/// A part of a sweep that another process computes, on another machine, into a journal of its own.
/// It may be computed twice: the rows are the same.
struct Shard {
  std::string facts;       ///< HashOf the facts of the sweep's journal
  std::string experiment;  ///< hash of the resolved experiment, run options included
  ShardKind kind = ShardKind::kTrials;
  std::string keys;  ///< KeysHash of its trials, or of what a calibration reads
  int paths = 0;     ///< how many of its first trials keep their path
  /// As the runner of trials encodes them; of kShrink the row that fails.
  std::vector<std::string> requests;
};

/// As bytes for another process of the same build on the same kind of machine.
std::string EncodeShard(const Shard& shard);
/// Throws std::runtime_error, naming the file that they are from, for other bytes.
Shard DecodeShard(std::string_view bytes, const std::string& file);
/// Shards with the same content have the same name, others have others.
std::string ShardName(const std::string& encoded);

/// Grows into one hash of keys in their order.
class KeysHash {
 public:
  void Add(const std::string& key);
  const std::string& Text() const { return text_; }

 private:
  std::string text_;
};

/// Of `count` items in a row, those of each shard: every shards-th, so that shards cost the same
/// where neighbours do. No shard is empty.
std::vector<std::vector<size_t>> DealOut(size_t count, size_t shards);

/// Where the journal of a shard stands when it is done, and while it is not.
std::filesystem::path ShardJournal(const std::filesystem::path& out, const std::string& name);
std::filesystem::path UnfinishedShardJournal(const std::filesystem::path& out,
                                             const std::string& name);

/// Copies a file so that the target is at every moment the old one or the new one, whole and on the
/// disk, whoever else copies there at the same time. Throws std::runtime_error, also when the
/// folder is not there.
void PublishFile(const std::filesystem::path& file, const std::filesystem::path& target);

}  // namespace rift::sweep
