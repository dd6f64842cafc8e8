#include "rift/sweep/run/shard.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <set>

#include "rift/files/network_file_system.hpp"
#include "rift/files/shell_word.hpp"
#include "rift/sweep/run/journal.hpp"
#include "rift/sweep/run/journal_summary.hpp"
#include "rift/sweep/run/slurm.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"
#include "support/processes/shell.hpp"

namespace rift::sweep {
namespace {

namespace fs = std::filesystem;

const Facts kFacts{{"gap.threshold_m", "0.06"}, {"seed", "1"}};

JournalEntry Entry(int number) {
  return {"ok", 0.01 * number, false, "row " + std::to_string(number)};
}

void WriteJournal(const fs::path& file, int first, int last, const Facts& facts = kFacts) {
  Journal journal(file, facts);
  for (int i = first; i <= last; ++i) journal.Add(std::to_string(i), Entry(i));
  journal.Close();
}

TEST_CASE("Items are dealt out to shards evenly, each once, and no shard is empty") {
  for (const size_t count : {0, 1, 7, 100}) {
    for (const size_t shards : {0, 1, 3, 7, 1000}) {
      INFO(count << " items, " << shards << " shards");
      const auto dealt = DealOut(count, shards);
      CHECK(dealt.size() == std::min(count, std::max<size_t>(shards, 1)));
      std::set<size_t> seen;
      size_t fewest = count, most = 0, all = 0;
      for (const std::vector<size_t>& shard : dealt) {
        CHECK(std::is_sorted(shard.begin(), shard.end()));
        seen.insert(shard.begin(), shard.end());
        fewest = std::min(fewest, shard.size());
        most = std::max(most, shard.size());
        all += shard.size();
      }
      CHECK(all == count);
      CHECK(seen.size() == count);
      if (count > 0) CHECK(fewest >= 1);
      if (count > 0) CHECK(most - fewest <= 1);
    }
  }
}

TEST_CASE("Neighbours are dealt out to different shards") {
  CHECK(DealOut(7, 3) == std::vector<std::vector<size_t>>{{0, 3, 6}, {1, 4}, {2, 5}});
}

TEST_CASE("A shard comes back from its bytes, and its name is that of its content") {
  Shard shard{.facts = "f", .experiment = "e", .kind = ShardKind::kShrink, .keys = "k", .paths = 2};
  shard.requests = {"one", std::string("t\0wo", 4), ""};
  const std::string bytes = EncodeShard(shard);
  const Shard back = DecodeShard(bytes, "file");
  CHECK(back.facts == "f");
  CHECK(back.experiment == "e");
  CHECK(back.keys == "k");
  CHECK(back.paths == 2);
  CHECK(back.kind == ShardKind::kShrink);
  CHECK(back.requests == shard.requests);
  CHECK(ShardName(EncodeShard(back)) == ShardName(bytes));
  shard.requests[0] = "other";
  CHECK(ShardName(EncodeShard(shard)) != ShardName(bytes));
}

TEST_CASE("Bytes that are no shard are refused with the name of their file") {
  const std::string bytes = EncodeShard({.facts = "f", .requests = {"one", "two"}});
  for (size_t length = 0; length < bytes.size(); ++length) {
    CHECK_THROWS_WITH(DecodeShard(bytes.substr(0, length), "3.shard"),
                      Catch::Contains("3.shard is no shard"));
  }
  const std::string no_shard = "3.shard is no shard of a sweep that this version of rift wrote: ";
  CHECK_THROWS_WITH(DecodeShard(bytes + "x", "3.shard"), no_shard + "there is more behind its end");
  std::string of_another = bytes;
  of_another[of_another.find("rift shard ") + 11] = '9';
  CHECK_THROWS_WITH(DecodeShard(of_another, "3.shard"), no_shard + "its layout is another");
  CHECK_THROWS_WITH(DecodeShard("", "3.shard"), Catch::Contains("3.shard is no shard"));
}

TEST_CASE("Keys in another order give another hash") {
  KeysHash one, other;
  for (const char* key : {"a", "b"}) one.Add(key);
  for (const char* key : {"b", "a"}) other.Add(key);
  CHECK(one.Text() != other.Text());
}

TEST_CASE("A hash of keys holds all of them, and where each of them ends") {
  const auto hash_of = [](const std::vector<std::string>& keys) {
    KeysHash hash;
    for (const std::string& key : keys) hash.Add(key);
    return hash.Text();
  };
  CHECK(hash_of({}).empty());
  CHECK(hash_of({"a", "b"}) == hash_of({"a", "b"}));
  CHECK(hash_of({"a", "b"}) != hash_of({"c", "b"}));
  CHECK(hash_of({"a", "b"}) != hash_of({"a", "c"}));
  CHECK(hash_of({"a", "b"}) != hash_of({"b"}));
  CHECK(hash_of({"a", "b"}) != hash_of({"a"}));
  CHECK(hash_of({"ab", "c"}) != hash_of({"a", "bc"}));
}

TEST_CASE("The journal of a shard stands elsewhere until it is done") {
  CHECK(ShardJournal("out", "n") == fs::path("out/shards/n.sqlite"));
  CHECK(UnfinishedShardJournal("out", "n") == fs::path("out/shards/n.part"));
}

TEST_CASE("A published file takes the place of an older one whole, and leaves nothing beside it") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "new", "new bytes");
  test::WriteText(folder / "shards/a.sqlite", "old");
  PublishFile(folder / "new", folder / "shards/a.sqlite");
  CHECK(test::ReadFile(folder / "shards/a.sqlite") == "new bytes");
  CHECK(std::distance(fs::directory_iterator(folder / "shards"), {}) == 1);
  CHECK_THROWS_WITH(PublishFile(folder / "new", folder / "gone/a.sqlite"),
                    "cannot write " + (folder / "gone/a.sqlite") + ": No such file or directory");
  CHECK_THROWS_WITH(PublishFile(folder / "none", folder / "shards/a.sqlite"),
                    "cannot write " + (folder / "shards/a.sqlite") + ": No such file or directory");
  CHECK(test::ReadFile(folder / "shards/a.sqlite") == "new bytes");
  CHECK_FALSE(fs::exists(folder / "gone"));
  // What cannot take the place of its target leaves nothing beside it.
  fs::create_directories(folder / "taken/b.sqlite/full");
  CHECK_THROWS_WITH(PublishFile(folder / "new", folder / "taken/b.sqlite"),
                    Catch::StartsWith("cannot write " + (folder / "taken/b.sqlite") + ": "));
  CHECK(std::distance(fs::directory_iterator(folder / "taken"), {}) == 1);
}

