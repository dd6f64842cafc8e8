// Disks that are full or cannot be written, quotas, clocks that jump, locales, terminals: nothing
// is lost, or the command ends with exit 3 and says why. Drives:
// tests/drive/hostile_drive_test.cpp.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <map>
#include <memory>

#include "support/inputs/trials.hpp"
#include "support/processes/environment.hpp"
#include "support/processes/file_size_limit.hpp"
#include "support/processes/process.hpp"
#include "support/processes/quick_gnuplot.hpp"
#include "support/processes/shell.hpp"
#include "support/processes/small_disk.hpp"
#include "support/processes/terminal_run.hpp"
#include "support/works.hpp"

namespace rift {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using test::Environment;
using test::ProcessResult;
using test::RunRift;
using Files = std::map<std::string, std::string>;

/// What a folder holds, by name. The journal and what a run took are other bytes each time.
Files FilesIn(const fs::path& folder) {
  Files files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = fs::relative(entry.path(), folder).string();
    const bool varies = name.starts_with("journal.sqlite") || name.ends_with(".run.json");
    if (entry.is_regular_file() && !varies) files[name] = test::ReadFile(entry.path());
  }
  return files;
}

std::vector<std::string> With(std::vector<std::string> words, const std::string& more) {
  words.push_back(more);
  return words;
}

/// A work in a folder of its own, and what it leaves there when all is well.
struct Scene {
  explicit Scene(const test::Work& what) : work(what) {
    Empty();
    usual_result = RunRift(work.words(out));
    INFO(work.name << ": " << usual_result.err);
    REQUIRE(usual_result.exit_code == 0);
    usual = FilesIn(out);
    REQUIRE_FALSE(usual[work.file].empty());
    Empty();
  }

  void Empty() const {
    fs::create_directories(out);
    for (const auto& entry : fs::directory_iterator(out)) fs::remove_all(entry);
  }

  /// No file is half-written: it is whole, or the log of a tracking that ended early.
  void CheckWhole() const {
    for (const auto& [name, text] : FilesIn(out)) {
      INFO(name);
      REQUIRE(usual.contains(name));
      const bool is_growing_log = work.name == "track" && name == work.file;
      if (!is_growing_log) CHECK(text == usual.at(name));
      if (is_growing_log) CHECK(usual.at(name).starts_with(text));
      if (is_growing_log) CHECK_THAT(text, Catch::EndsWith("\n") || Catch::Equals(""));
    }
  }

  void CheckFails(const ProcessResult& result, const std::vector<std::string>& reasons) const {
    INFO(work.name << ": " << result.err);
    CHECK(result.exit_code == 3);
    CHECK_THAT(result.err, Contains("rift: "));
    CHECK(std::any_of(reasons.begin(), reasons.end(), [&](const std::string& reason) {
      return result.err.find(reason) != std::string::npos;
    }));
    CheckWhole();
  }

  /// The same command again, when the trouble is over; a log that ended early is replaced when that
  /// is asked for.
  void CheckRecovers() const {
    const ProcessResult result = RunRift(
        With(work.words(out),
             work.name == "sweep" || work.name == "simulate" ? "--any-waypoints" : "--force"));
    INFO(work.name << ": " << result.err);
    CHECK(result.exit_code == 0);
    CHECK(FilesIn(out) == usual);
  }

  test::QuickGnuplot gnuplot;  // figures of gnuplot itself: the test of locales
  test::TemporaryFolder folder;
  test::Work work;
  std::string out = folder / "disk/out";
  Files usual;
  ProcessResult usual_result;
};

const test::Work& EachWork() {
  static const std::vector<test::Work> works = test::Works();
  return works[static_cast<size_t>(GENERATE(range(0, 4)))];
}

const std::vector<std::string> kFull{"No space left on device", "the disk is full",
                                     "the disk does not take it"};

