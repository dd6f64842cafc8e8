// What a sweep ends with and what is said at its end.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <functional>
#include <stdexcept>

#include "commands/sweep/steps.hpp"
#include "rift/commands/arguments/arguments.hpp"
#include "rift/trajectory/log.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"

namespace rift::commands {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using sweep::TrialStatus;

/// What is said on stderr.
std::string Said(const std::function<void()>& say) {
  std::FILE* const file = std::tmpfile();
  const int before = ::dup(2);
  ::dup2(::fileno(file), 2);
  say();
  ::dup2(before, 2);
  ::close(before);
  std::rewind(file);
  std::string text;
  for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) text += static_cast<char>(c);
  std::fclose(file);
  return text;
}

TEST_CASE("Whoever stops a sweep is told how it goes on, without the flag that begins it afresh") {
  SweepRequest request;
  experiment::Experiment experiment;
  experiment.candidate.kind = experiment::CandidateKind::kSimulation;
  CHECK(StoppedText(request, experiment, "out/a b") ==
        "stopped; the same command goes on where it was (rift sweep --status 'out/a b')");
  request.fresh = true;
  CHECK(StoppedText(request, experiment, "out/a") ==
        "stopped; the same command without --force (or --fresh) goes on where it was (rift sweep "
        "--status out/a)");
  CHECK(GoesOnText(request, "") ==
        "stopped; the same command without --force (or --fresh) goes on");
  experiment.candidate.kind = experiment::CandidateKind::kLogs;
  CHECK(StoppedText(request, experiment, "out/a") == "stopped; the same command starts over");
  int code = 0;
  CHECK(Said([&code] { code = SayStopped("stopped"); }) == "stopped\n");
  CHECK(code == 130);
}

TEST_CASE("At its end a sweep says where its report is, and what drives its worst row again") {
  SweepRequest request;
  experiment::Experiment experiment;
  const auto said = [&] { return Said([&] { SayWhere(request, experiment, "out/a b"); }); };
  experiment.candidate.kind = experiment::CandidateKind::kSimulation;
  CHECK(said() ==
        "worst row again: rift simulate --replay 'out/a b' worst\nreport: out/a b/report.html\n");
  experiment.candidate.kind = experiment::CandidateKind::kProgram;
  CHECK_THAT(said(), Contains("--replay 'out/a b' worst\n"));
  experiment.candidate.kind = experiment::CandidateKind::kLogs;
  CHECK(said() == "report: out/a b/report.html\n");
  request.quiet = true;
  CHECK(said().empty());
}

TEST_CASE("A sweep ends with 1 where no trial has a gap, and where asked for by its settings") {
  const auto ends_with = [](bool is_asked, int with_gap,
                            const std::vector<gap::RepeatVerdict>& verdicts) {
    sweep::SweepResult result;
    result.all.n = with_gap;
    for (const gap::RepeatVerdict& verdict : verdicts) {
      result.settings.emplace_back().verdict = verdict;
    }
    SweepRequest request;
    request.exit_code = is_asked;
    return ExitCodeOf(request, result);
  };
  using gap::Verdict;
  const gap::RepeatVerdict passed{.verdict = Verdict::kPassed, .above = 1, .repeats = 99};
  const gap::RepeatVerdict unseen{.verdict = Verdict::kNotSeenToFail, .repeats = 3};
  const gap::RepeatVerdict open{.verdict = Verdict::kUndecided, .above = 1, .repeats = 3};
  const gap::RepeatVerdict untold{.verdict = Verdict::kUndecided};
  const gap::RepeatVerdict falsified{.verdict = Verdict::kFalsified, .above = 9, .repeats = 9};
  for (const bool is_asked : {false, true}) {
    CHECK(ends_with(is_asked, 0, {passed}) == 1);
    CHECK(ends_with(is_asked, 1, {passed, unseen, untold}) == 0);
    CHECK(ends_with(is_asked, 1, {passed, open}) == (is_asked ? 1 : 0));
    CHECK(ends_with(is_asked, 1, {falsified, passed}) == (is_asked ? 1 : 0));
  }
}

