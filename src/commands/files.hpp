#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace rift::commands {

/// The whole file. Throws std::invalid_argument with the path and the system's reason.
std::string ReadFile(const std::filesystem::path& path);

/// A file in pieces of whole lines, none of which is held longer than it takes to read it.
class LinesOfFile {
 public:
  /// Throws as ReadFile does, and so does Next().
  explicit LinesOfFile(const std::filesystem::path& path);
  ~LinesOfFile();

  /// The next lines, valid until the next call; empty at the end. The last may lack its end.
  std::string_view Next();
  /// Of the whole file; 0 for a pipe.
  size_t Size_bytes() const { return size_bytes_; }

 private:
  bool ReadOn();

  std::filesystem::path path_;
  std::unique_ptr<class Descriptor> file_;
  size_t size_bytes_ = 0;
  std::vector<char> buffer_;
  size_t used_ = 0;   ///< of the buffer
  size_t given_ = 0;  ///< of these, by the last call
  bool has_ended_ = false;
};

/// Writes beside the target and renames, so that the target is whole or absent; a pipe or a device
/// is written to as it is, and a link leads to its file. Missing parent folders are made. Throws
/// std::runtime_error with the path and the system's reason.
void WriteFile(const std::filesystem::path& target, std::string_view text);

/// `out`, or out/NAME where none was asked for. Throws std::invalid_argument when the name of an
/// experiment would lead elsewhere.
std::filesystem::path OutputOf(const std::string& out, const std::string& name);

}  // namespace rift::commands
