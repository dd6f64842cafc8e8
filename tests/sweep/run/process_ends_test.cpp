// How jobs of workers end, and what is told of it.
#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <new>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "rift/sweep/run/byte_codec.hpp"
#include "rift/sweep/run/worker_pool.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"
#include "support/sanitizer.hpp"

namespace rift::sweep {
namespace {

/// The result of one job.
JobResult ResultOf(const WorkerPool::Work& work, const RunOptions& options = {}) {
  JobResult found;
  std::fflush(stdout);  // a sanitizer's _exit() writes in the worker what Catch has not yet
  WorkerPool pool(work, 1, options);
  pool.Run({1, [](int) { return std::string("job"); },
            [&](int, const JobResult& result) { found = result; }, [] { return true; }});
  return found;
}

/// A job that leaves an x in `file` whenever it is run, and then does what is to end it.
WorkerPool::Work Noting(const std::string& file, const std::function<void()>& end) {
  return [file, end](const std::string&) {
    std::ofstream(file, std::ios::app) << 'x';
    end();
    return std::string();
  };
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
  CHECK(ended.bytes == "ended with exit code 7");
  const test::TemporaryFolder folder;
  const std::string kills = folder / "kills";
  const JobResult killed =
      ResultOf(Noting(kills, [] { ::kill(::getpid(), SIGKILL); }), {.retries = 0});
  CHECK(killed.end == JobEnd::kCrashed);
  CHECK(killed.bytes == "ended by signal 9 (Killed)");
  CHECK(test::ReadFile(kills) == "xxxxx");
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
  WorkerPool pool(
      [](const std::string& job) -> std::string {
        const std::string text = job == "0" ? "of the first job" : "second";
        [[maybe_unused]] const auto n = ::write(2, text.data(), text.size());
        if (job == "1") std::abort();
        return "";
      },
      1, {.retries = 0});
  std::vector<std::string> reasons(2);
  pool.Run({2, [](int i) { return std::to_string(i); },
            [&](int i, const JobResult& result) { reasons[static_cast<size_t>(i)] = result.bytes; },
            [] { return true; }});
  CHECK(reasons == std::vector<std::string>{"", "ended by signal 6 (Aborted): second"});
}

/// A job that touches so many MiB and says so, and aborts.
JobResult Aborted(int touched_mib, const std::string& words, int memory_mb) {
  return ResultOf(
      [=](const std::string&) -> std::string {
        const size_t size = static_cast<size_t>(touched_mib) << 20;
        void* const taken =
            ::mmap(nullptr, size + 1, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        if (taken == MAP_FAILED) return "refused";
        std::memset(taken, 'x', size);
        [[maybe_unused]] const auto n = ::write(2, words.data(), words.size());
        std::abort();
      },
      {.memory_mb = memory_mb, .retries = 0});
}

TEST_CASE("A worker that aborts with its memory full, or says so, ran out of it") {
  SKIP_UNDER_SANITIZER();
  CHECK(Aborted(62, "", 64).end == JobEnd::kOutOfMemory);
  CHECK(Aborted(30, "", 64).end == JobEnd::kCrashed);
  CHECK(Aborted(106, "", 128).end == JobEnd::kCrashed);  // full is from nine tenths on
  const JobResult said = Aborted(0, "terminate called: what(): std::bad_alloc\n", 1024);
  CHECK(said.end == JobEnd::kOutOfMemory);
  CHECK(said.bytes == "wanted more than 1024 MB of memory");
}

TEST_CASE("What the sweep itself holds is no memory that a worker ran out of") {
  SKIP_UNDER_SANITIZER();
  const std::vector<char> held(size_t{64} << 20, 'x');
  CHECK(Aborted(0, "", 32).end == JobEnd::kCrashed);
  CHECK(Aborted(30, "", 32).end == JobEnd::kOutOfMemory);
}

TEST_CASE("A worker leaves Ctrl-C to the sweep, and other signals of the sweep end it") {
  SKIP_UNDER_SANITIZER();
  const auto at = [](int signal) {
    return ResultOf(
               [=](const std::string&) {
                 ::raise(signal);
                 return std::string("goes on");
               },
               {.retries = 0})
        .bytes;
  };
  CHECK(at(SIGINT) == "goes on");
  for (const int signal : {SIGTERM, SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL}) {
    using Action = struct sigaction;
    Action ignored{}, before{};
    ignored.sa_handler = SIG_IGN;
    REQUIRE(::sigaction(signal, &ignored, &before) == 0);
    const std::string told = at(signal);
    ::sigaction(signal, &before, nullptr);
    CHECK_THAT(told, Catch::StartsWith("ended by signal " + std::to_string(signal) + " "));
  }
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

TEST_CASE("Five kills from outside are the first failure of a job, and each further one the next") {
  const test::TemporaryFolder folder;
  const std::string kills = folder / "kills";
  const JobResult killed =
      ResultOf(Noting(kills, [] { ::kill(::getpid(), SIGKILL); }), {.retries = 1});
  CHECK(killed.bytes == "ended by signal 9 (Killed), twice");
  CHECK(test::ReadFile(kills) == "xxxxxx");
}

TEST_CASE("A signal of the job itself that is no kill is a failure at once") {
  SKIP_UNDER_SANITIZER();
  const test::TemporaryFolder folder;
  const std::string runs = folder / "runs";
  const JobResult ended =
      ResultOf(Noting(runs, [] { ::kill(::getpid(), SIGTERM); }), {.retries = 0});
  CHECK(ended.bytes == "ended by signal 15 (Terminated)");
  CHECK(test::ReadFile(runs) == "x");
}

TEST_CASE("A job that hangs is given up after its time, and tried once where no more is allowed") {
  const test::TemporaryFolder folder;
  const std::string runs = folder / "runs";
  const JobResult hung =
      ResultOf(Noting(runs, [] { ::sleep(1000); }), {.timeout_s = 0.25, .retries = 0});
  CHECK(hung.end == JobEnd::kHung);
  CHECK(hung.bytes == "had not ended after 0.25 s (run.timeout_s)");
  CHECK(test::ReadFile(runs) == "x");
}

TEST_CASE("What a worker prints is kept from the output of the sweep, as are its errors") {
  SKIP_UNDER_SANITIZER();
  const auto words = [](int descriptor) {
    return ResultOf(
               [=](const std::string&) -> std::string {
                 [[maybe_unused]] const auto n = ::write(descriptor, "printed\n", 8);
                 std::abort();
               },
               {.retries = 0})
        .bytes;
  };
  CHECK(words(1) == "ended by signal 6 (Aborted): printed");
  CHECK(words(2) == "ended by signal 6 (Aborted): printed");
}

TEST_CASE("A job that runs out of memory as an exception costs its worker, and says the limit") {
  const test::TemporaryFolder folder;
  const std::string runs = folder / "runs";
  const JobResult full = ResultOf(
      [&](const std::string&) -> std::string {
        std::ofstream(runs, std::ios::app) << ::getpid() << '\n';
        throw std::bad_alloc();
      },
      {.memory_mb = 77, .retries = 2});
  CHECK(full.end == JobEnd::kOutOfMemory);
  CHECK(full.bytes == "wanted more than 77 MB of memory, 3 times");
  std::istringstream lines(test::ReadFile(runs));
  std::set<std::string> workers;
  for (std::string line; std::getline(lines, line);) workers.insert(line);
  CHECK(workers.size() == 3);
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
