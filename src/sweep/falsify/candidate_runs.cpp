#include "rift/sweep/falsify/candidate_runs.hpp"

#include <stdexcept>
#include <utility>

#include "job_status.hpp"
#include "rift/sweep/falsify/compare_trial.hpp"
#include "rift/sweep/falsify/trajectory_bytes.hpp"
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
    write(EncodeRecording(reference));
    return write.Take();
  };
  const JobResult result = RunApart(work, request, evaluator.experiment().run);
  ProgramTrial trial{.row = EndedRow(request, result)};
  if (result.end != JobEnd::kDone) {
    evaluator.NameSides(trial.row);
    trial.candidate = {.status = trial.row.status, .reason = trial.row.reason};
    trial.reference = trial.candidate;
    return trial;
  }
  ByteReader read(result.bytes);
  std::string findings, candidate, reference;
  read(findings);
  read(candidate);
  read(reference);
  DecodeFindings(findings, trial.row);
  trial.candidate = DecodeRecording(candidate);
  trial.reference = DecodeRecording(reference);
  return trial;
}

template <class Bytes, Is<Recording> T>
void Members(Bytes& bytes, T& recording) {
  bytes(recording.status);
  bytes(recording.reason);
  bytes(recording.source);
  bytes(recording.limits);
  bytes(recording.left_m);
  bytes(recording.trajectory);
  bytes(recording.doubts);
}

std::string EncodeRecording(const Recording& recording) {
  ByteWriter write;
  write(recording);
  return write.Take();
}

Recording DecodeRecording(std::string_view bytes) {
  ByteReader read(bytes);
  Recording recording;
  read(recording);
  if (!read.IsAtEnd()) throw std::runtime_error("a run of a program is of another layout");
  return recording;
}

}  // namespace rift::sweep
