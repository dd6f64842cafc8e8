#include "row_codec.hpp"

#include <stdexcept>

#include "rift/sweep/run/byte_codec.hpp"

namespace rift::sweep {
namespace {

// One list of members for both directions; Row is const for a writer.
template <class Codec, class Row>
void Members(Codec& codec, Row& row) {
  codec(row.status);
  codec(row.reason);
  codec(row.candidate);
  codec(row.reference);
  codec(row.comparison);
  codec(row.falsified);
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
  size_t size = 0;
  read(size);
  request.theta.resize(size);
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
  return write.Take();
}

void DecodeFindings(std::string_view bytes, TrialRow& row) {
  ByteReader read(bytes);
  Members(read, row);
  size_t errors = 0;
  read(errors);
  row.evidence.errors_m.clear();
  for (size_t i = 0; i < errors; ++i) {
    double x_m = 0.0, y_m = 0.0;
    read(x_m);
    read(y_m);
    row.evidence.errors_m.emplace_back(x_m, y_m);
  }
  if (!read.IsAtEnd()) throw std::runtime_error("a row of the sweep is of another layout");
}

}  // namespace rift::sweep
