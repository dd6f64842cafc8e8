// How jobs of workers and programs of others end, and what is told of it.
#include <signal.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "rift/sweep/run/byte_codec.hpp"
#include "rift/sweep/run/external_program.hpp"
#include "rift/sweep/run/worker_pool.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"
#include "support/sanitizer.hpp"
#include "support/until.hpp"

namespace rift::sweep {
namespace {

namespace fs = std::filesystem;

/// The result of one job.
JobResult ResultOf(const WorkerPool::Work& work, const RunOptions& options = {}) {
  JobResult found;
  WorkerPool pool(work, 1, options);
  pool.Run({1, [](int) { return std::string("job"); },
            [&](int, const JobResult& result) { found = result; }, [] { return true; }});
  return found;
}

TEST_CASE("A job that crashes is tried as often as is allowed, and it is told how often that was") {
  SKIP_UNDER_SANITIZER();
  const auto reason = [](int retries) {
    return ResultOf([](const std::string&) -> std::string { std::abort(); }, {.retries = retries})
        .bytes;
  };
  CHECK(reason(0) == "ended by signal 6 (Aborted)");
  CHECK(reason(1) == "ended by signal 6 (Aborted), twice");
  CHECK(reason(3) == "ended by signal 6 (Aborted), 4 times");
}

TEST_CASE("A job that ends its worker with a code, or is killed for ever, is a crash") {
  const JobResult ended =
      ResultOf([](const std::string&) -> std::string { ::_exit(7); }, {.retries = 0});
  CHECK(ended.end == JobEnd::kCrashed);
  CHECK(ended.bytes.find("7") != std::string::npos);
  const JobResult killed = ResultOf(
      [](const std::string&) -> std::string {
        ::kill(::getpid(), SIGKILL);
        return "";
      },
      {.retries = 0});
  CHECK(killed.end == JobEnd::kCrashed);
  CHECK(killed.bytes.starts_with("ended by signal 9"));
}

TEST_CASE(
    "What a worker wrote last is told to 200 bytes of its first line, and of that job alone") {
  SKIP_UNDER_SANITIZER();
  const auto words = [](const std::string& text) {
    return ResultOf(
               [=](const std::string&) -> std::string {
                 [[maybe_unused]] const auto n = ::write(2, text.data(), text.size());
                 std::abort();
               },
               {.retries = 0})
        .bytes;
  };
  CHECK(words("one\ntwo\n") == "ended by signal 6 (Aborted): one");
  CHECK(words(std::string(300, 'x')) == "ended by signal 6 (Aborted): " + std::string(200, 'x'));
  CHECK(words("").ends_with("(Aborted)"));
}

TEST_CASE("What a job throws is its reason, and the worker goes on") {
  WorkerPool pool(
      [](const std::string& job) -> std::string {
        if (job == "1") throw std::runtime_error("no such setting");
        return job + " " + std::to_string(::getpid());
      },
      1, {});
  std::vector<JobResult> results(3);
  pool.Run({3, [](int i) { return std::to_string(i); },
            [&](int i, const JobResult& result) { results[static_cast<size_t>(i)] = result; },
            [] { return true; }});
  CHECK(results[1].end == JobEnd::kThrew);
  CHECK(results[1].bytes == "no such setting");
  CHECK(results[0].bytes.substr(2) == results[2].bytes.substr(2));
}

TEST_CASE("A pool has a worker at least, and a batch without jobs is done") {
  const auto echo = [](const std::string& job) { return job; };
  CHECK_THROWS_WITH(WorkerPool(echo, 0, {}), "0 workers: at least 1");
  WorkerPool pool(echo, 2, {});
  CHECK(pool.Run({0, {}, {}, [] { return true; }}));
  CHECK(CoresToUse() >= 1);
  CHECK(ResultOf([](const std::string&) { return std::string(); }).bytes.empty());
}

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
  const auto words = [](const std::string& lines) {
    Shell shell(lines);
    shell.program.Wait();
    return shell.program.LastWords();
  };
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
}

TEST_CASE(
    "A program that is not there ends with 127 and the reason, and one without a name throws") {
  ExternalProgram program({.arguments = {"no-such-program-of-rift"}},
                          ExternalProgram::MakeFolder());
  CHECK(program.Wait().code == 127);
  CHECK(program.LastWords() == "cannot run no-such-program-of-rift: No such file or directory");
  CHECK_THROWS_WITH(ExternalProgram({}, ExternalProgram::MakeFolder()), "a program has no name");
}

TEST_CASE("Values come back from their bytes, and too few bytes, or none of a kind, are refused") {
  ByteWriter write;
  write(std::string("a\0b", 3));
  write(std::optional<int>());
  write(std::optional<int>(7));
  write(std::vector<std::string>{"x", ""});
  write(std::vector<double>{0.1, -0.0});
  write(true);
  const std::string bytes = write.Take();
  ByteReader read(bytes);
  std::string text;
  std::optional<int> none = 3, seven;
  std::vector<std::string> words;
  std::vector<double> numbers;
  bool is_true = false;
  read(text), read(none), read(seven), read(words), read(numbers), read(is_true);
  CHECK(text == std::string("a\0b", 3));
  CHECK_FALSE(none);
  CHECK(seven == 7);
  CHECK(words == std::vector<std::string>{"x", ""});
  CHECK(numbers == std::vector<double>{0.1, -0.0});
  CHECK(is_true);
  CHECK(read.IsAtEnd());
  CHECK_THROWS_WITH(read(is_true), "a row of the sweep is cut short");
  ByteReader two(std::string_view("\x02", 1));
  CHECK_THROWS_WITH(two(is_true), "a row of the sweep holds a value that there is none of");
  ByteWriter long_list;
  long_list(size_t{3});
  long_list(1.0);
  const std::string short_bytes = long_list.Take();
  ByteReader cut(short_bytes);
  CHECK_THROWS_WITH(cut(numbers), "a row of the sweep is cut short");
}

}  // namespace
}  // namespace rift::sweep
