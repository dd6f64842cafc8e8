#include "rift/sweep/run/shard.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "rift/files/descriptor.hpp"
#include "rift/statistics/hash.hpp"
#include "rift/sweep/run/byte_codec.hpp"

namespace rift::sweep {
namespace {

namespace fs = std::filesystem;

const std::string kLayout = "rift shard 2";

[[noreturn]] void CannotPublish(const fs::path& target, const std::string& reason) {
  throw std::runtime_error(fmt::format("cannot write {}: {}", target.string(), reason));
}

/// To the disk, not only to the memory of this machine: the job ends with its node's promise.
void Sync(const fs::path& path, int flags) {
  const files::Descriptor file(path, flags);
  if (!file.IsOpen() || ::fsync(file.Number()) != 0) CannotPublish(path, strerror(errno));
}

/// No other process on any machine makes the same.
std::string OwnSuffix() {
  std::string host(256, '\0');
  if (::gethostname(host.data(), host.size() - 1) != 0) host = "host";
  return fmt::format(".{}.{}.new", host.c_str(), ::getpid());
}

}  // namespace

std::string EncodeShard(const Shard& shard) {
  ByteWriter write;
  write(kLayout);
  write(shard.facts);
  write(shard.experiment);
  write(shard.kind);
  write(shard.keys);
  write(shard.paths);
  write(shard.requests);
  return write.Take();
}

Shard DecodeShard(std::string_view bytes, const std::string& file) {
  try {
    ByteReader read(bytes);
    std::string layout;
    read(layout);
    if (layout != kLayout) throw std::runtime_error("its layout is another");
    Shard shard;
    read(shard.facts);
    read(shard.experiment);
    read(shard.kind);
    read(shard.keys);
    read(shard.paths);
    read(shard.requests);
    if (!read.IsAtEnd()) throw std::runtime_error("there is more behind its end");
    return shard;
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format(
        "{} is no shard of a sweep that this version of rift wrote: {}", file, error.what()));
  }
}

std::string ShardName(const std::string& encoded) { return statistics::Hash128Text(encoded); }

void KeysHash::Add(const std::string& key) { text_ = statistics::Hash128Text(text_ + key); }

std::vector<std::vector<size_t>> DealOut(size_t count, size_t shards) {
  std::vector<std::vector<size_t>> dealt(std::min(count, std::max<size_t>(shards, 1)));
  for (size_t i = 0; i < count; ++i) dealt[i % dealt.size()].push_back(i);
  return dealt;
}

fs::path ShardJournal(const fs::path& out, const std::string& name) {
  return out / "shards" / (name + ".sqlite");
}

fs::path UnfinishedShardJournal(const fs::path& out, const std::string& name) {
  return out / "shards" / (name + ".part");
}

void PublishFile(const fs::path& file, const fs::path& target) {
  const fs::path beside = target.string() + OwnSuffix();
  std::error_code error;
  fs::copy_file(file, beside, fs::copy_options::overwrite_existing, error);
  if (error) CannotPublish(target, error.message());
  try {
    Sync(beside, O_RDWR);
    fs::rename(beside, target, error);
    if (error) CannotPublish(target, error.message());
    Sync(target.parent_path(), O_RDONLY | O_DIRECTORY);
  } catch (const std::runtime_error&) {
    fs::remove(beside, error);
    throw;
  }
}

}  // namespace rift::sweep
