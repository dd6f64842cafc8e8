// What a journal asks of SQLite: the size of its pages, and to wait for who writes it.
#include <unistd.h>

#include <SQLiteCpp/SQLiteCpp.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <fstream>
#include <functional>
#include <string>
#include <thread>

#include "rift/sweep/run/journal.hpp"
#include "rift/sweep/run/journal_summary.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"
#include "support/until.hpp"

namespace rift::sweep {
namespace {

const Facts kFacts{{"seed", "1"}};

JournalEntry Entry(double gap_m) { return {"ok", gap_m, false, "row"}; }

TEST_CASE("Pages of a journal hold several rows: they are of 8 KiB") {
  const test::TemporaryFolder folder;
  Journal(folder / "journal.sqlite", kFacts).Close();
  const std::string bytes = test::ReadFile(folder / "journal.sqlite");
  // Bytes 16 and 17 of an SQLite file, the higher first.
  CHECK(static_cast<unsigned char>(bytes[16]) == 0x20);
  CHECK(static_cast<unsigned char>(bytes[17]) == 0x00);
  CHECK(bytes.size() % 8192 == 0);
}

/// Calls while another connection holds the file for itself, until the caller waits for it.
void WhileHeld(const std::string& file, const char* begin, const std::function<void()>& call) {
  SQLite::Database other(file, SQLite::OPEN_READWRITE);
  other.exec(begin);
  const std::string state = "/proc/self/task/" + std::to_string(::gettid()) + "/stat";
  std::atomic<bool> has_ended = false;
  std::thread release([&] {
    test::WaitUntil("who wants the journal sleeps", [&] {
      std::string pid, name, is;
      std::ifstream(state) >> pid >> name >> is;
      return has_ended || is == "S";
    });
    other.exec("COMMIT");
  });
  try {
    call();
  } catch (...) {
    has_ended = true;
    release.join();
    throw;
  }
  has_ended = true;
  release.join();
}

TEST_CASE("Whoever adds to a journal, or reads it, waits for another who writes it just now") {
  const test::TemporaryFolder folder;
  const std::string file = folder / "journal.sqlite";
  {
    Journal journal(file, kFacts);
    journal.Add("a", Entry(0.01));
    journal.Commit();
    WhileHeld(file, "BEGIN IMMEDIATE", [&] { journal.Add("b", Entry(0.02)); });
    journal.Close();
  }
  // Without a write-ahead log one who writes keeps all readers out.
  int trials = 0;
  WhileHeld(file, "BEGIN EXCLUSIVE", [&] { trials = ReadJournal(file).trials_by_status.at("ok"); });
  CHECK(trials == 2);
  WhileHeld(file, "BEGIN EXCLUSIVE", [&] { CHECK(Journal(file, kFacts).Has("b")); });
}

TEST_CASE("A journal is copied as well once a row of it was looked up") {
  const test::TemporaryFolder folder;
  Journal journal(folder / "journal.sqlite", kFacts);
  journal.Add("a", Entry(0.01));
  CHECK(journal.Find("a") == "row");
  CHECK_FALSE(journal.Find("b"));
  journal.CopyTo(folder / "copy");
  CHECK(ReadJournal(folder / "copy").trials_by_status.at("ok") == 1);
  CHECK(journal.Find("a") == "row");
  journal.CopyTo(folder / "again");
  CHECK(IsJournalOf(folder / "again", kFacts));
}

}  // namespace
}  // namespace rift::sweep
