#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace rift::test {

/// What a finished process left behind.
struct ProcessResult {
  int exit_code = -1;  ///< 128 + signal when a signal ended it
  std::string out;
  std::string err;
};

/// Runs the rift binary that was built with these tests, within the limits of RunningRift and with
/// its redirection of streams.
ProcessResult RunRift(const std::vector<std::string>& arguments,
                      const std::string& redirection = "");

/// A new empty folder, removed with all its contents at the end of its scope.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& Path() const { return path_; }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

void WriteText(const std::filesystem::path& path, const std::string& text);

}  // namespace rift::test
