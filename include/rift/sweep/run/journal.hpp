#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace rift::sweep {

/// What the rows of a journal were made from: keys of the experiment and versions, each with its
/// value as text.
using Facts = std::map<std::string, std::string>;

/// Facts as one hash.
std::string HashOf(const Facts& made_from);

/// A finished trial as the journal keeps it: the bytes bring the row back, the rest is for people.
struct JournalEntry {
  std::string status;
  double gap_m = 0.0;  ///< NaN: none
  bool falsified = false;
  std::string bytes;
};

/// Statuses of trials whose process was given up (kHung, kCrashed and kOutOfMemory of TrialStatus).
/// They tell of the machine and of RunOptions, and not of the experiment: run again, such a trial
/// may end otherwise. Every other row of a key is the same wherever it is computed.
inline constexpr std::array<std::string_view, 3> kGivenUp{"hung", "crashed", "out_of_memory"};

/// RunOptions under which the rows of a journal were computed: those of now, or perhaps others.
enum class Limits { kOfNow, kOther };

/// A journal of a shard that cannot be taken over.
class UselessJournal : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// How a journal keeps what is not committed whole yet. A write-ahead log is shared memory of the
/// processes that have it open, which two machines do not have: on a network file system (see
/// files::NetworkFileSystemOf) readers would see it damaged, so there the older way is taken.
enum class JournalLog { kAsTheFolderAllows, kWriteAhead, kRollback };

/// Finished trials in an SQLite file, which survive a `kill -9` of the process at any moment: what
/// is lost is what was added in the last kCommitEvery_s. One process writes; others may read.
///
/// Each row carries a hash of its values, its key and the facts. A row that does not fit its hash
/// is not there: Find does not give it, and opening the journal removes it.
///
/// Whatever SQLite reports (a full disk, a folder that cannot be written, a damaged file) is thrown
/// as std::runtime_error that names the file and what to do; what was committed stays. So is a file
/// that is no longer where it was made.
class Journal {
 public:
  static constexpr double kCommitEvery_s = 0.2;

  /// Opens the journal or makes an empty one, in a folder that exists.
  /// Throws std::invalid_argument for a journal made from other facts, naming those that differ,
  /// and for one whose tables are not those of this version.
  Journal(const std::filesystem::path& file, const Facts& made_from,
          JournalLog log = JournalLog::kAsTheFolderAllows);
  /// Commits; what cannot be committed any more is lost silently: call Close before.
  ~Journal();

  std::optional<std::string> Find(const std::string& key);
  bool Has(const std::string& key) { return Find(key).has_value(); }
  /// Rows and notes that did not fit their hash when the journal was opened.
  int Damaged() const;
  /// Adding a key again replaces it.
  void Add(const std::string& key, const JournalEntry& entry);
  /// Forgets the trials that ended so, and says how many they were.
  int Forget(const std::string& status);
  /// Commits when the last commit was long ago.
  void Tick();
  void Commit();
  /// A word about the sweep as a whole, for readers and for later runs: "state", "total".
  void SetNote(const std::string& name, const std::string& value);
  std::optional<std::string> Note(const std::string& name);
  /// What was taken over from another journal.
  struct Merged {
    int trials = 0;    ///< sound ones, those that were there already included
    int damaged = 0;   ///< rows that did not fit their hash and were left out
    int given_up = 0;  ///< of `trials`, those left out since they were given up under other limits
  };
  /// Takes over the trials of the journal of a shard, and its note of the time it took. A trial
  /// that was given up (kGivenUp) never takes the place of a row that is there, and is left out
  /// where the shard had other limits. Throws UselessJournal when it is none, is damaged as a
  /// whole, or was made from other facts.
  Merged Merge(const std::filesystem::path& other, Limits limits = Limits::kOfNow);
  /// Commits, and writes a journal with the same trials to a file that is not there yet.
  void CopyTo(const std::filesystem::path& file);
  /// Commits and leaves one plain file without a log beside it.
  void Close();

  /// Removes a journal with its log. Throws std::runtime_error when it cannot.
  static void Remove(const std::filesystem::path& file);

 private:
  struct Store;
  std::unique_ptr<Store> store_;
};

/// True for a journal that can be read and was made from these facts.
bool IsJournalOf(const std::filesystem::path& file, const Facts& made_from);

}  // namespace rift::sweep
