#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "rift/files/descriptor.hpp"

namespace rift::sessions {

/// Serves the first of some files that is there under http://127.0.0.1:PORT/TOKEN/, to this machine
/// alone, at any free port; the token is random, and whoever asks without it gets nothing. A
/// process of its own, which ends with this one or with this object: worker processes are forked
/// from here, and threads would not go with them.
class PageServer {
 public:
  /// Throws std::runtime_error when there is no port or no process to be had.
  explicit PageServer(const std::vector<std::filesystem::path>& files);
  ~PageServer();
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  const std::string& Url() const { return url_; }
  /// Waits until the last of the files has been served, at most that long. An answer with another
  /// one that is still under way does not count.
  bool WaitForLast(int timeout_ms);
  /// True when the page was asked for within the last seconds: somebody watches it.
  bool IsWatched();
  /// To be called now and then: a request counts as made when this is next called.
  void NoteRequests();

 private:
  std::string url_;
  pid_t process_ = -1;
  files::Descriptor requests_;  ///< the end of a pipe: a byte for each, kLast or kOther
  double last_request_s_ = -1e9;
  bool has_served_last_ = false;
};

}  // namespace rift::sessions
