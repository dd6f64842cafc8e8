#include "track_names.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <vector>

#include "outputs.hpp"

namespace rift::commands {

namespace fs = std::filesystem;

namespace {

/// `frames/*.jpg` is a camera too, and frames/000.jpg one of its pictures.
void RefuseAmongPictures(const fs::path& camera, const fs::path& log) {
  const bool is_pattern = camera.filename().string().find('*') != std::string::npos;
  const bool is_among =
      is_pattern && log.extension() == camera.extension() &&
      IsSameFile(fs::absolute(log).parent_path(), fs::absolute(camera).parent_path());
  if (!is_among) return;
  throw std::invalid_argument(
      fmt::format("--out {} is one of the camera's pictures: name a log", log.string()));
}

}  // namespace

fs::path RunFileOf(const fs::path& log) {
  return fs::path(log).replace_extension().string() + ".run.json";
}

void CheckLogName(const TrackRequest& request) {
  std::error_code not_there;
  if (fs::exists(request.out, not_there) && !fs::is_regular_file(request.out, not_there)) {
    throw std::invalid_argument(fmt::format(
        "--out {}: the log needs a file, since its run file stands beside it", request.out));
  }
  std::vector<fs::path> inputs{request.calibration};
  for (const std::string& input : {request.world, request.path, request.experiment}) {
    if (!input.empty()) inputs.emplace_back(input);
  }
  if (fs::exists(request.camera, not_there)) inputs.emplace_back(request.camera);
  RefuseAmongPictures(request.camera, request.out);
  std::vector<fs::path> outputs{request.out, RunFileOf(request.out)};
  if (!request.record_waypoints.empty()) outputs.emplace_back(request.record_waypoints);
  CheckOutputs(inputs, outputs);
}

}  // namespace rift::commands
