#include "rift/terminal/print.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <optional>
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

/// The characters that stderr's terminal shows in a line; none where it does not tell.
std::optional<std::size_t> Columns() {
  winsize size{};
  const bool is_told = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return is_told ? std::optional<std::size_t>(size.ws_col) : std::nullopt;
}

}  // namespace

void Say(std::string_view line) {
  const std::string clear = is_live.exchange(false) ? kClear : "";
  WriteToStderr(clear + TerminalText(line, LineBreaks::kEscaped) + '\n');
}

void SayInPlace(std::string_view line) {
  std::string text = TerminalText(line, LineBreaks::kEscaped);
  // Of a line that is wrapped only the last part could be cleared.
  if (const auto columns = Columns()) text = FirstCharacters(text, *columns - 1);
  WriteToStderr(kClear + text);
}

void LiveLine::Hide() {
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
