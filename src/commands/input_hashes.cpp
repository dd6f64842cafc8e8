#include "input_hashes.hpp"

#include <fmt/format.h>

#include "files.hpp"
#include "rift/statistics/hash.hpp"

namespace rift::commands {

void InputHashes::Add(const std::string& path) {
  hash_of_[path] = statistics::Hash128Text(ReadFile(path));
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
