#include "rift/files/files.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>
#include <thread>

#include "rift/files/append_file.hpp"
#include "rift/files/folder_lock.hpp"
#include "rift/files/network_file_system.hpp"
#include "rift/files/outputs.hpp"
#include "rift/files/process_end.hpp"
#include "rift/files/shell_word.hpp"
#include "support/processes/file_size_limit.hpp"
#include "support/processes/process.hpp"

namespace rift::files {
namespace {

using Catch::Matchers::Contains;
namespace fs = std::filesystem;

std::size_t FilesIn(const fs::path& folder) {
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(folder)) count += entry.is_regular_file();
  return count;
}

TEST_CASE("A folder that another still writes and renames in is removed whole") {
  const test::TemporaryFolder folder;
  for (int round = 0; round < 10; ++round) {
    fs::create_directories(folder / "shards");
    std::atomic<bool> has_begun = false;
    std::thread writer([&] {
      for (int i = 0; i < 200; ++i) {
        // As a task of a cluster publishes its journal.
        const std::string file = folder / ("shards/" + std::to_string(i));
        std::ofstream(file + ".new") << i;
        std::error_code removed;
        fs::rename(file + ".new", file, removed);
        has_begun = true;
      }
    });
    while (!has_begun) std::this_thread::yield();
    const std::error_code error = RemoveAll(folder / "shards");
    writer.join();
    CHECK_FALSE(error);
    CHECK_FALSE(fs::exists(folder / "shards"));
  }
  CHECK_FALSE(RemoveAll(folder / "shards"));
}

TEST_CASE("A file of any length is read as it was written and leaves nothing beside it") {
  const test::TemporaryFolder folder;
  for (const std::size_t size : {0U, 1U, 4095U, 4096U, 4097U, 100'000U}) {
    std::string text;
    for (std::size_t i = 0; i < size; ++i) text += static_cast<char>(i % 251);
    WriteFile(folder / "sub/a.bin", text);
    CHECK(ReadFile(folder / "sub/a.bin") == text);
    CHECK(FilesIn(folder.Path() / "sub") == 1);
  }
}

TEST_CASE("A file is for whoever the process lets read and write, as those of other programs are") {
  const test::TemporaryFolder folder;
  const mode_t before = ::umask(0027);
  WriteFile(folder / "whole", "text");
  { AppendFile grows(folder / "grows"); }
  ::umask(before);
  for (const char* name : {"whole", "grows"}) {
    INFO(name);
    CHECK(fs::status(folder / name).permissions() == fs::perms{0640});
  }
}

TEST_CASE("What is not there is nothing, and what cannot be read or written is told") {
  const test::TemporaryFolder folder;
  CHECK_FALSE(ReadIfThere(folder / "none"));
  test::WriteText(folder / "a", "text");
  CHECK(ReadIfThere(folder / "a").value_or("") == "text");
  CHECK_THROWS_WITH(ReadFile(folder / "none"),
                    "cannot read " + folder / "none" + ": No such file or directory");
  CHECK_THROWS_AS(ReadFile(folder / "none"), std::invalid_argument);
  CHECK_THROWS_WITH(WriteFile(folder / "a/b", "x"), Contains("cannot make folder " + folder / "a"));
  CHECK_THROWS_AS(WriteFile(folder / "a/b", "x"), std::runtime_error);
}

TEST_CASE("A link leads to its file, there or not, and one that leads round in circles is told") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "a", "old");
  fs::create_symlink("a", folder / "link");
  WriteFile(folder / "link", "new");
  CHECK(fs::is_symlink(folder / "link"));
  CHECK(ReadFile(folder / "a") == "new");
  fs::create_symlink("later", folder / "to_later");
  WriteFile(folder / "to_later", "made");
  CHECK(ReadFile(folder / "later") == "made");
  fs::create_symlink("round", folder / "round");
  CHECK_THROWS_WITH(WriteFile(folder / "round", "x"), Contains("cannot write"));
}

TEST_CASE("A file is the same by any name, there or not") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "a", "x");
  test::WriteText(folder / "b", "x");
  fs::create_hard_link(folder / "a", folder / "c");
  CHECK(IsSameFile(folder / "a", folder / "c"));
  CHECK(IsSameFile(folder / "none", folder / "x/../none"));
  CHECK_FALSE(IsSameFile(folder / "a", folder / "b"));
  CHECK_FALSE(IsSameFile(folder / "none", folder / "a"));
}

