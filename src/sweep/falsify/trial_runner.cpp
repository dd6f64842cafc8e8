#include "rift/sweep/falsify/trial_runner.hpp"

#include <stdexcept>
#include <utility>

#include "job_status.hpp"
#include "rift/sweep/run/byte_codec.hpp"
#include "rift/yaml/enum_name.hpp"

namespace rift::sweep {

TrialStatus StatusOf(JobEnd end) {
  switch (end) {
    case JobEnd::kDone:
      return TrialStatus::kOk;
    case JobEnd::kThrew:
      return TrialStatus::kFault;
    case JobEnd::kHung:
      return TrialStatus::kHung;
    case JobEnd::kCrashed:
      return TrialStatus::kCrashed;
    case JobEnd::kOutOfMemory:
      return TrialStatus::kOutOfMemory;
  }
  return TrialStatus::kFault;
}

namespace {

JournalEntry EntryOf(const TrialRow& row) {
  return {std::string(yaml::NameOf(row.status)), row.comparison.gap_m, row.falsified,
          EncodeFindings(row)};
}

WorkerPool::Work WorkOf(Evaluate evaluate) {
  return [evaluate = std::move(evaluate)](const std::string& job) {
    return EncodeFindings(evaluate(DecodeRequest(job)));
  };
}

}  // namespace

TrialRequest RequestOf(const TrialRow& row) {
  return {.theta = row.theta,
          .trial = row.trial,
          .seed = row.seed,
          .is_random_draw = row.is_random_draw};
}

TrialRow RowFor(TrialRequest request) {
  return {.theta = std::move(request.theta),
          .trial = std::move(request.trial),
          .seed = request.seed,
          .is_random_draw = request.is_random_draw};
}

TrialRow EndedRow(TrialRequest request, const JobResult& result) {
  TrialRow row = RowFor(std::move(request));
  if (result.end == JobEnd::kDone) return row;
  row.status = StatusOf(result.end);
  row.reason = result.bytes.substr(0, result.bytes.find('\n'));
  return row;
}

JobResult RunApart(const WorkerPool::Work& work, const TrialRequest& request,
                   const RunOptions& options) {
  JobResult ended;
  WorkerPool(work, 1, options)
      .Run({1, [&](int) { return EncodeRequest(request); },
            [&](int, const JobResult& result) { ended = result; }, [] { return true; }});
  return ended;
}

RunTrials RunHere(Evaluate evaluate, Watch watch) {
  return [evaluate = std::move(evaluate), watch = std::move(watch)](
             const std::vector<TrialRequest>& requests) -> std::optional<std::vector<TrialRow>> {
    std::vector<TrialRow> rows;
    rows.reserve(requests.size());
    for (const TrialRequest& request : requests) {
      if (!watch.go_on()) return std::nullopt;
      rows.push_back(evaluate(request));
      watch.seen(rows.back(), false);
    }
    return rows;
  };
}

TrialRunner::TrialRunner(Evaluate evaluate, KeyOf key_of, Journal* journal, int workers,
                         const RunOptions& options, Watch watch, size_t most_paths)
    : key_of_(std::move(key_of)),
      journal_(journal),
      watch_(std::move(watch)),
      pool_(WorkOf(std::move(evaluate)), workers, options),
      most_paths_(most_paths) {}

bool TrialRunner::HasAll(const std::vector<TrialRequest>& requests) {
  if (journal_ == nullptr) return false;
  for (const TrialRequest& request : requests) {
    if (!journal_->Find(key_of_(request))) return false;
  }
  return true;
}

std::vector<size_t> TrialRunner::Missing(const std::vector<TrialRequest>& requests) {
  std::vector<size_t> missing;
  for (size_t i = 0; i < requests.size(); ++i) {
    if (journal_ == nullptr || !journal_->Has(key_of_(requests[i]))) missing.push_back(i);
  }
  return missing;
}

TrialRow TrialRunner::Finish(TrialRequest request, const JobResult& result, bool keeps_path) {
  const std::string key = journal_ == nullptr ? "" : key_of_(request);
  TrialRow row = EndedRow(std::move(request), result);
  if (result.end == JobEnd::kDone) {
    DecodeFindings(result.bytes, row);
  } else {
    watch_.name_sides(row);
  }
  if (!keeps_path) row.evidence.ForgetPath();
  if (journal_ != nullptr) journal_->Add(key, EntryOf(row));
  watch_.seen(row, false);
  return row;
}

std::optional<std::vector<TrialRow>> TrialRunner::Run(std::vector<TrialRequest> requests) {
  std::vector<TrialRow> rows(requests.size());
  const auto keeps_path = [&](size_t i) { return run_ + i < most_paths_; };
  std::vector<int> missing;
  for (size_t i = 0; i < requests.size(); ++i) {
    std::optional<std::string> bytes;
    if (journal_ != nullptr) bytes = journal_->Find(key_of_(requests[i]));
    if (!bytes) {
      missing.push_back(static_cast<int>(i));
      continue;
    }
    rows[i] = RowFor(std::move(requests[i]));
    DecodeFindings(*bytes, rows[i]);
    if (!keeps_path(i)) rows[i].evidence.ForgetPath();
    watch_.seen(rows[i], true);
  }
  WorkerPool::Batch batch;
  batch.count = static_cast<int>(missing.size());
  batch.job = [&](int job) { return EncodeRequest(requests[missing[job]]); };
  batch.done = [&](int job, const JobResult& result) {
    const auto i = static_cast<size_t>(missing[job]);
    rows[i] = Finish(std::move(requests[i]), result, keeps_path(i));
  };
  batch.go_on = [&] {
    if (journal_ != nullptr) journal_->Tick();
    return watch_.go_on();
  };
  const bool is_whole = pool_.Run(batch);
  if (journal_ != nullptr) journal_->Commit();
  if (!is_whole) return std::nullopt;
  run_ += rows.size();
  return rows;
}

template <class Bytes, Is<experiment::ParameterValue> T>
void Members(Bytes& bytes, T& value) {
  bytes(value.text);
  bytes(value.number);
}

template <class Bytes, Is<TrialRequest> T>
void Members(Bytes& bytes, T& request) {
  bytes(request.theta);
  bytes(request.trial);
  bytes(request.seed);
  bytes(request.is_random_draw);
}

template <class Bytes, class T>
requires(Is<T, Eigen::Vector2d> || Is<T, Eigen::Vector2f>) void Members(Bytes& bytes, T& v) {
  bytes(v.x());
  bytes(v.y());
}

template <class Bytes, Is<TrialDoubt> T>
void Members(Bytes& bytes, T& doubt) {
  bytes(doubt.about);
  bytes(doubt.text);
}

/// What a trial found; what was asked for is another's.
template <class Bytes, Is<TrialRow> T>
void Members(Bytes& bytes, T& row) {
  bytes(row.seed);
  bytes(row.status);
  bytes(row.reason);
  bytes(row.candidate);
  bytes(row.reference);
  bytes(row.comparison);
  bytes(row.falsified);
  bytes(row.left_m);
  bytes(row.way_gap_m);
  bytes(row.evidence.fingerprint);
  bytes(row.evidence.candidate_limits);
  bytes(row.evidence.reference_limits);
  bytes(row.evidence.errors_m);
  bytes(row.evidence.path_m);
  bytes(row.evidence.path_times_s);
  bytes(row.doubts);
}

std::string EncodeRequest(const TrialRequest& request) {
  ByteWriter write;
  write(request);
  return write.Take();
}

TrialRequest DecodeRequest(std::string_view bytes) {
  ByteReader read(bytes);
  TrialRequest request;
  read(request);
  return request;
}

std::string EncodeFindings(const TrialRow& row) {
  ByteWriter write;
  write(row);
  return write.Take();
}

void DecodeFindings(std::string_view bytes, TrialRow& row) {
  ByteReader read(bytes);
  read(row);
  if (!read.IsAtEnd()) throw std::runtime_error("a row of the sweep is of another layout");
}

}  // namespace rift::sweep
