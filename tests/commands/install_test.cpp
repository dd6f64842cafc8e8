// What a package brings: manual and completions made from the options, the programs with their data
// in a folder of their own, and the library for another CMake project.
#include <catch2/catch.hpp>
#include <filesystem>
#include <regex>
#include <set>

#include "support/help_flags.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"
#include "support/processes/running_rift.hpp"
#include "support/processes/shell.hpp"
#include "support/sanitizer.hpp"
#include "support/tree.hpp"

namespace rift {
namespace {

using Catch::Matchers::Contains;
using test::RunRift;

const std::vector<std::string> kCommands{"simulate", "track", "drive", "gap", "sweep"};

/// What `command` prints in a shell.
std::string Shell(const std::string& command, const test::TemporaryFolder& folder) {
  const std::string file = folder / "shell.txt";
  INFO(command);
  const int status = test::RunShell("(" + command + ") > " + file + " 2>&1");
  INFO(test::ReadFile(file));
  REQUIRE(status == 0);
  return test::ReadFile(file);
}

TEST_CASE("Manual and completions name every flag of every command") {
  const std::string bash = RunRift({"help", "--bash"}).out, zsh = RunRift({"help", "--zsh"}).out;
  for (const std::string& command : kCommands) {
    const std::set<std::string> flags = test::FlagsOf(command);
    CHECK(flags.size() > 10);
    const std::string page = RunRift({"help", "--man", command}).out;
    for (const std::string& flag : flags) {
      INFO(command << " " << flag);
      CHECK_THAT(page, Contains(std::regex_replace(flag, std::regex("-"), "\\-")));
      CHECK_THAT(bash, Contains(flag));
      CHECK_THAT(zsh, Contains(flag + "["));
    }
  }
  CHECK(RunRift({"help", "--man", "gapp"}).exit_code == 2);
  CHECK(RunRift({"help", "--fish"}).exit_code == 2);
}

TEST_CASE("bash completes commands, flags and the words that a flag takes") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "rift.bash", RunRift({"help", "--bash"}).out);
  const auto completed = [&](const std::string& words, int at) {
    return Shell("bash -c 'source " + (folder / "rift.bash") + "; COMP_WORDS=(" + words +
                     "); COMP_CWORD=" + std::to_string(at) + "; _rift; echo ${COMPREPLY[@]}'",
                 folder);
  };
  CHECK(completed("rift sw", 1) == "sweep\n");
  CHECK(completed("rift gap --prof", 2) == "--profile\n");
  CHECK(completed("rift gap --real-format t", 3) == "tum tracker\n");
  CHECK(completed("rift sweep x.yaml --writ", 3) == "--write-robot\n");
}

TEST_CASE("An installed rift finds its experiments, and another project its library") {
  SKIP_UNDER_SANITIZER();
  const test::TemporaryFolder folder;
  const std::string install = "cmake --install " + test::BuildDir() + " --prefix " + (folder / "p");
  Shell(install + " --component rift", folder);
  const std::string run = "cd " + folder.Path().string() + " && p/bin/rift ";
  CHECK_THAT(Shell(run + "simulate configs/waypoints/paper.yaml --out run", folder),
             Contains("reached: the last waypoint"));
  CHECK_THAT(Shell(run + "gap data/example/simulator.csv data/example/robot1.csv", folder),
             Contains("gap"));
  CHECK_THAT(Shell("man --warnings -E UTF-8 -l " + (folder / "p/share/man/man1/rift-gap.1") +
                       " || grep -c SYNOPSIS " + (folder / "p/share/man/man1/rift-gap.1"),
                   folder),
             !Contains("warning"));
  Shell(install + " --component dev", folder);
  Shell("cmake -S " + test::SourceDir() + "/examples/consumer -B " + (folder / "b") +
            " -DCMAKE_PREFIX_PATH=" + (folder / "p"),
        folder);
  Shell("cmake --build " + (folder / "b"), folder);
  const std::string example = test::SourceDir() + "/data/example/";
  const std::string gap_m = Shell(
      (folder / "b/measure_gap ") + example + "simulator.csv " + example + "robot1.csv", folder);
  const std::string evidence =
      RunRift({"gap", example + "simulator.csv", example + "robot1.csv", "--json", "-"}).out;
  CHECK_THAT(evidence, Contains(gap_m.substr(0, 5)));
}

}  // namespace
}  // namespace rift
