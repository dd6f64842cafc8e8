// What each command ends with, and what becomes of results that find no room: every file that a
// flag names, and every document that goes to stdout.
#include <catch2/catch.hpp>
#include <filesystem>

#include "support/flag_contract.hpp"
#include "support/processes/process.hpp"
#include "support/processes/quick_gnuplot.hpp"
#include "support/tree.hpp"

namespace rift {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using test::ProcessResult;
using test::RunRift;
using test::TemporaryFolder;
using test::WriteText;

const std::string kLogs = "%data/example/simulator.csv %data/example/robot1.csv";
const std::string kFilm = "track --camera @frames/*.jpg --fps 15 --calibration @camera.yaml ";

/// Words of command lines are as in FlagRow.
struct Folder {
  Folder() {
    const fs::path data = test::SourceDir() + "/data/camera";
    fs::create_directory(folder / "frames");
    for (const char* name : {"frames/000.jpg", "frames/001.jpg", "frames/002.jpg", "camera.yaml"}) {
      fs::copy(data / name, folder / name);
    }
    const std::string task =
        "waypoints: [{x: 0, y: 0, heading: 0}, {x: 0.25, y: 0.02, stop: true}]\n"
        "gap: {threshold_m: 0.001}\nreference: {kind: path}\n"
        "space: {control.v_min: [0.14, 0.16]}\n";
    WriteText(folder / "task.yaml", task);
    WriteText(folder / "short.yaml", task + "trial: {timeout_s: 0.3}\n");
    for (const std::string name : {"before", "after"}) {
      const double mismatch = name == "after" ? 0.1 : 0.0;
      const ProcessResult result =
          Run("sweep @task.yaml --quiet --out @" + name +
              " --set simulation.motor.mismatch=" + std::to_string(mismatch));
      INFO(result.err);
      REQUIRE(result.exit_code == 0);
    }
    for (const char* end : {"json", "csv", "svg", "tum", "mcap", "png", "yaml", "html"}) {
      fs::create_symlink("/dev/full", folder / (std::string("full.") + end));
    }
  }
  ProcessResult Run(const std::string& words, const std::string& redirection = "") const {
    return RunRift(test::SplitWords(words, folder), redirection);
  }

  test::QuickGnuplot gnuplot;
  TemporaryFolder folder;
};

TEST_CASE("Each command ends with the exit codes of the table in docs") {
  const Folder folder;
  struct Row {
    std::string words;
    int exit_code;
    std::string says;  ///< on stdout or stderr
  };
  const std::string absent =
      " --port @gone --camera x --calibration @camera.yaml --yes --out @drive";
  for (const auto& [words, exit_code, says] : std::vector<Row>{
           {"--version", 0, "commit: "},
           {"swep", 2, "did you mean"},
           {"gap " + kLogs, 0, "gap_m"},
           {"gap " + kLogs + " --threshold 0.001 --share 0.001 --exit-code", 1, "verdict: "},
           {"gap @gone.csv " + kLogs, 2, "cannot read"},
           {"gap " + kLogs + " --json @full.json", 3, "No space left on device"},
           {"simulate @task.yaml --out @log.csv", 0, "reached"},
           {"simulate @short.yaml --out @log2.csv", 1, "timed_out"},
           {"simulate @gone.yaml --out @log3.csv", 2, "cannot read"},
           {"simulate @task.yaml --out @full.csv", 3, "No space left on device"},
           {"sweep @task.yaml --quiet --out @before", 0, "falsified"},
           {"sweep @task.yaml --quiet --out @before --exit-code", 1, "falsified"},
           {"sweep @short.yaml --quiet --out @short", 1, "without gap: row 1"},
           {"sweep @gone.yaml", 2, "cannot read"},
           {"sweep @task.yaml --quiet --out /proc/nowhere", 3, "cannot make folder"},
           {kFilm + "--out @seen.csv", 0, "3 rows"},
           {kFilm + "--out @none.csv --id 7", 1, "never seen"},
           {"track --calibrate --images @frames --out @board.yaml", 1, "verdict: refuse"},
           {kFilm, 2, "--out LOG.csv is missing"},
           {kFilm + "--out @log4.csv --tum @full.tum", 3, "No space left on device"},
           {"drive --ping", 2, "--port is missing"},
           {"drive @task.yaml" + absent, 3, "there is no serial port"},
           {"drive --ping --port @gone", 3, "there is no serial port"}}) {
    const ProcessResult result = folder.Run(words);
    INFO("rift " << words << "\n" << result.out << result.err);
    CHECK(result.exit_code == exit_code);
    CHECK_THAT(result.out + result.err, Contains(says));
    CHECK_FALSE(fs::exists(folder.folder / "drive"));
  }
}

TEST_CASE("A file that finds no room is exit 3 and named, whichever flag names it") {
  const Folder folder;
  const std::string run = "simulate @task.yaml --any-waypoints --out @run ";
  for (const auto& [words, file] : std::vector<std::pair<std::string, std::string>>{
           {"gap " + kLogs + " --json ", "full.json"},
           {"gap " + kLogs + " --profile ", "full.csv"},
           {"gap " + kLogs + " --figure ", "full.svg"},
           {"gap " + kLogs + " --figure ", "full.png"},
           {"simulate @task.yaml --out ", "full.csv"},
           {run + "--tum ", "full.tum"},
           {run + "--mcap ", "full.mcap"},
           {run + "--figure ", "full.svg"},
           {kFilm + "--out @log.csv --force --tum ", "full.tum"},
           {kFilm + "--out @log.csv --force --mcap ", "full.mcap"},
           {"sweep --compare @before @after --page ", "full.html"}}) {
    const ProcessResult result = folder.Run(words + "@" + file);
    INFO("rift " << words << file << "\n" << result.out << result.err);
    CHECK(result.exit_code == 3);
    CHECK_THAT(result.err, Contains(file) && Contains("No space left on device"));
    CHECK(fs::is_symlink(folder.folder / file));
  }
}

TEST_CASE(
    "A document on a stdout that is full or closed is exit 3, and on a closed stderr is whole") {
  const Folder folder;
  for (const std::string& words : std::vector<std::string>{
           "gap " + kLogs + " --json -", "gap " + kLogs + " --profile -",
           "simulate @task.yaml --out -", "simulate @task.yaml --json --any-waypoints --out @run",
           "simulate --keys", "simulate --replay @before worst --out @again", kFilm + "--out -",
           "sweep --status @before", "sweep --status @before --json",
           "sweep --compare @before @after", "sweep --compare @before @after --json",
           "sweep @task.yaml --out @before --json", "sweep @task.yaml --out @before --brief",
           "track --keys", "drive --keys", "help sweep", "help --man", "help --bash"}) {
    const ProcessResult usual = folder.Run(words);
    INFO("rift " << words << "\n" << usual.err);
    REQUIRE(usual.exit_code == 0);
    REQUIRE_FALSE(usual.out.empty());
    for (const char* broken : {">/dev/full", ">&-"}) {
      const ProcessResult result = folder.Run(words, broken);
      INFO(broken << ": " << result.err);
      CHECK(result.exit_code == 3);
      CHECK_THAT(result.err, Contains("cannot write to stdout: "));
    }
    for (const char* silent : {"2>/dev/full", "2>&-"}) {
      const ProcessResult result = folder.Run(words, silent);
      INFO(silent);
      CHECK(result.exit_code == 0);
      CHECK(result.out == usual.out);
    }
  }
}

}  // namespace
}  // namespace rift
