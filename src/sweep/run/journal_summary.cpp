#include "rift/sweep/run/journal_summary.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "journal_database.hpp"
#include "rift/sweep/run/beside_table.hpp"

namespace rift::sweep {

namespace fs = std::filesystem;

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
