// A drive of the robot at a suggested setting, judged as a trial of the sweep.

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <stdexcept>

#include "experiment_sides.hpp"
#include "job_status.hpp"
#include "rift/sweep/falsify/candidate_runs.hpp"
#include "rift/sweep/falsify/compare_trial.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "rift/sweep/falsify/trial_runner.hpp"
#include "simulated_recording.hpp"

namespace rift::sweep {

using experiment::ReferenceKind;

namespace {

/// In a process that is given up when its program hangs, as the trials of the sweep were.
Recording ProgramReference(Evaluator& evaluator, const TrialRequest& request) {
  const auto work = [&evaluator](const std::string& job) {
    return EncodeRecording(evaluator.Reference(DecodeRequest(job)));
  };
  const JobResult result = RunApart(work, request, evaluator.experiment().run);
  if (result.end == JobEnd::kDone) return DecodeRecording(result.bytes);
  const TrialRow ended = EndedRow(request, result);
  return {.status = ended.status,
          .reason = ended.reason,
          .source = fmt::format("program with seed {}", request.seed.value_or(0))};
}

}  // namespace

TrialRow Evaluator::EvaluateDriven(const TrialRequest& asked, const std::string& path,
                                   trial::Outcome outcome) {
  if (experiment_.objective == experiment::Objective::kOdometry) {
    throw std::invalid_argument(fmt::format(
        "{}: objective is odometry, and suggested drives are judged by the gap of their poses",
        experiment_file_));
  }
  const std::string saved =
      std::filesystem::path(path).replace_filename("experiment.yaml").string();
  if (const std::optional<std::string> text = inputs_.read(saved)) {
    const auto other = WhyOtherDrive(saved, *text, ExperimentFor(experiment_, asked));
    if (other) {
      inputs_.note(*other + ": this drive does not count");
      TrialRow row = RowFor(asked);
      row.status = TrialStatus::kInvalid;
      row.reason = *other;
      return row;
    }
  }
  const bool is_reference = experiment_.reference.kind == ReferenceKind::kLogs;
  LogOptions of_drive;
  of_drive.read.format = trajectory::Format::kRift;
  of_drive.format_key = "the format of rift drive";
  if (is_reference) of_drive.tag_offset_m = experiment_.reference.tag_offset_m;
  RecordedLogs logs(inputs_, of_drive);
  Recording driven = logs.At(path);
  if (driven.status == TrialStatus::kOk && outcome != trial::Outcome::kReached) {
    driven.status = StatusOf(outcome);
    driven.reason = "the robot did not reach the end";
  }
  TrialRequest request = asked;
  if (request.seed) request.seed = SeedWithReference(*request.seed);
  const Recording reference = is_reference         ? driven
                              : reference_program_ ? ProgramReference(*this, request)
                                                   : Reference(request);
  const TrialRow row = CompareTrial(experiment_, request,
                                    is_reference ? Candidate(request, driven) : driven, reference);
  if (!row.Tells()) {
    inputs_.note(fmt::format("{}{}: this drive does not count",
                             row.reason.starts_with(path) ? "" : path + ": ", row.reason));
  }
  return row;
}

}  // namespace rift::sweep
