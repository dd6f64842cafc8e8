#include "rift/sweep/run/worker_pool.hpp"

#include <fcntl.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <stdexcept>
#include <vector>

#include "rift/sweep/run/external_program.hpp"
#include "rift/sweep/run/machine_trouble.hpp"
#include "support/processes/environment.hpp"
#include "support/processes/process.hpp"
#include "support/sanitizer.hpp"

namespace rift::sweep {
namespace {

/// Runs `count` jobs whose bytes are their indices.
std::map<int, JobResult> RunAll(WorkerPool& pool, int count) {
  std::map<int, JobResult> results;
  const bool is_whole = pool.Run({count, [](int i) { return std::to_string(i); },
                                  [&](int i, JobResult result) {
                                    const bool is_first =
                                        results.emplace(i, std::move(result)).second;
                                    REQUIRE(is_first);
                                  },
                                  [] { return true; }});
  REQUIRE(is_whole);
  return results;
}

[[gnu::noinline]] std::string Devour() {
  std::vector<std::vector<char>> eaten;
  while (true) eaten.emplace_back(1 << 20, 'x');
}

/// Job 1 hangs, 2 segfaults, 3 eats memory, 4 throws, 5 aborts with a word.
std::string Trouble(const std::string& job) {
  if (job == "1") ::sleep(1000);
  if (job == "2") std::raise(SIGSEGV);
  if (job == "3") return Devour();
  if (job == "4") throw std::runtime_error("no such setting");
  if (job == "5") {
    const std::string words = "ODE INTERNAL ERROR 1\n";
    [[maybe_unused]] const auto n = ::write(2, words.data(), words.size());
    std::abort();
  }
  return "answer to " + job;
}

TEST_CASE("Where no temporary folder can be made the message says what to set") {
  const test::TemporaryFolder folder;
  const test::Environment nowhere("TMPDIR", folder / "gone");
  CHECK_THROWS_WITH(ExternalProgram::MakeFolder(),
                    "cannot make a temporary folder in " + (folder / "gone") +
                        ": No such file or directory; set TMPDIR to a folder that can be written");
}

TEST_CASE("Every job of a batch is answered once by processes of their own") {
  const pid_t here = ::getpid();
  WorkerPool pool(
      [here](const std::string& job) {
        return ::getpid() == here ? "same process" : job + " " + std::to_string(::getpid());
      },
      2, {});
  std::set<std::string> processes;
  for (const auto& [index, result] : RunAll(pool, 100)) {
    REQUIRE(result.end == JobEnd::kDone);
    CHECK(result.bytes.starts_with(std::to_string(index) + " "));
    processes.insert(result.bytes.substr(result.bytes.find(' ')));
  }
  CHECK(processes.size() == 2);
}

TEST_CASE("A job that hangs or crashes or eats memory is a result with its reason") {
  SKIP_UNDER_SANITIZER();
  for (const int workers : {1, 2}) {
    WorkerPool pool(Trouble, workers, {.timeout_s = 3.0, .memory_mb = 32});
    const std::map<int, JobResult> results = RunAll(pool, 8);
    REQUIRE(results.size() == 8);
    CHECK(results.at(0).bytes == "answer to 0");
    CHECK(results.at(1).end == JobEnd::kHung);
    CHECK(results.at(1).bytes == "had not ended after 3 s (run.timeout_s), twice");
    CHECK(results.at(2).end == JobEnd::kCrashed);
    CHECK(results.at(2).bytes == "ended by signal 11 (Segmentation fault), twice");
    CHECK(results.at(3).end == JobEnd::kOutOfMemory);
    CHECK(results.at(3).bytes == "wanted more than 32 MB of memory, twice");
    CHECK(results.at(4).end == JobEnd::kThrew);
    CHECK(results.at(4).bytes == "no such setting");
    CHECK(results.at(5).end == JobEnd::kCrashed);
    CHECK(results.at(5).bytes == "ended by signal 6 (Aborted): ODE INTERNAL ERROR 1, twice");
    CHECK(results.at(6).bytes == "answer to 6");
    CHECK(results.at(7).bytes == "answer to 7");
  }
}

TEST_CASE("Trouble of the machine ends a batch, is no result of a job, and the pool goes on") {
  const test::TemporaryFolder folder;
  const std::string mended = folder / "mended";
  for (const int workers : {1, 2}) {
    WorkerPool pool(
        [&mended](const std::string& job) {
          if (job == "3" && !std::ifstream(mended)) throw MachineTrouble("no room for " + job);
          return job;
        },
        workers, {});
    const auto run = [&] {
      pool.Run({8, [](int i) { return std::to_string(i); },
                [](int i, const JobResult& result) {
                  CHECK(i != 3);
                  CHECK(result.end == JobEnd::kDone);
                },
                [] { return true; }});
    };
    CHECK_THROWS_WITH(run(), "no room for 3");
    CHECK_THROWS_AS(run(), MachineTrouble);
    test::WriteText(mended, "");
    CHECK(RunAll(pool, 8).at(3).bytes == "3");
    std::filesystem::remove(mended);
  }
}

TEST_CASE("A job whose worker is killed from outside is done by the next worker") {
  const test::TemporaryFolder folder;
  const std::string mark = folder / "killed";
  WorkerPool pool(
      [&mark](const std::string& job) {
        if (job == "3" && !std::ifstream(mark)) {
          std::ofstream(mark) << "once";
          ::kill(::getpid(), SIGKILL);
        }
        return job;
      },
      2, {.retries = 0});
  for (const auto& [index, result] : RunAll(pool, 8)) {
    CHECK(result.end == JobEnd::kDone);
    CHECK(result.bytes == std::to_string(index));
  }
}

TEST_CASE("A batch that is told to stop kills what is under way and the pool goes on") {
  WorkerPool pool(
      [](const std::string& job) {
        if (job == "stuck") ::sleep(1000);
        return job;
      },
      2, {});
  int asked = 0;
  const bool is_whole = pool.Run({4, [](int) { return std::string("stuck"); },
                                  [](int, const JobResult&) { FAIL("nothing can have ended"); },
                                  [&] { return ++asked < 3; }});
  CHECK_FALSE(is_whole);
  CHECK(RunAll(pool, 4).size() == 4);
}

TEST_CASE("A worker sees what was loaded before it started") {
  const std::vector<int> loaded{7, 8, 9};
  WorkerPool pool([&](const std::string& job) { return std::to_string(loaded.at(std::stoi(job))); },
                  1, {});
  CHECK(RunAll(pool, 3).at(2).bytes == "9");
}

TEST_CASE("A long answer comes through whole") {
  WorkerPool pool([](const std::string& job) { return std::string(3'000'000, job[0]); }, 2, {});
  for (const auto& [index, result] : RunAll(pool, 3)) {
    CHECK(result.bytes == std::string(3'000'000, static_cast<char>('0' + index)));
  }
}

TEST_CASE("A worker has its next job before it asks, and the last jobs wait for who is free") {
  // How many jobs of a batch were handed out before the first was done.
  const auto handed_out = [](int workers, int count) {
    WorkerPool pool([](const std::string& job) { return job; }, workers, {});
    int handed = 0, at_first = 0;
    pool.Run({count,
              [&](int i) {
                ++handed;
                return std::to_string(i);
              },
              [&](int, const JobResult&) { at_first = at_first > 0 ? at_first : handed; },
              [] { return true; }});
    CHECK(handed == count);
    return at_first;
  };
  CHECK(handed_out(1, 5) == 2);
  CHECK(handed_out(1, 2) == 1);
  CHECK(handed_out(2, 6) == 4);
  CHECK(handed_out(2, 5) == 3);
  CHECK(handed_out(2, 4) == 2);
}

TEST_CASE("A job that was to be tried again is forgotten with its batch") {
  WorkerPool pool(
      [](const std::string& job) {
        if (job == "crash") ::_exit(7);
        return job;
      },
      1, {.retries = 3});
  int asked = 0;
  CHECK_FALSE(pool.Run({1, [](int) { return std::string("crash"); },
                        [](int, const JobResult&) { FAIL("it was to be tried again"); },
                        [&] { return ++asked < 3; }}));
  for (const auto& [index, result] : RunAll(pool, 2)) CHECK(result.bytes == std::to_string(index));
}

/// Whether a process may have so many MiB more. They are never touched.
std::string Take(const std::string& mib) {
  const size_t size = std::stoul(mib) << 20;
  void* const taken =
      ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (taken == MAP_FAILED) return "refused";
  ::munmap(taken, size);
  return "taken";
}

TEST_CASE("A worker may take its memory on top of what the sweep itself holds, and no more") {
  SKIP_UNDER_SANITIZER();
  constexpr size_t kHeld = size_t{200} << 20;
  void* const held =
      ::mmap(nullptr, kHeld, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  REQUIRE(held != MAP_FAILED);
  WorkerPool pool([](const std::string& job) { return Take(job == "0" ? "48" : "80"); }, 1,
                  {.memory_mb = 64});
  const std::map<int, JobResult> results = RunAll(pool, 2);
  ::munmap(held, kHeld);
  CHECK(results.at(0).bytes == "taken");
  CHECK(results.at(1).bytes == "refused");
}

TEST_CASE("A worker has no open file of the sweep") {
  const int low = ::open("/dev/null", O_RDONLY), high = ::fcntl(low, F_DUPFD, 500);
  REQUIRE(low >= 0);
  REQUIRE(high >= 500);
  WorkerPool pool(
      [&](const std::string& job) {
        return std::string(::fcntl(job == "0" ? low : high, F_GETFD) < 0 ? "closed" : "open");
      },
      1, {});
  for (const auto& [index, result] : RunAll(pool, 2)) CHECK(result.bytes == "closed");
  ::close(low);
  ::close(high);
}

TEST_CASE("The cores to use are those that this process may run on") {
  cpu_set_t before;
  CPU_ZERO(&before);
  REQUIRE(::sched_getaffinity(0, sizeof before, &before) == 0);
  int allowed = 0;
  cpu_set_t one;
  CPU_ZERO(&one);
  for (int core = 0; core < CPU_SETSIZE; ++core) {
    if (!CPU_ISSET(core, &before)) continue;
    if (++allowed == 1) CPU_SET(core, &one);
  }
  CHECK(CoresToUse() == allowed);
  REQUIRE(::sched_setaffinity(0, sizeof one, &one) == 0);
  CHECK(CoresToUse() == 1);
  ::sched_setaffinity(0, sizeof before, &before);
}

TEST_CASE("A worker that is killed between two batches is replaced in the next") {
  WorkerPool pool([](const std::string& job) { return job + " " + std::to_string(::getpid()); }, 1,
                  {.retries = 0});
  const std::string first = RunAll(pool, 1).at(0).bytes;
  const pid_t worker = std::stoi(first.substr(2));
  REQUIRE(::kill(worker, SIGKILL) == 0);
  siginfo_t ended{};  // and left for the pool to reap
  REQUIRE(::waitid(P_PID, static_cast<id_t>(worker), &ended, WEXITED | WNOWAIT) == 0);
  const JobResult second = RunAll(pool, 1).at(0);
  CHECK(second.end == JobEnd::kDone);
  CHECK(second.bytes.starts_with("0 "));
  CHECK(second.bytes != first);
}

long OpenFiles() { return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {}); }

TEST_CASE("A pool that is gone leaves no process, not even a dead one, and no open file") {
  const long before = OpenFiles();
  std::set<pid_t> workers;
  {
    WorkerPool pool(
        [](const std::string& job) {
          if (job == "5") ::_exit(7);
          return std::to_string(::getpid());
        },
        2, {.retries = 0});
    for (const auto& [index, result] : RunAll(pool, 20)) {
      if (index != 5) workers.insert(std::stoi(result.bytes));
    }
    CHECK(workers.size() >= 2);
    CHECK(OpenFiles() > before);
  }
  CHECK(OpenFiles() == before);
  for (const pid_t worker : workers) {
    const bool is_there = ::kill(worker, 0) == 0 || errno != ESRCH;
    CHECK_FALSE(is_there);
  }
}

TEST_CASE("The time of a job begins when the one before it has ended") {
  WorkerPool pool(
      [](const std::string& job) {
        ::usleep(400'000);
        return job;
      },
      1, {.timeout_s = 3.0, .retries = 0});  // for 3.2 s of jobs
  for (const auto& [index, result] : RunAll(pool, 8)) {
    CHECK(result.end == JobEnd::kDone);
    CHECK(result.bytes == std::to_string(index));
  }
}

TEST_CASE("Where no process can be made a batch ends with the reason, and a later one is run") {
  SKIP_UNDER_SANITIZER();
  WorkerPool pool([](const std::string& job) { return job; }, 1, {});
  rlimit before{};
  REQUIRE(::getrlimit(RLIMIT_NOFILE, &before) == 0);
  const rlimit none{3, before.rlim_max};
  std::string told = "nothing";
  ::setrlimit(RLIMIT_NOFILE, &none);
  try {
    pool.Run({1, [](int) { return std::string("0"); }, [](int, const JobResult&) {},
              [] { return true; }});
  } catch (const MachineTrouble& trouble) {
    told = trouble.what();
  }
  ::setrlimit(RLIMIT_NOFILE, &before);
  CHECK(told == "cannot start a worker process: Too many open files");
  CHECK(RunAll(pool, 2).at(1).bytes == "1");
}

TEST_CASE("A job of nothing, and one of as much as a socket holds, come to the worker whole") {
  WorkerPool pool(
      [](const std::string& job) {
        return std::to_string(job.size()) + (job.empty() ? "" : job.substr(job.size() - 1));
      },
      1, {});
  std::map<int, std::string> answers;
  pool.Run({2, [](int i) { return i == 0 ? std::string() : std::string(60'000, 'x') + "y"; },
            [&](int i, const JobResult& result) { answers[i] = result.bytes; },
            [] { return true; }});
  CHECK(answers == std::map<int, std::string>{{0, "0"}, {1, "60001y"}});
}

}  // namespace
}  // namespace rift::sweep
