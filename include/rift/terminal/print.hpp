#pragma once

#include <string>
#include <string_view>

/// The only place that writes to stdout and stderr (a test holds the tree to it). None of these
/// throws because a stream cannot be written: a robot must not stop, and a sweep must not be lost,
/// because a note could not be shown. What is for people passes TerminalText().
namespace rift::terminal {

/// One line on stderr: a note, a warning or an error. Lost when stderr cannot be written.
void Say(std::string_view line);

/// The same without a line's end, in place of what stands on the terminal's line, and no longer
/// than that line.
void SayInPlace(std::string_view line);

/// A line of stderr that is replaced by the next one, where stderr is a terminal; nothing
/// elsewhere. Say() takes its place, and so does the end of this.
class LiveLine {
 public:
  LiveLine() = default;
  ~LiveLine() { Hide(); }
  LiveLine(const LiveLine&) = delete;
  LiveLine& operator=(const LiveLine&) = delete;

  static void Show(const std::string& line);
  static void Hide();
};

/// Sounds the terminal's bell, where stderr is one.
void RingBell();

/// Results on stdout for people; line breaks stay.
void PrintText(std::string_view text);

/// Results on stdout for programs (JSON), byte for byte.
void PrintData(std::string_view data);

/// Sends what was printed on its way. Returns the errno of the first result that stdout did not
/// take since the program began, 0 when it took all.
int FlushResults();

}  // namespace rift::terminal
