#include "rift/report/text/gap_flags.hpp"

#include <catch2/catch.hpp>

namespace rift::report {
namespace {

experiment::Experiment OfLogs() {
  experiment::Experiment experiment;
  experiment.candidate.kind = experiment::CandidateKind::kLogs;
  experiment.reference.kind = experiment::ReferenceKind::kLogs;
  return experiment;
}

TEST_CASE("Flags of rift gap say how each side's logs are read, and what is no default") {
  experiment::Experiment experiment = OfLogs();
  CHECK(GapFlags(experiment) == " --sim-format auto --real-format auto");
  experiment.candidate.format = trajectory::Format::kWebots;
  experiment.reference.format = trajectory::Format::kTracker;
  CHECK(GapFlags(experiment) == " --sim-format webots --real-format tracker");

  experiment = OfLogs();
  experiment.candidate.columns = "t=a,x=b,y=c";
  experiment.candidate.units = "mm";
  experiment.reference.columns = "t=d,x=e,y=f";
  experiment.reference.units = "cm,ms";
  experiment.reference.tag_offset_m = 0.03;
  experiment.gap.skip_start = 0.1;
  experiment.gap.samples = 500;
  CHECK(GapFlags(experiment) ==
        " --sim-format auto --real-format auto --sim-columns 't=a,x=b,y=c' --sim-units 'mm'"
        " --real-columns 't=d,x=e,y=f' --real-units 'cm,ms' --tag-offset 0.03 --samples 500"
        " --skip-start 0.1");
}

TEST_CASE("A column's name with a quote stays one word of the command") {
  experiment::Experiment experiment = OfLogs();
  experiment.candidate.columns = "t=a,x=b,y=c'; rm -r d";
  CHECK(GapFlags(experiment) ==
        R"( --sim-format auto --real-format auto --sim-columns 't=a,x=b,y=c'\''; rm -r d')");
}

TEST_CASE("Where either side is no log there is no command that measures it") {
  experiment::Experiment experiment = OfLogs();
  experiment.candidate.kind = experiment::CandidateKind::kSimulation;
  CHECK(GapFlags(experiment).empty());
  experiment = OfLogs();
  experiment.reference.kind = experiment::ReferenceKind::kNominal;
  CHECK(GapFlags(experiment).empty());
}

}  // namespace
}  // namespace rift::report
