// A drive of the robot at a suggested setting, judged as a trial of the sweep.

#include <fmt/format.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <utility>

#include "experiment_sides.hpp"
#include "job_status.hpp"
#include "rift/sweep/falsify/candidate_runs.hpp"
#include "rift/sweep/falsify/compare_trial.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "rift/sweep/falsify/trial_runner.hpp"
#include "rift/sweep/run/byte_codec.hpp"
#include "rift/sweep/run/machine_trouble.hpp"
#include "simulated_recording.hpp"

namespace rift::sweep {

using experiment::ReferenceKind;

namespace {

/// What a drive is held against, and the trial that this is of: another seed may take the place of
/// the one that was asked for.
struct OtherSide {
  TrialRequest request;
  Recording recording;
};

/// In a process that is given up when a program hangs, as the trials of the sweep were. Where this
/// machine cannot run it the drive counts for nothing, and the sweep is done.
OtherSide RunOtherSideApart(const std::function<OtherSide(TrialRequest)>& run,
                            const TrialRequest& request, const RunOptions& options) {
  const auto work = [&run](const std::string& job) {
    const OtherSide other = run(DecodeRequest(job));
    ByteWriter write;
    write(EncodeRequest(other.request));
    write(EncodeRecording(other.recording));
    return write.Take();
  };
  OtherSide other{request,
                  {.source = fmt::format("program with seed {}", request.seed.value_or(0))}};
  try {
    const JobResult result = RunApart(work, request, options);
    if (result.end == JobEnd::kDone) {
      ByteReader read(result.bytes);
      std::string asked, recording;
      read(asked);
      read(recording);
      return {DecodeRequest(asked), DecodeRecording(recording)};
    }
    const TrialRow ended = EndedRow(request, result);
    other.recording.status = ended.status;
    other.recording.reason = ended.reason;
  } catch (const MachineTrouble& trouble) {
    other.recording.status = TrialStatus::kFault;
    other.recording.reason = trouble.what();
  }
  return other;
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
  const auto run = [&](TrialRequest request) -> OtherSide {
    if (request.seed) request.seed = SeedWithReference(*request.seed);
    Recording recording = is_reference ? Candidate(request, driven) : Reference(request);
    return {std::move(request), std::move(recording)};
  };
  const bool runs_program = candidate_program_ || reference_program_;
  const auto [request, other] =
      runs_program ? RunOtherSideApart(run, asked, experiment_.run) : run(asked);
  const TrialRow row = CompareTrial(experiment_, request, is_reference ? other : driven,
                                    is_reference ? driven : other);
  if (!row.Tells()) {
    inputs_.note(fmt::format("{}{}: this drive does not count",
                             row.reason.starts_with(path) ? "" : path + ": ", row.reason));
  }
  return row;
}

}  // namespace rift::sweep
