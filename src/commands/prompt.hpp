#pragma once

#include <string>
#include <string_view>

namespace rift::commands {

/// A line of stderr for people.
void Say(const std::string& line);

/// A line of stderr that is replaced by the next one, where stderr is a terminal; nothing
/// elsewhere. Say() takes its place, and so does the end of this.
class LiveLine {
 public:
  LiveLine() = default;
  ~LiveLine();
  LiveLine(const LiveLine&) = delete;
  LiveLine& operator=(const LiveLine&) = delete;

  static void Show(const std::string& line);
};

/// Sounds the terminal's bell, where stderr is one.
void RingBell();

/// What a person answers with one key of `keys`; Enter is the first of them. 'q', Ctrl-C and
/// SIGTERM give up: 'q'. `says_yes` answers Enter at once. Throws std::invalid_argument where stdin
/// is no terminal and nobody says yes.
char Ask(const std::string& question, std::string_view keys, bool says_yes);

}  // namespace rift::commands