TEST_CASE("Logs that are not there are bad input, and a robot that never arrives is a result") {
  const auto result = [](const std::vector<TrialStatus>& ends, const std::string& candidate) {
    sweep::SweepResult made;
    made.candidate_kind = candidate;
    for (const TrialStatus status : ends) {
      sweep::TrialRow row{.status = status};
      row.reason = "reason " + std::to_string(made.rows.size());
      made.rows.push_back(row);
    }
    return made;
  };
  SweepRequest request;
  request.experiment = "task.yaml";
  const std::string message =
      "task.yaml: not one of 2 trials could be compared; the first: reason 0";
  using Ends = std::vector<TrialStatus>;
  for (const Ends& ends : {Ends{TrialStatus::kMissing, TrialStatus::kMissing},
                           {TrialStatus::kUnreadable, TrialStatus::kMissing},
                           {TrialStatus::kUnreadable, TrialStatus::kUnreadable}}) {
    CHECK_THROWS_AS(EndWithoutGap(request, result(ends, "simulation")), std::invalid_argument);
    CHECK_THROWS_WITH(EndWithoutGap(request, result(ends, "simulation")), message);
  }
  for (const Ends& ends : {Ends{TrialStatus::kFell, TrialStatus::kMissing},
                           {TrialStatus::kMissing, TrialStatus::kTimedOut}}) {
    int code = 0;
    CHECK(Said([&] { code = EndWithoutGap(request, result(ends, "simulation")); }) ==
          "rift: " + message + "\n");
    CHECK(code == 1);
    CHECK_THROWS_WITH(EndWithoutGap(request, result(ends, "logs")), message);
  }
}

TEST_CASE("Without a folder the name of the experiment is one in out, if it is a plain name") {
  CHECK(OutputOf("there/run", "../a") == "there/run");
  CHECK(OutputOf("", "paper") == fs::path("out/paper"));
  CHECK(OutputOf("", "..a.") == fs::path("out/..a."));
  for (const std::string name : {"", ".", "..", "a/b", "/"}) {
    CHECK_THROWS_WITH(OutputOf("", name), "the name of the experiment, '" + name +
                                              "', is no folder name: say --out DIR");
  }
}

TEST_CASE("A folder is that of a sweep by its table or its journal, of a run by its log") {
  const test::TemporaryFolder folder;
  CHECK_NOTHROW(RefuseSweepFolder(folder.Path()));
  CHECK_NOTHROW(RefuseRunFolder(folder.Path()));
  for (const char* name : {"table.csv", "journal.sqlite", "trajectory.csv"}) {
    test::WriteText(folder / name, "x");
    const bool is_run = std::string(name) == "trajectory.csv";
    INFO(name);
    if (is_run) {
      CHECK_NOTHROW(RefuseSweepFolder(folder.Path()));
      CHECK_THROWS_WITH(RefuseRunFolder(folder.Path()),
                        folder.Path().string() + " holds a run: name another folder with --out");
    } else {
      CHECK_NOTHROW(RefuseRunFolder(folder.Path()));
      CHECK_THROWS_WITH(RefuseSweepFolder(folder.Path()),
                        folder.Path().string() + " holds a sweep: name another folder with --out");
    }
    fs::remove(folder / name);
  }
}

TEST_CASE("Copies of a log are each of its own kind, and those that were written are named") {
  const test::TemporaryFolder folder;
  trajectory::Trajectory path;
  for (int i = 0; i < 3; ++i) {
    path.poses.push_back({.t_s = 0.5 * i, .x_m = 0.1 * i, .y_m = 0.0, .yaw_rad = 0.0});
  }
  CHECK(LogCopies{}.Files().empty());
  LogCopies copies{.tum = folder / "a.tum"};
  CHECK(copies.Files() == std::vector<fs::path>{folder / "a.tum"});
  CHECK(Said([&] { copies.Write(path); }) == "log: " + (folder / "a.tum") + "\n");
  CHECK(test::ReadFile(folder / "a.tum") == trajectory::WriteTum(path));
  copies = {.mcap = folder / "a.mcap"};
  CHECK(Said([&] { copies.Write(path); }) == "log: " + (folder / "a.mcap") + "\n");
  CHECK(test::ReadFile(folder / "a.mcap") == trajectory::WriteMcap(path));
  copies.tum = folder / "b.tum";
  CHECK(copies.Files() == std::vector<fs::path>{folder / "b.tum", folder / "a.mcap"});
}

}  // namespace
}  // namespace rift::commands
