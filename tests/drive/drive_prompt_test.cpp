// What a person at the terminal types to rift drive, and what the terminal tells.
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "drive_scene.hpp"
#include "support/processes/terminal_run.hpp"

namespace rift {
namespace {

namespace fs = std::filesystem;
using test::kAll;
using test::Scene;
using test::TerminalRun;
using test::Uninterrupted;

/// Runs a drive that is to be repeated once, into `out`; each key of `typed` is pressed when the
/// text before it was shown, after the one before. One whose text is not shown is left out when a
/// later text is: a drive that a busy machine ends asks the next question all the same.
TerminalRun DriveOnce(const Scene& scene, const std::string& out,
                      const std::vector<std::pair<std::string, std::string>>& typed) {
  std::vector<std::string> arguments = scene.Arguments();
  arguments.pop_back();  // --yes
  arguments.back() = out;
  arguments.insert(arguments.end(), {"--repeat", "1"});
  std::size_t next = 0, seen = 0;
  return test::RunInTerminal(arguments, 200, [&](const std::string& shown) {
    std::string keys;
    for (std::size_t i = next; i < typed.size(); ++i) {
      const std::size_t at = shown.find(typed[i].first, seen);
      if (at == shown.npos) continue;
      seen = at + typed[i].first.size();
      keys += typed[i].second;
      next = i + 1;
    }
    return keys;
  });
}

TEST_CASE("A key ends a series with a bell and the next ones say what becomes of the drive") {
  const std::string question =
      "was begun and did not reach the end: Enter: again, k: keep it as it is, s: skip, q: quit";
  Uninterrupted(kAll, [&question](Scene& scene) {
    const std::string out = scene.folder / "run";
    const fs::path drive = out + "/1", unfinished = out + "/1.unfinished";
    const TerminalRun stopped = DriveOnce(
        scene, out, {{"put the robot at the start: ", "\n"}, {"loop delay", "x"}, {question, "q"}});
    INFO(stopped.shown);
    if (!fs::exists(unfinished / "summary.json")) return false;  // it refused to drive
    const auto summary =
        nlohmann::json::parse(files::ReadFile((unfinished / "summary.json").string()));
    if (summary["stop"]["reason"] != "operator") return false;  // a busy machine came first
    CHECK(stopped.exit_code == 1);
    CHECK_FALSE(scene.floor.Moves());
    CHECK(summary["stop"]["text"] == "a key was pressed");
    CHECK(stopped.shown.find('\a') != stopped.shown.npos);
    CHECK(stopped.shown.find(question) == stopped.shown.npos);
    CHECK_THAT(stopped.shown, Catch::Contains("the same command goes on where it was"));

    const TerminalRun skipped = DriveOnce(scene, out, {{question, "xs"}});
    INFO(skipped.shown);
    CHECK(skipped.exit_code == 1);
    CHECK_THAT(skipped.shown, Catch::Contains("1 of 1 drives did not reach the end"));

    const TerminalRun quit = DriveOnce(scene, out, {{question, "q"}});
    INFO(quit.shown);
    CHECK(quit.exit_code == 1);
    CHECK(quit.shown.find('\a') == quit.shown.npos);
    CHECK_THAT(quit.shown, Catch::Contains("the same command goes on where it was"));
    CHECK(fs::exists(unfinished));

    Scene other;  // a camera serves one client
    const TerminalRun again =
        DriveOnce(other, out, {{question, "\n"}, {"put the robot at the start: ", "q"}});
    INFO(again.shown);
    CHECK(again.exit_code == 1);
    CHECK_FALSE(fs::exists(unfinished));
    CHECK(fs::exists(unfinished.string() + "1/trajectory.csv"));

    fs::rename(unfinished.string() + "1", unfinished);
    const TerminalRun kept = DriveOnce(scene, out, {{question, "k"}});
    INFO(kept.shown);
    CHECK(kept.exit_code == 0);
    CHECK(fs::exists(drive / "trajectory.csv"));
    CHECK_FALSE(fs::exists(unfinished));
    return true;
  });
}

}  // namespace
}  // namespace rift
