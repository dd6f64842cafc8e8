#include "journal_database.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <cctype>
#include <string_view>

#include "rift/statistics/hash.hpp"

namespace rift::sweep {
namespace {

namespace fs = std::filesystem;

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

std::string TablesOf(SQLite::Database& database) {
  std::string tables;
  SQLite::Statement select(database, "SELECT sql FROM sqlite_master ORDER BY name");
  while (select.executeStep()) tables += select.getColumn(0).getString() + '\n';
  return tables;
}

/// As a URI that tells SQLite that nobody writes the file.
std::string Immutable(const fs::path& file) {
  std::string uri = "file:";
  for (const char c : fs::absolute(file).string()) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) != 0 ||
                          std::string_view("/._-").find(c) != std::string_view::npos;
    uri += is_plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return uri + "?immutable=1";
}

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

}  // namespace

void MakeTables(SQLite::Database& database) {
  SQLite::Transaction transaction(database);
  database.exec(kSchema);
  transaction.commit();
}

void RequireOurTables(SQLite::Database& database, const fs::path& file) {
  SQLite::Database ours(":memory:", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  MakeTables(ours);
  if (TablesOf(database) == TablesOf(ours)) return;
  throw std::invalid_argument(fmt::format(
      "{}: its tables are not those of this version of rift: another version wrote it, or it is "
      "damaged; choose another folder with --out, or start over with --fresh",
      file.string()));
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

int Count(SQLite::Database& database, const char* query) {
  SQLite::Statement count(database, query);
  return count.executeStep() ? count.getColumn(0).getInt() : 0;
}

void DefineSoundRows(SQLite::Database& database, std::string& facts) {
  database.createFunction("sum_of", -1, true, &facts, SumOf);
  database.exec(kSoundRows);
}

int CountDamagedTrials(SQLite::Database& database) {
  return Count(database,
               "SELECT (SELECT COUNT(*) FROM trial) - (SELECT COUNT(*) FROM sound_trial)");
}

int CountDamagedNotes(SQLite::Database& database) {
  return Count(database, "SELECT (SELECT COUNT(*) FROM note) - (SELECT COUNT(*) FROM sound_note)");
}

void RequireFiles(const fs::path& file) {
  for (const char* suffix : kJournalSuffixes) {
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

SQLite::Database OpenPublished(const fs::path& file) {
  return {Immutable(file), SQLite::OPEN_READONLY | SQLite::OPEN_URI};
}

std::string AdviceFor(const SQLite::Exception& error) {
  return fmt::format("{} ({})", Advice(error.getErrorCode()), OnOneLine(error.what()));
}

}  // namespace rift::sweep
