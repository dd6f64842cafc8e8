// How programs of others are started, talked to, and end with all that they start.
#include "rift/sweep/run/external_program.hpp"

#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "rift/sweep/run/machine_trouble.hpp"
#include "support/processes/environment.hpp"
#include "support/processes/process.hpp"
#include "support/sanitizer.hpp"
#include "support/until.hpp"

namespace rift::sweep {
namespace {

namespace fs = std::filesystem;

/// `sh -c lines` in a folder of its own.
struct Shell {
  explicit Shell(const std::string& lines, bool talks = false)
      : program({.arguments = {"sh", "-c", lines},
                 .environment = {{"RIFT_WORD", "from outside"}},
                 .files = {{"told.txt", "in a file"}},
                 .memory_mb = 512,
                 .talks = talks},
                ExternalProgram::MakeFolder()) {}
  ExternalProgram program;
};

TEST_CASE("A program has its folder, its files and its environment, and ends with its code") {
  Shell shell(
      "pwd >&2; [ \"$(cat told.txt)\" = 'in a file' ] || exit 1; "
      "[ \"$RIFT_WORD\" = 'from outside' ] || exit 2; exit 42");
  const ExternalProgram::Exit exit = shell.program.Wait();
  CHECK(exit.code == 42);
  CHECK(exit.signal == 0);
  CHECK(shell.program.LastWords() == "{folder}");
  CHECK(shell.program.Owner() == ::getpid());
  CHECK(fs::exists(fs::path(shell.program.Folder()) / "told.txt"));
  CHECK(Shell("kill -TERM $$").program.Wait().signal == SIGTERM);
  CHECK(Shell("exit 0").program.Wait().code == 0);
}

TEST_CASE("A program that cannot be given its files is trouble of the machine") {
  const test::TemporaryFolder folder;
  fs::create_directory(folder / "of_its_own");
  const ProgramStart start{.arguments = {"true"}, .files = {{"no/such.txt", "text"}}};
  CHECK_THROWS_AS(ExternalProgram(start, folder / "of_its_own"), MachineTrouble);
  CHECK_FALSE(fs::exists(folder / "of_its_own"));
  CHECK_THROWS_WITH(ExternalProgram(start, folder / "gone"),
                    Catch::EndsWith("gone/no/such.txt: No such file or directory"));
}

std::string WordsOf(const std::string& lines) {
  Shell shell(lines);
  shell.program.Wait();
  return shell.program.LastWords();
}

TEST_CASE("A program has its memory and as much in files, no core, and no way to raise them") {
  // In kB, and in blocks of 512 bytes.
  CHECK(WordsOf("echo $(ulimit -S -d) $(ulimit -S -f) $(ulimit -S -c) >&2") == "524288 1048576 0");
  CHECK(WordsOf("echo $(ulimit -H -d) $(ulimit -H -f) $(ulimit -H -c) >&2") == "524288 1048576 0");
}

TEST_CASE("A program that does not talk reads nothing and its output goes nowhere") {
  CHECK(WordsOf("WORD=$(readlink /proc/$$/fd/0); echo $WORD >&2") == "/dev/null");
  CHECK(WordsOf("WORD=$(readlink /proc/$$/fd/1); echo $WORD >&2") == "/dev/null");
  const test::Environment outside("RIFT_WORD", "of the caller");
  CHECK(WordsOf("echo \"$RIFT_WORD\" >&2") == "from outside");
}

TEST_CASE("A program is ended by each signal, blocks none, and its group is its own") {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) {
    CHECK(Shell("kill -" + std::to_string(signal) + " $$").program.Wait().signal == signal);
  }
  CHECK(WordsOf("while read -r K V; do [ $K != SigBlk: ] || echo $V >&2; done < /proc/$$/status") ==
        "0000000000000000");
  std::string folder;
  {
    Shell shell("kill -KILL 0");
    folder = shell.program.Folder();
    CHECK(shell.program.Wait().signal == SIGKILL);
  }
  CHECK_FALSE(fs::exists(folder));  // who keeps it was not in the group
  const std::string session = WordsOf(
      "read -r PID NAME STATE PARENT GROUP SESSION REST < /proc/$$/stat; echo $SESSION >&2");
  CHECK(session != std::to_string(::getsid(0)));
}

TEST_CASE("A program whose keeper is killed is killed with it") {
  std::string folder;
  {
    Shell shell("echo $$ $PPID >&2; exec sleep 1000");
    folder = shell.program.Folder();
    test::WaitUntil("it has started", [&] { return !shell.program.LastWords().empty(); });
    const std::string words = shell.program.LastWords();
    const pid_t program = std::stoi(words), keeper = std::stoi(words.substr(words.find(' ')));
    REQUIRE(keeper != ::getpid());
    ::kill(keeper, SIGKILL);
    CHECK(shell.program.Wait().signal == SIGKILL);
    // It may stay a zombie, whose command line is empty.
    const std::string line = "/proc/" + std::to_string(program) + "/cmdline";
    test::WaitUntil("it is gone", [&] { return std::ifstream(line).peek() == EOF; });
  }
  fs::remove_all(folder);
}

TEST_CASE("The folder of a program is gone with it") {
  std::string folder;
  {
    Shell shell("sleep 1000 & exit 0");
    shell.program.Wait();
    folder = shell.program.Folder();
    CHECK(fs::exists(folder));
  }
  CHECK_FALSE(fs::exists(folder));
}

TEST_CASE("Last words are the last line that is one, to 200 bytes, until they are forgotten") {
  const auto words = WordsOf;
  CHECK(words("printf 'one\\ntwo\\n \\n\\t\\n' >&2") == "two");
  CHECK(words("printf 'only' >&2") == "only");
  CHECK(words(":").empty());
  CHECK(words("printf '%0300d' 0 >&2").size() == 200);
  CHECK(words("echo \"$PWD/a and $PWD/b\" >&2") == "{folder}/a and {folder}/b");
  Shell shell("echo first >&2; read -r LINE; echo second >&2", true);
  test::WaitUntil("its first word", [&] { return shell.program.LastWords() == "first"; });
  shell.program.ForgetWords();
  CHECK(shell.program.LastWords().empty());
  CHECK(shell.program.SendLine("go"));
  shell.program.Wait();
  CHECK(shell.program.LastWords() == "second");
}

TEST_CASE("Of what Node ends with the error is the last words, and of others the last line") {
  const auto words = [](const std::string& text) {
    return WordsOf("cat >&2 <<'END'\n" + text + "\nEND");
  };
  const std::string node = "\n\nNode.js v20.20.2\n", stack = "\n    at f (/x/NodeError.js:1:2)";
  const std::string source = "/x/a.mjs:1\nthrow new Error('source')\n^\n\n";
  CHECK(words(source + "Error: no wheel" + stack + node) == "Error: no wheel");
  CHECK(words(source + "Error [ERR_MODULE_NOT_FOUND]: Cannot find package 'x'" + stack +
              " {\n  code: 'ERR_MODULE_NOT_FOUND'\n}" + node) ==
        "Error [ERR_MODULE_NOT_FOUND]: Cannot find package 'x'");
  CHECK(words("/x/a.mjs:1\nthrow 'flat'\n^\nflat\n(Use `node --trace-uncaught ...` to show where "
              "the exception was thrown)" +
              node) == "flat");
  CHECK(words("Exception in thread \"main\" java.lang.IllegalStateException: flat" + stack) ==
        "Exception in thread \"main\" java.lang.IllegalStateException: flat");
  // Others end with their reason, whatever they wrote before it.
  CHECK(words("ValueError: seen\nstd::bad_alloc") == "std::bad_alloc");
  CHECK(words("error: 0.1\nat the goal") == "at the goal");
  CHECK(words("  at f\n}") == "}");
  CHECK(words("Error: long ago" + [&] {
          std::string many;
          for (int i = 0; i < 70; ++i) many += stack;
          return many;
        }()) == "    at f (/x/NodeError.js:1:2)");
}

TEST_CASE("Last words are found behind more than a reader of files takes, and in no pipe") {
  CHECK(WordsOf("truncate -s 300M stderr.txt; printf '\\nend\\n' >&2") == "end");
  CHECK(WordsOf("rm stderr.txt; mkfifo stderr.txt").empty());
}

TEST_CASE("What a row keeps of words is their first line, cut between two characters") {
  CHECK(ShortWords("one\ntwo") == "one");
  CHECK(ShortWords("").empty());
  CHECK(ShortWords(std::string(200, 'a')).size() == 200);
  CHECK(ShortWords(std::string(201, 'a')).size() == 200);
  const std::string before(198, 'a');
  CHECK(ShortWords(before + "\u00e9" + "b") == before + "\u00e9");
  CHECK(ShortWords(before + "\u20ac" + "b") == before);
  CHECK(ShortWords(std::string(300, '\x80')).size() == 197);  // no text at all
}

TEST_CASE("What a program writes before it reads its next line is seen, however late") {
  Shell shell(
      "read -r LINE; echo $LINE; sleep 0.1; echo late; read -r LINE; echo \"$LINE\"; read -r LINE; "
      "exec sleep 1000",
      true);
  CHECK(shell.program.UnreadAtNextLine('o', -1).empty());
  CHECK(shell.program.SendLine("one"));
  CHECK(shell.program.ReceiveLine() == "one");
  CHECK(shell.program.UnreadAtNextLine('t', 0).empty());
  CHECK(shell.program.UnreadAtNextLine('t', -1) == "late\n");
  CHECK(shell.program.ReceiveLine() == "late");
  CHECK(shell.program.SendLine("two"));
  CHECK(shell.program.ReceiveLine() == "two");
  CHECK(shell.program.SendLine("three"));
  CHECK(shell.program.UnreadAtNextLine('f', 20).empty());  // it reads no more
  Shell ended("exit 0", true);
  ended.program.Wait();
  CHECK(ended.program.UnreadAtNextLine('o', -1).empty());
}

TEST_CASE("Lines go to a program and come back one by one, and none after its end") {
  Shell shell(
      "while read -r LINE; do [ \"$LINE\" != end ] || exit 3; "
      "printf '%s\\n%s again\\n' \"$LINE\" \"$LINE\"; done",
      true);
  CHECK(shell.program.SendLine("a b"));
  CHECK(shell.program.ReceiveLine() == "a b");
  CHECK(shell.program.SendLine("c"));
  CHECK(shell.program.ReceiveLine() == "a b again");
  CHECK(shell.program.ReceiveLine() == "c");
  CHECK(shell.program.ReceiveLine() == "c again");
  CHECK(shell.program.SendLine("end"));
  CHECK_FALSE(shell.program.ReceiveLine());
  CHECK(shell.program.Wait().code == 3);
  CHECK_FALSE(shell.program.SendLine("nobody reads this"));
}

TEST_CASE(
    "A program that is not there ends with 127 and the reason, and one without a name throws") {
  ExternalProgram program({.arguments = {"no-such-program-of-rift"}},
                          ExternalProgram::MakeFolder());
  const ExternalProgram::Exit exit = program.Wait();
  CHECK(exit.code == 127);
  CHECK(program.LastWords() == "cannot run no-such-program-of-rift: No such file or directory");
  CHECK(ExternalProgram::WasNeverStarted(exit, program.LastWords()));
  CHECK_FALSE(ExternalProgram::WasNeverStarted(exit, "sh: 1: sim: not found"));
  CHECK_FALSE(ExternalProgram::WasNeverStarted({.code = 1}, program.LastWords()));
  CHECK_THROWS_WITH(ExternalProgram({}, ExternalProgram::MakeFolder()), "a program has no name");
}

TEST_CASE("A folder for a program is new and empty, where TMPDIR says, or it is said why not") {
  const test::TemporaryFolder folder;
  {
    const test::Environment here("TMPDIR", folder.Path().string());
    const fs::path one = ExternalProgram::MakeFolder(), other = ExternalProgram::MakeFolder();
    CHECK(one.parent_path() == folder.Path());
    CHECK(one.filename().string().starts_with("rift-"));
    CHECK(fs::is_empty(one));
    CHECK(one != other);
    CHECK((fs::status(one).permissions() & fs::perms::mask) == fs::perms::owner_all);
  }
  const test::Environment nobody("TMPDIR", "/proc");  // is there, and takes no folder
  CHECK_THROWS_WITH(ExternalProgram::MakeFolder(),
                    "cannot make a temporary folder in /proc: No such file or directory; set "
                    "TMPDIR to a folder that can be written");
}

TEST_CASE("Who keeps a program bears the signals that end others, and the program's own end") {
  const ExternalProgram::Exit exit =
      Shell("for S in INT TERM HUP PIPE; do kill -$S $PPID; done; exit 5").program.Wait();
  CHECK(exit.code == 5);
  CHECK(exit.signal == 0);
}

TEST_CASE("Whatever a program leaves running ends with it, in sessions of their own, too") {
  std::string folder;
  std::vector<pid_t> left;
  {
    Shell shell(
        "(setsid sleep 1000 & echo $! >> pids); sleep 1000 & echo $! >> pids; "
        "nohup setsid sh -c 'trap \"\" TERM HUP INT; sleep 1000 & echo $! >> pids; wait' > "
        "/dev/null & echo $! >> pids; while [ $(wc -l < pids) -lt 4 ]; do sleep 0.01; done");
    shell.program.Wait();
    std::ifstream pids(fs::path(shell.program.Folder()) / "pids");
    for (pid_t pid = 0; pids >> pid;) left.push_back(pid);
    REQUIRE(left.size() == 4);
    for (const pid_t pid : left) CHECK(::kill(pid, 0) == 0);
  }
  for (const pid_t pid : left) CHECK(::kill(pid, 0) != 0);
}

TEST_CASE("The end of a program that talks is seen though a child of it holds its output open") {
  Shell shell("echo one; sleep 1000 & exit 9", true);
  CHECK(shell.program.ReceiveLine() == "one");
  CHECK_FALSE(shell.program.ReceiveLine());
  CHECK(shell.program.Wait().code == 9);
}

TEST_CASE("What goes on for 64 MiB without an end is taken for a line") {
  Shell shell("head -c 67108865 /dev/zero; exit 0", true);
  const std::optional<std::string> line = shell.program.ReceiveLine();
  REQUIRE(line);
  CHECK(line->size() == 67'108'865);
  CHECK_FALSE(shell.program.ReceiveLine());
}

TEST_CASE("A program that is gone leaves no file open here, and those of its folder are private") {
  const auto open_files = [] { return std::distance(fs::directory_iterator("/proc/self/fd"), {}); };
  const auto before = open_files();
  for (const bool talks : {true, false}) {
    Shell shell("stat -c %a told.txt stderr.txt | tr '\\n' ' ' >&2", talks);
    CHECK(open_files() == before + (talks ? 3 : 1));
    shell.program.Wait();
    CHECK(shell.program.LastWords() == "600 600");
  }
  CHECK(open_files() == before);
}

TEST_CASE("Of an error above a stack the nearest line that names one is told, within 64 lines") {
  std::string stack;
  for (int i = 0; i < 60; ++i) stack += "\n    at f (/x/a.js:1:2)";
  const auto words = [](const std::string& text) {
    return WordsOf("cat >&2 <<'END'\n" + text + "\nEND");
  };
  CHECK(words("TypeError: near" + stack) == "TypeError: near");
  CHECK(words("sim error: no wheel\nsecond line" + stack) == "sim error: no wheel");
  CHECK(words("first line\nsecond line" + stack) == "second line");
  CHECK(words("RangeError: far\nTypeError: near\nsecond line" + stack) == "TypeError: near");
  CHECK(words("RangeError: far\nlast line") == "last line");
}

TEST_CASE("Below an error 63 lines of a stack are passed over, and no more") {
  const auto words = [](int lines) {
    std::string text = "RangeError: far";
    for (int i = 0; i < lines; ++i) text += "\n    at f (/x/a.js:1:2)";
    return WordsOf("cat >&2 <<'END'\n" + text + "\nEND");
  };
  CHECK(words(63) == "RangeError: far");
  CHECK(words(64) == "    at f (/x/a.js:1:2)");
}

TEST_CASE("Of one line without an end the last 64 KiB are looked at") {
  CHECK(WordsOf("printf 0123456789 >&2; head -c 65530 /dev/zero | tr '\\0' x >&2") ==
        "456789" + std::string(194, 'x'));
}

TEST_CASE("A program whose folder is gone is not started anywhere else") {
  const test::TemporaryFolder here;
  const fs::path before = fs::current_path();
  fs::current_path(here.Path());
  ExternalProgram program({.arguments = {"sh", "-c", "echo started > told.txt"}},
                          here / "of_its_own");
  const ExternalProgram::Exit exit = program.Wait();
  fs::current_path(before);
  CHECK(exit.code == 127);
  CHECK(exit.signal == 0);
  CHECK_FALSE(fs::exists(here / "told.txt"));
}

TEST_CASE("A long line comes to a program whole") {
  Shell shell("head -n 1 | wc -c", true);
  CHECK(shell.program.SendLine(std::string(1'000'000, 'a')));
  CHECK(shell.program.ReceiveLine() == "1000001");
}

TEST_CASE("A program that cannot be started for want of files leaves none open, and no folder") {
  SKIP_UNDER_SANITIZER();
  // No number below the next is free, so that the limit alone says how many more there may be.
  std::vector<int> filled;
  const auto open_files = [] { return std::distance(fs::directory_iterator("/proc/self/fd"), {}); };
  do {
    filled.push_back(::dup(0));
  } while (filled.back() + 1 < open_files() - 1);
  rlimit before{};
  REQUIRE(::getrlimit(RLIMIT_NOFILE, &before) == 0);
  for (const int more : {1, 3, 5}) {  // for none, one or two of its three pairs of sockets
    const std::string folder = ExternalProgram::MakeFolder();
    const auto open_before = open_files();
    const rlimit few{static_cast<rlim_t>(filled.back() + 1 + more), before.rlim_max};
    std::string told = "nothing";
    ::setrlimit(RLIMIT_NOFILE, &few);
    try {
      ExternalProgram({.arguments = {"true"}, .talks = true}, folder);
    } catch (const MachineTrouble& trouble) {
      told = trouble.what();
    }
    ::setrlimit(RLIMIT_NOFILE, &before);
    CAPTURE(more);
    CHECK(told == "cannot start a program: Too many open files");
    CHECK(open_files() == open_before);
    CHECK_FALSE(fs::exists(folder));
  }
  for (const int one : filled) ::close(one);
}

}  // namespace
}  // namespace rift::sweep
