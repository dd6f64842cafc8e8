// The files in the folder of a sweep: which are saved, which are removed, what keeps others out.
#include "sessions/sweep_folder.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "rift/report/json/json.hpp"
#include "rift/sessions/sweep/journal.hpp"
#include "support/processes/process.hpp"

namespace rift::sessions {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kReport{"report.html", "explanation.json", "likeness.json",
                                       "programs.json", "figures/fig07_gap.svg"};
const std::vector<std::string> kFound{"table.csv",        "summary.json", "inputs.txt",
                                      "calibration.json", "shrunk.json",  "shrunk/table.csv",
                                      "rare_event.json",  "live.html"};
const std::vector<std::string> kKept{"experiment.yaml", "journal.sqlite", "suggested.yaml",
                                     "suggested/1_1/trajectory.csv"};

void Fill(const fs::path& folder) {
  for (const auto* names : {&kReport, &kFound, &kKept}) {
    for (const std::string& name : *names) {
      fs::create_directories((folder / name).parent_path());
      test::WriteText(folder / name, "x");
    }
  }
}

TEST_CASE("An earlier report is removed without the answers to further questions, drives never") {
  const test::TemporaryFolder folder;
  Fill(folder.Path());
  const auto are_there = [&](const std::vector<std::string>& names, bool there) {
    for (const std::string& name : names) {
      INFO(name);
      CHECK(fs::exists(folder.Path() / name) == there);
    }
  };
  RemoveReport(folder.Path());
  are_there(kReport, false);
  CHECK_FALSE(fs::exists(folder / "figures"));
  are_there(kFound, true);
  are_there(kKept, true);
  Fill(folder.Path());
  RemoveFindings(folder.Path());
  are_there(kReport, false);
  are_there(kFound, false);
  CHECK_FALSE(fs::exists(folder / "shrunk"));
  are_there(kKept, true);
}

TEST_CASE("Figures of somebody else stay when those of a sweep go") {
  const test::TemporaryFolder folder;
  Fill(folder.Path());
  const std::vector<std::string> ours{"fig07_.svg", "fig08_gap_by_trial.png", "gap_over_v_min.svg",
                                      "calibration.png"};
  const std::vector<std::string> others{"mine.svg",     "fig08.txt",   "gap.png",
                                        "fig_mine.svg", "fig1.png",    "fig2_setup.svg",
                                        "fig12b.svg",   "figures.png", "calibration.csv"};
  for (const auto* names : {&ours, &others}) {
    for (const std::string& name : *names) test::WriteText(folder / ("figures/" + name), "x");
  }
  RemoveReport(folder.Path());
  for (const std::string& name : ours) {
    INFO(name);
    CHECK_FALSE(fs::exists(folder / ("figures/" + name)));
  }
  for (const std::string& name : others) {
    INFO(name);
    CHECK(fs::exists(folder / ("figures/" + name)));
  }
}

TEST_CASE("Files with a sweep's names are others' where no experiment and no journal is") {
  const test::TemporaryFolder folder;
  CHECK(OthersFile(folder.Path()).empty());
  fs::create_directories(folder / "figures");
  for (const char* name : {"notes.txt", "figures/fig1_setup.png", "figures/fig_mine.svg"}) {
    test::WriteText(folder / name, "x");
  }
  CHECK(OthersFile(folder.Path()).empty());
  std::vector<std::string> names = kReport;
  names.insert(names.end(), {"table.csv", "summary.json", "inputs.txt", "calibration.json",
                             "shrunk", "shrunk.json", "rare_event.json", "live.html",
                             "figures/calibration.png", "figures/gap_over_v_min.svg"});
  for (const std::string& name : names) {
    INFO(name);
    test::WriteText(folder / name, "x");
    CHECK(OthersFile(folder.Path()) == folder / name);
    for (const std::string own : {"experiment.yaml", "journal.sqlite"}) {
      test::WriteText(folder / own, "x");
      CHECK(OthersFile(folder.Path()).empty());
      fs::remove(folder / own);
    }
    fs::remove(folder / name);
  }
}

TEST_CASE("A saved sweep is its experiment, what it read, its table and its summary") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "a.csv", "t_s,x_m,y_m,yaw_rad\n0,0,0,0\n1,0.5,0.01,0\n2,1,0,0\n");
  test::WriteText(folder / "b.csv", "t_s,x_m,y_m,yaw_rad\n0,0,0,0\n1,0.5,0.03,0\n2,1,0,0\n");
  const experiment::Experiment logs =
      LoadText("candidate: {kind: logs, path: " + (folder / "a.csv") +
               "}\nreference: {kind: logs, path: " + (folder / "b.csv") + "}\n");
  SweepTold told;
  const auto result = SweepInto(folder / "out", logs, told);
  REQUIRE(result);
  CHECK(files::ReadFile(folder / "out/experiment.yaml") == experiment::WriteExperiment(logs));
  CHECK(files::ReadFile(folder / "out/table.csv") == report::TableCsv(*result));
  CHECK(files::ReadFile(folder / "out/summary.json") == report::SummaryJson(*result));
  const std::string inputs = files::ReadFile(folder / "out/inputs.txt");
  CHECK_THAT(inputs, Catch::Contains(folder / "a.csv") && Catch::Contains(folder / "b.csv"));
  CHECK(experiment::WriteExperiment(SavedExperiment(folder / "out")) ==
        experiment::WriteExperiment(logs));
}

TEST_CASE("A journal lets another experiment say by itself what differs, but not logs and fits") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "experiment.yaml", "of others");
  test::WriteText(folder / kJournalName, "");
  CHECK_FALSE(HoldsOtherExperiment(folder.Path(), SmallGrid()));
  experiment::Experiment fit = SmallGrid();
  fit.goal = experiment::Goal::kCalibrate;
  CHECK(HoldsOtherExperiment(folder.Path(), fit));
  const experiment::Experiment logs =
      LoadText("candidate: {kind: logs, path: a.csv}\nreference: {kind: logs, path: b.csv}\n");
  CHECK(HoldsOtherExperiment(folder.Path(), logs));
  test::WriteText(folder / "experiment.yaml", experiment::WriteExperiment(logs));
  CHECK_FALSE(HoldsOtherExperiment(folder.Path(), logs));
  fs::remove(folder / "experiment.yaml");
  CHECK_FALSE(HoldsOtherExperiment(folder.Path(), fit));
}

}  // namespace
}  // namespace rift::sessions
