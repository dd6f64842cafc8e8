#include "rift/sweep/run/journal.hpp"

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>

#include "support/inputs/trials.hpp"
#include "support/processes/child_end.hpp"
#include "support/processes/process.hpp"

namespace rift::sweep {
namespace {

namespace fs = std::filesystem;

const Facts kFacts{{"gap.threshold_m", "0.06"}, {"seed", "1"}};

JournalEntry Entry(double gap_m) {
  return {"ok", gap_m, gap_m > 0.06, "row of " + std::to_string(gap_m)};
}

template <class Call>
std::string Refusal(const Call& call) {
  try {
    call();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "accepted";
}

TEST_CASE("What is no file under the name of a journal, or of its log, is refused at once") {
  const test::TemporaryFolder folder;
  const std::string file = folder / "journal.sqlite";
  using Make = std::function<void(const std::string&)>;
  const auto pipe = [](const std::string& name) { REQUIRE(::mkfifo(name.c_str(), 0600) == 0); };
  const auto device = [](const std::string& name) { fs::create_symlink("/dev/zero", name); };
  const auto directory = [](const std::string& name) { fs::create_directory(name); };
  for (const std::string suffix : {"", "-wal", "-shm", "-journal"}) {
    for (const Make& make : {Make(pipe), Make(device), Make(directory)}) {
      Journal(file, kFacts).Close();
      fs::remove(file + suffix);
      make(file + suffix);
      INFO(suffix);
      const std::string says = file + suffix + " is not a file";
      CHECK_THAT(Refusal([&] { Journal(file, kFacts); }), Catch::StartsWith(says));
      CHECK_THAT(Refusal([&] { ReadJournal(file); }), Catch::StartsWith(says));
      if (suffix.empty()) CHECK_FALSE(IsJournalOf(file, kFacts));
      Journal::Remove(file);
    }
  }
  pipe(folder / "shard.sqlite");
  Journal journal(file, kFacts);
  CHECK_THROWS_AS(journal.Merge(folder / "shard.sqlite"), UselessJournal);
}

TEST_CASE("A journal gives back what was added to it when it is opened again") {
  const test::TemporaryFolder folder;
  const std::string file = folder / "journal.sqlite";
  const std::string bytes("a\0b\xff", 4);
  {
    Journal journal(file, kFacts);
    CHECK_FALSE(journal.Find("x=1"));
    journal.Add("x=1", {"ok", 0.05, false, bytes});
    CHECK(journal.Find("x=1") == bytes);
    journal.SetNote("state", "running");
    journal.Close();
  }
  CHECK_FALSE(std::filesystem::exists(file + "-wal"));
  Journal journal(file, kFacts);
  CHECK(journal.Find("x=1") == bytes);
  CHECK_FALSE(journal.Find("x=2"));
  CHECK(journal.Note("state") == "running");
}

TEST_CASE("What was committed survives a kill of the process") {
  const test::TemporaryFolder folder;
  const std::string file = folder / "journal.sqlite";
  const pid_t child = ::fork();
  if (child == 0) {
    Journal journal(file, kFacts);
    for (int i = 0; i < 100; ++i) journal.Add(std::to_string(i), Entry(0.01 * i));
    journal.Commit();
    journal.Add("in flight", Entry(0.1));
    ::raise(SIGKILL);
  }
  const int status = test::EndOf(child, "the process that writes the journal");
  REQUIRE(WIFSIGNALED(status));
  CHECK(ReadJournal(file).trials_by_status.at("ok") == 100);
  Journal journal(file, kFacts);
  CHECK(journal.Find("99"));
  CHECK_FALSE(journal.Find("in flight"));
}

TEST_CASE("A journal of another experiment is refused with the keys that differ") {
  const test::TemporaryFolder folder;
  const std::string file = folder / "journal.sqlite";
  Journal(file, kFacts).Close();
  const Facts other{{"gap.threshold_m", "0.05"}, {"control.v_min", "0.2"}, {"seed", "1"}};
  const std::string refusal = Refusal([&] { Journal(file, other); });
  CHECK(refusal.find("gap.threshold_m was 0.06 and is 0.05") != std::string::npos);
  CHECK(refusal.find("control.v_min is 0.2 and was not set") != std::string::npos);
  CHECK(refusal.find("--fresh") != std::string::npos);
  CHECK_NOTHROW(Journal(file, kFacts));
}

TEST_CASE("A damaged journal is refused and left alone") {
  const test::TemporaryFolder folder;
  const std::string file = folder / "journal.sqlite";
  test::WriteText(file, std::string(5000, 'x'));
  const std::string text_file = Refusal([&] { Journal(file, kFacts); });
  CHECK(text_file.starts_with(file + ": it is damaged"));
  CHECK(test::ReadFile(file) == std::string(5000, 'x'));
  std::filesystem::remove(file);
  {
    Journal journal(file, kFacts);
    for (int i = 0; i < 1000; ++i) journal.Add(std::to_string(i), Entry(0.01));
    journal.Close();
  }
  std::string bytes = test::ReadFile(file);
  for (size_t i = 4096; i < bytes.size(); i += 512) bytes[i] = '\x7f';
  test::WriteText(file, bytes);
  CHECK(Refusal([&] { Journal(file, kFacts); }).find("it is damaged") != std::string::npos);
}

TEST_CASE("A journal that cannot be made says so") {
  CHECK(Refusal([] {
          Journal("/proc/journal.sqlite", kFacts);
        }).starts_with("/proc/journal.sqlite: it cannot be written here"));
  CHECK(Refusal([] { ReadJournal("nowhere/journal.sqlite"); }).find("no such file") !=
        std::string::npos);
}

TEST_CASE("A full disk ends with a message and keeps what was committed") {
  const test::TemporaryFolder folder;
  const std::string file = folder / "journal.sqlite";
  const pid_t child = ::fork();
  if (child == 0) {
    std::string told = "nothing";
    try {
      Journal journal(file, kFacts);
      journal.Add("first", Entry(0.01));
      journal.Commit();
      std::signal(SIGXFSZ, SIG_IGN);
      const rlimit limit{100'000, 100'000};
      ::setrlimit(RLIMIT_FSIZE, &limit);
      for (int i = 0; i < 10'000; ++i) {
        journal.Add(std::to_string(i), Entry(0.01));
        if (i % 100 == 0) journal.Commit();
      }
    } catch (const std::runtime_error& full) {
      told = full.what();
    }
    ::_exit(told.find("what was committed is kept") != told.npos ? 0 : 1);
  }
  const int status = test::EndOf(child, "the process that writes the journal");
  CHECK(status == 0);
  Journal journal(file, kFacts);
  CHECK(journal.Find("first"));
  CHECK(journal.Find("0"));
}

TEST_CASE("A reader sees a running sweep") {
  const test::TemporaryFolder folder;
  const std::string file = folder / "journal.sqlite";
  Journal journal(file, kFacts);
  journal.Add("a", Entry(0.05));
  journal.Add("b", Entry(0.09));
  journal.Add("c", {"crashed", std::nan(""), false, ""});
  journal.SetNote("state", "running");
  journal.Commit();
  const JournalSummary summary = ReadJournal(file);
  CHECK(summary.trials_by_status.at("ok") == 2);
  CHECK(summary.trials_by_status.at("crashed") == 1);
  CHECK(summary.falsified == 1);
  CHECK(*summary.largest_gap_m == 0.09);
  CHECK(summary.largest_key == "b");
  CHECK(summary.notes.at("state") == "running");
}

}  // namespace
}  // namespace rift::sweep
