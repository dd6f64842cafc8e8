#include "rift/sweep/run/journal.hpp"

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <SQLiteCpp/SQLiteCpp.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <stdexcept>

#include "rift/sweep/falsify/result.hpp"
#include "rift/sweep/run/journal_summary.hpp"
#include "rift/yaml/enum_name.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/child_end.hpp"
#include "support/processes/process.hpp"
#include "support/until.hpp"

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

TEST_CASE("A journal forgets the trials that ended in one way, and those alone, for good") {
  const test::TemporaryFolder folder;
  const std::string file = folder / "journal.sqlite";
  {
    Journal journal(file, kFacts);
    journal.Add("a", {"hung", std::nan(""), false, "a"});
    journal.Add("b", {"ok", 0.01, false, "b"});
    journal.Add("c", {"hung", std::nan(""), false, "c"});
    CHECK(journal.Forget("hung") == 2);
    CHECK(journal.Forget("crashed") == 0);
    CHECK_FALSE(journal.Find("a"));
    journal.Close();
  }
  Journal journal(file, kFacts);
  CHECK_FALSE(journal.Find("c"));
  CHECK(journal.Find("b") == "b");
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

TEST_CASE("What differs is told in one line, whatever a damaged journal holds") {
  const test::TemporaryFolder folder;
  const std::string file = folder / "journal.sqlite";
  Journal(file, {{"gap.\nthreshold_m",
                  "0.0\x7f\x1f"
                  "6"},
                 {"seed", "1"}})
      .Close();
  const std::string refusal = Refusal([&] { Journal(file, kFacts); });
  CHECK(refusal.find("gap.?threshold_m was 0.0??6 and is not set; ") != std::string::npos);
  CHECK(refusal.find('\n') == std::string::npos);
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

TEST_CASE("A database of somebody else is refused and left alone, to the last byte") {
  const test::TemporaryFolder folder;
  const std::string file = folder / "journal.sqlite";
  SQLite::Database(file, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE)
      .exec("CREATE TABLE photo(name); INSERT INTO photo VALUES ('x')");
  const std::string bytes = test::ReadFile(file);
  CHECK_THAT(Refusal([&] { Journal(file, kFacts); }),
             Catch::StartsWith(file + ": its tables are not those of this version of rift"));
  CHECK(test::ReadFile(file) == bytes);
}

TEST_CASE("The statuses of trials that were given up are those of workers that did not end well") {
  using Status = TrialStatus;
  REQUIRE(kGivenUp.size() == 3);
  CHECK(kGivenUp[0] == yaml::NameOf(Status::kHung));
  CHECK(kGivenUp[1] == yaml::NameOf(Status::kCrashed));
  CHECK(kGivenUp[2] == yaml::NameOf(Status::kOutOfMemory));
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

TEST_CASE("Of many keys that differ the first five are named, in their order, and how many more") {
  const test::TemporaryFolder folder;
  const std::string file = folder / "journal.sqlite";
  Journal(file, {{"a", "1"}, {"b", "1"}, {"c", "1"}, {"d", "1"}, {"same", "1"}}).Close();
  Facts now{{"a", "2"}, {"b", "2"}, {"c", "2"}, {"same", "1"}, {"x", "3"}};
  const std::string five =
      "a was 1 and is 2; b was 1 and is 2; c was 1 and is 2; d was 1 and is not set; x is 3 and "
      "was not set";
  const auto differences = [&] {
    const std::string text = Refusal([&] { Journal(file, now); });
    const size_t begin = text.find(": ") + 2;
    return text.substr(begin, text.find("; choose another folder") - begin);
  };
  CHECK(differences() == five);
  now["y"] = "4";
  CHECK(differences() == five + "; and 1 more");
  now["z"] = "5";
  CHECK(differences() == five + "; and 2 more");
}

TEST_CASE("Facts have a hash of their keys and values, each in its place") {
  const Facts facts{{"a", "1"}, {"b", "2"}};
  CHECK(HashOf(facts) == HashOf({{"b", "2"}, {"a", "1"}}));
  CHECK(HashOf(facts) != HashOf({{"a", "2"}, {"b", "1"}}));
  CHECK(HashOf(facts) != HashOf({{"a", "1"}}));
  CHECK(HashOf(facts).size() == 32);
}

TEST_CASE("A summary counts by status, and takes the first key of the largest gaps") {
  const test::TemporaryFolder folder;
  const std::string file = folder / "journal.sqlite";
  Journal journal(file, kFacts);
  journal.Add("z", Entry(0.09));
  journal.Add("y", Entry(0.09));
  journal.Add("x", Entry(0.01));
  journal.Add("w", {"fell", std::nan(""), true, ""});
  journal.Add(std::string("beside the table: ") + "v", Entry(0.5));
  journal.Close();
  const JournalSummary summary = ReadJournal(file);
  CHECK(summary.trials_by_status == std::map<std::string, int>{{"fell", 1}, {"ok", 3}});
  CHECK(summary.falsified == 3);
  CHECK(summary.largest_key == "y");
  CHECK(summary.damaged == 0);
  Journal::Remove(file);
  Journal(file, kFacts).Close();
  CHECK_FALSE(ReadJournal(file).largest_gap_m);
  CHECK(ReadJournal(file).falsified == 0);
}

TEST_CASE("What is added again takes the place of what was there, and so do notes") {
  const test::TemporaryFolder folder;
  Journal journal(folder / "journal.sqlite", kFacts);
  CHECK_FALSE(journal.Note("state"));
  CHECK_FALSE(journal.Has("x"));
  journal.Add("x", {"ok", 0.01, false, "first"});
  journal.Add("x", {"ok", -0.0, false, "second"});
  journal.SetNote("state", "running");
  journal.SetNote("state", "done");
  CHECK(journal.Find("x") == "second");
  CHECK(journal.Has("x"));
  CHECK(journal.Note("state") == "done");
  journal.Close();
  CHECK(ReadJournal(folder / "journal.sqlite").trials_by_status.at("ok") == 1);
}

TEST_CASE("A merge takes over every value of a row, and how long the other took") {
  const test::TemporaryFolder folder;
  Journal other(folder / "other", kFacts);
  other.Add("fell", {"fell", std::nan(""), true, "a"});
  other.Add("ok", {"ok", 0.07, true, "b"});
  other.SetNote("elapsed_s", "12.5");
  other.SetNote("state", "done");
  other.Close();
  Journal journal(folder / "all", kFacts);
  CHECK(journal.Merge(folder / "other").trials == 2);
  CHECK(journal.Note("elapsed_s") == "12.5");
  CHECK_FALSE(journal.Note("state"));
  const JournalSummary summary = ReadJournal(folder / "all");  // by another, at once
  CHECK(summary.falsified == 2);
  CHECK(summary.trials_by_status.at("fell") == 1);
  CHECK(summary.largest_key == "ok");
  CHECK(*summary.largest_gap_m == 0.07);
}

TEST_CASE("What is added is committed once the last commit was long ago, by whoever ticks") {
  const test::TemporaryFolder folder;
  const std::string file = folder / "journal.sqlite";
  Journal journal(file, kFacts);
  journal.Tick();  // nothing is open
  journal.Add("a", Entry(0.05));
  CHECK(ReadJournal(file).trials_by_status.empty());
  test::WaitUntil("it is committed", [&] {
    journal.Tick();
    return ReadJournal(file).trials_by_status.contains("ok");
  });
}

TEST_CASE("A journal that is not closed keeps what was added, too") {
  const test::TemporaryFolder folder;
  const std::string file = folder / "journal.sqlite";
  {
    Journal journal(file, kFacts);
    journal.Add("a", Entry(0.05));
    journal.SetNote("total", "3");
    CHECK(fs::exists(file + "-wal"));  // as a local folder allows
  }
  Journal journal(file, kFacts);
  CHECK(journal.Has("a"));
  CHECK(journal.Note("total") == "3");
}

TEST_CASE("A closed journal is one file, which a reader that cannot write beside it can read") {
  const test::TemporaryFolder folder;
  const std::string file = folder / "journal.sqlite";
  {
    Journal journal(file, kFacts);
    journal.Add("a", Entry(0.05));
    journal.Close();
  }
  CHECK(std::distance(fs::directory_iterator(folder.Path()), {}) == 1);
  // Bytes 18 and 19 of an SQLite file: 1 of the old journal, 2 of a write-ahead log.
  const std::string bytes = test::ReadFile(file);
  CHECK(bytes[18] == 1);
  CHECK(bytes[19] == 1);
}

TEST_CASE("A journal is removed with all that stands beside it, or it is said what is not") {
  const test::TemporaryFolder folder;
  const std::string file = folder / "journal.sqlite";
  for (const char* suffix : {"", "-wal", "-shm", "-journal"}) test::WriteText(file + suffix, "x");
  test::WriteText(file + "-other", "x");
  Journal::Remove(file);
  CHECK(std::distance(fs::directory_iterator(folder.Path()), {}) == 1);
  CHECK_NOTHROW(Journal::Remove(file));
  fs::create_directories(file + "-wal/full");
  CHECK_THROWS_WITH(Journal::Remove(file), "cannot remove " + file + "-wal: Directory not empty");
}

TEST_CASE("A journal that is not to be taken over is told with its file and why") {
  const test::TemporaryFolder folder;
  Journal journal(folder / "all", kFacts);
  Journal(folder / "other", {{"seed", "2"}}).Close();
  CHECK_THROWS_WITH(journal.Merge(folder / "other"),
                    (folder / "other") + " is the journal of another experiment");
  CHECK_THROWS_WITH(journal.Merge(folder / "gone"), (folder / "gone") + " is no file");
  CHECK_THROWS_WITH(Journal(folder / "other", {{"seed", "3"}}),
                    (folder / "other") +
                        " is the journal of another experiment: seed was 2 and is 3; choose "
                        "another folder with --out, or start over with --fresh");
}

TEST_CASE("A journal that another program is writing says so, and is not waited for for ever") {
  const test::TemporaryFolder folder;
  const std::string file = folder / "journal.sqlite";
  Journal journal(file, kFacts);
  SQLite::Database other(file, SQLite::OPEN_READWRITE);
  other.exec("BEGIN IMMEDIATE");
  CHECK_THROWS_WITH(journal.Add("a", Entry(0.05)),
                    file + ": another program is writing it (database is locked)");
}

}  // namespace
}  // namespace rift::sweep
