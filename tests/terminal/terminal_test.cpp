#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <stdexcept>

#include "rift/terminal/exit_code.hpp"
#include "rift/terminal/print.hpp"
#include "rift/terminal/stop_signal.hpp"
#include "rift/yaml/node.hpp"
#include "support/processes/child_end.hpp"
#include "support/processes/process.hpp"
#include "support/tree.hpp"
#include "terminal/text.hpp"

namespace rift::terminal {
namespace {

/// What goes to a stream of this process meanwhile.
class Caught {
 public:
  explicit Caught(std::FILE* stream) : stream_(stream) {
    std::fflush(stream_);
    kept_ = ::dup(::fileno(stream_));
    ::dup2(::fileno(file_), ::fileno(stream_));
  }
  ~Caught() { Text(); }
  std::string Text() {
    if (kept_ >= 0) {
      std::fflush(stream_);
      ::dup2(kept_, ::fileno(stream_));
      ::close(kept_);
      kept_ = -1;
      std::rewind(file_);
      for (int c = std::fgetc(file_); c != EOF; c = std::fgetc(file_)) {
        text_ += static_cast<char>(c);
      }
      std::fclose(file_);
    }
    return text_;
  }
  Caught(const Caught&) = delete;
  Caught& operator=(const Caught&) = delete;

