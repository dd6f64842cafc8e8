#include "rift/sweep/run/journal.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "journal_database.hpp"
#include "rift/files/network_file_system.hpp"
#include "rift/statistics/hash.hpp"

namespace rift::sweep {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// Names at most a few of the facts that differ, in one line: those of a damaged file may hold
/// anything.
std::string Differences(const Facts& then, const Facts& now) {
  constexpr size_t kMostNamed = 5;
  std::vector<std::string> differing;
  for (const auto& [key, value] : then) {
    const auto found = now.find(key);
    if (found == now.end()) {
      differing.push_back(fmt::format("{} was {} and is not set", key, value));
    } else if (found->second != value) {
      differing.push_back(fmt::format("{} was {} and is {}", key, value, found->second));
    }
  }
  for (const auto& [key, value] : now) {
    if (!then.contains(key))
      differing.push_back(fmt::format("{} is {} and was not set", key, value));
  }
  const size_t more = differing.size() > kMostNamed ? differing.size() - kMostNamed : 0;
  differing.resize(differing.size() - more);
  std::string text = fmt::format("{}", fmt::join(differing, "; "));
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; }, '?');
  return more == 0 ? text : fmt::format("{}; and {} more", text, more);
}

bool IsGivenUp(const std::string& status) {
  return std::find(kGivenUp.begin(), kGivenUp.end(), status) != kGivenUp.end();
}

bool HasSharedMemory(const fs::path& file, JournalLog log) {
  if (log != JournalLog::kAsTheFolderAllows) return log == JournalLog::kWriteAhead;
  return files::NetworkFileSystemOf(file.parent_path()).empty();
}

JournalEntry EntryOf(SQLite::Statement& row) {
  JournalEntry entry{.status = row.getColumn(1).getString(),
                     .gap_m = std::numeric_limits<double>::quiet_NaN(),
                     .falsified = row.getColumn(3).getInt() != 0,
                     .bytes = row.getColumn(4).getString()};
  if (!row.getColumn(2).isNull()) entry.gap_m = row.getColumn(2).getDouble();
  return entry;
}

}  // namespace

std::string HashOf(const Facts& made_from) {
  std::string facts;
  for (const auto& [key, value] : made_from) facts += fmt::format("{}\n{}\n", key, value);
  return statistics::Hash128Text(facts);
}

struct Journal::Store {
  Store(const fs::path& path, JournalLog log)
      : file(path), database(path.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE) {
    database.setBusyTimeout(2000);
    Check();
    // Before anything is written: a database of somebody else stays as it is.
    const bool is_new = Count(database, "SELECT COUNT(*) FROM sqlite_master") == 0;
    if (!is_new) RequireOurTables(database, file);
    // NORMAL: a commit survives the process, and after a loss of power the journal is whole but
    // may lack the last commits.
    // Rows of 1.4 kB: each would fill a page of 4 kB by itself.
    database.exec("PRAGMA page_size=8192");
    if (HasSharedMemory(path, log)) {
      database.exec("PRAGMA journal_mode=WAL; PRAGMA synchronous=NORMAL;");
    } else {
      database.exec("PRAGMA journal_mode=DELETE; PRAGMA synchronous=FULL;");
    }
    if (is_new) MakeTables(database);
  }

  /// Removes what is damaged.
  void Prepare(const Facts& made_from) {
    facts = HashOf(made_from);
    DefineSoundRows(database, facts);
    damaged = CountDamagedTrials(database) + CountDamagedNotes(database);
    if (damaged > 0) {
      database.exec("DELETE FROM trial WHERE key NOT IN (SELECT key FROM sound_trial)");
      database.exec("DELETE FROM note WHERE name NOT IN (SELECT name FROM sound_note)");
    }
    find.emplace(database, "SELECT row FROM sound_trial WHERE key = ?");
    add.emplace(database,
                "INSERT OR REPLACE INTO trial VALUES "
                "(?1, ?2, ?3, ?4, ?5, sum_of('trial', ?1, ?2, ?3, ?4, ?5))");
  }

