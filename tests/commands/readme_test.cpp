// The recipes of README and docs, as they are printed, in the order they are printed.
#include <catch2/catch.hpp>
#include <filesystem>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"
#include "support/processes/quick_gnuplot.hpp"
#include "support/processes/running_rift.hpp"
#include "support/processes/shell.hpp"
#include "support/tree.hpp"

namespace rift {
namespace {

/// What a clone that was built holds, for commands that are run in the folder.
void LinkTree(const test::TemporaryFolder& folder) {
  for (const char* name : {"configs", "data"}) {
    std::filesystem::create_symlink(test::SourceDir() + "/" + name, folder / name);
  }
  std::filesystem::create_symlink(test::BuildDir(), folder / "build");
}

void RunAsPrinted(const test::TemporaryFolder& folder, const std::string& recipe) {
  const std::string log = folder / "log.txt";
  // A comment behind the recipe ends with its line.
  const int status = test::RunShell("cd " + folder.Path().string() + " && {\n" + recipe + "\n} > " +
                                    log + " 2>&1");
  INFO(recipe << "\n" << test::ReadFile(log));
  // The worst of a sweep may be a run that does not arrive, which ends with 1.
  const bool may_miss =
      recipe.find("rift simulate --replay") != recipe.npos && recipe.find(" worst") != recipe.npos;
  CHECK((status == 0 || (may_miss && status == 1)));
}

/// A command of a document, its lines that end in a backslash joined.
std::vector<std::string> CommandsOf(const std::string& document) {
  std::istringstream text(test::ReadFile(test::SourceDir() + "/" + document));
  std::vector<std::string> commands;
  for (std::string line; std::getline(text, line);) {
    if (!line.starts_with("    build/rift")) continue;
    std::string command = line.substr(4);
    while (command.ends_with('\\') && std::getline(text, line)) {
      command.replace(command.size() - 1, 1, line.substr(line.find_first_not_of(' ')));
    }
    commands.push_back(command);
  }
  return commands;
}

/// What a command needs that no test has, by a part of it. Empty: it is run.
std::string WhyNotRun(const std::string& command) {
  struct Need {
    const char* part;
    const char* reason;
  };
  for (const Need& need : {
           Need{"/dev/", "a robot or a camera"},
           Need{"cam.yaml", "a lens that the user calibrated"},
           Need{"configs/paper", "the authors' trials"},
           Need{"configs/calibrate.yaml", "the authors' trials"},
           Need{"configs/twin.yaml", "two processes in real time: the tests of drive do it"},
           Need{"out/twin/", "the same"},
           Need{"out/sim", "a drive before it"},
           Need{"out/identify/", "drives of a robot"},
           Need{"my_task.yaml", "a file that the reader writes"},
           Need{"--real-columns", "a log in columns of its own: the tests of gap do it"},
           Need{"--rare-event", "2400 trials: the tests of sweep do it"},
       }) {
    if (command.find(need.part) != command.npos) return need.reason;
  }
  return "";
}

/// Windows stay open until somebody closes them.
std::string WithoutWindow(std::string command) {
  const std::string flag = " --view";
  const size_t at = command.find(flag);
  return at == command.npos ? command : command.erase(at, flag.size());
}

/// A command with the budget that a test has, where its experiment is given more: what it does is
/// the same, how well it knows what it says is not.
std::string WithinBudget(std::string command) {
  struct Budget {
    std::string experiment;
    const char* flags;
  };
  for (const Budget& budget : {
           Budget{"configs/falsify.yaml", " --budget 20"},
           Budget{"data/example/failures.yaml", " --budget 20"},
           Budget{"configs/programs/diff_drive.yaml", " --budget 8 --set falsify.most_repeats=5"},
           Budget{"data/hidden/calibrate.yaml",
                  " --set calibrate.judge_runs=2 --set 'calibrate.method={iterations: 1, runs: 0, "
                  "simulated_logs: 2, horizon: {phases: 1}}'"},
       }) {
    const size_t at = command.find(budget.experiment);
    if (at != command.npos) command.insert(at + budget.experiment.size(), budget.flags);
  }
  return command;
}

/// Documents that are read one after the other, in one folder.
class Reader {
 public:
  Reader() { LinkTree(folder); }

  /// Runs what can be run here, and tells how many commands that were. What is printed again, to
  /// the letter, is run once: a sweep of which nothing is left to compute draws all its figures
  /// again.
  int RunRecipesOf(const std::string& document) {
    int run = 0;
    for (const std::string& command : CommandsOf(document)) {
      if (!WhyNotRun(command).empty()) continue;
      if (done_.insert(command).second) Run(command);
      ++run;
    }
    return run;
  }

  test::TemporaryFolder folder;

 private:
  void Run(const std::string& command) const {
    std::optional<test::QuickGnuplot> gnuplot;
    const bool is_drawn = command.find("demo.yaml") != command.npos;  // beside its picture below
    if (!is_drawn) gnuplot.emplace();
    RunAsPrinted(folder, WithinBudget(WithoutWindow(command)));
  }

  std::set<std::string> done_;
};

std::string OnlyFile(const std::filesystem::path& folder, const std::string& start,
                     const std::string& end) {
  std::vector<std::string> found;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename();
    if (name.starts_with(start) && name.ends_with(end)) found.push_back(entry.path());
  }
  REQUIRE(found.size() == 1);
  return found.front();
}

TEST_CASE("The README is short") {
  const std::string readme = test::ReadFile(test::SourceDir() + "/README.md");
  CHECK(std::count(readme.begin(), readme.end(), '\n') <= 120);
}

// In one folder, as of a reader of both: a sweep of the README goes on in docs.
TEST_CASE("The recipes of the README, and of docs after it, work as they are printed") {
  Reader reader;
  CHECK(reader.RunRecipesOf("README.md") >= 9);
  CHECK(reader.RunRecipesOf("docs/recipes.md") >= 18);
  CHECK(std::filesystem::exists(reader.folder / "out/watched/report.html"));
  CHECK(test::ReadFile(reader.folder / "out/change.html").find("simulation.link.delay_s") !=
        std::string::npos);
  INFO("data/readme/make draws the README's picture anew");
  CHECK((test::ReadFile(OnlyFile(reader.folder / "out/watched/figures", "fig07", ".png")) ==
         test::ReadFile(test::SourceDir() + "/data/readme/demo.png")));
}

TEST_CASE("The recipes for programs work as they are printed, and those for tags") {
  Reader reader;
  CHECK(reader.RunRecipesOf("docs/programs.md") >= 4);
  CHECK(reader.RunRecipesOf("docs/tags.md") == 2);
}

}  // namespace
}  // namespace rift
