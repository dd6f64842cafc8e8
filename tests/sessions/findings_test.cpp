// What is written of a finished sweep: explanation, figures, page, and the paths on it.
#include "rift/sessions/sweep/findings.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "rift/sessions/sweep/live_page.hpp"
#include "rift/sessions/sweep/suggested.hpp"
#include "rift/sweep/falsify/evidence.hpp"
#include "rift/trajectory/log.hpp"
#include "sessions/sweep/page_evidence.hpp"
#include "sessions/sweep_folder.hpp"
#include "support/processes/process.hpp"
#include "support/processes/quick_gnuplot.hpp"
#include "support/until.hpp"

namespace rift::sessions {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

/// A sweep at its end, with what it was made by.
struct Swept {
  explicit Swept(const experiment::Experiment& swept)
      : experiment(swept), evaluator(experiment, "sweep.yaml", FileInputs()) {
    result = *RunSweep(evaluator, {.out = folder.Path()}, ObserverOf(told));
  }
  std::optional<WorstPaths> Worst() { return WorstPair(result, evaluator, ObserverOf(told).say); }

  test::TemporaryFolder folder;
  experiment::Experiment experiment;
  sweep::Evaluator evaluator;
  SweepTold told;
  sweep::SweepResult result;
};

TEST_CASE("The report of a sweep is its explanation, its figures as SVG and PNG, and its page") {
  const test::QuickGnuplot quick;
  Swept swept(SmallGrid());
  const fs::path out = swept.folder.Path();
  for (const char* name : {"fig01_old.svg", "fig01_old.png", "fig01_old.txt", "mine.svg"}) {
    fs::create_directories(out / "figures");
    test::WriteText(out / "figures" / name, "x");
  }
  const SweepFindings findings = ExplainSweep(out, swept.evaluator, swept.result, 0, 1);
  CHECK(findings.likeness.empty());
  CHECK(findings.programs.empty());
  CHECK(findings.explanation.suggestions.list.size() <= 5);
  CHECK_FALSE(fs::exists(out / "suggested.yaml"));
  SaveReport(out, swept.evaluator, swept.result, findings, ObserverOf(swept.told));
  CHECK(nlohmann::json::parse(files::ReadFile(out / "explanation.json")).is_object());
  CHECK_FALSE(fs::exists(out / "likeness.json"));
  CHECK_FALSE(fs::exists(out / "programs.json"));
  CHECK_FALSE(fs::exists(out / "figures/fig01_old.svg"));
  CHECK_FALSE(fs::exists(out / "figures/fig01_old.png"));
  CHECK(fs::exists(out / "figures/fig01_old.txt"));
  CHECK(fs::exists(out / "figures/mine.svg"));
  int svg = 0, png = 0;
  for (const auto& entry : fs::directory_iterator(out / "figures")) {
    svg += entry.path().extension() == ".svg";
    png += entry.path().extension() == ".png";
  }
  CHECK(svg == png + 1);
  CHECK(png >= 3);
  const std::string page = files::ReadFile(out / "report.html");
  CHECK(page.find("waypoint path") != page.npos);
  // One axis with two words: what cannot be drawn of it is named with its reason.
  CHECK_THAT(swept.told.Text(), Contains("note: fig") && Contains(" is not drawn: "));
}

TEST_CASE("Experiments are suggested only where that is asked for, as many as that") {
  Swept swept(LoadText(kShortWay +
                       "gap: {threshold_m: 0.004}\nreference: {kind: path, trials: 1}\n"
                       "goal: falsify\nspace:\n  v_min: {min: 0.12, max: 0.2, step: 0.02}\n"
                       "  mismatch: {min: -0.25, max: 0.25}\n"
                       "search: {budget: 24}\nfalsify: {until: budget, most_repeats: 2}\n"));
  const fs::path out = swept.folder.Path();
  const SweepFindings none = ExplainSweep(out, swept.evaluator, swept.result, 0, 1);
  CHECK_FALSE(fs::exists(out / "suggested.yaml"));
  REQUIRE(none.explanation.suggestions.list.size() >= 2);
  const SweepFindings one = ExplainSweep(out, swept.evaluator, swept.result, 1, 1);
  CHECK(one.explanation.suggestions.list.size() == 1);
  const auto saved = ReadSuggested(out, swept.experiment);
  REQUIRE(saved.size() == 1);
  CHECK(saved[0].values == one.explanation.suggestions.list[0].values);
}

std::string Path(double bend_m, int rows = 60) {
  trajectory::Trajectory path;
  for (int i = 0; i <= rows; ++i) {
    const double u = i / double(rows);
    path.poses.push_back(
        {.t_s = 4.0 * u, .x_m = u, .y_m = bend_m * u * u, .yaw_rad = 2 * bend_m * u});
  }
  return trajectory::WriteRift(path);
}

/// Two surfaces, two trials of each, a log of the robot for each trial.
experiment::Experiment LogsIn(const test::TemporaryFolder& folder) {
  double bend_m = 0.0;
  for (const std::string surface : {"ice", "sand"}) {
    for (const std::string trial : {"1", "2"}) {
      test::WriteText(folder / (surface + trial + "_real.csv"), Path(bend_m));
      test::WriteText(folder / (surface + trial + "_sim.csv"), Path(2.0 * bend_m + 0.01));
      bend_m += 0.03;
    }
  }
  return LoadText("space: {surface: [ice, sand]}\ncandidate: {kind: logs, path: \"" +
                  (folder / "{surface}{trial}_sim.csv") +
                  "\"}\nreference: {kind: logs, trials: [1, 2], path: \"" +
                  (folder / "{surface}{trial}_real.csv") +
                  "\"}\nlikeness: {shuffles: 19}\ngap: {skip_start: 0.1}\n");
}

TEST_CASE(
    "Every log of the robot is a reference of the page with its trial, and likeness is saved") {
  const test::QuickGnuplot quick;
  const test::TemporaryFolder logs;
  Swept swept(LogsIn(logs));
  const report::PageEvidence evidence = EvidenceFor(swept.result, swept.evaluator, nullptr);
  REQUIRE(evidence.references.size() == 4);
  CHECK(evidence.reference_of_row == std::vector<int>{0, 1, 2, 3});
  CHECK_THAT(evidence.gap_flags, Contains("--skip-start 0.1"));
  CHECK(evidence.references[0].name == "robot, trial 1");
  CHECK(evidence.references[3].name == "robot, trial 2");
  CHECK(evidence.references[3].path_m.back().y() == Approx(0.09));
  REQUIRE(evidence.references[3].times_s.size() == evidence.references[3].path_m.size());
  CHECK(evidence.references[3].times_s.back() == Approx(4.0));
  const auto worst = swept.Worst();
  REQUIRE(worst);
  CHECK(swept.result.rows[3].comparison.gap_m > swept.result.rows[2].comparison.gap_m);
  CHECK(worst->pair.real == "robot, trial 2");
  const fs::path out = swept.folder.Path();
  const SweepFindings findings = ExplainSweep(out, swept.evaluator, swept.result, 3, 1);
  CHECK_FALSE(fs::exists(out / "suggested.yaml"));
  REQUIRE_FALSE(findings.likeness.empty());
  SaveReport(out, swept.evaluator, swept.result, findings, ObserverOf(swept.told));
  CHECK_THAT(swept.told.Text(), Contains("note: suggested.yaml is not written: candidate.kind is "
                                         "logs"));
  CHECK(fs::exists(out / "likeness.json"));
  CHECK_THAT(files::ReadFile(out / "report.html"), Contains("robot, trial 2"));
}

/// The path of a row on a page: x and y of its points, in 0.2 mm.
std::vector<long> DrawnPath(const fs::path& page, const std::string& id) {
  const std::string text = files::ReadFile(page);
  const std::string open = R"(<script type="application/json" id="page-data">)";
  const size_t begin = text.find(open) + open.size();
  const auto data =
      nlohmann::json::parse(text.substr(begin, text.find("</script>", begin) - begin));
  const auto& rows = data.at("paths").at("rows");
  std::vector<long> points;
  if (!rows.contains(id)) return points;
  for (const auto& step : rows.at(id).at("d")) {
    const long before = points.size() < 2 ? 0 : points[points.size() - 2];
    points.push_back(before + step.get<long>());
  }
  return points;
}

TEST_CASE("The worst trial is drawn where no row has kept its path, and the others are not") {
  const test::QuickGnuplot quick;
  const test::TemporaryFolder logs;
  Swept swept(LogsIn(logs));
  const fs::path out = swept.folder.Path(), page = out / "report.html";
  REQUIRE(sweep::WorstRow(swept.result) == 3);
  const SweepFindings findings = ExplainSweep(out, swept.evaluator, swept.result, 0, 1);
  SaveReport(out, swept.evaluator, swept.result, findings, ObserverOf(swept.told));
  const std::vector<long> kept = DrawnPath(page, "4");
  for (sweep::TrialRow& row : swept.result.rows) row.evidence.ForgetPath();
  SaveReport(out, swept.evaluator, swept.result, findings, ObserverOf(swept.told));
  const std::vector<long> made = DrawnPath(page, "4");
  REQUIRE(kept.size() == 2 * 65);
  REQUIRE(made.size() == kept.size());
  for (size_t i = 0; i < kept.size(); ++i) {
    INFO(i);
    CHECK(std::abs(made[i] - kept[i]) <= 4);  // the compared points are half a millimetre apart
  }
  CHECK(DrawnPath(page, "3").empty());
}

TEST_CASE("A page draws the references of a hundred rows and of no more") {
  const test::TemporaryFolder logs;
  for (int trial = 1; trial <= 102; ++trial) {
    const std::string stem = logs / std::to_string(trial);
    test::WriteText(stem + "_real.csv", Path(0.001 * trial, 12));
    test::WriteText(stem + "_sim.csv", Path(0.0, 12));
  }
  Swept swept(LoadText("candidate: {kind: logs, path: \"" + (logs / "{trial}_sim.csv") +
                       "\"}\nreference: {kind: logs, trials: 102, path: \"" +
                       (logs / "{trial}_real.csv") + "\"}\ngap: {samples: 50}\n"));
  const report::PageEvidence evidence = EvidenceFor(swept.result, swept.evaluator, nullptr);
  CHECK(evidence.references.size() == 100);
  CHECK(evidence.reference_of_row[99] == 99);
  CHECK(evidence.reference_of_row[100] == -1);
}

TEST_CASE("Equal references are kept once, and a row without a log has none") {
  const test::TemporaryFolder logs;
  const experiment::Experiment experiment = LogsIn(logs);
  test::WriteText(logs / "sand2_real.csv", files::ReadFile(logs / "ice1_real.csv"));
  fs::remove(logs / "ice2_real.csv");
  Swept swept(experiment);
  const report::PageEvidence evidence = EvidenceFor(swept.result, swept.evaluator, nullptr);
  CHECK(evidence.references.size() == 2);
  CHECK(evidence.reference_of_row == std::vector<int>{0, -1, 1, 0});
}

TEST_CASE(
    "The path of a task is the reference of all its repeats, without times, with its waypoints") {
  Swept swept(SmallGrid());
  const report::PageEvidence evidence = EvidenceFor(swept.result, swept.evaluator, nullptr);
  REQUIRE(evidence.references.size() == 1);
  CHECK(evidence.references[0].name == "waypoint path");
  CHECK(evidence.references[0].times_s.empty());
  CHECK(evidence.references[0].path_m.back().x() == Approx(0.25));
  CHECK(evidence.references[0].path_m.back().y() == Approx(0.02));
  CHECK(evidence.reference_of_row == std::vector<int>{0, 0, 0, 0});
  REQUIRE(evidence.waypoints.size() == 2);
  CHECK(evidence.waypoints[1].p_in_world_m.x() == 0.25);
  CHECK(evidence.waypoints[1].p_in_world_m.y() == 0.02);
}

TEST_CASE("A reference that has to be run is the worst trial's, and only where it may be run") {
  Swept swept(LoadText(kShortWay +
                       "gap: {threshold_m: 0.01}\nreference: {kind: nominal, trials: 2}\n"
                       "space: {mismatch: [0, 0.1]}\n"));
  CHECK(EvidenceFor(swept.result, swept.evaluator, nullptr).references.empty());
  const auto paths = swept.Worst();
  REQUIRE(paths);
  CHECK(paths->pair.real == "undisturbed run");
  CHECK(paths->pair.sim == "simulator");
  const report::PageEvidence evidence =
      EvidenceFor(swept.result, swept.evaluator, &paths->reference);
  REQUIRE(evidence.references.size() == 1);
  CHECK(evidence.references[0].name == "undisturbed run");
  CHECK_FALSE(evidence.references[0].times_s.empty());
  const int worst = sweep::WorstRow(swept.result).value();
  for (int row = 0; row < 4; ++row) {
    CHECK(evidence.reference_of_row[row] == (row == worst ? 0 : -1));
  }
}

TEST_CASE("The path that a program should drive is called so, and has no times") {
  Swept driven(
      LoadText("program: {segments: [{straight_m: 0.1}]}\ngap: {threshold_m: 0.01}\n"
               "reference: {kind: path, trials: 1}\nspace: {mismatch: [0]}\n"));
  const report::PageEvidence path = EvidenceFor(driven.result, driven.evaluator, nullptr);
  REQUIRE(path.references.size() == 1);
  CHECK(path.references[0].name == "program path");
  CHECK(path.references[0].times_s.empty());
}

TEST_CASE("A sweep is explained beside a setting whose program no robot can drive") {
  Swept swept(
      LoadText("program: {segments: [{straight_m: 0.05}]}\ngap: {threshold_m: 0.01}\n"
               "reference: {kind: path, trials: 1}\nspace: {program.speed_mps: [5, 0.1]}\n"));
  REQUIRE(swept.result.rows.size() == 2);
  REQUIRE(swept.result.rows[0].status == sweep::TrialStatus::kFault);
  REQUIRE(swept.result.rows[1].IsOk());
  const SweepFindings findings =
      ExplainSweep(swept.folder.Path(), swept.evaluator, swept.result, 0, 1);
  REQUIRE(findings.programs.size() == 2);
  CHECK(findings.programs[0].lost.size() == 1);
  CHECK(findings.programs[1].runs.size() == 1);
  const report::PageEvidence evidence = EvidenceFor(swept.result, swept.evaluator, nullptr);
  CHECK(evidence.references.size() == 1);
  CHECK(evidence.reference_of_row == std::vector<int>{-1, 0});
}

TEST_CASE("Without a gap there is no worst pair") {
  Swept swept(SmallGrid({"trial.timeout_s=0.5"}));
  CHECK_FALSE(swept.Worst());
  CHECK(swept.told.Text().find("worst") == std::string::npos);
}

TEST_CASE("A worst trial that does not come out again costs its picture alone, and is said") {
  const test::QuickGnuplot quick;
  const test::TemporaryFolder programs;
  const std::string sim = programs / "sim";
  const auto write_program = [&](const std::string& lines) {
    test::WriteText(sim, "#!/bin/sh\n" + lines + "\n");
    fs::permissions(sim, fs::perms::owner_all);
  };
  write_program("printf 't_s,x_m,y_m\\n0,0,0\\n1,0.1,0\\n2,0.25,%s\\n' \"$2\" > \"$1\"");
  const auto side = [&](const std::string& end) {
    return "{kind: program, run: [" + sim + ", \"{out}\", \"" + end + "\"]}\n";
  };
  const std::string limits = "run: {timeout_s: 5, retries: 0}\n";
  Swept swept(LoadText(kShortWay + "candidate: " + side("{mu}") + "reference: {kind: path}\n" +
                       limits + "space: {mu: [0.02, 0.1]}\n"));
  Swept simulated(
      LoadText(kShortWay + "reference: " + side("0.02") + limits + "space: {mismatch: [0.1]}\n"));
  REQUIRE(swept.Worst());
  REQUIRE(simulated.Worst());
  const std::string note = "note: row 2, the worst, is not drawn against its reference: ";
  struct Case {
    std::string lines, why;
  };
  for (const Case& end : {Case{"echo no licence >&2; exit 1",
                               "program with seed 1: ended with exit code 1: no licence"},
                          Case{"exec sleep 1000", "had not ended after 5 s (run.timeout_s)"},
                          Case{"", "cannot run " + sim}}) {
    INFO(end.lines);
    end.lines.empty() ? static_cast<void>(fs::remove(sim)) : write_program(end.lines);
    swept.told.lines.clear();
    const fs::path out = swept.folder.Path();
    fs::remove(out / "report.html");
    SaveReport(out, swept.evaluator, swept.result, {}, ObserverOf(swept.told));
    CHECK_THAT(swept.told.Text(), Contains(note) && Contains(end.why));
    CHECK(fs::exists(out / "report.html"));
  }
  CHECK_FALSE(simulated.Worst());
  CHECK_THAT(simulated.told.Text(), Contains("cannot run " + sim));
}

TEST_CASE("Programs of a grid that are not on this machine cost their measures and no report") {
  const test::QuickGnuplot quick;
  const test::TemporaryFolder programs;
  const std::string sim = programs / "sim";
  test::WriteText(sim, "#!/bin/sh\nprintf 't_s,x_m,y_m\\n0,0,0\\n1,0.05,0\\n2,0.1,0.01\\n' > $1\n");
  fs::permissions(sim, fs::perms::owner_all);
  Swept swept(
      LoadText("program: {segments: [{straight_m: 0.1}]}\nreference: {kind: path}\n"
               "candidate: {kind: program, run: [" +
               sim +
               ", \"{out}\"]}\n"
               "space: {mu: [1]}\n"));
  fs::remove(sim);
  const fs::path out = swept.folder.Path();
  const SweepFindings findings = ExplainSweep(out, swept.evaluator, swept.result, 0, 1);
  CHECK(findings.programs.empty());
  REQUIRE(findings.notes.size() == 1);
  CHECK_THAT(findings.notes[0], Catch::StartsWith("note: programs.json is left out: ") &&
                                    Contains("cannot run " + sim));
  SaveReport(out, swept.evaluator, swept.result, findings, ObserverOf(swept.told));
  CHECK_THAT(swept.told.Text(), Contains("note: programs.json is left out"));
  CHECK(fs::exists(out / "report.html"));
}

TEST_CASE("The page of a sweep that runs begins before a trial, grows with them, and goes") {
  const test::TemporaryFolder folder;
  Swept swept(SmallGrid());
  const fs::path file = folder / "live.html";
  {
    LivePage page(folder.Path(), swept.evaluator);
    CHECK_THAT(page.Url(), Catch::StartsWith("http://127.0.0.1:"));
    CHECK_THAT(files::ReadFile(file), Contains("The first trials are running."));
    page.Tick();  // without a row nothing is drawn, however late
    for (const sweep::TrialRow& row : swept.result.rows) page.Seen(row);
    test::WaitUntil("the page is drawn", [&] {
      page.Tick();
      return files::ReadFile(file).find("first trials") == std::string::npos;
    });
    const int failures = swept.result.all.failures;
    CHECK_THAT(files::ReadFile(file),
               Contains("4 trials so far, " + std::to_string(failures) + " of them failed"));
    fs::remove(file);
    page.Tick();  // nothing new
    CHECK_FALSE(fs::exists(file));
    test::WriteText(file, "x");
    page.End();
    CHECK_FALSE(fs::exists(file));
    test::WriteText(file, "x");
  }
  CHECK_FALSE(fs::exists(file));
}

TEST_CASE("A page of more than twenty thousand trials is not drawn while the sweep runs") {
  const test::TemporaryFolder folder;
  Swept swept(SmallGrid());
  LivePage page(folder.Path(), swept.evaluator);
  sweep::TrialRow row = swept.result.rows[0];
  row.evidence = {};
  for (int i = 0; i < 20'001; ++i) page.Seen(row);
  page.Tick();
  CHECK_THAT(files::ReadFile(folder / "live.html"), Contains("The first trials are running."));
}

}  // namespace
}  // namespace rift::sessions
