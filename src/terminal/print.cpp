#include "rift/terminal/print.hpp"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <string>

#include "text.hpp"

namespace rift::terminal {
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

constexpr const char* kClear = "\r\x1b[K";

std::atomic<bool> is_live = false;  // a LiveLine stands on the terminal's line

}  // namespace

void Say(std::string_view line) {
  const std::string clear = is_live.exchange(false) ? kClear : "";
  WriteToStderr(clear + TerminalText(line, LineBreaks::kEscaped) + '\n');
}

void SayInPlace(std::string_view line) {
  WriteToStderr(kClear + TerminalText(line, LineBreaks::kEscaped));
}

LiveLine::~LiveLine() {
  if (is_live.exchange(false)) WriteToStderr(kClear);
}

void LiveLine::Show(const std::string& line) {
  if (::isatty(STDERR_FILENO) == 0) return;
  is_live = true;
  SayInPlace(line);
}

void RingBell() {
  if (::isatty(STDERR_FILENO) == 1) WriteToStderr("\a");
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

}  // namespace rift::terminal
