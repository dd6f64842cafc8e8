#include "input_hashes.hpp"

#include <fmt/format.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "files.hpp"

namespace rift::commands {

void InputHashes::Add(const std::string& path) {
  const std::string bytes = ReadFile(path);
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  hash_of_[path] = fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

std::string InputHashes::Of(const std::string& path) const {
  const auto found = hash_of_.find(path);
  return found == hash_of_.end() ? "" : found->second;
}

std::string InputHashes::Text() const {
  std::string text;
  for (const auto& [path, hash] : hash_of_) text += fmt::format("{}  {}\n", hash, path);
  return text;
}

}  // namespace rift::commands