  /// A statement of its own, since one that has not ended keeps the journal from WAL mode.
  void Check() {
    SQLite::Statement check(database, "PRAGMA quick_check(1)");
    if (check.executeStep() && check.getColumn(0).getString() != "ok") {
      throw SQLite::Exception(check.getColumn(0).getString(), SQLITE_CORRUPT);
    }
  }

  /// What goes into a file without a name is lost when the process ends.
  void RequireInPlace() {
    int has_moved = 0;
    sqlite3_file_control(database.getHandle(), nullptr, SQLITE_FCNTL_HAS_MOVED, &has_moved);
    if (has_moved == 0) return;
    throw std::runtime_error(
        fmt::format("{} was removed, moved or replaced while the sweep was running: put it back "
                    "and run the same command again, or start over",
                    file.string()));
  }

  void Begin() {
    if (transaction) return;
    transaction.emplace(database);
    begun = Clock::now();
  }

  fs::path file;
  std::string facts;  ///< as one hash
  SQLite::Database database;
  std::optional<SQLite::Statement> find, add;
  std::optional<SQLite::Transaction> transaction;
  Clock::time_point begun;
  int damaged = 0;
};

Journal::Journal(const fs::path& file, const Facts& made_from, JournalLog log) {
  Told(file, [&] {
    RequireFiles(file);
    store_ = std::make_unique<Store>(file, log);
    const Facts then = ReadFacts(store_->database);
    if (then.empty()) {
      SQLite::Transaction transaction(store_->database);
      SQLite::Statement insert(store_->database, "INSERT INTO made_from VALUES (?, ?)");
      for (const auto& [key, value] : made_from) {
        insert.bind(1, key);
        insert.bind(2, value);
        insert.exec();
        insert.reset();
      }
      transaction.commit();
    } else if (then != made_from) {
      throw std::invalid_argument(fmt::format(
          "{} is the journal of another experiment: {}; choose another folder with --out, or "
          "start over with --fresh",
          file.string(), Differences(then, made_from)));
    }
    store_->Prepare(made_from);
  });
}

Journal::~Journal() {
  try {
    if (store_) Commit();
  } catch (const std::runtime_error&) {
    // Only while another error, which is the one to be told, unwinds.
  }
}

std::optional<std::string> Journal::Find(const std::string& key) {
  return Told(store_->file, [&]() -> std::optional<std::string> {
    SQLite::Statement& find = *store_->find;
    find.reset();
    find.bindNoCopy(1, key);
    std::optional<std::string> bytes;
    if (find.executeStep()) bytes = find.getColumn(0).getString();
    find.reset();
    return bytes;
  });
}

void Journal::Add(const std::string& key, const JournalEntry& entry) {
  Told(store_->file, [&] {
    store_->Begin();
    SQLite::Statement& add = *store_->add;
    add.reset();
    add.bindNoCopy(1, key);
    add.bindNoCopy(2, entry.status);
    if (std::isnan(entry.gap_m)) {
      add.bind(3);
    } else {
      add.bind(3, entry.gap_m + 0.0);  // SQLite keeps no negative zero
    }
    add.bind(4, static_cast<int>(entry.falsified));
    add.bindNoCopy(5, entry.bytes.data(), static_cast<int>(entry.bytes.size()));
    add.exec();
  });
  Tick();
}

int Journal::Forget(const std::string& status) {
  return Told(store_->file, [&] {
    store_->Begin();
    SQLite::Statement forget(store_->database, "DELETE FROM trial WHERE status = ?");
    forget.bind(1, status);
    return forget.exec();
  });
}

void Journal::Tick() {
  if (!store_->transaction) return;
  const std::chrono::duration<double> since = Clock::now() - store_->begun;
  if (since.count() > kCommitEvery_s) Commit();
}

void Journal::Commit() {
  if (!store_->transaction) return;
  Told(store_->file, [&] {
    store_->transaction->commit();
    store_->transaction.reset();
  });
  store_->RequireInPlace();
}

