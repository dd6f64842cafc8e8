#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "rift/files/files.hpp"
#include "rift/files/outputs.hpp"
#include "rift/sessions/track/tracking.hpp"

namespace rift::sessions {
namespace {

namespace fs = std::filesystem;

/// `frames/*.jpg` is a camera too, and frames/000.jpg one of its pictures.
void RefuseAmongPictures(const fs::path& camera, const fs::path& log) {
  const bool is_pattern = camera.filename().string().find('*') != std::string::npos;
  const bool is_among =
      is_pattern && log.extension() == camera.extension() &&
      files::IsSameFile(fs::absolute(log).parent_path(), fs::absolute(camera).parent_path());
  if (!is_among) return;
  throw std::invalid_argument(
      fmt::format("--out {} is one of the camera's pictures: name a log", log.string()));
}

}  // namespace

void CheckNames(const TrackingJob& job, std::vector<fs::path> inputs,
                const std::vector<fs::path>& copies) {
  std::error_code not_there;
  if (fs::exists(job.log, not_there) && !fs::is_regular_file(job.log, not_there)) {
    throw std::invalid_argument(fmt::format(
        "--out {}: the log needs a file, since its run file stands beside it", job.log));
  }
  inputs.emplace_back(job.calibration);
  for (const std::string& input : {job.world, job.path}) {
    if (!input.empty()) inputs.emplace_back(input);
  }
  if (fs::exists(job.camera, not_there)) inputs.emplace_back(job.camera);
  RefuseAmongPictures(job.camera, job.log);
  std::vector<fs::path> outputs;
  if (!job.IsPiped()) outputs.emplace_back(job.log);
  if (!job.record_waypoints.empty()) outputs.emplace_back(job.record_waypoints);
  outputs.insert(outputs.end(), copies.begin(), copies.end());
  files::CheckOutputs(inputs, {.files = outputs, .force = job.force});
  // Without its log it is of a camera that showed no tag, and tells nothing.
  inputs.insert(inputs.end(), outputs.begin(), outputs.end());
  if (!job.IsPiped()) files::CheckOutputs(inputs, {.files = {RunFileOf(job.log)}, .force = true});
}

}  // namespace rift::sessions
