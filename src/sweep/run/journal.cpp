#include "rift/sweep/run/journal.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "rift/files/network_file_system.hpp"
#include "rift/statistics/hash.hpp"
#include "rift/sweep/run/beside_table.hpp"

namespace rift::sweep {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr const char* kSchema = R"(
  CREATE TABLE IF NOT EXISTS made_from(key TEXT PRIMARY KEY, value TEXT) WITHOUT ROWID;
  CREATE TABLE IF NOT EXISTS note(name TEXT PRIMARY KEY, value TEXT, sum TEXT) WITHOUT ROWID;
  CREATE TABLE IF NOT EXISTS trial(key TEXT PRIMARY KEY, status TEXT, gap_m REAL, falsified INTEGER,
                                   row BLOB, sum TEXT) WITHOUT ROWID;)";

// The rows that are believed: their sum is that of their values under their key in this journal.
constexpr const char* kSoundRows = R"(
  CREATE TEMP VIEW sound_note AS SELECT * FROM note WHERE sum = sum_of('note', name, value);
  CREATE TEMP VIEW sound_trial AS SELECT * FROM trial
    WHERE sum = sum_of('trial', key, status, gap_m, falsified, row);)";

/// How a user gets on from what SQLite reports.
std::string Advice(int code) {
  switch (code & 0xff) {
    case SQLITE_FULL:
      return "the disk is full; make room and run the same command again: what was committed is "
             "kept";
    case SQLITE_IOERR:
      return "the disk does not take it; run the same command again when it does: what was "
             "committed is kept";
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return "it is damaged; move it away to look at it, or start over with --fresh";
    case SQLITE_CANTOPEN:
    case SQLITE_READONLY:
    case SQLITE_PERM:
    case SQLITE_AUTH:
      return "it cannot be written here: choose another folder with --out";
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "another program is writing it";
    default:
      return "run the same command again, or start over with --fresh";
  }
}

/// SQLite tells of a damaged file in several.
std::string OnOneLine(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

/// Calls, and throws what SQLite reports as one line.
template <class Call>
auto Told(const fs::path& file, const Call& call) {
  try {
    return call();
  } catch (const SQLite::Exception& error) {
    throw std::runtime_error(fmt::format("{}: {} ({})", file.string(), Advice(error.getErrorCode()),
                                         OnOneLine(error.what())));
  }
}

/// Names at most a few of the facts that differ.
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
  const std::string text = fmt::format("{}", fmt::join(differing, "; "));
  return more == 0 ? text : fmt::format("{}; and {} more", text, more);
}

Facts ReadTable(SQLite::Database& database, const char* query) {
  Facts facts;
  SQLite::Statement select(database, query);
  while (select.executeStep()) {
    facts[select.getColumn(0).getString()] = select.getColumn(1).getString();
  }
  return facts;
}

Facts ReadFacts(SQLite::Database& database) {
  return ReadTable(database, "SELECT key, value FROM made_from");
}

/// Two different lists of values never give the same bytes.
void AppendValue(std::string& bytes, sqlite3_value* value) {
  const int type = sqlite3_value_type(value);
  const double number = type == SQLITE_NULL ? 0.0 : sqlite3_value_double(value);
  const bool is_number = type == SQLITE_INTEGER || type == SQLITE_FLOAT;
  const void* start = is_number ? &number : sqlite3_value_blob(value);
  const size_t size = is_number ? sizeof number : static_cast<size_t>(sqlite3_value_bytes(value));
  bytes += fmt::format("{} {} ", type, size);
  if (size > 0) bytes.append(static_cast<const char*>(start), size);
}

/// The SQL function sum_of(...): a hash of its arguments and of what the journal was made from.
void SumOf(sqlite3_context* context, int count, sqlite3_value** values) {
  std::string bytes = *static_cast<const std::string*>(sqlite3_user_data(context));
  for (int i = 0; i < count; ++i) AppendValue(bytes, values[i]);
  const std::string sum = statistics::Hash128Text(bytes);
  sqlite3_result_text(context, sum.data(), static_cast<int>(sum.size()), SQLITE_TRANSIENT);
}

/// `facts` must outlive the database.
void DefineSoundRows(SQLite::Database& database, std::string& facts) {
  database.createFunction("sum_of", -1, true, &facts, SumOf);
  database.exec(kSoundRows);
}

int Count(SQLite::Database& database, const char* query) {
  SQLite::Statement count(database, query);
  return count.executeStep() ? count.getColumn(0).getInt() : 0;
}

int CountDamagedTrials(SQLite::Database& database) {
  return Count(database,
               "SELECT (SELECT COUNT(*) FROM trial) - (SELECT COUNT(*) FROM sound_trial)");
}

