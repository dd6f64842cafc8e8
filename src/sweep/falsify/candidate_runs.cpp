#include "rift/sweep/falsify/candidate_runs.hpp"

#include <stdexcept>
#include <utility>

#include "job_status.hpp"
#include "rift/sweep/run/byte_codec.hpp"

namespace rift::sweep {

CandidateRuns::CandidateRuns(Evaluator& evaluator, int workers)
    : pool_(
          [&evaluator](const std::string& job) {
            return EncodeRecording(evaluator.Candidate(DecodeRequest(job), {}));
          },
          workers, evaluator.experiment().run) {}

std::vector<Recording> CandidateRuns::Run(const std::vector<TrialRequest>& requests) {
  std::vector<Recording> runs(requests.size());
  WorkerPool::Batch batch;
  batch.count = static_cast<int>(requests.size());
  batch.job = [&](int i) { return EncodeRequest(requests[static_cast<size_t>(i)]); };
  batch.done = [&](int i, const JobResult& result) {
    Recording& run = runs[static_cast<size_t>(i)];
    if (result.end == JobEnd::kDone) {
      run = DecodeRecording(result.bytes);
    } else {
      const TrialRow row = EndedRow(requests[static_cast<size_t>(i)], result);
      run = {.status = row.status, .reason = row.reason};
    }
  };
  batch.go_on = [] { return true; };
  pool_.Run(batch);
  return runs;
}

ProgramTrial RunProgramTrial(Evaluator& evaluator, const TrialRequest& request) {
  const auto work = [&evaluator](const std::string& job) {
    const TrialRequest asked = DecodeRequest(job);
    const Recording reference = evaluator.Reference(asked);
    const Recording candidate = evaluator.Candidate(asked, reference);
    ByteWriter write;
    write(EncodeFindings(CompareTrial(evaluator.experiment(), asked, candidate, reference)));
    write(EncodeRecording(candidate));
    return write.Take();
  };
  ProgramTrial trial;
  WorkerPool::Batch batch;
  batch.count = 1;
  batch.job = [&](int) { return EncodeRequest(request); };
  batch.done = [&](int, const JobResult& result) {
    trial.row = EndedRow(request, result);
    if (result.end != JobEnd::kDone) {
      evaluator.NameSides(trial.row);
      trial.candidate = {.status = trial.row.status, .reason = trial.row.reason};
      return;
    }
    ByteReader read(result.bytes);
    std::string findings, recording;
    read(findings);
    read(recording);
    DecodeFindings(findings, trial.row);
    trial.candidate = DecodeRecording(recording);
  };
  batch.go_on = [] { return true; };
  WorkerPool(work, 1, evaluator.experiment().run).Run(batch);
  return trial;
}

std::string EncodeRecording(const Recording& recording) {
  ByteWriter write;
  write(recording.status);
  write(recording.reason);
  write(recording.source);
  write(recording.limits);
  write(recording.left_m);
  write(recording.trajectory.poses.size());
  for (const trajectory::StampedPose& pose : recording.trajectory.poses) write(pose);
  write(recording.trajectory.channels.size());
  for (const trajectory::Channel& channel : recording.trajectory.channels) {
    write(channel.name);
    write(channel.values.size());
    for (const double value : channel.values) write(value);
  }
  write(recording.doubts.size());
  for (const std::string& doubt : recording.doubts) write(doubt);
  return write.Take();
}

Recording DecodeRecording(std::string_view bytes) {
  ByteReader read(bytes);
  Recording recording;
  read(recording.status);
  read(recording.reason);
  read(recording.source);
  read(recording.limits);
  read(recording.left_m);
  recording.trajectory.poses.resize(read.Count(sizeof(trajectory::StampedPose)));
  for (trajectory::StampedPose& pose : recording.trajectory.poses) read(pose);
  recording.trajectory.channels.resize(read.Count(2 * sizeof(size_t)));
  for (trajectory::Channel& channel : recording.trajectory.channels) {
    read(channel.name);
    channel.values.resize(read.Count(sizeof(double)));
    for (double& value : channel.values) read(value);
  }
  recording.doubts.resize(read.Count(sizeof(size_t)));
  for (std::string& doubt : recording.doubts) read(doubt);
  if (!read.IsAtEnd()) throw std::runtime_error("a run of a program is of another layout");
  return recording;
}

}  // namespace rift::sweep
