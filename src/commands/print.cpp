#include "print.hpp"

#include <cerrno>
#include <cstdio>
#include <string>

#include "terminal_text.hpp"

namespace rift::commands {
namespace {

int stdout_errno = 0;  // of the first write that failed

void NoteFailure() {
  if (stdout_errno == 0) stdout_errno = errno != 0 ? errno : EIO;
}

/// In one call: lines of several threads do not mix.
void WriteToStderr(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

}  // namespace

void Say(std::string_view line) { WriteToStderr(TerminalText(line, LineBreaks::kEscaped) + '\n'); }

void SayInPlace(std::string_view line) {
  WriteToStderr("\r\x1b[K" + TerminalText(line, LineBreaks::kEscaped));
}

void PrintText(std::string_view text) { PrintData(TerminalText(text, LineBreaks::kKept)); }

void PrintData(std::string_view data) {
  errno = 0;
  if (std::fwrite(data.data(), 1, data.size(), stdout) != data.size()) NoteFailure();
}

int FlushResults() {
  errno = 0;
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) NoteFailure();
  return stdout_errno;
}

}  // namespace rift::commands