TEST_CASE(
    "What is published stands under a name of this machine and this process until it is whole") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "new", "new bytes");
  std::string host(256, '\0');
  REQUIRE(::gethostname(host.data(), host.size() - 1) == 0);
  const std::string process = std::to_string(::getpid());
  const auto open_files = [] { return std::distance(fs::directory_iterator("/proc/self/fd"), {}); };
  const auto before = open_files();
  // Those of other machines and other processes are no hindrance.
  fs::create_directories(folder / ("a.sqlite.another." + process + ".new"));
  fs::create_directories(folder /
                         (std::string("a.sqlite.") + host.c_str() + ".1" + process + ".new"));
  PublishFile(folder / "new", folder / "a.sqlite");
  CHECK(test::ReadFile(folder / "a.sqlite") == "new bytes");
  CHECK(open_files() == before);
  fs::create_directories(folder /
                         (std::string("a.sqlite.") + host.c_str() + "." + process + ".new"));
  CHECK_THROWS_WITH(PublishFile(folder / "new", folder / "a.sqlite"),
                    Catch::StartsWith("cannot write " + (folder / "a.sqlite") + ": "));
}

TEST_CASE("Journals of shards merge into one with the rows of all, whichever comes twice") {
  const test::TemporaryFolder folder;
  WriteJournal(folder / "a", 0, 9);
  WriteJournal(folder / "b", 5, 14);  // a shard that overlaps
  Journal journal(folder / "all", kFacts);
  CHECK(journal.Merge(folder / "a").trials == 10);
  CHECK(journal.Merge(folder / "b").trials == 10);
  CHECK(journal.Merge(folder / "a").damaged == 0);
  journal.Close();
  Journal merged(folder / "all", kFacts);
  for (int i = 0; i < 15; ++i) CHECK(merged.Find(std::to_string(i)) == Entry(i).bytes);
  CHECK_FALSE(merged.Find("15"));
  CHECK(ReadJournal(folder / "all").trials_by_status.at("ok") == 15);
}

TEST_CASE("A trial that was given up takes no row's place, and none under other limits") {
  const test::TemporaryFolder folder;
  const auto row = [](const std::string& status) {
    return JournalEntry{status, 0.01, false, status};
  };
  Journal journal(folder / "all", kFacts), shard(folder / "shard", kFacts);
  journal.Add("came out here", row("ok"));
  shard.Add("came out here", row("hung"));
  journal.Add("came out there", row("out_of_memory"));
  shard.Add("came out there", row("fell"));
  shard.Add("nowhere", row("crashed"));
  shard.Close();
  const Journal::Merged other = journal.Merge(folder / "shard", Limits::kOther);
  CHECK(other.trials == 3);
  CHECK(other.given_up == 1);
  CHECK(other.damaged == 0);
  CHECK_FALSE(journal.Has("nowhere"));
  CHECK(journal.Merge(folder / "shard").given_up == 0);
  CHECK(journal.Find("nowhere") == "crashed");
  CHECK(journal.Find("came out here") == "ok");
  CHECK(journal.Find("came out there") == "fell");
}

