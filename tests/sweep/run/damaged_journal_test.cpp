#include <SQLiteCpp/SQLiteCpp.h>

#include <catch2/catch.hpp>
#include <cstring>
#include <random>
#include <stdexcept>

#include "rift/sweep/falsify/trial_runner.hpp"
#include "rift/sweep/run/journal.hpp"
#include "rift/sweep/run/journal_summary.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"

namespace rift::sweep {
namespace {

namespace fs = std::filesystem;
using Generator = std::mt19937_64;

constexpr int kTrials = 60;
const Facts kFacts{{"gap.threshold_m", "0.06"}, {"seed", "1"}};

std::vector<TrialRequest> Requests() {
  std::vector<TrialRequest> requests(kTrials);
  for (int i = 0; i < kTrials; ++i) {
    requests[i].theta = {{std::to_string(i), static_cast<double>(i)}};
    requests[i].trial = "1";
    requests[i].seed = static_cast<std::uint64_t>(i);
  }
  return requests;
}

TrialRow Evaluated(const TrialRequest& request) {
  TrialRow row{.theta = request.theta, .trial = request.trial, .seed = request.seed};
  const double i = request.theta[0].number.value();
  row.candidate = "simulation, seed " + request.theta[0].text;
  row.reference = "path";
  row.comparison.gap_m = 0.001 * i;
  row.falsified = i > 40;
  row.status = i < 55 ? TrialStatus::kOk : TrialStatus::kFell;
  for (int k = 0; k < 8; ++k) row.evidence.errors_m.emplace_back(0.01 * k, 0.001 * i);
  return row;
}

/// All that a table is made of, as bytes, from a sweep over the journal of a file.
struct Swept {
  std::string table;
  int computed = 0;
  int damaged = 0;
};
Swept SweepOver(const fs::path& file) {
  Journal journal(file, kFacts);
  Swept swept;
  swept.damaged = journal.Damaged();
  Watch watch;
  watch.seen = [&](const TrialRow&, bool from_journal) { swept.computed += from_journal ? 0 : 1; };
  const auto key_of = [](const TrialRequest& request) { return "x=" + request.theta[0].text; };
  TrialRunner runner(Evaluated, key_of, &journal, 1, {}, watch);
  const auto rows = runner.Run(Requests());
  journal.Close();
  for (const TrialRow& row : rows.value()) {
    swept.table += row.theta[0].text + " " + EncodeFindings(row) + "\n";
  }
  return swept;
}

int Drawn(Generator& generator, int below) {
  return std::uniform_int_distribution(0, below - 1)(generator);
}

void OverwriteBytes(const fs::path& file, Generator& generator) {
  std::string bytes = test::ReadFile(file);
  for (int left = 1 + Drawn(generator, 4); left > 0; --left) {
    bytes[static_cast<size_t>(Drawn(generator, static_cast<int>(bytes.size())))] =
        static_cast<char>(Drawn(generator, 256));
  }
  test::WriteText(file, bytes);
}

std::string KeyDrawn(Generator& generator) {
  return "'x=" + std::to_string(Drawn(generator, kTrials)) + "'";
}

/// What SQLite itself has nothing against.
void ChangeBySql(const fs::path& file, Generator& generator) {
  SQLite::Database database(file.string(), SQLite::OPEN_READWRITE);
  const std::string a = KeyDrawn(generator), b = KeyDrawn(generator);
  const std::string from_b = "(SELECT row FROM trial WHERE key = " + b + ")";
  const std::vector<std::string> changes{
      // two rows under each other's keys, with and without their sums
      "UPDATE trial SET key = CASE key WHEN " + a + " THEN 'c' ELSE " + a + " END WHERE key IN (" +
          a + ", " + b + "); UPDATE trial SET key = " + b + " WHERE key = 'c'",
      "UPDATE trial SET row = " + from_b + " WHERE key = " + a,
      "UPDATE trial SET row = " + from_b + ", sum = (SELECT sum FROM trial WHERE key = " + b +
          ") WHERE key = " + a,
      "UPDATE trial SET status = 'crashed' WHERE key = " + a,
      "UPDATE trial SET gap_m = gap_m + 1e-17 + 0.5 WHERE key = " + a,
      "UPDATE trial SET falsified = 1 - falsified WHERE key = " + a,
      "UPDATE trial SET row = zeroblob(length(row)) WHERE key = " + a,
      "UPDATE trial SET row = substr(row, 1, 20) WHERE key = " + a,
      "UPDATE trial SET sum = NULL WHERE key = " + a,
      "UPDATE trial SET row = CAST(row AS TEXT) WHERE key = " + a,
      "DELETE FROM trial WHERE key = " + a,
      "DELETE FROM trial",
      "DELETE FROM made_from",
      "UPDATE made_from SET value = '2' WHERE key = 'seed'",
      "ALTER TABLE trial RENAME COLUMN falsified TO verified",
      "UPDATE note SET value = '1e9'"};
  try {
    database.exec(changes[static_cast<size_t>(Drawn(generator, static_cast<int>(changes.size())))]);
  } catch (const SQLite::Exception&) {
    // A swap of a row with itself.
  }
}

TEST_CASE("A damaged journal never gives a wrong row: they are run again or it is refused") {
  const test::TemporaryFolder folder;
  const fs::path sound = folder / "sound.sqlite", file = folder / "journal.sqlite";
  const std::string table = SweepOver(sound).table;
  REQUIRE(SweepOver(sound).table == table);
  REQUIRE(SweepOver(sound).computed == 0);
  Generator generator(23);
  int repaired = 0, refused = 0;
  for (int i = 0; i < 200; ++i) {
    fs::copy_file(sound, file, fs::copy_options::overwrite_existing);
    (i % 2 == 0 ? OverwriteBytes : ChangeBySql)(file, generator);
    INFO("damage " << i);
    try {
      const Swept swept = SweepOver(file);
      CHECK(swept.table == table);
      CHECK(swept.computed >= swept.damaged - 1);  // one entry may be a note
      repaired += swept.computed > 0 ? 1 : 0;
      CHECK(SweepOver(file).computed == 0);
    } catch (const std::exception& error) {
      CHECK(std::string(error.what()).find('\n') == std::string::npos);
      CHECK(std::string(error.what()).starts_with(file.string() + ": ") !=
            (std::string(error.what()).find("another experiment") != std::string::npos));
      ++refused;
      Journal::Remove(file);
    }
  }
  CHECK(repaired > 50);
  CHECK(refused > 5);
  CHECK(repaired + refused < 200);  // some bytes belong to nobody
}

TEST_CASE("Rows of a journal made from other facts are not believed") {
  const test::TemporaryFolder folder;
  const std::string file = folder / "journal.sqlite", other = folder / "other.sqlite";
  SweepOver(file);
  Journal(other, {{"gap.threshold_m", "0.05"}, {"seed", "1"}}).Close();
  {
    SQLite::Database database(other, SQLite::OPEN_READWRITE);
    database.exec("ATTACH '" + file + "' AS good");
    database.exec("INSERT INTO trial SELECT * FROM good.trial");
  }
  CHECK(ReadJournal(file).damaged == 0);
  CHECK(ReadJournal(file).trials_by_status.at("ok") == 55);
  CHECK(ReadJournal(other).damaged == kTrials);
  CHECK(ReadJournal(other).trials_by_status.empty());
  Journal journal(other, {{"gap.threshold_m", "0.05"}, {"seed", "1"}});
  CHECK(journal.Damaged() == kTrials);
  CHECK_FALSE(journal.Find("x=1"));
}

TEST_CASE("Damaged notes and rows are counted when a journal is opened, and gone the next time") {
  const test::TemporaryFolder folder;
  const std::string file = folder / "journal.sqlite";
  {
    Journal journal(file, kFacts);
    for (const char* key : {"x=1", "x=2"}) journal.Add(key, {"ok", 0.01, false, "row"});
    journal.SetNote("elapsed_s", "12.5");
    journal.SetNote("name", "night");
    journal.Close();
  }
  const auto change = [&](const char* command) {
    SQLite::Database(file, SQLite::OPEN_READWRITE).exec(command);
  };
  const auto damaged = [&] {
    Journal journal(file, kFacts);
    CHECK_FALSE(journal.Note("elapsed_s"));
    CHECK(journal.Note("name") == "night");
    CHECK(journal.Has("x=2"));
    return journal.Damaged();
  };
  change("UPDATE note SET value = '1e9' WHERE name = 'elapsed_s'");
  CHECK(damaged() == 1);
  CHECK(damaged() == 0);
  change("UPDATE trial SET row = 'other' WHERE key = 'x=1'");
  change("INSERT INTO note VALUES ('elapsed_s', '1e9', NULL), ('total', '3', '')");
  CHECK(damaged() == 3);
  CHECK(damaged() == 0);
}

TEST_CASE("A journal that was removed or replaced while it is written says so") {
  const test::TemporaryFolder folder;
  const fs::path file = folder / "out/journal.sqlite";
  for (const bool is_replaced : {false, true}) {
    fs::create_directories(file.parent_path());
    Journal journal(file, kFacts);
    journal.Add("x=1", {"ok", 0.01, false, "row"});
    CHECK_NOTHROW(journal.Commit());
    fs::remove_all(file.parent_path());
    if (is_replaced) {
      fs::create_directories(file.parent_path());
      Journal(file, kFacts).Close();
    }
    journal.Add("x=2", {"ok", 0.01, false, "row"});
    CHECK_THROWS_WITH(journal.Commit(),
                      Catch::StartsWith(file.string() + " was removed, moved or replaced"));
    CHECK_THROWS(journal.Close());
  }
}

TEST_CASE("Bytes that are no row are refused, whichever byte is wrong") {
  const std::string bytes = EncodeFindings(Evaluated(Requests()[3]));
  TrialRow row;
  CHECK_NOTHROW(DecodeFindings(bytes, row));
  CHECK(EncodeFindings(row) == bytes);
  for (size_t length = 0; length < bytes.size(); ++length) {
    CHECK_THROWS_AS(DecodeFindings(bytes.substr(0, length), row), std::runtime_error);
  }
  const auto with = [&](const void* value, size_t size, size_t at) {
    std::string changed = bytes;
    std::memcpy(changed.data() + at, value, size);
    return changed;
  };
  const size_t status_at = 1 + sizeof(std::uint64_t);  // behind the seed and whether there is one
  for (const int status : {0x7fffffff, -1, 13}) {
    CHECK_THROWS_AS(DecodeFindings(with(&status, sizeof status, status_at), row),
                    std::runtime_error);
  }
  for (size_t at = 0; at < bytes.size(); ++at) {
    for (const int value : {0x00, 0x02, 0x7f, 0xff}) {
      try {
        DecodeFindings(with(&value, 1, at), row);
        CHECK(static_cast<size_t>(row.status) < EnumNames(TrialStatus{}).size());
      } catch (const std::runtime_error&) {
      }
    }
  }
}

}  // namespace
}  // namespace rift::sweep
