#include "rift/sweep/falsify/trial_runner.hpp"

#include <stdexcept>
#include <utility>

#include "job_status.hpp"
#include "rift/sweep/run/byte_codec.hpp"

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

TrialRow RowFor(TrialRequest request) {
  return {.theta = std::move(request.theta),
          .trial = std::move(request.trial),
          .seed = request.seed,
          .is_random_draw = request.is_random_draw};
}

JournalEntry EntryOf(const TrialRow& row) {
  const auto status = EnumNames(row.status)[static_cast<size_t>(row.status)];
  return {std::string(status), row.comparison.gap_m, row.falsified, EncodeFindings(row)};
}

WorkerPool::Work WorkOf(Evaluate evaluate) {
  return [evaluate = std::move(evaluate)](const std::string& job) {
    return EncodeFindings(evaluate(DecodeRequest(job)));
  };
}

}  // namespace

TrialRow EndedRow(TrialRequest request, const JobResult& result) {
  TrialRow row = RowFor(std::move(request));
  if (result.end == JobEnd::kDone) return row;
  row.status = StatusOf(result.end);
  row.reason = result.bytes.substr(0, result.bytes.find('\n'));
  return row;
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
  if (!keeps_path) row.evidence.path_m = {};
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
    if (!keeps_path(i)) rows[i].evidence.path_m = {};
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

namespace {

// One list of members for both directions; Row is const for a writer.
template <class Codec, class Row>
void Members(Codec& codec, Row& row) {
  codec(row.seed);
  codec(row.status);
  codec(row.reason);
  codec(row.candidate);
  codec(row.reference);
  codec(row.comparison);
  codec(row.falsified);
  codec(row.left_m);
  codec(row.way_gap_m);
  codec(row.evidence.fingerprint);
  codec(row.evidence.candidate_limits);
  codec(row.evidence.reference_limits);
}

}  // namespace

std::string EncodeRequest(const TrialRequest& request) {
  ByteWriter write;
  write(request.theta.size());
  for (const experiment::ParameterValue& value : request.theta) {
    write(value.text);
    write(value.number);
  }
  write(request.trial);
  write(request.seed);
  write(request.is_random_draw);
  return write.Take();
}

TrialRequest DecodeRequest(std::string_view bytes) {
  ByteReader read(bytes);
  TrialRequest request;
  request.theta.resize(read.Count(sizeof(size_t) + sizeof(double)));
  for (experiment::ParameterValue& value : request.theta) {
    read(value.text);
    read(value.number);
  }
  read(request.trial);
  read(request.seed);
  read(request.is_random_draw);
  return request;
}

std::string EncodeFindings(const TrialRow& row) {
  ByteWriter write;
  Members(write, row);
  write(row.evidence.errors_m.size());
  for (const Eigen::Vector2d& error_m : row.evidence.errors_m) {
    write(error_m.x());
    write(error_m.y());
  }
  write(row.evidence.path_m.size());
  for (const Eigen::Vector2f& point_m : row.evidence.path_m) {
    write(point_m.x());
    write(point_m.y());
  }
  write(row.doubts.size());
  for (const TrialDoubt& doubt : row.doubts) {
    write(doubt.about);
    write(doubt.text);
  }
  return write.Take();
}

void DecodeFindings(std::string_view bytes, TrialRow& row) {
  ByteReader read(bytes);
  Members(read, row);
  const size_t errors = read.Count(2 * sizeof(double));
  row.evidence.errors_m.clear();
  for (size_t i = 0; i < errors; ++i) {
    double x_m = 0.0, y_m = 0.0;
    read(x_m);
    read(y_m);
    row.evidence.errors_m.emplace_back(x_m, y_m);
  }
  row.evidence.path_m.assign(read.Count(2 * sizeof(float)), Eigen::Vector2f::Zero());
  for (Eigen::Vector2f& point_m : row.evidence.path_m) {
    read(point_m.x());
    read(point_m.y());
  }
  row.doubts.resize(read.Count(sizeof(DoubtAbout) + sizeof(size_t)));
  for (TrialDoubt& doubt : row.doubts) {
    read(doubt.about);
    read(doubt.text);
  }
  if (!read.IsAtEnd()) throw std::runtime_error("a row of the sweep is of another layout");
}

}  // namespace rift::sweep