 private:
  std::FILE* stream_;
  std::FILE* file_ = std::tmpfile();
  int kept_ = -1;
  std::string text_;
};

TEST_CASE("What work throws is a line on stderr and the exit code of its kind") {
  const auto ends_with = [](const std::function<int()>& work) {
    Caught err(stderr), out(stdout);
    const int code = ReportErrors(work);
    CHECK(out.Text().empty());
    return std::pair(code, err.Text());
  };
  using Ends = std::pair<int, std::string>;
  CHECK(ends_with([] { return 7; }) == Ends{7, ""});
  CHECK(ends_with([]() -> int { throw std::invalid_argument("bad\nword"); }) ==
        Ends{2, "rift: bad\\x0aword\n"});
  CHECK(ends_with([]() -> int { throw yaml::Error("a.yaml:1:2: wrong"); }) ==
        Ends{2, "rift: a.yaml:1:2: wrong\n"});
  CHECK(ends_with([]() -> int { throw std::runtime_error("the port is gone"); }) ==
        Ends{3, "rift: the port is gone\n"});
  const auto full = std::make_error_code(std::errc::no_space_on_device);
  CHECK(ends_with([&]() -> int { throw std::filesystem::filesystem_error("f", full); }) ==
        Ends{3, "rift: No space left on device\n"});
  CHECK(ends_with([&]() -> int { throw std::filesystem::filesystem_error("f", "/x", full); }) ==
        Ends{3, "rift: cannot use /x: No space left on device\n"});
  CHECK(ends_with([] { return Fail("no", kRunTimeFailure); }) == Ends{3, "rift: no\n"});
}

TEST_CASE("Notes go to stderr in one line, results to stdout as they are") {
  Caught out(stdout), err(stderr);
  Say("a\tnote\x1b[2J");
  PrintText("two\nlines\x1b\n");
  PrintData("raw\x1b\n");
  LiveLine::Show("progress");  // not a terminal
  RingBell();
  CHECK(FlushResults() == 0);
  CHECK(out.Text() == "two\nlines\\x1b\nraw\x1b\n");
  CHECK(err.Text() == "a\\x09note\\x1b[2J\n");
}

TEST_CASE("A line in place clears what stands there and has no end") {
  Caught err(stderr);
  SayInPlace("half");
  CHECK(err.Text() == "\r\x1b[Khalf");
}

/// What a terminal of so many columns, or of a number it does not tell, is sent on stderr.
std::string Shown(unsigned short columns, const std::function<void()>& show) {
  winsize size{};
  size.ws_col = columns;
  int terminal = -1, stream = -1;
  REQUIRE(::openpty(&terminal, &stream, nullptr, nullptr, &size) == 0);
  const int before = ::dup(STDERR_FILENO);
  ::dup2(stream, STDERR_FILENO);
  show();
  ::dup2(before, STDERR_FILENO);
  ::close(before);
  ::close(stream);  // the last to write to it: what was sent has an end
  std::string sent;
  std::array<char, 256> chunk{};
  for (ssize_t got = 0; (got = ::read(terminal, chunk.data(), chunk.size())) > 0;) {
    sent.append(chunk.data(), static_cast<std::size_t>(got));
  }
  ::close(terminal);
  return sent;
}

TEST_CASE("On a terminal a live line is cut to its width, and a note takes its place") {
  const std::string clear = "\r\x1b[K";
  const auto all = [] {
    LiveLine::Show("0123456789");
    LiveLine::Show("new");
    Say("a note");
    Say("another");
    LiveLine::Show("last");
    LiveLine::Hide();
    LiveLine::Hide();  // nothing is there any more
    Say("the end");
  };
  CHECK(Shown(8, all) == clear + "0123456" + clear + "new" + clear + "a note\r\nanother\r\n" +
                             clear + "last" + clear + "the end\r\n");
  CHECK_THAT(Shown(0, all), Catch::StartsWith(clear + "0123456789" + clear));
  CHECK(Shown(8, RingBell) == "\a");
}

TEST_CASE("A text holds nothing that a terminal obeys or hides") {
  const auto shown = [](std::string_view text) { return TerminalText(text, LineBreaks::kEscaped); };
  CHECK(shown("plain ~ text") == "plain ~ text");
  CHECK(shown("\x1f|\x20|\x7e|\x7f") == "\\x1f| |~|\\x7f");
  CHECK(shown("a\nb") == "a\\x0ab");
  CHECK(TerminalText("a\nb\r", LineBreaks::kKept) == "a\nb\\x0d");
  CHECK(shown("\xff\xc3") == "\\xff\\xc3");  // no UTF-8
  CHECK(shown("\xc3\xa4\xe2\x82\xac\xf0\x9f\xa4\x96") == "\xc3\xa4\xe2\x82\xac\xf0\x9f\xa4\x96");
  CHECK(shown("\xc2\x80\xc2\x9f\xc2\xa0") == "\\u{80}\\u{9f}\xc2\xa0");
  CHECK(shown("\xd8\x9b\xd8\x9c\xd8\x9d") == "\xd8\x9b\\u{61c}\xd8\x9d");
  // U+200D, 200E, 200F, 2010; U+2027, 2028, 202E, 202F; U+2065, 2066, 2069, 206A.
  CHECK(shown("\xe2\x80\x8d\xe2\x80\x8e\xe2\x80\x8f\xe2\x80\x90") ==
        "\xe2\x80\x8d\\u{200e}\\u{200f}\xe2\x80\x90");
  CHECK(shown("\xe2\x80\xa7\xe2\x80\xa8\xe2\x80\xae\xe2\x80\xaf") ==
        "\xe2\x80\xa7\\u{2028}\\u{202e}\xe2\x80\xaf");
  CHECK(shown("\xe2\x81\xa5\xe2\x81\xa6\xe2\x81\xa9\xe2\x81\xaa") ==
        "\xe2\x81\xa5\\u{2066}\\u{2069}\xe2\x81\xaa");
}

TEST_CASE("A line is cut between characters, each of which counts as one") {
  CHECK(FirstCharacters("abc", 2) == "ab");
  CHECK(FirstCharacters("abc", 3) == "abc");
  CHECK(FirstCharacters("abc", 9) == "abc");
  CHECK(FirstCharacters("abc", 0).empty());
  CHECK(FirstCharacters("\xc3\xa4\xe2\x82\xac"
                        "b",
                        2) == "\xc3\xa4\xe2\x82\xac");
}

TEST_CASE("The first Ctrl-C or SIGTERM asks for an end and the handlers are put back") {
  const int signal = GENERATE(SIGINT, SIGTERM);
  static volatile std::sig_atomic_t seen = 0;
  seen = 0;
  std::signal(signal, [](int) { seen = 1; });
  {
    const StopSignal stop;
    CHECK_FALSE(stop.IsAsked());
    std::raise(signal);
    CHECK(stop.IsAsked());
    std::raise(signal);  // the same one, as `timeout` sends two
    CHECK(stop.IsAsked());
  }
  CHECK(seen == 0);
  std::raise(signal);
  CHECK(seen == 1);
  const StopSignal again;
  CHECK_FALSE(again.IsAsked());
  std::signal(signal, SIG_DFL);
}

TEST_CASE("A Ctrl-C or SIGTERM a second after the first ends the process, one at once does not") {
  const int first = GENERATE(SIGINT, SIGTERM), later = GENERATE(SIGINT, SIGTERM);
  const pid_t child = ::fork();
  if (child == 0) {
    const StopSignal stop;
    std::raise(first);
    std::raise(later);
    std::raise(first);
    const bool asked = stop.IsAsked();
    struct timespec left {
      1, 50'000'000
    };
    while (::nanosleep(&left, &left) != 0) {
    }
    if (asked) std::raise(later);
    ::_exit(1);
  }
  const int status = test::EndOf(child, "a process that was told to stop thrice");
  REQUIRE(WIFSIGNALED(status));
  CHECK(WTERMSIG(status) == later);
}

TEST_CASE("Where Ctrl-C or SIGTERM ends the process it leaves one line and the code of a stop") {
  const int signal = GENERATE(SIGINT, SIGTERM);
  Caught err(stderr), out(stdout);
  const pid_t child = ::fork();
  if (child == 0) {
    const EndSignal end("stopped; \x1b]0;it\nstarts over");
    std::raise(signal);
    ::_exit(1);
  }
  const int status = test::EndOf(child, "a process that was told to stop");
  CHECK(err.Text() == "stopped; \\x1b]0;it\\x0astarts over\n");
  CHECK(out.Text().empty());
  REQUIRE(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == kStopped);
  static volatile std::sig_atomic_t seen = 0;
  seen = 0;
  std::signal(signal, [](int) { seen = 1; });
  { const EndSignal end("stopped"); }
  std::raise(signal);  // as before
  CHECK(seen == 1);
  std::signal(signal, SIG_DFL);
}

}  // namespace
}  // namespace rift::terminal