TEST_CASE("The streams of the process are known by the file they go to") {
  CHECK(IsStandardStream("/dev/stdout"));
  CHECK(IsStandardStream("/dev/stderr"));
  const test::TemporaryFolder folder;
  test::WriteText(folder / "a", "x");
  CHECK_FALSE(IsStandardStream(folder / "a"));
  CHECK_FALSE(IsStandardStream(folder / "none"));
}

TEST_CASE("A file that grows holds every text in order, and may be no file that is there") {
  const test::TemporaryFolder folder;
  {
    AppendFile file(folder / "log");
    file.Append("one\n");
    CHECK(ReadFile(folder / "log") == "one\n");
    file.Append("two\n");
    file.Sync();
    CHECK_NOTHROW(file.RequireInPlace());
  }
  CHECK(ReadFile(folder / "log") == "one\ntwo\n");
  CHECK_THROWS_WITH(AppendFile(folder / "log"),
                    Contains(folder / "log") && Contains("File exists"));
}

TEST_CASE("A file that grows is missed where it was removed, moved or replaced") {
  const test::TemporaryFolder folder;
  AppendFile file(folder / "log");
  SECTION("removed") { fs::remove(folder / "log"); }
  SECTION("moved") { fs::rename(folder / "log", folder / "other"); }
  SECTION("replaced") {
    test::WriteText(folder / "new", "x");
    fs::rename(folder / "new", folder / "log");
  }
  CHECK_THROWS_WITH(file.RequireInPlace(),
                    folder / "log" + " was removed or moved while it was being written");
}

TEST_CASE("A folder is held by one at a time and free again afterwards") {
  const test::TemporaryFolder folder;
  const fs::path held = folder.Path() / "out/sweep";
  {
    const FolderLock lock(held);
    CHECK(fs::is_directory(held));
    CHECK(FolderLock::IsHeld(held));
    CHECK_NOTHROW(lock.RequireInPlace());
    CHECK_THROWS_WITH(FolderLock(held),
                      Contains("another sweep is at work in " + held.string() +
                               ": wait for it (rift sweep --status " + held.string() + ")"));
    CHECK(FolderLock::IsHeld(held));
  }
  CHECK_FALSE(FolderLock::IsHeld(held));
  CHECK_FALSE(FolderLock::IsHeld(folder / "none"));
  CHECK_NOTHROW(FolderLock(held));
  test::WriteText(folder / "file", "x");
  CHECK_THROWS_WITH(FolderLock(folder / "file"), Contains("cannot "));
}

TEST_CASE("A text that finds no room stands in the file up to its last whole line") {
  std::signal(SIGXFSZ, SIG_IGN);  // as in the program (terminal/process_start.hpp)
  const test::TemporaryFolder folder;
  AppendFile file(folder / "log");
  file.Append("first\nsecond\n");
  {
    const test::FileSizeLimit limit(25);
    CHECK_THROWS_WITH(file.Append("third\nfourth\nfifth\n"),
                      "cannot write " + (folder / "log") + ": File too large");
  }
  CHECK(ReadFile(folder / "log") == "first\nsecond\nthird\n");
  file.Append("again\n");
  CHECK(ReadFile(folder / "log") == "first\nsecond\nthird\nagain\n");
  file.Append("");
  CHECK_NOTHROW(file.Sync());
}

TEST_CASE("A file without a folder is written where the process is, and a device as it is") {
  const test::TemporaryFolder folder;
  const fs::path before = fs::current_path();
  fs::current_path(folder.Path());
  CHECK_NOTHROW(WriteFile("a.txt", "here"));
  CHECK(ReadFile("a.txt") == "here");
  fs::current_path(before);
  CHECK(ReadFile(folder / "a.txt") == "here");
  CHECK_NOTHROW(WriteFile("/dev/null", "nowhere"));
  CHECK_THROWS_WITH(WriteFile("/dev/full", "no room"), Contains("cannot write /dev/full"));
}

TEST_CASE("Forty links lead to a file and one more leads nowhere") {
  const test::TemporaryFolder folder;
  fs::path last = folder / "file";
  for (int i = 1; i <= 41; ++i) {
    const fs::path link = folder / ("link" + std::to_string(i));
    fs::create_symlink(last, link);
    last = link;
  }
  CHECK_THROWS_WITH(WriteFile(folder / "link41", "x"), Contains("cannot write"));
  CHECK_FALSE(fs::exists(folder / "file"));
  CHECK_NOTHROW(WriteFile(folder / "link40", "x"));
  CHECK(ReadFile(folder / "file") == "x");
}

TEST_CASE("A folder that is let go while another waits for it is had") {
  const test::TemporaryFolder folder;
  auto first = std::make_unique<FolderLock>(folder.Path());
  std::thread leaves([&first] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    first.reset();
  });
  CHECK_NOTHROW(FolderLock(folder.Path()));
  leaves.join();
}

