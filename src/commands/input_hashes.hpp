#pragma once

#include <map>
#include <string>

namespace rift::commands {

/// Fingerprints of the files a run was made from: changed inputs show.
class InputHashes {
 public:
  void Add(const std::string& path);
  /// Of a file that was added; empty for any other.
  std::string Of(const std::string& path) const;
  /// `hash  path` a line, sorted by path; 128-bit XXH3 in hexadecimal, as `xxhsum -H2` prints it.
  std::string Text() const;

 private:
  std::map<std::string, std::string> hash_of_;
};

}  // namespace rift::commands
