#pragma once

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "rift/sweep/run/journal.hpp"

namespace rift::sweep {

/// Makes the tables of a journal in an empty database: all or, when it is killed, none.
void MakeTables(SQLite::Database& database);

/// Throws std::invalid_argument for tables other than those that this version makes.
void RequireOurTables(SQLite::Database& database, const std::filesystem::path& file);

/// What the journal was made from.
Facts ReadFacts(SQLite::Database& database);

/// The first two columns of a query.
Facts ReadTable(SQLite::Database& database, const char* query);

/// The number that a query gives; 0 where it gives none.
int Count(SQLite::Database& database, const char* query);

/// Defines the SQL function sum_of(...), a hash of its arguments and of `facts` (HashOf), and the
/// views sound_trial and sound_note of the rows that fit their sum: these are believed.
/// `facts` must outlive the database.
void DefineSoundRows(SQLite::Database& database, std::string& facts);

int CountDamagedTrials(SQLite::Database& database);
int CountDamagedNotes(SQLite::Database& database);

/// The names that SQLite adds for what it keeps beside a file.
inline constexpr std::array<const char*, 4> kJournalSuffixes{"", "-wal", "-shm", "-journal"};

/// Throws std::runtime_error where something other than a file has one of the names of a journal:
/// SQLite would wait for ever for the writer of a pipe, and read a device without an end.
void RequireFiles(const std::filesystem::path& file);

/// Opens the journal of a shard, which was published whole and nobody writes: without locks, which
/// a network file system may not have, and without a log beside it.
SQLite::Database OpenPublished(const std::filesystem::path& file);

/// How a user gets on from what SQLite reports.
std::string AdviceFor(const SQLite::Exception& error);

/// Calls, and throws what SQLite reports as one line, a std::runtime_error.
template <class Call>
auto Told(const std::filesystem::path& file, const Call& call) {
  try {
    return call();
  } catch (const SQLite::Exception& error) {
    throw std::runtime_error(fmt::format("{}: {}", file.string(), AdviceFor(error)));
  }
}

}  // namespace rift::sweep