int Journal::Damaged() const { return store_->damaged; }

void Journal::SetNote(const std::string& name, const std::string& value) {
  Told(store_->file, [&] {
    store_->Begin();
    SQLite::Statement insert(store_->database,
                             "INSERT OR REPLACE INTO note VALUES "
                             "(?1, ?2, sum_of('note', ?1, ?2))");
    insert.bind(1, name);
    insert.bind(2, value);
    insert.exec();
  });
}

std::optional<std::string> Journal::Note(const std::string& name) {
  return Told(store_->file, [&]() -> std::optional<std::string> {
    SQLite::Statement select(store_->database, "SELECT value FROM sound_note WHERE name = ?");
    select.bind(1, name);
    if (!select.executeStep()) return std::nullopt;
    return select.getColumn(0).getString();
  });
}

Journal::Merged Journal::Merge(const fs::path& other, Limits limits) {
  Merged merged;
  std::error_code not_there;
  if (!fs::is_regular_file(other, not_there)) throw UselessJournal(other.string() + " is no file");
  try {
    SQLite::Database database = OpenPublished(other);
    std::string facts = HashOf(ReadFacts(database));
    if (facts != store_->facts) {
      throw UselessJournal(other.string() + " is the journal of another experiment");
    }
    DefineSoundRows(database, facts);
    const int all = Count(database, "SELECT COUNT(*) FROM trial");
    SQLite::Statement rows(database, "SELECT key, status, gap_m, falsified, row FROM sound_trial");
    while (rows.executeStep()) {
      const std::string key = rows.getColumn(0).getString();
      const JournalEntry entry = EntryOf(rows);
      ++merged.trials;
      const bool is_given_up = IsGivenUp(entry.status);
      if (is_given_up && Has(key)) continue;
      const bool is_left_out = is_given_up && limits == Limits::kOther;
      merged.given_up += is_left_out;
      if (!is_left_out) Add(key, entry);
    }
    merged.damaged = all - merged.trials;
    SQLite::Statement elapsed(database, "SELECT value FROM sound_note WHERE name = 'elapsed_s'");
    if (elapsed.executeStep()) SetNote("elapsed_s", elapsed.getColumn(0).getString());
  } catch (const SQLite::Exception& error) {  // of the other: what ours reports is no such
    throw UselessJournal(fmt::format("{}: {}", other.string(), error.what()));
  }
  Commit();
  return merged;
}

void Journal::CopyTo(const fs::path& file) {
  Commit();
  Told(file, [&] {
    SQLite::Statement copy(store_->database, "VACUUM INTO ?");
    copy.bind(1, file.string());
    copy.exec();
  });
}

void Journal::Close() {
  Commit();
  store_->RequireInPlace();
  Told(store_->file, [&] {
    store_->find.reset();
    store_->add.reset();
    store_->database.exec("PRAGMA wal_checkpoint(TRUNCATE)");
    store_->database.tryExec("PRAGMA journal_mode=DELETE");  // not while somebody reads
  });
  store_.reset();
}

void Journal::Remove(const fs::path& file) {
  for (const char* suffix : kJournalSuffixes) {
    std::error_code error;
    fs::remove(file.string() + suffix, error);
    if (error) {
      throw std::runtime_error(
          fmt::format("cannot remove {}{}: {}", file.string(), suffix, error.message()));
    }
  }
}

bool IsJournalOf(const fs::path& file, const Facts& made_from) {
  std::error_code not_there;
  if (!fs::is_regular_file(file, not_there)) return false;
  try {
    SQLite::Database database = OpenPublished(file);
    SQLite::Statement check(database, "PRAGMA quick_check(1)");
    const bool is_whole = check.executeStep() && check.getColumn(0).getString() == "ok";
    return is_whole && ReadFacts(database) == made_from;
  } catch (const SQLite::Exception&) {
    return false;
  }
}

}  // namespace rift::sweep