TEST_CASE("A disk that becomes full is exit 3, leaves whole files, and with room all is done") {
  const Scene scene(EachWork());
  int failed = 0;
  for (int kbyte = 4; kbyte < 65'536; kbyte *= 4) {
    test::SmallDisk disk(scene.folder / "disk");
    RIFT_SKIP_WITHOUT(disk);
    scene.Empty();
    disk.Resize(kbyte);
    INFO(kbyte << " kB");
    const ProcessResult result = RunRift(scene.work.words(scene.out));
    if (result.exit_code == 0) break;
    ++failed;
    scene.CheckFails(result, kFull);
    disk.Resize(65'536);
    scene.CheckRecovers();
  }
  CHECK(failed > 0);
}

TEST_CASE("A limit on the size of files is exit 3 with its reason and no signal") {
  const Scene scene(EachWork());
  int failed = 0;
  for (rlim_t bytes = 1000; bytes < 10'000'000; bytes *= 8) {
    scene.Empty();
    ProcessResult result;
    {
      const test::FileSizeLimit limit(bytes);
      result = RunRift(scene.work.words(scene.out));
    }
    INFO(bytes << " bytes");
    if (result.exit_code == 0) break;
    ++failed;
    scene.CheckFails(result, {"File too large", "the disk does not take it", "gnuplot"});
    scene.CheckRecovers();
  }
  CHECK(failed > 0);
}

TEST_CASE("A quota that is used up is exit 3, also where the system tells it late") {
  const Scene scene(EachWork());
  const Environment shim("LD_PRELOAD", test::BuildDir() + "/tests/librift_system_shim.so");
  const Environment folder("RIFT_SHIM_QUOTA", scene.out);
  for (const bool is_late : {false, true}) {
    const Environment late("RIFT_SHIM_QUOTA_LATE",
                           is_late ? std::optional<std::string>("1") : std::nullopt);
    for (const char* bytes : {"0", "2000"}) {
      const Environment quota("RIFT_SHIM_QUOTA_BYTES", bytes);
      scene.Empty();
      INFO(bytes << " bytes, late: " << is_late);
      const ProcessResult result = RunRift(scene.work.words(scene.out));
      INFO(result.err);
      CHECK(result.exit_code == 3);
      CHECK((result.err.find("Disk quota exceeded") != std::string::npos ||
             result.err.find("the disk does not take it") != std::string::npos));
      if (!is_late) scene.CheckWhole();
    }
  }
}

TEST_CASE("A folder that cannot be written is exit 3 and stays as it was") {
  const Scene scene(EachWork());
  test::SmallDisk disk(scene.folder / "disk");
  RIFT_SKIP_WITHOUT(disk);
  scene.Empty();
  disk.MakeReadOnly();
  const ProcessResult result = RunRift(scene.work.words(scene.out));
  scene.CheckFails(result, {"Read-only file system", "it cannot be written here"});
  CHECK(fs::is_empty(scene.out));
}

TEST_CASE("A wall clock that jumps changes nothing") {
  const Scene scene(EachWork());
  const Environment shim("LD_PRELOAD", test::BuildDir() + "/tests/librift_system_shim.so");
  const Environment clock("RIFT_SHIM_CLOCK", "1");
  const ProcessResult result = RunRift(scene.work.words(scene.out));
  INFO(result.err);
  CHECK(result.exit_code == 0);
  CHECK(FilesIn(scene.out) == scene.usual);
}

/// A folder with de_DE, a locale with a comma in its numbers, made once.
struct GermanLocale {
  static const GermanLocale& Get() {
    static const GermanLocale locale;
    return locale;
  }

  test::TemporaryFolder folder;
  std::string name = "de_DE.ISO-8859-1";  // of UTF-8 the letters alone take two seconds
  /// False where the sources of locales are not installed.
  bool is_there = test::RunShell("localedef -i de_DE -f ISO-8859-1 '" + folder / name +
                                 "' >/dev/null 2>&1") == 0;
};

TEST_CASE("Locale, display, home and width of the environment change no byte") {
  using Value = std::optional<std::string>;
  const Scene scene(EachWork());
  const GermanLocale& german = GermanLocale::Get();
  std::vector<Value> names{std::nullopt, "C", "C.UTF-8", "xx_XX.UTF-8"};
  if (german.is_there) names.emplace_back(german.name);
  const Environment path("LOCPATH", german.folder.Path().string());
  const Environment display("DISPLAY", std::nullopt), home("HOME", std::nullopt);
  const Environment language("LANG", std::nullopt);
  bool is_narrow = false;
  for (const Value& name : names) {
    is_narrow = !is_narrow;
    const Environment locale("LC_ALL", name);
    const Environment terminal("TERM", is_narrow ? Value("dumb") : Value());
    const Environment width("COLUMNS", is_narrow ? Value("20") : Value());
    scene.Empty();
    INFO("LC_ALL=" << name.value_or("(not set)"));
    const ProcessResult result = RunRift(scene.work.words(scene.out));
    INFO(result.err);
    CHECK(result.exit_code == 0);
    CHECK(FilesIn(scene.out) == scene.usual);
    if (scene.work.name != "track") CHECK(result.out == scene.usual_result.out);
  }
}

TEST_CASE("Figures are the same bytes in every locale") {
  const test::TemporaryFolder folder;
  const std::string example = test::SourceDir() + "/data/example/";
  const auto figure = [&](const std::string& name) {
    const ProcessResult result = RunRift({"gap", example + "simulator.csv", example + "robot1.csv",
                                          "--figure", folder / (name + ".svg")});
    INFO(result.err);
    CHECK(result.exit_code == 0);
    return test::ReadFile(folder / (name + ".svg"));
  };
  const std::string usual = figure("usual");
  const GermanLocale& german = GermanLocale::Get();
  const Environment path("LOCPATH", german.folder.Path().string());
  for (const std::string& name : {std::string("C"), std::string("xx_XX.UTF-8"),
                                  german.is_there ? german.name : std::string("POSIX")}) {
    const Environment locale("LC_ALL", name);
    INFO(name);
    CHECK(figure(name) == usual);
  }
}

TEST_CASE("In a terminal of any width lines in place fit and results stay whole") {
  const Scene scene(EachWork());
  for (const int columns : {20, 200, 1, 0}) {
    scene.Empty();
    const test::TerminalRun run = test::RunInTerminal(scene.work.words(scene.out), columns);
    INFO(scene.work.name << " in " << columns << " columns:\n" << run.shown);
    CHECK(run.exit_code == 0);
    CHECK(FilesIn(scene.out) == scene.usual);
    const size_t longest = run.LongestInPlace("");
    if (columns > 0) CHECK(longest < static_cast<size_t>(columns));
    if (scene.work.name == "sweep" && columns == 20) CHECK(longest == 19);
    if (scene.work.name == "track") continue;  // its text holds what it took
    std::string results;
    for (const char c : scene.usual_result.out) results += c == '\n' ? "\r\n" : std::string(1, c);
    CHECK_THAT(run.shown, Contains(results));
  }
}

}  // namespace
}  // namespace rift