TEST_CASE("A journal of a shard that is no journal, or another's, or damaged, is not taken over") {
  const test::TemporaryFolder folder;
  Journal journal(folder / "all", kFacts);
  WriteJournal(folder / "other", 0, 3, {{"seed", "2"}});
  CHECK_THROWS_AS(journal.Merge(folder / "other"), UselessJournal);
  test::WriteText(folder / "text", std::string(5000, 'x'));
  CHECK_THROWS_AS(journal.Merge(folder / "text"), UselessJournal);
  CHECK_THROWS_AS(journal.Merge(folder / "missing"), UselessJournal);
  CHECK_FALSE(journal.Find("0"));

  WriteJournal(folder / "cut", 0, 999);
  fs::resize_file(folder / "cut", fs::file_size(folder / "cut") / 2);
  CHECK_THROWS_AS(journal.Merge(folder / "cut"), UselessJournal);
  CHECK_FALSE(IsJournalOf(folder / "cut", kFacts));
  CHECK_FALSE(IsJournalOf(folder / "other", kFacts));
  CHECK_FALSE(IsJournalOf(folder / "missing", kFacts));
}

TEST_CASE("A damaged row of a shard is left out of the merge, and counted") {
  const test::TemporaryFolder folder;
  WriteJournal(folder / "a", 0, 9);
  std::string bytes = test::ReadFile(folder / "a");
  const size_t at = bytes.find("row 7");
  REQUIRE(at != std::string::npos);
  bytes[at] = 'R';
  test::WriteText(folder / "a", bytes);
  Journal journal(folder / "all", kFacts);
  const Journal::Merged merged = journal.Merge(folder / "a");
  CHECK(merged.trials == 9);
  CHECK(merged.damaged == 1);
  CHECK_FALSE(journal.Find("7"));
}

TEST_CASE("A copy of a journal holds what was added until then, while it is written on") {
  const test::TemporaryFolder folder;
  Journal journal(folder / "a%?#'", kFacts);
  journal.Add("1", Entry(1));
  journal.CopyTo(folder / "copy %41");
  journal.Add("2", Entry(2));
  CHECK(IsJournalOf(folder / "copy %41", kFacts));
  Journal other(folder / "other", kFacts);
  CHECK(other.Merge(folder / "copy %41").trials == 1);
  CHECK(journal.Find("2"));
}

TEST_CASE("Without a write-ahead log a journal keeps its promise with no file beside it") {
  const test::TemporaryFolder folder;
  const std::string file = folder / "journal.sqlite";
  for (const JournalLog log : {JournalLog::kWriteAhead, JournalLog::kRollback}) {
    Journal::Remove(file);
    {
      Journal journal(file, kFacts, log);
      journal.Add("1", Entry(1));
      journal.Commit();
      CHECK(fs::exists(file + "-wal") == (log == JournalLog::kWriteAhead));
      CHECK(ReadJournal(file).trials_by_status.at("ok") == 1);  // by another, meanwhile
      journal.Close();
    }
    CHECK(Journal(file, kFacts, log).Find("1") == Entry(1).bytes);
  }
}

TEST_CASE("File systems with other machines behind them are told from local ones") {
  CHECK(files::NetworkFileSystemName(0x6969) == "NFS");
  CHECK(files::NetworkFileSystemName(0xFF534D42) == "CIFS");
  CHECK(files::NetworkFileSystemName(static_cast<unsigned long>(static_cast<int>(0xFE534D42))) ==
        "SMB2");
  CHECK(files::NetworkFileSystemName(0x0BD00BD0) == "Lustre");
  CHECK(files::NetworkFileSystemName(0x47504653) == "GPFS");
  CHECK(files::NetworkFileSystemName(0x65735546) == "FUSE");
  for (const unsigned long local : {0xEF53UL, 0x58465342UL, 0x01021994UL, 0x794C7630UL,
                                    0x9123683EUL}) {  // ext4, XFS, tmpfs, overlay, btrfs
    CHECK(files::NetworkFileSystemName(local).empty());
  }
  CHECK(files::NetworkFileSystemOf("/proc").empty());
  CHECK(files::NetworkFileSystemOf("/no such folder").empty());
}

TEST_CASE("Indices of an array are written as ranges") {
  CHECK(IndexRanges({}).empty());
  CHECK(IndexRanges({3}) == "3");
  CHECK(IndexRanges({0, 1, 2, 3, 4, 7, 9, 10}) == "0-4,7,9-10");
}

TEST_CASE("Any text becomes one word of a shell") {
  const test::TemporaryFolder folder;
  const std::string printed = folder / "printed";
  for (const std::string text : {"a b", "", "it's $(rm) `x` \\ \"", "~root", "*", "a\nb", "#1",
                                 "out/sweep", "x=1,y:2@3%4"}) {
    for (const std::string& word : {files::ShellQuoted(text), files::ShellWord(text)}) {
      INFO(word);
      REQUIRE(test::RunShell("printf %s " + word + " > " + printed) == 0);
      CHECK(test::ReadFile(printed) == text);
    }
  }
  CHECK(files::ShellQuoted("a b") == "'a b'");
  CHECK(files::ShellWord("out/sweep_1.5") == "out/sweep_1.5");
}

}  // namespace
}  // namespace rift::sweep