TEST_CASE("An input is found by its name here, by its whole path, or not at all") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "a.yaml", "x");
  CHECK(FindInput(folder / "a.yaml") == folder / "a.yaml");
  CHECK(FindInput("no/such/file.yaml") == "no/such/file.yaml");
  CHECK(FindInput("").empty());
}

TEST_CASE("Every file system of other machines has its name by its number, signed or not") {
  const std::vector<std::pair<unsigned long, std::string>> kinds{
      {0x6969, "NFS"},          {0x517B, "SMB"},      {0xFF534D42, "CIFS"},  {0xFE534D42, "SMB2"},
      {0x0BD00BD0, "Lustre"},   {0x47504653, "GPFS"}, {0x65735546, "FUSE"},  {0x19830326, "BeeGFS"},
      {0x00C36400, "Ceph"},     {0x5346414F, "AFS"},  {0x6B414653, "AFS"},   {0xAAD7AAEA, "PanFS"},
      {0x20030528, "OrangeFS"}, {0x01021997, "9P"},   {0x73757245, "Coda"},  {0x7461636F, "OCFS2"},
      {0x01161970, "GFS2"},     {0x564C, "NCP"},      {0x786F4256, "vboxsf"}};
  for (const auto& [type, name] : kinds) {
    INFO(name);
    CHECK(NetworkFileSystemName(type) == name);
    CHECK(NetworkFileSystemName(type | 0xFFFFFFFF00000000UL) == name);
  }
  CHECK(NetworkFileSystemName(0xEF53).empty());  // ext4
  CHECK(NetworkFileSystemOf("/no/such/folder").empty());
}

TEST_CASE("A held folder is missed where it was removed, moved or replaced") {
  const test::TemporaryFolder folder;
  const fs::path held = folder.Path() / "out";
  const FolderLock lock(held);
  SECTION("removed") { fs::remove_all(held); }
  SECTION("moved") { fs::rename(held, folder / "other"); }
  SECTION("replaced") {
    fs::rename(held, folder / "other");
    fs::create_directory(held);
  }
  CHECK_THROWS_WITH(
      lock.RequireInPlace(),
      "folder " + held.string() +
          " was removed, moved or replaced while it was being worked in: what was written may be "
          "lost; run the same command again");
}

TEST_CASE("File systems of other machines have their names, and local ones none") {
  CHECK(NetworkFileSystemName(0x6969) == "NFS");
  CHECK(NetworkFileSystemName(0x0BD00BD0) == "Lustre");
  CHECK(NetworkFileSystemName(0xFFFFFFFFFF534D42UL) == "CIFS");  // signed
  CHECK(NetworkFileSystemName(0xEF53).empty());                  // ext4
  CHECK(NetworkFileSystemOf("/proc").empty());
  CHECK(NetworkFileSystemOf("/none/of/it").empty());
}

TEST_CASE("The end of a process is told by its code or its signal, with its last words") {
  CHECK(ProcessEndText(3, 0, "") == "ended with exit code 3");
  CHECK(ProcessEndText(3, 0, "no friction") == "ended with exit code 3: no friction");
  CHECK(ProcessEndText(0, SIGSEGV, "") == "ended by signal 11 (Segmentation fault)");
  const auto status_of = [](int code, int signal) {
    const pid_t child = ::fork();
    if (child == 0) {
      if (signal != 0) ::raise(signal);
      ::_exit(code);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return status;
  };
  CHECK(ProcessEndText(status_of(7, 0), "x") == "ended with exit code 7: x");
  CHECK(ProcessEndText(status_of(0, SIGKILL), "") == "ended by signal 9 (Killed)");
}

TEST_CASE("A word for a shell is quoted where the shell needs it and never elsewhere") {
  CHECK(ShellWord("run/a-b_c.csv") == "run/a-b_c.csv");
  CHECK(ShellWord("") == "''");
  for (const char special : std::string(" \t\n\r\v\f'\"\\$&;()<>|*?[]#`!{}~^")) {
    const std::string word = std::string("a") + special;
    CHECK(ShellWord(word) != word);
    CHECK(ShellWord(word) == ShellQuoted(word));
  }
  CHECK(ShellQuoted("it's") == "'it'\\''s'");
  for (const char plain : std::string("a0Z_-.,:/=+%@")) {
    CHECK(ShellWord(std::string(1, plain)) == std::string(1, plain));
  }
}

}  // namespace
}  // namespace rift::files
