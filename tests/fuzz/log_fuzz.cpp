// A log: a first line FORMAT|COLUMNS|UNITS, then the file. FORMAT is one of trajectory::Format, or
// encoders.
#include <algorithm>
#include <cmath>

#include "fuzz.hpp"
#include "rift/odometry/odometry.hpp"
#include "rift/trajectory/log.hpp"
#include "rift/trajectory/read_options.hpp"

namespace rift {
namespace {

void ReadEncodersOf(std::string_view text) {
  const auto readings = odometry::ReadEncoders(text, "log");
  const std::string written = odometry::EncodersCsv(readings);
  fuzz::Require(odometry::EncodersCsv(odometry::ReadEncoders(written, "log")) == written,
                "encoders that were written read back the same", written);
}

void CheckCopies(const trajectory::Trajectory& path) {
  using trajectory::Format;
  for (const auto& pose : path.poses) {
    fuzz::Require(std::isfinite(pose.t_s + pose.x_m + pose.y_m), "poses are finite");
  }
  const std::string written = trajectory::WriteRift(path);
  const trajectory::Log again = trajectory::ReadLog(written, "log", Format::kRift);
  fuzz::Require(trajectory::WriteRift(again.trajectory) == written,
                "a log that was written reads back the same", written);
  trajectory::ReadLog(trajectory::WriteTum(path), "log", Format::kTum);
  if (path.poses.back().t_s - path.poses.front().t_s < 1e9 && path.poses.back().t_s < 1e9) {
    trajectory::WriteMcap(path);
  }
}

void ReadLogOf(std::string_view format, std::string_view columns, std::string_view units,
               std::string_view text) {
  constexpr auto kNames = EnumNames(trajectory::Format{});
  const auto* const name = std::find(kNames.begin(), kNames.end(), format);
  trajectory::ReadOptions options;
  if (name != kNames.end()) {
    options.format = static_cast<trajectory::Format>(name - kNames.begin());
  }
  options.columns = columns;
  options.units = units;
  trajectory::Trajectory path;
  try {
    trajectory::CheckColumns(options);
    path = trajectory::ReadLog(text, "log", options).trajectory;
  } catch (const std::invalid_argument& error) {
    fuzz::RequireOneLine(error.what());
    return;
  }
  CheckCopies(path);
}

}  // namespace
}  // namespace rift

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rift;
  std::string_view text = fuzz::TextOf(data, size);
  std::string_view head = fuzz::TakeUntil(text, '\n');
  const std::string_view format = fuzz::TakeUntil(head, '|');
  const std::string_view columns = fuzz::TakeUntil(head, '|');
  if (format != "encoders") {
    ReadLogOf(format, columns, head, text);
    return 0;
  }
  try {
    ReadEncodersOf(text);
  } catch (const std::invalid_argument& error) {
    fuzz::RequireOneLine(error.what());
  }
  return 0;
}