int CountDamagedNotes(SQLite::Database& database) {
  return Count(database, "SELECT (SELECT COUNT(*) FROM note) - (SELECT COUNT(*) FROM sound_note)");
}

std::string TablesOf(SQLite::Database& database) {
  std::string tables;
  SQLite::Statement select(database, "SELECT sql FROM sqlite_master ORDER BY name");
  while (select.executeStep()) tables += select.getColumn(0).getString() + '\n';
  return tables;
}

/// Throws std::invalid_argument for tables other than those that this version makes.
void RequireOurTables(SQLite::Database& database, const fs::path& file) {
  SQLite::Database ours(":memory:", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  ours.exec(kSchema);
  if (TablesOf(database) == TablesOf(ours)) return;
  throw std::invalid_argument(fmt::format(
      "{}: its tables are not those of this version of rift: another version wrote it, or it is "
      "damaged; choose another folder with --out, or start over with --fresh",
      file.string()));
}

bool HasSharedMemory(const fs::path& file, JournalLog log) {
  if (log != JournalLog::kAsTheFolderAllows) return log == JournalLog::kWriteAhead;
  return files::NetworkFileSystemOf(file.parent_path()).empty();
}

/// The names that SQLite adds for what it keeps beside a file.
constexpr std::array<const char*, 4> kSuffixes{"", "-wal", "-shm", "-journal"};

/// SQLite would wait for ever for the writer of a pipe, and read a device without an end.
void RequireFiles(const fs::path& file) {
  for (const char* suffix : kSuffixes) {
    const fs::path part = file.string() + suffix;
    std::error_code unknown;
    const fs::file_status status = fs::status(part, unknown);
    if (!fs::exists(status) || fs::is_regular_file(status)) continue;
    throw std::runtime_error(fmt::format(
        "{} is not a file, and a journal is kept under this name: move it away, or choose another "
        "folder with --out",
        part.string()));
  }
}

/// As a URI that tells SQLite that nobody writes the file: without locks, which a network file
/// system may not have, and without a log beside it.
std::string Immutable(const fs::path& file) {
  std::string uri = "file:";
  for (const char c : fs::absolute(file).string()) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) != 0 ||
                          std::string_view("/._-").find(c) != std::string_view::npos;
    uri += is_plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return uri + "?immutable=1";
}

/// The journal of a shard, which was published whole.
SQLite::Database OpenPublished(const fs::path& file) {
  return {Immutable(file), SQLite::OPEN_READONLY | SQLite::OPEN_URI};
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
    // NORMAL: a commit survives the process, and after a loss of power the journal is whole but
    // may lack the last commits.
    // Rows of 1.4 kB: each would fill a page of 4 kB by itself.
    database.exec("PRAGMA page_size=8192");
    if (HasSharedMemory(path, log)) {
      database.exec("PRAGMA journal_mode=WAL; PRAGMA synchronous=NORMAL;");
    } else {
      database.exec("PRAGMA journal_mode=DELETE; PRAGMA synchronous=FULL;");
    }
    database.exec(kSchema);
    RequireOurTables(database, file);
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

Journal::Merged Journal::Merge(const fs::path& other) {
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
      Add(rows.getColumn(0).getString(), EntryOf(rows));
      ++merged.trials;
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
  for (const char* suffix : kSuffixes) {
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

JournalSummary ReadJournal(const fs::path& file) {
  if (!fs::exists(file)) {
    throw std::invalid_argument(fmt::format(
        "{}: no such file; a sweep of simulated trials keeps its journal there", file.string()));
  }
  RequireFiles(file);
  return Told(file, [&] {
    std::string facts;
    SQLite::Database database(file.string(), SQLite::OPEN_READONLY);
    database.setBusyTimeout(2000);
    RequireOurTables(database, file);
    facts = HashOf(ReadFacts(database));
    DefineSoundRows(database, facts);
    JournalSummary summary;
    summary.damaged = CountDamagedTrials(database);
    summary.notes = ReadTable(database, "SELECT name, value FROM sound_note");
    const std::string of_table =
        fmt::format("FROM sound_trial WHERE key NOT LIKE '{}%'", kBesideTable);
    SQLite::Statement count(
        database, "SELECT status, COUNT(*), SUM(falsified) " + of_table + " GROUP BY status");
    while (count.executeStep()) {
      summary.trials_by_status[count.getColumn(0).getString()] = count.getColumn(1).getInt();
      summary.falsified += count.getColumn(2).getInt();
    }
    SQLite::Statement worst(database,
                            "SELECT key, gap_m " + of_table +
                                " AND gap_m IS NOT NULL ORDER BY gap_m DESC, key LIMIT 1");
    if (worst.executeStep()) {
      summary.largest_key = worst.getColumn(0).getString();
      summary.largest_gap_m = worst.getColumn(1).getDouble();
    }
    return summary;
  });
}

}  // namespace rift::sweep
